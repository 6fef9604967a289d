// Faults of a motion given in time that steps cannot follow: jumps, fast changes, kinks.
#pragma once

#include <optional>
#include <vector>

#include "samara/math/time_curve.hpp"

namespace samara::math {

struct CurveFault {
  enum class Kind {
    jump,  ///< of the value, within less than a millionth of a step
    fast,  ///< between the ends of a step the value leaves the straight line
    kink,  ///< a jump of the rate
  };
  Kind kind = Kind::jump;
  double time = 0.0;  ///< [s]; fast: the start of the step
  double size = 0.0;  ///< jump: change in its part of a step; kink: change of the rate;
                      ///< fast: distance from the straight line over the step
};

/// The first jump of the curve from 0 to `until` [s], or otherwise the first step in which it is
/// fast: more than a tenth of its range away from the straight line. With more than 50000 steps the
/// curve is searched in 50000 parts, for jumps only.
std::optional<CurveFault> find_jump(const TimeCurve& curve, double until, double step);

/// The largest jump of the rate of a curve without jumps.
std::optional<CurveFault> find_kink(const TimeCurve& curve, double until, double step);

}  // namespace samara::math
