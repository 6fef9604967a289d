#include "samara/analysis/identification.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <string_view>
#include <tuple>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace samara::analysis {
namespace {

using system::EnergyGroup;

/// Share of the energy that must be strain for a mode to be called elastic.
constexpr double elastic_share = 0.15;

/// Relative distance of two exponents that do not split.
constexpr double degenerate = 1e-7;

/// Share of a multiblade component beyond which it names a mode.
constexpr double clear_share = 0.7;

/// On each side of the identified harmonic, those whose rates make the kinetic energy.
constexpr Eigen::Index fitted_harmonics = 8;

/// Moduli closer than this, relative, are the same, and real parts closer than this, relative to
/// the modulus, too.
constexpr double same_size = 1e-6;

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
  if (!joint.empty() && (std::abs(mode.exponent) < zero ||
                         (mode.resolved && is_rigid_body(system, shape, mode))))
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

/// (lambda + d/dt) of a shape where all its instants are known: harmonics about the identified one
/// are fitted, for instants of several sectors are not equally spaced. A shape of fewer instants, or
/// at rest, stands for its rate.
Eigen::MatrixXcd rate_of(const ModeSet& set, std::size_t m) {
  const Mode& mode = set.modes[m];
  const Eigen::MatrixXcd& shape = set.shapes[m];
  const Eigen::Index instants = shape.cols();
  if (instants != static_cast<Eigen::Index>(set.shape_times.size()) || is_at_rest(mode, set))
    return shape;
  if (instants == 1) return mode.exponent * shape;
  const Eigen::Index reach = std::min<Eigen::Index>(fitted_harmonics, (instants - 1) / 3);
  Eigen::MatrixXcd waves(instants, 2 * reach + 1);
  Eigen::VectorXcd rates(2 * reach + 1);
  for (Eigen::Index h = -reach; h <= reach; ++h) {
    const double k = static_cast<double>(h + mode.harmonic) * set.rotor_speed;
    rates(h + reach) =
        mode.exponent + std::complex<double>(0.0, static_cast<double>(h) * set.rotor_speed);
    for (Eigen::Index i = 0; i < instants; ++i)
      waves(i, h + reach) = std::polar(1.0, k * set.shape_times[static_cast<std::size_t>(i)]);
  }
  const Eigen::MatrixXcd fit =
      waves.colPivHouseholderQr().solve(Eigen::MatrixXcd::Identity(instants, instants));
  const Eigen::MatrixXcd derivative = waves * rates.asDiagonal() * fit;
  return shape * derivative.transpose();
}

/// Mean kinetic energy of each motion, mode x motion, but for a factor of each mode.
Eigen::MatrixXd motion_energies(const system::PeriodicSystem& system,
                                const PeriodicSolution& solution, const ModeSet& set, int motions,
                                int sectors) {
  Eigen::MatrixXd energies =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(set.shapes.size()), motions);
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  std::map<double, std::unique_ptr<system::MotionEnergies>> at;
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    const Eigen::MatrixXcd rate = rate_of(set, m);
    for (Eigen::Index c = 0; c < rate.cols(); ++c) {
      const double t = time_of(set, rate, c, sectors);
      std::unique_ptr<system::MotionEnergies>& about = at[t];
      if (!about) {
        solution.evaluate(t, z.get(), z_dot.get());
        about = system.motion_energies(t, z.get());
      }
      energies.row(static_cast<Eigen::Index>(m)) += about->of(rate.col(c));
    }
  }
  return energies;
}

/// Name of the motion with the largest share of the kinetic energy and that of the strain energy
/// together. Strain weighs as much as the kinetic energy where all that restores is strain, less
/// where rotation stiffens, and more in overdamped motions, which hardly move. `kinetic_energy` 0: a
/// motion at rest, whose strain is that of another one.
std::size_t leading_motion(const system::PeriodicSystem& system,
                           const std::vector<system::Motion>& motions,
                           const Eigen::RowVectorXd& energies, const Eigen::MatrixXcd& shape,
                           double kinetic_energy) {
  const double total = energies.sum();
  std::map<std::string, double> shares;
  for (std::size_t i = 0; i < motions.size(); ++i)
    if (total > 0.0)
      shares[text_of(motions[i])] += energies(static_cast<Eigen::Index>(i)) / total;
  for (const auto& [name, energy] : strain_energies(system, shape))
    if (kinetic_energy > 0.0) shares[name] += energy / kinetic_energy;
  std::size_t leading = 0;
  double most = 0.0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const auto found = shares.find(text_of(motions[i]));
    if (found == shares.end() || !(found->second > most)) continue;
    leading = i;
    most = found->second;
  }
  return leading;
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

bool turns_with_rotor(const system::PeriodicSystem& system, const std::string& part) {
  return std::any_of(system.energy_groups().begin(), system.energy_groups().end(),
                     [&part](const EnergyGroup& group) {
                       return group.kind == EnergyGroup::Kind::kinetic && group.part == part &&
                              group.frame == system::Frame::rotating;
                     });
}

/// What a mode is called, piece by piece.
struct Name {
  std::string part, motion;
  std::string together;  ///< of the blades
  std::string text() const { return part + (motion.empty() ? "" : " " + motion) + together; }
};

/// Two motions between which modes of equal exponents cannot choose.
std::string common_motion(const std::string& a, const std::string& b) {
  const auto bends = [](const std::string& motion) {
    return motion == "flap" || motion == "lead-lag" || motion == "fore-aft" ||
           motion == "lateral" || motion == "bending";
  };
  return a == b ? a : bends(a) && bends(b) ? "bending" : "";
}

/// Modes of equal exponents mix at will: what their names differ in says nothing. Other harmonics
/// keep them apart over a blade passage, where half a turn, say, gives one the opposite sign.
/// `canonical`: they have been chosen by how the blades move together.
void unite_degenerate(const ModeSet& set, int sectors, bool canonical, std::vector<Name>& names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      const Mode& a = set.modes[i];
      const Mode& b = set.modes[j];
      if (a.exponent == 0.0 || names[i].part != names[j].part) continue;
      if (std::abs(a.exponent - b.exponent) > degenerate * std::abs(a.exponent)) continue;
      if (sectors > 1 && a.harmonic != b.harmonic) continue;
      const bool turned = canonical && names[i].together != names[j].together;
      const std::string motion = common_motion(names[i].motion, names[j].motion);
      if (motion.empty() || turned) continue;
      names[i].motion = names[j].motion = motion;
      names[i].together = names[j].together = "";
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
                   const std::vector<std::complex<double>>& exponents,
                   std::vector<Eigen::MatrixXcd>& shapes) {
  if (!has_canonical_shapes(system)) return;
  const system::RotorSymmetry& symmetry = system.symmetry();
  std::vector<bool> done(exponents.size(), false);
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    std::vector<std::size_t> equal;
    for (std::size_t j = i; j < exponents.size(); ++j)
      if (!done[j] && exponents[i].imag() != 0.0 &&
          std::abs(exponents[j] - exponents[i]) <= degenerate * std::abs(exponents[i]))
        equal.push_back(j);
    if (equal.size() < 2) continue;
    Eigen::MatrixXcd all(system.size(), static_cast<Eigen::Index>(equal.size()));
    for (std::size_t j = 0; j < equal.size(); ++j) {
      done[equal[j]] = true;
      all.col(static_cast<Eigen::Index>(j)) = shapes[equal[j]].col(0) / shapes[equal[j]].norm();
    }
    // P moves the blades' motions on by one blade: within the modes of one exponent it is a matrix.
    Eigen::MatrixXcd turned(all.rows(), all.cols());
    for (Eigen::Index row = 0; row < all.rows(); ++row) {
      const auto at = static_cast<std::size_t>(row);
      turned.row(row) = symmetry.sign[at] * all.row(symmetry.source[at]);
    }
    const Eigen::MatrixXcd within = all.colPivHouseholderQr().solve(turned);
    const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> turns(within);
    if (turns.info() != Eigen::Success) continue;
    for (std::size_t j = 0; j < equal.size(); ++j)
      shapes[equal[j]] = all * turns.eigenvectors().col(static_cast<Eigen::Index>(j));
  }
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

void name_modes(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                ModeSet& set, int sectors) {
  const std::vector<system::Motion> motions = system.motions();
  for (const system::Motion& motion : motions) set.blades = std::max(set.blades, motion.blade);
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  Eigen::MatrixXd energies;
  if (!motions.empty())
    energies = motion_energies(system, solution, set, static_cast<int>(motions.size()), sectors);
  const bool together = set.blades == 2 || (set.blades > 2 && set.rotor_speed > 0.0);
  std::vector<Name> names;
  std::vector<int> components;
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    const Mode& mode = set.modes[m];
    Name name;
    int component = -1;
    if (motions.empty()) {
      name.part = strained_motion(system, set.shapes[m], mode, zero);
    } else {
      const system::Motion& leading =
          motions[leading_motion(system, motions, energies.row(static_cast<Eigen::Index>(m)),
                                 set.shapes[m],
                                 is_at_rest(mode, set) ? 0.0 : mode.kinetic_energy)];
      name.part = leading.part;
      name.motion = leading.name;
      if (leading.blade > 0 && together && mode.exponent.imag() > zero) {
        Eigen::Index largest = 0;
        const Eigen::VectorXd shares =
            multiblade_shares(motions, set.blades, leading.name, set.shapes[m]);
        if (shares.size() > 0 && shares.maxCoeff(&largest) > clear_share) {
          component = static_cast<int>(largest);
          name.together = word_of(component, set.blades);
        }
      }
    }
    names.push_back(name);
    components.push_back(component);
  }
  const bool canonical = has_canonical_shapes(system) && set.shape_times.size() == 1;
  unite_degenerate(set, sectors, canonical, names);
  for (std::size_t m = 0; m < names.size(); ++m) {
    Mode& mode = set.modes[m];
    mode.label = names[m].text();
    const double frequency = mode.exponent.imag();
    if (set.rotor_speed == 0.0 || mode.parts.empty() || !turns_with_rotor(system, mode.parts.front().part) ||
        mode.parts.front().part == "drivetrain" || names[m].part == "shaft torsion" ||
        names[m].part == "rotor rotation" || frequency <= zero)
      mode.fixed_frame_frequency = frequency;
    else if (set.blades > 2 && !names[m].together.empty())
      mode.fixed_frame_frequency = std::abs(
          frequency -
          (2 * components[m] > set.blades ? components[m] - set.blades : components[m]) *
              set.rotor_speed);
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
                        harmonic_key(m));
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
  std::map<std::string, int> all;
  std::map<std::string, int> number;
  for (const Mode& mode : set.modes) ++all[mode.label];
  for (Mode& mode : set.modes)
    if (!mode.label.empty() && all[mode.label] > 1) {
      const std::string name = mode.label;
      mode.label += " " + std::to_string(++number[name]);
    }
}

}  // namespace samara::analysis
