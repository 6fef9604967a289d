// The verdict on stability: modes that are known well enough to count, and their growth or decay.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "samara/analysis/mode.hpp"

namespace samara::simulation {

enum class Motion { rigid_body, undamped, growing, decaying };

/// Motion of a mode by its exponent. Rates below their error, and exponents below
/// analysis::zero_exponent, count as zero.
Motion motion_of(const analysis::Mode& mode, double rotor_speed);

/// Limits of the estimated error of an exponent, relative to its modulus: above the first a mode is
/// marked; above the second it does not count for a verdict.
inline constexpr double marked_error = 0.01;
inline constexpr double largest_error = 0.1;

/// True if the error of a mode is too large for the mode to count.
bool is_rough(const analysis::Mode& mode);

enum class Stability {
  stable,    ///< all modes decay
  neutral,   ///< no mode grows; one or more neither grow nor decay by more than the error
  unstable,  ///< a mode grows
  unknown,   ///< there is no verdict: `StabilityAssessment::doubt`
};

/// "stable", "neutral", "unstable", "no verdict".
const char* word_of(Stability stability);

/// Reason why there is no verdict.
enum class Doubt {
  none,
  unresolved,     ///< the slowest modes are not all resolved
  incomplete,     ///< modes may be missing in the part of the spectrum that was searched
  growing_alone,  ///< a mode of a conservative system grows, none decays with it: error of the mesh
  may_grow,       ///< a mode grows by its exponent, which has too large an error
  rough,          ///< all modes, or in a medium most of the slowest, have too large an error
};

/// Modes are given by their index in ModeSet::modes.
struct StabilityAssessment {
  Stability stability = Stability::unknown;
  Doubt doubt = Doubt::none;
  std::vector<Motion> motions;             ///< one per mode
  std::vector<std::size_t> growing;        ///< fastest growth first
  std::vector<std::size_t> growing_alone;  ///< in a conservative system: error of the mesh
  std::vector<std::size_t> may_grow;       ///< growing, with too large an error
  std::vector<std::size_t> decaying;
  std::optional<std::size_t> least_damped;  ///< the least damped of the decaying modes
  int undamped = 0;
  int rigid_body = 0;
  int of_medium = 0;    ///< decaying modes of a medium, also in `decaying`
  int rough = 0;        ///< resolved by the step, with an error above `largest_error`
  int first = 0;        ///< the ten slowest of the resolved modes, or all of them
  int first_rough = 0;  ///< of these, those with too large an error
  int unresolved = 0;   ///< not resolved, not counted
  /// All modes below this are resolved, except those that are deflated [rad/s].
  double reach = std::numeric_limits<double>::infinity();
  /// Modes below this have errors below `marked_error` [rad/s].
  double accurate_reach = std::numeric_limits<double>::infinity();
};

/// Only resolved modes with small errors count. One that grows suffices for a verdict; others are
/// given if the ten slowest modes, or all modes, are known. In a medium, whose loads decide about
/// growth, at least half of them must count. Where not all modes were searched, the verdict is that
/// of the modes in ModeSet::searched.
StabilityAssessment assess_stability(const analysis::ModeSet& set);

}  // namespace samara::simulation
