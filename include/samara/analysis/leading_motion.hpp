// The motion of the turbine that a mode is named after, and the harmonic of this motion
// (docs/theory.md, section 5.6).
#pragma once

#include <complex>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/mode.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Number of identical parts (the blades) that have motions.
int count_instances(const std::vector<system::Motion>& motions);

/// How blades at rest move against each other, without a mean: the cosine or the sine of the angle
/// from blade 1, multiplied by one amplitude.
enum class CyclicMotion { none, cosine, sine };

/// Whether an exponent is zero but for round-off and the error by the step.
bool is_at_rest(const Mode& mode, const ModeSet& set);

/// Whether a motion with this principal exponent [1/s] is a slow drift: it hardly changes within a
/// revolution, so that its positions, not their rates, tell what moves. `rotor_speed`: [rad/s]; 0
/// without a turning rotor, where no motion is one.
bool is_drift(std::complex<double> exponent, double rotor_speed);

/// The largest harmonic of the joints, or of all positions where there are no joints, of a shape at
/// equal distances over a period: 0 of a displacement at rest, 1 of a rotor disc that stays tilted
/// on hinges of the shaft axis, which has no energy in its own axes.
int harmonic_of_positions(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape);

/// The motion that a mode is named after: the one with most kinetic and strain energy.
struct LeadingMotion {
  system::Motion motion;
  /// Multiblade component n of the motion: each blade is 2 pi n / B ahead of the blade behind it.
  /// -1: no component is dominant. At rest only the mean, n = 0, and `cyclic` are distinct.
  int component = -1;
  int harmonic = 0;      ///< that has its energy, as Mode::harmonic
  bool is_clear = true;  ///< most of its energy is in this harmonic
  CyclicMotion cyclic = CyclicMotion::none;
};

/// One for each mode; empty where the system does not declare its motions, or without shapes. Each
/// shape has some instants of each of `sectors` parts of the period: the first ones of
/// `set.shape_times` in this part.
std::vector<LeadingMotion> find_leading_motions(const system::PeriodicSystem& system,
                                                const PeriodicSolution& solution,
                                                const ModeSet& set, int sectors = 1);

}  // namespace samara::analysis
