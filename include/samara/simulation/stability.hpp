// The verdict on stability: which modes are known well enough to count, and what they do.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "samara/analysis/mode.hpp"

namespace samara::simulation {

enum class Motion { rigid_body, undamped, growing, decaying };

/// Stability of a mode by its exponent; rates below their error, and exponents below
/// analysis::zero_exponent, count as zero.
Motion motion_of(const analysis::Mode& mode, double rotor_speed);

/// Estimated errors of an exponent, relative to its modulus, beyond which a mode is marked, and
/// beyond which it counts for no verdict.
inline constexpr double marked_error = 0.01;
inline constexpr double largest_error = 0.1;

/// Whether too little is known of a mode to say whether it grows.
bool is_rough(const analysis::Mode& mode);

enum class Stability {
  stable,    ///< all modes decay
  neutral,   ///< no mode grows, one or more neither grow nor decay by more than the error
  unstable,  ///< a mode grows
  unknown,   ///< there is no verdict: `StabilityAssessment::reason`
};

/// Why there is no verdict.
enum class Doubt {
  none,
  unresolved,     ///< the slowest modes are not all resolved
  growing_alone,  ///< a mode of a conservative system grows and none decays with it: the mesh
  rough,          ///< all modes have too large an error
};

/// Modes are given by their place in ModeSet::modes.
struct StabilityAssessment {
  Stability stability = Stability::unknown;
  Doubt doubt = Doubt::none;
  std::vector<Motion> motions;             ///< one a mode
  std::vector<std::size_t> growing;        ///< the fastest growth first
  std::vector<std::size_t> growing_alone;  ///< what the mesh makes of a conservative system
  std::vector<std::size_t> decaying;
  std::optional<std::size_t> least_damped;  ///< of those that decay
  int undamped = 0;
  int rigid_body = 0;
  int rough = 0;       ///< resolved by the step, with an error above `largest_error`
  int unresolved = 0;  ///< left out
  /// All modes below are resolved, but for those that are deflated [rad/s].
  double reach = std::numeric_limits<double>::infinity();
  /// Those below have errors below `marked_error` [rad/s].
  double accurate_reach = std::numeric_limits<double>::infinity();
};

/// Only modes that are resolved and whose errors are small count. A verdict is given where the ten
/// slowest modes are known, or all.
StabilityAssessment assess_stability(const analysis::ModeSet& set);

}  // namespace samara::simulation
