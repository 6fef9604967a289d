#include "samara/analysis/leading_motion.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include <Eigen/QR>

#include "samara/analysis/identification.hpp"

#include "strain_energy.hpp"

namespace samara::analysis {
namespace {

/// Share above which a multiblade component names a mode.
constexpr double clear_share = 0.7;

/// Number of harmonics on each side of the identified one whose rates give the kinetic energy.
constexpr Eigen::Index fitted_harmonics = 8;

/// Share of the kinetic energy of the coordinates at the identified harmonic above which this
/// harmonic alone names a mode.
constexpr double dominant_part = 0.5;

/// Share of the kinetic energy above which a harmonic may become that of the mode.
constexpr double clear_part = 0.2;

/// Share of a joint in the kinetic energy above which the mean turn of what it carries may name a
/// mode.
constexpr double least_of_turn = 0.1;
/// Relative difference of equal energies.
constexpr double round_off = 1e-6;

/// Relative to the rotor speed: a real principal exponent below this is that of a slow drift, and
/// so is any below the second: round-off may split a double real one, and a joint that drifts so
/// slowly has next to no energy.
constexpr double slow_drift = 0.05;
constexpr double slowest_drift = 1e-3;
/// Harmonics of positions among which that of a motion without energy is.
constexpr int most_harmonic_of_rest = 4;

/// Instant of a column of a shape.
double time_of(const ModeSet& set, const Eigen::MatrixXcd& shape, Eigen::Index column,
               int sectors) {
  const auto all = static_cast<Eigen::Index>(set.shape_times.size()) / sectors;
  const Eigen::Index taken = std::max<Eigen::Index>(1, shape.cols() / sectors);
  return set.shape_times[static_cast<std::size_t>(column / taken * all + column % taken)];
}

/// A mode for its name: its coordinates at the identified harmonic alone, because the stated
/// frequency is that of this harmonic. A motion may have further harmonics where exponents of two
/// modes nearly coincide but for multiples of the rotor speed.
struct NamedShape {
  Eigen::MatrixXcd shape;       ///< positions and loads at the identified harmonic
  Eigen::MatrixXcd shape_rate;  ///< (lambda + d/dt) of it
  Eigen::MatrixXcd whole_rate;  ///< (lambda + d/dt) of all harmonics
  bool is_whole = true;         ///< the identified harmonic stands for all of them
  /// The fit: shape = coefficients waves^T, with lambda + i h Omega in `rates`; empty without a
  /// fit.
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

/// Harmonics about the identified one are fitted, because the instants of several sectors are not
/// equally spaced. A shape of few instants, or at rest, is used in place of its rate. For a real
/// exponent the shape keeps all harmonics.
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
  named.is_whole = false;
  named.shape = named.at(0);
  named.shape_rate = mode.exponent * named.shape;
  return named;
}

/// Energies of the motions about the steady state at the instants of the shapes.
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
  bool at_identified = true;  ///< found from the identified harmonic alone
  /// Harmonic of the motion, counted from the identified one; empty where it has several.
  std::optional<int> shift = 0;
};

/// Share of the kinetic energy of mode m in the harmonic `h`, counted from the identified one.
double share_at(const ModeSet& set, std::size_t m, Eigen::Index h) {
  const Eigen::Index column = set.modes[m].harmonic + h - set.first_harmonic;
  return column >= 0 && column < set.participation.cols()
             ? set.participation(static_cast<Eigen::Index>(m), column)
             : 0.0;
}

/// Energy of a motion and of those with the same name, for example of all blades.
double energy_alike(const std::vector<system::Motion>& motions, std::size_t motion,
                    const Eigen::VectorXd& energies) {
  double sum = 0.0;
  for (std::size_t i = 0; i < motions.size(); ++i)
    if (motions[i].is_alike(motions[motion])) sum += energies(static_cast<Eigen::Index>(i));
  return sum;
}

/// The motion with most energy, together with those with the same name.
std::size_t leading_of(const std::vector<system::Motion>& motions,
                       const Eigen::VectorXd& energies) {
  std::size_t most = 0;
  for (std::size_t i = 1; i < motions.size(); ++i)
    if (energy_alike(motions, i, energies) > energy_alike(motions, most, energies)) most = i;
  return most;
}

/// The harmonic, counted from the identified one, that has most of the kinetic energy of a motion
/// and of those with the same name, and more than `clear_part` of that of the mode. Empty where
/// there is none. `own`: energy of these motions at all harmonics.
std::optional<int> own_shift(const std::vector<system::Motion>& motions, const ModeSet& set,
                             std::size_t m, std::size_t motion, double own, const NamedShape& named,
                             int sectors, MotionsInTime& in_time) {
  for (Eigen::Index h = -named.reach(); h <= named.reach(); ++h) {
    if (!(share_at(set, m, h) > clear_part)) continue;
    const Eigen::MatrixXcd rates = named.rate_at(h) * named.at(h);
    double energy = 0.0;
    for (Eigen::Index c = 0; c < rates.cols(); ++c)
      energy += energy_alike(motions, motion,
                             in_time.at(time_of(set, named.shape, c, sectors))
                                 .of(rates.col(c), named.whole_rate.col(c)));
    if (energy > dominant_part * own) return static_cast<int>(h);
  }
  return std::nullopt;
}

/// The motion with the largest sum of kinetic and strain energy. The strain energy equals the
/// kinetic energy where strain alone restores; it is smaller where rotation stiffens, and larger in
/// overdamped motions, which hardly move. It does not count at rest, where it is that of another
/// motion, and for a joint that drifts. `left_out`: this motion and those alike have no part in the
/// choice; null: all motions have one.
Leading find_leading(const system::PeriodicSystem& system,
                     const std::vector<system::Motion>& motions, const ModeSet& set, std::size_t m,
                     const NamedShape& named, int sectors, MotionsInTime& in_time,
                     const system::Motion* left_out) {
  const Mode& mode = set.modes[m];
  const auto count = static_cast<Eigen::Index>(motions.size());
  Eigen::VectorXd counts = Eigen::VectorXd::Ones(count);
  for (Eigen::Index i = 0; i < count; ++i)
    if (left_out != nullptr && motions[static_cast<std::size_t>(i)].is_alike(*left_out))
      counts(i) = 0.0;
  Eigen::VectorXd identified = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(count);
  for (Eigen::Index c = 0; c < named.shape.cols(); ++c) {
    const system::MotionEnergies& about = in_time.at(time_of(set, named.shape, c, sectors));
    all += counts.cwiseProduct(about.of(named.whole_rate.col(c), named.whole_rate.col(c)));
    if (!named.is_whole)
      identified += counts.cwiseProduct(about.of(named.shape_rate.col(c), named.whole_rate.col(c)));
  }
  if (named.is_whole) identified = all;
  if (left_out != nullptr && !(all.sum() > 0.0))  // nothing else moves
    return find_leading(system, motions, set, m, named, sectors, in_time, nullptr);
  // The identified harmonic has less of the energy where it is that of blades that the tower moves:
  // the tower moves at another harmonic.
  const bool is_dominant = identified.sum() > dominant_part * all.sum();
  const Eigen::VectorXd& energies = is_dominant ? identified : all;
  const double part = is_dominant ? identified.sum() / all.sum() : 1.0;
  std::map<std::string, double> shares;
  if (energies.sum() > 0.0)
    for (std::size_t i = 0; i < motions.size(); ++i)
      shares[motions[i].name()] += energies(static_cast<Eigen::Index>(i)) / energies.sum();
  const auto leading = [&] {
    Leading found{0, is_dominant};
    double most = 0.0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const double share = shares[motions[i].name()];
      if (!(share > most)) continue;
      found.motion = i;
      most = share;
    }
    return found;
  };
  if (is_at_rest(mode, set) || !(mode.kinetic_energy > 0.0)) return leading();
  // A joint drifts: the parts that bend with it have little of the motion, even if their strain is
  // large.
  const system::Owner& mover = motions[leading().motion].owner;
  const bool is_beam = mover.kind == system::PartKind::beam || mover.instance > 0;
  const bool is_slowest = std::abs(mode.exponent) < slowest_drift * set.rotor_speed;
  // Parts that move as a slow drift goes on may have most of its energy, once a revolution. The
  // mean of the motion strains an overdamped part, but not those that a joint carries. The
  // motion that is next to one left out is that of the energy.
  const bool drifts = left_out == nullptr && is_drift(mode.exponent, set.rotor_speed) &&
                      is_rigid_body(system, named.shape.rowwise().mean(), mode);
  if (mode.exponent.imag() == 0.0 && !is_beam && !is_slowest && !drifts) return leading();
  if (drifts) {
    Eigen::VectorXd of_shape = Eigen::VectorXd::Zero(count);
    for (Eigen::Index c = 0; c < named.shape.cols(); ++c)
      of_shape += in_time.at(time_of(set, named.shape, c, sectors))
                      .of(named.shape.col(c), named.shape.col(c));
    return {leading_of(motions, counts.cwiseProduct(of_shape)), is_dominant};
  }
  for (const auto& [name, energy] :
       strain_energies(system, is_dominant ? named.shape : set.shapes[m]))
    shares[name] += energy / (part * mode.kinetic_energy);
  if (left_out != nullptr) shares.erase(left_out->name());
  Leading found = leading();
  // A joint that makes the largest part of the mean turn of what it carries stands for all of it.
  bool has_joint = false;
  for (Eigen::Index i = 0; i < count; ++i)
    if (motions[static_cast<std::size_t>(i)].owner.kind == system::PartKind::joint &&
        energies(i) > least_of_turn * energies.sum())
      has_joint = true;
  if (has_joint) {
    Eigen::VectorXd turns = Eigen::VectorXd::Zero(count);
    for (Eigen::Index c = 0; c < named.shape.cols(); ++c)
      turns += in_time.at(time_of(set, named.shape, c, sectors))
                   .of_mean_turns((is_dominant ? named.shape_rate : named.whole_rate).col(c),
                                  named.whole_rate.col(c));
    turns = turns.cwiseProduct(counts).eval();
    const std::size_t most = leading_of(motions, turns);
    const auto own = static_cast<Eigen::Index>(most);
    Eigen::VectorXd parts = energies - turns;  // of the mean turn
    parts(own) = energies(own);
    const bool is_in_series = motions[most].owner.kind == system::PartKind::joint &&
                              turns(own) > (1.0 + round_off) * energies(own);
    if (is_in_series && leading_of(motions, parts) == most) found.motion = most;
  }
  // Where most of this motion is at another harmonic, the frequency of the motion is that of this
  // harmonic.
  const double own = energy_alike(motions, found.motion, all);
  if (named.waves.size() > 0 && mode.exponent.imag() > 0.0 &&
      energy_alike(motions, found.motion, identified) < dominant_part * own)
    found.shift = own_shift(motions, set, m, found.motion, own, named, sectors, in_time);
  return found;
}

/// The multiblade components of a motion: n = 0 is the mean of the blades; in component n each
/// blade is 2 pi n / B ahead of the blade behind it.
struct Multiblade {
  Eigen::VectorXd shares;  ///< of the components; empty where nothing moves
  /// Positive where the sum of components 1 and B - 1 follows the cosine of the angle from blade 1
  /// more than its sine.
  double cosine_less_sine = 0.0;
};

Multiblade multiblade_of(const std::vector<system::Motion>& motions, int count,
                         const system::Motion& one, const Eigen::MatrixXcd& shape) {
  std::vector<const system::Motion*> alike;
  for (const system::Motion& motion : motions)
    if (motion.is_alike(one)) alike.push_back(&motion);
  if (static_cast<int>(alike.size()) != count) return {};
  Multiblade found{Eigen::VectorXd::Zero(count)};
  for (std::size_t i = 0; i < alike.front()->unknowns.size(); ++i) {
    Eigen::MatrixXcd components = Eigen::MatrixXcd::Zero(count, shape.cols());
    for (int n = 0; n < count; ++n)
      for (int k = 0; k < count; ++k)
        components.row(n) += std::polar(1.0, -2.0 * std::numbers::pi * n * k / count) *
                             shape.row(alike[static_cast<std::size_t>(k)]->unknowns[i]);
    const double weight = alike.front()->weight[i];
    found.shares += weight * components.rowwise().squaredNorm();
    // |c_1 + c_B-1|^2 - |c_1 - c_B-1|^2 over four
    found.cosine_less_sine += weight * components.row(1).dot(components.row(count - 1)).real();
  }
  const double total = found.shares.sum();
  if (!(total > 0.0)) return {};
  found.shares /= total;
  return found;
}

/// How three or more blades at rest move against each other; `none` where they move alike for the
/// most part, or in patterns of higher order.
CyclicMotion cyclic_motion(const Multiblade& found) {
  const Eigen::Index last = found.shares.size() - 1;
  if (last < 2 || !(found.shares(1) + found.shares(last) > clear_share)) return CyclicMotion::none;
  return found.cosine_less_sine > 0.0 ? CyclicMotion::cosine : CyclicMotion::sine;
}

/// The states of `one` and of the identical parts, as motions.
std::vector<system::Motion> motions_of_states(const system::PeriodicSystem& system,
                                              const system::Owner& one) {
  std::vector<system::Motion> motions;
  for (std::size_t i = 0; i < system.unknowns().size(); ++i) {
    const system::Unknown& unknown = system.unknowns()[i];
    if (unknown.role != system::UnknownRole::state || !unknown.owner.is_alike(one)) continue;
    if (motions.empty() || motions.back().owner != unknown.owner)
      motions.push_back({unknown.owner});
    motions.back().unknowns.push_back(static_cast<PetscInt>(i));
    motions.back().weight.push_back(1.0 / (unknown.scale * unknown.scale));
  }
  return motions;
}

/// The dominant multiblade component of a motion, -1 where there is none.
int clear_component(const Eigen::VectorXd& shares) {
  Eigen::Index largest = 0;
  return shares.size() > 0 && shares.maxCoeff(&largest) > clear_share ? static_cast<int>(largest)
                                                                      : -1;
}

/// The motion of mode m, its harmonic and the phase between the blades. `left_out`: see
/// find_leading.
LeadingMotion leading_motion_of(const system::PeriodicSystem& system,
                                const std::vector<system::Motion>& motions, const ModeSet& set,
                                std::size_t m, int sectors, MotionsInTime& in_time,
                                const system::Motion* left_out) {
  const int count = count_instances(motions);
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  const bool together = count == 2 || (count > 2 && set.rotor_speed > 0.0);
  const Mode& mode = set.modes[m];
  if (mode.state) {
    LeadingMotion one{{*mode.state}, -1, mode.harmonic, true};
    if (mode.state->instance > 0 && together && mode.exponent.imag() > zero)
      one.component = clear_component(
          multiblade_of(motions_of_states(system, *mode.state), count, one.motion, set.shapes[m])
              .shares);
    return one;
  }
  const NamedShape named = named_shape(set, m);
  const Leading found = find_leading(system, motions, set, m, named, sectors, in_time, left_out);
  const system::Motion& motion = motions[found.motion];
  const int shift = found.shift.value_or(0);
  LeadingMotion one{motion, -1, mode.harmonic + shift, found.shift.has_value()};
  if (motion.owner.instance > 0 && together && mode.exponent.imag() > zero) {
    one.component = clear_component(
        multiblade_of(
            motions, count, motion,
            shift != 0 ? named.at(shift) : (found.at_identified ? named.shape : set.shapes[m]))
            .shares);
    // The mode will be replaced by its conjugate, in which the blades follow each other in the
    // opposite order.
    if (one.component > 0 && mode.exponent.imag() + shift * set.rotor_speed < 0.0)
      one.component = count - one.component;
  }
  if (motion.owner.instance > 0 && count > 2 && set.rotor_speed == 0.0) {
    const Multiblade components = multiblade_of(motions, count, motion, set.shapes[m]);
    if (clear_component(components.shares) == 0) one.component = 0;
    one.cyclic = cyclic_motion(components);
  }
  return one;
}

/// Modes that a joint cannot have: it has one coordinate for each part that it carries, and each
/// coordinate two exponents. Those of resolved modes and the slowest ones are its own; only real
/// ones are counted.
std::vector<std::size_t> surplus_of_joints(const std::vector<system::Motion>& motions,
                                           const std::vector<LeadingMotion>& leading,
                                           const ModeSet& set) {
  std::vector<std::vector<std::size_t>> of_joints;
  for (std::size_t m = 0; m < leading.size(); ++m) {
    const system::Motion& own = leading[m].motion;
    if (set.modes[m].state || set.modes[m].exponent.imag() != 0.0 ||
        own.owner.kind != system::PartKind::joint)
      continue;
    const auto found = std::ranges::find_if(of_joints, [&](const std::vector<std::size_t>& modes) {
      return leading[modes.front()].motion.is_alike(own);
    });
    if (found == of_joints.end())
      of_joints.push_back({m});
    else
      found->push_back(m);
  }
  std::vector<std::size_t> surplus;
  for (std::vector<std::size_t>& modes : of_joints) {
    const system::Motion& own = leading[modes.front()].motion;
    const auto coordinates = std::ranges::count_if(
        motions, [&own](const system::Motion& motion) { return motion.is_alike(own); });
    std::ranges::stable_sort(modes, {}, [&set](std::size_t m) {
      return std::pair(!set.modes[m].resolved, std::abs(set.modes[m].exponent));
    });
    for (std::size_t i = 2 * static_cast<std::size_t>(coordinates); i < modes.size(); ++i)
      surplus.push_back(modes[i]);
  }
  return surplus;
}

}  // namespace

bool is_at_rest(const Mode& mode, const ModeSet& set) {
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  const double unsure = mode.growth_error - mode.mesh_growth_error;
  return std::abs(mode.exponent) < zero ||
         (std::abs(mode.exponent) < unsure &&
          (mode.exponent.imag() == 0.0 || unsure < slowest_drift * set.rotor_speed));
}

bool is_drift(std::complex<double> exponent, double rotor_speed) {
  const double size = std::abs(exponent);
  return size < slowest_drift * rotor_speed ||
         (exponent.imag() == 0.0 && size < slow_drift * rotor_speed);
}

int harmonic_of_positions(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape) {
  std::vector<Eigen::Index> of_joints;
  std::vector<Eigen::Index> positions;
  for (Eigen::Index i = 0; i < shape.rows(); ++i) {
    const system::Unknown& unknown = system.unknowns()[static_cast<std::size_t>(i)];
    if (unknown.role != system::UnknownRole::position) continue;
    positions.push_back(i);
    if (unknown.owner.kind == system::PartKind::joint) of_joints.push_back(i);
  }
  const Eigen::MatrixXcd counted = shape(of_joints.empty() ? positions : of_joints, Eigen::all);
  const Eigen::Index count = shape.cols();
  int best = 0;
  double largest = 0.0;
  for (int k = 0; k <= std::min<int>(static_cast<int>(count / 2), most_harmonic_of_rest); ++k) {
    Eigen::VectorXcd wave(count);
    for (Eigen::Index i = 0; i < count; ++i)
      wave(i) = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k * i % count) /
                                    static_cast<double>(count));
    const double size = (k > 0 ? 2.0 : 1.0) * (counted * wave).squaredNorm();  // with its conjugate
    if (size <= largest) continue;
    largest = size;
    best = k;
  }
  return best;
}

int count_instances(const std::vector<system::Motion>& motions) {
  int count = 0;
  for (const system::Motion& motion : motions) count = std::max(count, motion.owner.instance);
  return count;
}

std::vector<LeadingMotion> find_leading_motions(const system::PeriodicSystem& system,
                                                const PeriodicSolution& solution,
                                                const ModeSet& set, int sectors) {
  const std::vector<system::Motion> motions = system.motions();
  std::vector<LeadingMotion> leading;
  if (set.shapes.empty() || motions.empty()) return leading;
  MotionsInTime in_time(system, solution);
  for (std::size_t m = 0; m < set.shapes.size(); ++m)
    leading.push_back(leading_motion_of(system, motions, set, m, sectors, in_time, nullptr));
  for (const std::size_t m : surplus_of_joints(motions, leading, set))
    leading[m] = leading_motion_of(system, motions, set, m, sectors, in_time, &leading[m].motion);
  return leading;
}

}  // namespace samara::analysis
