#include "samara/analysis/identification.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace samara::analysis {
namespace {

using system::EnergyGroup;

/// Share of the energy that must be strain for a mode to be called elastic.
constexpr double elastic_share = 0.15;

/// Share of a multiblade component beyond which it names a mode.
constexpr double clear_share = 0.7;

/// On each side of the identified harmonic, those whose rates make the kinetic energy.
constexpr Eigen::Index fitted_harmonics = 8;

/// Moduli, and real parts relative to the modulus, closer than this sort as the same.
constexpr double same_size = 1e-6;
/// Share of the kinetic energy whose coordinates move at the identified harmonic, beyond which they
/// alone name a mode.
constexpr double dominant_part = 0.5;

/// Share of the kinetic energy at a harmonic, from which on it may be that of the mode.
constexpr double clear_part = 0.2;

/// Exponents closer than this, relative, or than so many of their errors by rounding, are the same.
constexpr double degenerate = 1e-7;
constexpr double many_errors = 4.0;

/// Exponents that are the same, one chain of neighbours each, of two or more; zeros left out.
/// `apart`: of each, how far the same one may be, relative. Those of different `classes` are not
/// the same.
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

Eigen::MatrixXd weight_of(const EnergyGroup& group) {
  const auto n = static_cast<Eigen::Index>(group.unknowns.size());
  return Eigen::Map<const Eigen::MatrixXd>(group.weight.data(), n, n);
}

double mean_strain_energy(const EnergyGroup& group, const Eigen::MatrixXcd& shape) {
  const Eigen::MatrixXd weight = weight_of(group);
  double energy = 0.0;
  for (Eigen::Index a = 0; a < weight.rows(); ++a)
    for (Eigen::Index b = 0; b < weight.cols(); ++b) {
      if (weight(a, b) == 0.0) continue;
      const auto row = group.unknowns[static_cast<std::size_t>(a)];
      const auto column = group.unknowns[static_cast<std::size_t>(b)];
      energy += 0.5 * weight(a, b) * std::real(shape.row(row).dot(shape.row(column)));
    }
  return energy / static_cast<double>(shape.cols());
}

/// The joint that turns most: the free position of the largest mean square.
std::string moving_joint(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape) {
  std::string name;
  double largest = 0.0;
  for (std::size_t i = 0; i < system.rows().size(); ++i) {
    const system::Unknown& unknown = system.unknowns()[i];
    const bool joint = unknown.name.ends_with(" angle");
    const double size = shape.row(static_cast<Eigen::Index>(i)).squaredNorm();
    const bool support = unknown.name.find(" support theta") != std::string::npos;
    if (!(joint || support) || size <= largest) continue;
    largest = size;
    const std::string beam = unknown.name.substr(0, unknown.name.find(' '));
    if (joint)
      name = unknown.name.substr(0, unknown.name.size() - std::string(" angle").size());
    else if (unknown.is_free)
      name = beam + " hinge";
    else
      name = beam == "tower" ? "foundation" : beam + " support";
  }
  return name;
}

std::string text_of(const system::Motion& motion) {
  return motion.part + (motion.name.empty() ? "" : " " + motion.name);
}

/// Mean strain energy by name; shear belongs to the bending that it makes.
constexpr std::string_view shear = " shear";
std::map<std::string, double> strain_energies(const system::PeriodicSystem& system,
                                              const Eigen::MatrixXcd& shape) {
  std::map<std::string, double> strain;
  for (const EnergyGroup& group : system.energy_groups())
    if (group.kind == EnergyGroup::Kind::strain) {
      std::string name = group.motion;
      if (name.ends_with(shear)) name.resize(name.size() - shear.size());
      if (group.part != "joint" && group.part != "support") name = group.part + " " + name;
      strain[name] += mean_strain_energy(group, shape);
    }
  return strain;
}

/// Of a system that does not know its motions: by the strain energy.
std::string strained_motion(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                            const Mode& mode, double zero) {
  const std::map<std::string, double> strain = strain_energies(system, shape);
  const auto largest_entry =
      std::max_element(strain.begin(), strain.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  const std::string joint = moving_joint(system, shape);
  if (!joint.empty() &&
      (std::abs(mode.exponent) < zero || (mode.resolved && is_rigid_body(system, shape, mode))))
    return joint;
  if (largest_entry == strain.end()) return joint.empty() ? "mode" : joint;
  return largest_entry->first;
}

/// Whether an exponent is none but for rounding and the step.
bool is_at_rest(const Mode& mode, const ModeSet& set) {
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  const double unsure = mode.growth_error - mode.mesh_growth_error;
  return std::abs(mode.exponent) < zero ||
         (mode.exponent.imag() == 0.0 && std::abs(mode.exponent) < unsure);
}

/// Instant of a column of a shape.
double time_of(const ModeSet& set, const Eigen::MatrixXcd& shape, Eigen::Index column,
               int sectors) {
  const auto all = static_cast<Eigen::Index>(set.shape_times.size()) / sectors;
  const Eigen::Index taken = std::max<Eigen::Index>(1, shape.cols() / sectors);
  return set.shape_times[static_cast<std::size_t>(column / taken * all + column % taken)];
}

/// A mode as its name wants it: of its coordinates the identified harmonic alone, which is the one
/// whose frequency is stated. Beside it a motion may have others, where exponents of two modes
/// nearly coincide but for multiples of the rotor speed.
struct NamedShape {
  Eigen::MatrixXcd shape;       ///< positions and loads at the identified harmonic
  Eigen::MatrixXcd shape_rate;  ///< (lambda + d/dt) of it
  Eigen::MatrixXcd whole_rate;  ///< (lambda + d/dt) of all harmonics
  /// The fit: shape = coefficients waves^T, rates of lambda; empty where nothing was fitted.
  Eigen::MatrixXcd coefficients;
  Eigen::MatrixXcd waves;
  Eigen::VectorXcd rates;

  /// Harmonics on each side of the identified one.
  Eigen::Index reach() const { return waves.cols() / 2; }
  Eigen::MatrixXcd at(Eigen::Index h) const {
    return coefficients.col(reach() + h) * waves.col(reach() + h).transpose();
  }
  std::complex<double> rate_at(Eigen::Index h) const { return rates(reach() + h); }
};

/// Harmonics about the identified one are fitted, for instants of several sectors are not equally
/// spaced. A shape of few instants, or at rest, stands for its rate, and so does each harmonic
/// where none has been identified.
NamedShape named_shape(const ModeSet& set, std::size_t m) {
  const Mode& mode = set.modes[m];
  const Eigen::MatrixXcd& shape = set.shapes[m];
  const Eigen::Index instants = shape.cols();
  NamedShape named;
  const bool is_short = instants != static_cast<Eigen::Index>(set.shape_times.size());
  if (is_short || instants == 1 || is_at_rest(mode, set)) {
    named.shape = shape;
    named.whole_rate = is_short || is_at_rest(mode, set) ? shape : mode.exponent * shape;
    named.shape_rate = named.whole_rate;
    return named;
  }
  const Eigen::Index reach = std::min<Eigen::Index>(fitted_harmonics, (instants - 1) / 3);
  named.waves.resize(instants, 2 * reach + 1);
  named.rates.resize(2 * reach + 1);
  for (Eigen::Index h = -reach; h <= reach; ++h) {
    const double k = static_cast<double>(h + mode.harmonic) * set.rotor_speed;
    named.rates(h + reach) =
        mode.exponent + std::complex<double>(0.0, static_cast<double>(h) * set.rotor_speed);
    for (Eigen::Index i = 0; i < instants; ++i)
      named.waves(i, h + reach) = std::polar(1.0, k * set.shape_times[static_cast<std::size_t>(i)]);
  }
  const Eigen::MatrixXcd fit =
      named.waves.colPivHouseholderQr().solve(Eigen::MatrixXcd::Identity(instants, instants));
  named.coefficients = shape * fit.transpose();
  named.whole_rate = named.coefficients * named.rates.asDiagonal() * named.waves.transpose();
  if (mode.exponent.imag() == 0.0) {
    named.shape = shape;
    named.shape_rate = named.whole_rate;
    return named;
  }
  named.shape = named.at(0);
  named.shape_rate = mode.exponent * named.shape;
  return named;
}

/// The motions about the steady states at all instants of the shapes.
class MotionsInTime {
 public:
  MotionsInTime(const system::PeriodicSystem& system, const PeriodicSolution& solution)
      : system_(system),
        solution_(solution),
        z_(system.make_state()),
        z_dot_(system.make_state()) {}

  const system::MotionEnergies& at(double t) {
    std::unique_ptr<system::MotionEnergies>& about = about_[t];
    if (!about) {
      solution_.evaluate(t, z_.get(), z_dot_.get());
      about = system_.motion_energies(t, z_.get());
    }
    return *about;
  }

 private:
  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  petsc::Handle<Vec> z_, z_dot_;
  std::map<double, std::unique_ptr<system::MotionEnergies>> about_;
};

struct Leading {
  std::size_t motion = 0;
  bool at_identified = true;  ///< harmonic, by which it was found
  /// Its own harmonic, from the identified one, or nothing where it has several.
  std::optional<int> shift = 0;
};

/// Share of the kinetic energy of mode m in the harmonic `h` beyond the identified one.
double share_at(const ModeSet& set, std::size_t m, Eigen::Index h) {
  const Eigen::Index column = set.modes[m].harmonic + h - set.first_harmonic;
  return column >= 0 && column < set.participation.cols()
             ? set.participation(static_cast<Eigen::Index>(m), column)
             : 0.0;
}

/// The harmonic, counted from the identified one, that has most of the kinetic energy of a motion
/// and of those of its name, `own` over all, and no small part of that of the mode; nothing where
/// none has.
std::optional<int> own_shift(const std::vector<system::Motion>& motions, const ModeSet& set,
                             std::size_t m, std::size_t motion, double own, const NamedShape& named,
                             int sectors, MotionsInTime& in_time) {
  for (Eigen::Index h = -named.reach(); h <= named.reach(); ++h) {
    const Eigen::MatrixXcd rates = named.rate_at(h) * named.at(h);
    double energy = 0.0;
    for (Eigen::Index c = 0; c < rates.cols(); ++c) {
      const Eigen::VectorXd energies = in_time.at(time_of(set, named.shape, c, sectors))
                                           .of(rates.col(c), named.whole_rate.col(c));
      for (std::size_t i = 0; i < motions.size(); ++i)
        if (text_of(motions[i]) == text_of(motions[motion]))
          energy += energies(static_cast<Eigen::Index>(i));
    }
    if (energy > dominant_part * own && share_at(set, m, h) > clear_part)
      return static_cast<int>(h);
  }
  return std::nullopt;
}

/// The motion with the largest share of the kinetic energy and that of the strain energy together.
/// Strain weighs as much as the kinetic energy where all that restores is strain, less where
/// rotation stiffens, and more in overdamped motions, which hardly move; it does not count at rest,
/// where it is that of another motion, and beside a joint that drifts.
Leading find_leading(const system::PeriodicSystem& system,
                     const std::vector<system::Motion>& motions, const ModeSet& set, std::size_t m,
                     const NamedShape& named, int sectors, MotionsInTime& in_time) {
  const Mode& mode = set.modes[m];
  const auto count = static_cast<Eigen::Index>(motions.size());
  Eigen::VectorXd identified = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(count);
  for (Eigen::Index c = 0; c < named.shape.cols(); ++c) {
    const system::MotionEnergies& about = in_time.at(time_of(set, named.shape, c, sectors));
    identified += about.of(named.shape_rate.col(c), named.whole_rate.col(c));
    all += about.of(named.whole_rate.col(c), named.whole_rate.col(c));
  }
  // Less where the mode was identified in blades that the tower carries: it is in another one.
  const bool is_dominant = identified.sum() > dominant_part * all.sum();
  const Eigen::VectorXd& energies = is_dominant ? identified : all;
  const double part = is_dominant ? identified.sum() / all.sum() : 1.0;
  std::map<std::string, double> shares;
  if (energies.sum() > 0.0)
    for (std::size_t i = 0; i < motions.size(); ++i)
      shares[text_of(motions[i])] += energies(static_cast<Eigen::Index>(i)) / energies.sum();
  const auto leading = [&] {
    Leading found{0, is_dominant};
    double most = 0.0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const double share = shares[text_of(motions[i])];
      if (!(share > most)) continue;
      found.motion = i;
      most = share;
    }
    return found;
  };
  if (is_at_rest(mode, set) || !(mode.kinetic_energy > 0.0)) return leading();
  // A joint that drifts: what bends with it has little of the motion, however much it strains.
  const std::string& mover = motions[leading().motion].part;
  if (mode.exponent.imag() == 0.0 && mover != "blade" && mover != "tower") return leading();
  for (const auto& [name, energy] :
       strain_energies(system, is_dominant ? named.shape : set.shapes[m]))
    shares[name] += energy / (part * mode.kinetic_energy);
  Leading found = leading();
  // Where most of this motion is at another harmonic, its frequency is there.
  double own = 0.0;
  double own_identified = 0.0;
  for (std::size_t i = 0; i < motions.size(); ++i)
    if (text_of(motions[i]) == text_of(motions[found.motion])) {
      own += all(static_cast<Eigen::Index>(i));
      own_identified += identified(static_cast<Eigen::Index>(i));
    }
  if (named.waves.size() > 0 && mode.exponent.imag() > 0.0 && own_identified < dominant_part * own)
    found.shift = own_shift(motions, set, m, found.motion, own, named, sectors, in_time);
  return found;
}

/// Shares of the multiblade components of a motion: n = 0 is the mean of the blades, in n each
/// blade is 2 pi n / B ahead of the one behind it. Empty where nothing moves.
Eigen::VectorXd multiblade_shares(const std::vector<system::Motion>& motions, int blades,
                                  const std::string& name, const Eigen::MatrixXcd& shape) {
  std::vector<const system::Motion*> alike;
  for (const system::Motion& motion : motions)
    if (motion.blade > 0 && motion.name == name) alike.push_back(&motion);
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(blades);
  if (static_cast<int>(alike.size()) != blades) return {};
  for (std::size_t i = 0; i < alike.front()->unknowns.size(); ++i)
    for (int n = 0; n < blades; ++n) {
      Eigen::RowVectorXcd component = Eigen::RowVectorXcd::Zero(shape.cols());
      for (int k = 0; k < blades; ++k)
        component += std::polar(1.0, -2.0 * std::numbers::pi * n * k / blades) *
                     shape.row(alike[static_cast<std::size_t>(k)]->unknowns[i]);
      shares(n) += alike.front()->weight[i] * component.squaredNorm();
    }
  const double total = shares.sum();
  return total > 0.0 ? Eigen::VectorXd(shares / total) : Eigen::VectorXd();
}

const char* word_of(int n, int blades) {
  if (blades == 2) return n == 0 ? " symmetric" : " antisymmetric";
  if (n == 0) return " collective";
  if (n == 1) return " regressive";
  return n == blades - 1 ? " progressive" : " reactionless";
}

int blades_of(const std::vector<system::Motion>& motions) {
  int blades = 0;
  for (const system::Motion& motion : motions) blades = std::max(blades, motion.blade);
  return blades;
}

/// What a mode is called, piece by piece.
struct Name {
  std::string part, motion;
  std::string together;  ///< of the blades
  std::string text() const { return part + (motion.empty() ? "" : " " + motion) + together; }
};

/// Ways to bend, between which modes of equal exponents cannot choose.
bool bends(const std::string& motion) {
  return motion == "flap" || motion == "lead-lag" || motion == "fore-aft" || motion == "lateral";
}

/// Modes of equal exponents mix at will: what their names differ in says nothing. Other harmonics
/// keep them apart over a blade passage, where half a turn, say, gives one the opposite sign.
/// `canonical`: they have been chosen by how the blades move together.
void unite_degenerate(const ModeSet& set, int sectors, bool canonical, std::vector<Name>& names) {
  std::vector<std::complex<double>> exponents;
  std::vector<double> apart;
  std::vector<int> harmonics;
  for (const Mode& mode : set.modes) {
    exponents.push_back(mode.exponent);
    apart.push_back(std::clamp(many_errors * mode.rounding_error, degenerate, same_size));
    harmonics.push_back(sectors > 1 ? mode.harmonic : 0);
  }
  for (const std::vector<std::size_t>& equal : groups_of(exponents, apart, harmonics)) {
    std::map<std::string, std::set<std::string>> motions;  // of each part
    std::map<std::pair<std::string, bool>, int> count;
    for (const std::size_t m : equal) {
      if (bends(names[m].motion)) motions[names[m].part].insert(names[m].motion);
      ++count[{names[m].part + names[m].motion, false}];
      if (bends(names[m].motion)) ++count[{names[m].part, true}];
    }
    for (const std::size_t m : equal) {
      Name& name = names[m];
      const bool bending = bends(name.motion);
      const int alike =
          bending ? count[{name.part, true}] : count[{name.part + name.motion, false}];
      if (bending && motions[name.part].size() > 1) name.motion = "bending";
      if (!canonical && alike > 1) name.together = "";
    }
  }
}

/// Places in ascending order of `values`, the same for those that are closer than `apart` to the
/// next.
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
    // P moves the blades' motions on by one blade: within these modes it is a matrix W, whose B-th
    // power is one, and which does not mix exponents.
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

double strain_energy_of(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape) {
  double energy = 0.0;
  for (const EnergyGroup& group : system.energy_groups())
    if (group.kind == EnergyGroup::Kind::strain) energy += mean_strain_energy(group, shape);
  return energy;
}

bool is_rigid_body(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                   const Mode& mode) {
  double strained = 0.0;
  for (const EnergyGroup& group : system.energy_groups())
    if (group.kind == EnergyGroup::Kind::strain && group.part != "joint")
      strained +=
          (1.0 + group.damping * std::abs(mode.exponent)) * mean_strain_energy(group, shape);
  return strained < elastic_share * (strained + mode.kinetic_energy);
}

void scale_shapes(const system::PeriodicSystem& system, ModeSet& set) {
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    Eigen::MatrixXcd& shape = set.shapes[m];
    double largest = 0.0;
    for (Eigen::Index i = 0; i < shape.rows(); ++i)
      if (system.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::position)
        largest = std::max(largest, shape.row(i).cwiseAbs().maxCoeff());
    if (!(largest > 0.0)) continue;
    shape /= largest;
    set.modes[m].kinetic_energy /= largest * largest;
  }
}

std::vector<LeadingMotion> find_leading_motions(const system::PeriodicSystem& system,
                                                const PeriodicSolution& solution,
                                                const ModeSet& set, int sectors) {
  const std::vector<system::Motion> motions = system.motions();
  std::vector<LeadingMotion> leading;
  if (set.shapes.empty() || motions.empty()) return leading;
  const int blades = blades_of(motions);
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  const bool together = blades == 2 || (blades > 2 && set.rotor_speed > 0.0);
  MotionsInTime in_time(system, solution);
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    const Mode& mode = set.modes[m];
    const NamedShape named = named_shape(set, m);
    const Leading found = find_leading(system, motions, set, m, named, sectors, in_time);
    const system::Motion& motion = motions[found.motion];
    const int shift = found.shift.value_or(0);
    LeadingMotion one{motion.part, motion.name, -1, mode.harmonic + shift, found.shift.has_value()};
    if (motion.blade > 0 && together && mode.exponent.imag() > zero) {
      Eigen::Index largest = 0;
      const Eigen::VectorXd shares = multiblade_shares(
          motions, blades, motion.name,
          shift != 0 ? named.at(shift) : (found.at_identified ? named.shape : set.shapes[m]));
      if (shares.size() > 0 && shares.maxCoeff(&largest) > clear_share)
        one.component = static_cast<int>(largest);
      // The mode will be its conjugate, in which the blades follow each other the other way.
      if (one.component > 0 && mode.exponent.imag() + shift * set.rotor_speed < 0.0)
        one.component = blades - one.component;
    }
    leading.push_back(one);
  }
  return leading;
}

void name_modes(const system::PeriodicSystem& system, const std::vector<LeadingMotion>& leading,
                ModeSet& set, int sectors) {
  set.blades = blades_of(system.motions());
  if (set.shapes.empty()) return;  // another rank has them
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  std::vector<Name> names;
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    if (leading.empty()) {
      names.push_back({strained_motion(system, set.shapes[m], set.modes[m], zero), "", ""});
      continue;
    }
    const int component = leading[m].component;
    names.push_back(
        {leading[m].part, leading[m].name, component < 0 ? "" : word_of(component, set.blades)});
  }
  const bool canonical = has_canonical_shapes(system) && set.shape_times.size() == 1;
  unite_degenerate(set, sectors, canonical, names);
  for (std::size_t m = 0; m < names.size(); ++m) {
    Mode& mode = set.modes[m];
    mode.label = names[m].text();
    const double frequency = mode.exponent.imag();
    const bool in_blades = names[m].part.starts_with("blade");
    const bool is_clear = leading.empty() || leading[m].is_clear;
    if (set.rotor_speed == 0.0 || frequency <= zero || (!in_blades && is_clear))
      mode.fixed_frame_frequency = frequency;
    else if (set.blades > 2 && is_clear && !names[m].together.empty()) {
      const int n = leading[m].component;
      mode.fixed_frame_frequency =
          std::abs(frequency - (2 * n > set.blades ? n - set.blades : n) * set.rotor_speed);
    }
  }
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
      return std::tuple(!set.modes[m].resolved, by_size[m], by_growth[m], set.modes[m].label,
                        harmonic_key(m), std::abs(set.modes[m].exponent));
    };
    return key(a) < key(b);
  });
  ModeSet sorted = set;
  for (std::size_t i = 0; i < count; ++i) {
    sorted.modes[i] = std::move(set.modes[order[i]]);
    if (!set.shapes.empty()) sorted.shapes[i] = std::move(set.shapes[order[i]]);
    if (set.participation.rows() > 0)
      sorted.participation.row(static_cast<Eigen::Index>(i)) =
          set.participation.row(static_cast<Eigen::Index>(order[i]));
  }
  set = std::move(sorted);
  // Modes that are not resolved come after the others, take the last numbers, and change no name of
  // a mode that is.
  std::map<std::string, int> alike;
  for (const Mode& mode : set.modes)
    if (mode.resolved) ++alike[mode.label];
  std::map<std::string, int> number;
  for (Mode& mode : set.modes) {
    const std::string name = mode.label;
    const int own = ++number[name];
    if (!name.empty() && (alike[name] > 1 || own > 1)) mode.label += " " + std::to_string(own);
  }
}

}  // namespace samara::analysis
