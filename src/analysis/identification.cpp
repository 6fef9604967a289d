#include "samara/analysis/identification.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "samara/base/format.hpp"

#include "strain_energy.hpp"

namespace samara::analysis {
namespace {

using system::EnergyGroup;

/// Share of the energy that must be strain for a mode to be called elastic.
constexpr double elastic_share = 0.15;

/// Relative difference below which moduli, and real parts relative to the modulus, sort as the
/// same.
constexpr double same_size = 1e-6;
/// Exponents are the same if their relative difference is below `degenerate`, or below
/// `many_errors` times their errors by round-off.
constexpr double degenerate = 1e-7;
constexpr double many_errors = 4.0;
/// Relative to the largest one: a smaller singular value of displacements is round-off.
constexpr double least_displacement = 1e-4;
/// Distance of a coordinate from the displacements that move it alone.
constexpr double moves_alone = 1e-6;
/// Part of the largest strain energy of a place along a part, below which the sign of the load
/// there has no meaning.
constexpr double least_energy = 0.05;

/// Groups of two or more exponents that are the same, each group a chain of neighbours; zeros are
/// left out. `apart`: for each exponent, the largest relative difference from one that is the same.
/// Exponents of different `classes` are not the same.
std::vector<std::vector<std::size_t>> groups_of(const std::vector<std::complex<double>>& exponents,
                                                const std::vector<double>& apart,
                                                const std::vector<int>& classes) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < exponents.size(); ++i)
    if (exponents[i] != 0.0) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(exponents[a]) < std::abs(exponents[b]);
  });
  std::vector<std::vector<std::size_t>> groups;
  std::vector<bool> taken(order.size(), false);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (taken[i]) continue;
    std::vector<std::size_t> group{order[i]};
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const std::size_t a = group.back();
      const std::size_t b = order[j];
      const double size = std::abs(exponents[b]);
      if (size - std::abs(exponents[a]) > same_size * size) break;
      if (taken[j] || classes[a] != classes[b] ||
          std::abs(exponents[b] - exponents[a]) > std::max(apart[a], apart[b]) * size)
        continue;
      taken[j] = true;
      group.push_back(b);
    }
    if (group.size() > 1) groups.push_back(group);
  }
  return groups;
}

/// The joint that moves most: its position has the largest mean square.
std::optional<system::Owner> moving_joint(const system::PeriodicSystem& system,
                                          const Eigen::MatrixXcd& shape) {
  std::optional<system::Owner> joint;
  double largest = 0.0;
  for (std::size_t i = 0; i < system.rows().size(); ++i) {
    const system::Unknown& unknown = system.unknowns()[i];
    if (unknown.owner.kind != system::PartKind::joint ||
        unknown.role != system::UnknownRole::position)
      continue;
    const double size = shape.row(static_cast<Eigen::Index>(i)).squaredNorm();
    if (size <= largest) continue;
    largest = size;
    joint = unknown.owner;
  }
  return joint;
}

/// Motion of a mode of a system that does not declare its motions, from the strain energy.
system::Motion strained_motion(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                               const Mode& mode, double zero) {
  const std::map<std::string, double> strain = strain_energies(system, shape);
  const auto largest =
      std::max_element(strain.begin(), strain.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  const std::optional<system::Owner> joint = moving_joint(system, shape);
  const bool is_rigid =
      std::abs(mode.exponent) < zero || (mode.resolved && is_rigid_body(system, shape, mode));
  if (joint && (is_rigid || largest == strain.end())) return {*joint};
  for (const EnergyGroup& group : system.energy_groups())
    if (largest != strain.end() && group.kind == EnergyGroup::Kind::strain &&
        motion_name(group) == largest->first)
      return {group.owner, group.direction};
  return {{system::PartKind::body, "mode"}};
}

const char* word_of(const LeadingMotion& leading, int instances) {
  if (leading.cyclic != CyclicMotion::none)
    return leading.cyclic == CyclicMotion::cosine ? " cosine-cyclic" : " sine-cyclic";
  const int n = leading.component;
  if (n < 0) return "";
  if (instances == 2) return n == 0 ? " symmetric" : " antisymmetric";
  if (n == 0) return " collective";
  if (n == 1) return " regressive";
  return n == instances - 1 ? " progressive" : " reactionless";
}

/// Numbers of modes of parts that deform, by their shapes.
class ShapeNumbers {
 public:
  explicit ShapeNumbers(const system::PeriodicSystem& system) {
    for (const EnergyGroup& group : system.energy_groups()) {
      if (group.kind != EnergyGroup::Kind::strain || group.unknowns.size() != 1) continue;
      const Eigen::Index load = group.unknowns.front();
      const std::string& quantity = system.unknowns()[static_cast<std::size_t>(load)].quantity;
      loads_[{group.owner.kind, motion_name(group)}][{group.owner.instance, quantity}].push_back(
          {load, group.weight.front()});
    }
  }

  /// The load that the motion restores changes its sign (number - 1) times along the part. Thus the
  /// number is known where other modes of the motion are not. 0: the part has too few places, or
  /// the motion no such load.
  int number_of(const system::Motion& motion, const Eigen::MatrixXcd& shape) const {
    const auto found = loads_.find({motion.owner.kind, motion.name()});
    if (found == loads_.end() || shape.size() == 0) return 0;
    const std::vector<Place>* places = nullptr;
    Eigen::VectorXd energies = Eigen::VectorXd::Zero(1);
    for (const auto& [key, along] : found->second) {
      Eigen::VectorXd own(static_cast<Eigen::Index>(along.size()));
      for (Eigen::Index i = 0; i < own.size(); ++i) {
        const Place& place = along[static_cast<std::size_t>(i)];
        own(i) = place.weight * shape.row(place.load).squaredNorm();
      }
      if (own.sum() <= energies.sum()) continue;
      energies = own;
      places = &along;
    }
    if (places == nullptr) return 0;
    Eigen::Index largest = 0;
    const double most = energies.maxCoeff(&largest);
    const auto load_at = [&](Eigen::Index i) {
      return shape.row((*places)[static_cast<std::size_t>(i)].load);
    };
    // The phase of a strongly damped mode turns along the part: what is in phase counts.
    const double square = load_at(largest).squaredNorm();
    int number = 0;
    bool is_positive = true;
    for (Eigen::Index i = 0; i < energies.size(); ++i) {
      const double in_phase = load_at(largest).dot(load_at(i)).real();
      const double weight = (*places)[static_cast<std::size_t>(i)].weight;
      if (!(weight * in_phase * in_phase >= least_energy * most * square)) continue;
      const bool sign = in_phase > 0.0;
      if (number == 0 || sign != is_positive) ++number;
      is_positive = sign;
    }
    return energies.size() > 3 && 2 * number < energies.size() ? number : 0;
  }

 private:
  struct Place {
    Eigen::Index load;
    double weight;
  };
  using Motion = std::pair<system::PartKind, std::string>;  // kind of part, name
  using Load = std::pair<int, std::string>;                 // instance of the part, quantity

  /// From the root of each part to its tip.
  std::map<Motion, std::map<Load, std::vector<Place>>> loads_;
};

/// Name of a mode, in two parts.
struct Name {
  system::Motion motion;
  std::string together;     ///< word for the phase between the blades
  bool is_mixture = false;  ///< of bending in two directions, with others of the same exponent
  std::string text() const { return motion.name() + together; }
};

/// Modes of equal exponents are arbitrary mixtures: differences between their names have no meaning
/// and are removed. Over a blade passage modes at different harmonics stay distinct, because half a
/// turn, for example, changes the sign of one of them. `canonical`: the modes have been chosen by
/// the phase between the blades.
void unite_degenerate(const ModeSet& set, int sectors, bool canonical, std::vector<Name>& names) {
  std::vector<std::complex<double>> exponents;
  std::vector<double> apart;
  std::vector<int> harmonics;
  for (const Mode& mode : set.modes) {
    exponents.push_back(mode.exponent);
    apart.push_back(std::clamp(many_errors * mode.round_off_error, degenerate, same_size));
    harmonics.push_back(sectors > 1 ? mode.harmonic : 0);
  }
  for (const std::vector<std::size_t>& equal : groups_of(exponents, apart, harmonics)) {
    std::map<std::string, std::set<std::string>> directions;  // of each part that bends
    std::map<std::string, int> bending;                       // modes of the part
    std::map<std::string, int> count;                         // modes of the motion
    for (const std::size_t m : equal) {
      const system::Motion& motion = names[m].motion;
      ++count[motion.name()];
      if (!motion.bends) continue;
      directions[motion.owner.part].insert(motion.direction);
      ++bending[motion.owner.part];
    }
    for (const std::size_t m : equal) {
      Name& name = names[m];
      const std::string& part = name.motion.owner.part;
      const int alike = name.motion.bends ? bending[part] : count[name.motion.name()];
      if (name.motion.bends) {
        // Arbitrary mixtures may all have more of one direction than of the other: then they are
        // more than the parts that can move in it.
        const int parts = name.motion.owner.instance > 0 ? set.instances : 1;
        name.is_mixture = directions[part].size() > 1 || (parts > 0 && bending[part] > parts);
        if (name.is_mixture) name.motion.direction = "bending";
      }
      if (!canonical && alike > 1) name.together = "";
    }
  }
}

/// Places in ascending order of `values`; the same place for a value whose distance to the next is
/// at most `relative` times its modulus plus `absolute`.
std::vector<int> ranks_of(const std::vector<double>& values, double relative, double absolute) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&values](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<int> ranks(values.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    const double gap = values[order[i]] - values[order[i - 1]];
    const bool same = gap <= relative * std::abs(values[order[i]]) + absolute;
    ranks[order[i]] = ranks[order[i - 1]] + (same ? 0 : 1);
  }
  return ranks;
}

/// Root of the mean square of all positions, relative to their scales.
double size_of_positions(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape) {
  double square = 0.0;
  for (Eigen::Index i = 0; i < shape.rows(); ++i) {
    const system::Unknown& unknown = system.unknowns()[static_cast<std::size_t>(i)];
    if (unknown.role == system::UnknownRole::position)
      square += (shape.row(i) / unknown.scale).squaredNorm();
  }
  return std::sqrt(square / static_cast<double>(shape.cols()));
}

/// Mean values of the unconstrained coordinates.
Eigen::VectorXcd displacements(const system::PeriodicSystem& system,
                               const Eigen::MatrixXcd& shape) {
  const auto& coordinates = system.unconstrained_coordinates();
  Eigen::VectorXcd means(static_cast<Eigen::Index>(coordinates.size()));
  for (Eigen::Index j = 0; j < means.size(); ++j)
    means(j) = shape.row(coordinates[static_cast<std::size_t>(j)].unknown).mean();
  return means;
}

/// Numbers of exponents of each unconstrained coordinate that are not zero: real ones of motions
/// that it leads.
std::vector<int> count_drifts(const system::PeriodicSystem& system,
                              const std::vector<LeadingMotion>& leading, const ModeSet& set) {
  const auto& coordinates = system.unconstrained_coordinates();
  std::vector<int> drifts(coordinates.size(), 0);
  for (std::size_t m = 0; m < leading.size(); ++m) {
    if (set.modes[m].exponent.imag() != 0.0 || is_at_rest(set.modes[m], set)) continue;
    for (std::size_t j = 0; j < coordinates.size(); ++j)
      if (system.unknowns()[static_cast<std::size_t>(coordinates[j].unknown)].owner ==
          leading[m].motion.owner)
        ++drifts[j];
  }
  return drifts;
}

/// Whether each unconstrained coordinate leads as many of the given modes as it is chosen for.
bool leads_as_often(const system::PeriodicSystem& system, const std::vector<LeadingMotion>& leading,
                    const std::vector<std::size_t>& modes,
                    const std::vector<Eigen::Index>& chosen) {
  const auto& coordinates = system.unconstrained_coordinates();
  if (leading.empty()) return false;
  for (std::size_t j = 0; j < coordinates.size(); ++j) {
    const system::Owner& owner =
        system.unknowns()[static_cast<std::size_t>(coordinates[j].unknown)].owner;
    const auto leads = std::ranges::count_if(
        modes, [&](std::size_t m) { return leading[m].motion.owner == owner; });
    if (leads != std::ranges::count(chosen, static_cast<Eigen::Index>(j))) return false;
  }
  return true;
}

/// Replaces modes at rest. Each coordinate has two exponents; `leading` tells which of them are not
/// zero. False where no mode changes.
bool separate_displacements(const system::PeriodicSystem& system,
                            const std::vector<LeadingMotion>& leading, ModeSet& set) {
  std::vector<std::size_t> at_rest;
  for (std::size_t m = 0; m < set.shapes.size(); ++m)
    if (!set.modes[m].state && is_at_rest(set.modes[m], set)) at_rest.push_back(m);
  // Those of modes that are not resolved have few instants.
  if (std::ranges::any_of(at_rest, [&](std::size_t m) {
        return set.shapes[m].cols() != set.shapes[at_rest.front()].cols();
      }))
    return false;
  const auto coordinates = static_cast<Eigen::Index>(system.unconstrained_coordinates().size());
  if (at_rest.size() < 2 || coordinates < 2) return false;
  const auto count = static_cast<Eigen::Index>(at_rest.size());
  Eigen::MatrixXcd moved(coordinates, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::MatrixXcd& shape = set.shapes[at_rest[static_cast<std::size_t>(i)]];
    const double size = size_of_positions(system, shape);
    if (!(size > 0.0)) return false;
    shape /= size;
    moved.col(i) = displacements(system, shape);
  }
  Eigen::JacobiSVD<Eigen::MatrixXcd> svd(moved, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(least_displacement);
  const Eigen::MatrixXcd alone = Eigen::MatrixXcd::Identity(coordinates, coordinates);
  const Eigen::MatrixXcd factors = svd.solve(alone);
  std::vector<Eigen::Index> moving;
  for (Eigen::Index j = 0; j < coordinates; ++j)
    if ((moved * factors.col(j) - alone.col(j)).norm() < moves_alone) moving.push_back(j);
  if (moving.size() < 2 || static_cast<Eigen::Index>(moving.size()) != svd.rank()) return false;
  // Each of them once, then those that have not two exponents yet.
  std::vector<int> has = count_drifts(system, leading, set);
  std::vector<Eigen::Index> chosen = moving;
  for (const Eigen::Index j : moving) ++has[static_cast<std::size_t>(j)];
  while (chosen.size() < at_rest.size()) {
    const Eigen::Index next = *std::ranges::min_element(
        moving, {}, [&has](Eigen::Index j) { return has[static_cast<std::size_t>(j)]; });
    chosen.push_back(next);
    ++has[static_cast<std::size_t>(next)];
  }
  if (leads_as_often(system, leading, at_rest, chosen)) return false;
  std::vector<Eigen::MatrixXcd> separate(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    separate[i].setZero(set.shapes[at_rest[0]].rows(), set.shapes[at_rest[0]].cols());
    for (std::size_t k = 0; k < at_rest.size(); ++k)
      separate[i] += factors(static_cast<Eigen::Index>(k), chosen[i]) * set.shapes[at_rest[k]];
  }
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    set.shapes[at_rest[i]] = std::move(separate[i]);
    set.modes[at_rest[i]].parts.clear();  // those of the combination before
  }
  return true;
}

}  // namespace

bool has_canonical_shapes(const system::PeriodicSystem& system) {
  return system.period() > 0.0 && system.symmetry().sectors > 2;
}

void choose_shapes(const system::PeriodicSystem& system,
                   std::vector<std::complex<double>>& exponents,
                   std::vector<Eigen::MatrixXcd>& shapes) {
  if (!has_canonical_shapes(system)) return;
  const system::RotorSymmetry& symmetry = system.symmetry();
  for (const std::vector<std::size_t>& equal :
       groups_of(exponents, std::vector<double>(exponents.size(), same_size),
                 std::vector<int>(exponents.size(), 0))) {
    if (exponents[equal.front()].imag() == 0.0) continue;
    const auto count = static_cast<Eigen::Index>(equal.size());
    Eigen::MatrixXcd all(system.size(), count);
    Eigen::VectorXcd values(count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const std::size_t mode = equal[static_cast<std::size_t>(j)];
      all.col(j) = shapes[mode].col(0) / shapes[mode].norm();
      values(j) = exponents[mode];
    }
    // P moves the motion of each blade to the next blade. Within these modes it is a matrix W whose
    // B-th power is the identity; W does not mix exponents.
    Eigen::MatrixXcd turned(all.rows(), count);
    for (Eigen::Index row = 0; row < all.rows(); ++row) {
      const auto at = static_cast<std::size_t>(row);
      turned.row(row) = symmetry.sign[at] * all.row(symmetry.source[at]);
    }
    const Eigen::MatrixXcd W = all.colPivHouseholderQr().solve(turned);
    Eigen::MatrixXcd chosen(count, count);
    Eigen::VectorXcd chosen_values(count);
    Eigen::Index found = 0;
    for (int n = 0; n < symmetry.sectors; ++n) {
      Eigen::MatrixXcd projector = Eigen::MatrixXcd::Zero(count, count);
      Eigen::MatrixXcd power = Eigen::MatrixXcd::Identity(count, count);
      for (int j = 0; j < symmetry.sectors; ++j) {
        projector +=
            std::polar(1.0 / symmetry.sectors, -2.0 * std::numbers::pi * n * j / symmetry.sectors) *
            power;
        power = (power * W).eval();
      }
      const auto rank = static_cast<Eigen::Index>(std::lround(projector.trace().real()));
      if (rank < 1 || found + rank > count) continue;
      const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(projector, Eigen::ComputeThinU);
      const Eigen::MatrixXcd basis = svd.matrixU().leftCols(rank);
      const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> within(basis.adjoint() *
                                                               values.asDiagonal() * basis);
      chosen.middleCols(found, rank) = basis * within.eigenvectors();
      chosen_values.segment(found, rank) = within.eigenvalues();
      found += rank;
    }
    if (found != count) continue;
    for (Eigen::Index j = 0; j < count; ++j) {
      const std::size_t mode = equal[static_cast<std::size_t>(j)];
      shapes[mode] = all * chosen.col(j);
      exponents[mode] = chosen_values(j);
    }
  }
}

bool is_rigid_body(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                   const Mode& mode) {
  double strained = 0.0;
  for (const EnergyGroup& group : system.energy_groups())
    if (group.kind == EnergyGroup::Kind::strain && group.owner.kind != system::PartKind::joint)
      strained +=
          (1.0 + group.damping * std::abs(mode.exponent)) * mean_strain_energy(group, shape);
  return strained < elastic_share * (strained + mode.kinetic_energy);
}

std::vector<LeadingMotion> separate_motions(const system::PeriodicSystem& system,
                                            const PeriodicSolution& solution, ModeSet& set,
                                            int sectors) {
  std::vector<LeadingMotion> leading = find_leading_motions(system, solution, set, sectors);
  if (separate_displacements(system, leading, set))
    leading = find_leading_motions(system, solution, set, sectors);
  return leading;
}

void conjugate_mode(ModeSet& set, std::size_t m) {
  Mode& mode = set.modes[m];
  mode.exponent = std::conj(mode.exponent);
  mode.step_exponent = std::conj(mode.step_exponent);
  mode.harmonic = -mode.harmonic;
  mode.multiplier = std::conj(mode.multiplier);
  mirror_harmonics(static_cast<Eigen::Index>(m), set.participation);
  if (!set.shapes.empty()) set.shapes[m] = set.shapes[m].conjugate().eval();
}

void mirror_harmonics(Eigen::Index m, Eigen::MatrixXd& shares) {
  const Eigen::RowVectorXd own = shares.row(m);
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    const Eigen::Index mirrored = own.size() / 2 * 2 - i;
    shares(m, i) = mirrored < own.size() ? own(mirrored) : 0.0;
  }
}

void scale_shapes(const system::PeriodicSystem& system, ModeSet& set) {
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    Eigen::MatrixXcd& shape = set.shapes[m];
    double largest = 0.0;
    const std::optional<system::Owner>& state = set.modes[m].state;
    for (Eigen::Index i = 0; i < shape.rows(); ++i) {
      const system::Unknown& unknown = system.unknowns()[static_cast<std::size_t>(i)];
      const bool counts =
          state ? unknown.role == system::UnknownRole::state && unknown.owner.is_alike(*state)
                : unknown.role == system::UnknownRole::position;
      if (counts) largest = std::max(largest, shape.row(i).cwiseAbs().maxCoeff() / unknown.scale);
    }
    if (!(largest > 0.0)) continue;
    shape /= largest;
    set.modes[m].kinetic_energy /= largest * largest;
  }
}

void name_modes(const system::PeriodicSystem& system, const std::vector<LeadingMotion>& leading,
                ModeSet& set, int sectors) {
  set.instances = count_instances(system.motions());
  set.medium_states = static_cast<int>(std::count_if(
      system.unknowns().begin(), system.unknowns().end(), [](const system::Unknown& unknown) {
        return unknown.role == system::UnknownRole::state && unknown.is_of_medium();
      }));
  if (set.shapes.empty()) return;  // another rank has them
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  const ShapeNumbers numbers(system);
  std::vector<Name> names;
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    const Mode& mode = set.modes[m];
    if (leading.empty()) {
      names.push_back({mode.state ? system::Motion{*mode.state}
                                  : strained_motion(system, set.shapes[m], mode, zero),
                       ""});
      continue;
    }
    names.push_back({leading[m].motion, word_of(leading[m], set.instances)});
  }
  const bool canonical = has_canonical_shapes(system) && set.shape_times.size() == 1;
  unite_degenerate(set, sectors, canonical, names);
  for (std::size_t m = 0; m < names.size(); ++m) {
    Mode& mode = set.modes[m];
    mode.name = names[m].text();
    mode.motion = names[m].motion.name();
    mode.is_mixture = names[m].is_mixture;
    mode.shape_number =
        numbers.number_of(leading.empty() ? names[m].motion : leading[m].motion, set.shapes[m]);
    const double frequency = mode.exponent.imag();
    const bool is_rotating = names[m].motion.owner.instance > 0;
    const bool is_clear = leading.empty() || mode.state || leading[m].is_clear;
    if (set.rotor_speed == 0.0 || frequency <= zero || (!is_rotating && is_clear))
      mode.fixed_frame_frequency = frequency;
    else if (set.instances > 2 && is_clear && !names[m].together.empty()) {
      const int n = leading[m].component;
      mode.fixed_frame_frequency =
          std::abs(frequency - (2 * n > set.instances ? n - set.instances : n) * set.rotor_speed);
    }
  }
}

std::string label_of(const std::string& name, int number, std::map<std::string, int>& times) {
  const std::string label = number > 0 ? ordinal(number) + " " + name : name;
  const int time = ++times[label];
  return time > 1 ? label + " (" + std::to_string(time) + ")" : label;
}

void pick_modes(ModeSet& set, const std::vector<std::size_t>& numbers) {
  std::vector<Mode> modes;
  std::vector<Eigen::MatrixXcd> shapes;  // large: moved, not copied
  std::vector<Eigen::Index> rows;
  for (const std::size_t m : numbers) {
    modes.push_back(std::move(set.modes[m]));
    if (!set.shapes.empty()) shapes.push_back(std::move(set.shapes[m]));
    rows.push_back(static_cast<Eigen::Index>(m));
  }
  set.modes = std::move(modes);
  set.shapes = std::move(shapes);
  if (set.participation.rows() > 0) set.participation = set.participation(rows, Eigen::all).eval();
}

void arrange_modes(ModeSet& set) {
  const std::size_t count = set.modes.size();
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  std::vector<double> sizes;
  std::vector<double> decays;
  for (const Mode& mode : set.modes) {
    const double size = std::abs(mode.exponent);
    sizes.push_back(size < zero ? 0.0 : size);
    decays.push_back(size < zero ? 0.0 : -mode.exponent.real() / size);
  }
  const std::vector<int> by_size = ranks_of(sizes, same_size, 0.0);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto harmonic_key = [&set](std::size_t m) {
    return std::pair(std::abs(set.modes[m].harmonic), set.modes[m].harmonic);
  };
  const std::vector<int> by_growth = ranks_of(decays, 0.0, same_size);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t m) {
      return std::tuple(!set.modes[m].resolved, is_of_medium(set.modes[m]), by_size[m],
                        by_growth[m], set.modes[m].name, harmonic_key(m),
                        std::abs(set.modes[m].exponent));
    };
    return key(a) < key(b);
  });
  pick_modes(set, order);
  // Modes that are not resolved come after the others and take the last numbers; they do not change
  // the names of resolved modes.
  std::map<std::string, int> alike;
  for (const Mode& mode : set.modes)
    if (mode.resolved) ++alike[mode.name];
  std::map<std::string, int> last;   // numbers by the names, and by the motions alone
  std::map<std::string, int> mixed;  // place of the size of the last mixture, by the names
  std::map<std::string, int> times;
  for (std::size_t i = 0; i < count; ++i) {
    Mode& mode = set.modes[i];
    const int size = by_size[order[i]];
    const bool has_partner =
        mode.is_mixture && mixed.contains(mode.name) && mixed[mode.name] == size;
    if (mode.is_mixture) mixed[mode.name] = size;
    const int own = mode.shape_number > 0 ? mode.shape_number
                    : has_partner         ? last[mode.name]
                                          : last[mode.name] + 1;
    for (const std::string& name : {mode.name, mode.motion}) last[name] = std::max(last[name], own);
    const bool has_number =
        !mode.name.empty() && (mode.shape_number > 0 || alike[mode.name] > 1 || own > 1);
    mode.number = has_number ? own : 0;
    mode.label = mode.name.empty() ? "" : label_of(mode.name, mode.number, times);
  }
}

}  // namespace samara::analysis
