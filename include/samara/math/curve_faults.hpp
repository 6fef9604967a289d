// Where a motion given in time is none that steps can follow.
#pragma once

#include <optional>
#include <vector>

#include "samara/math/time_curve.hpp"

namespace samara::math {

struct CurveFault {
  enum class Kind {
    jump,  ///< of the value, within less than a millionth of a step
    fast,  ///< between the ends of a step the value goes elsewhere
    kink,  ///< a jump of the rate
  };
  Kind kind = Kind::jump;
  double time = 0.0;  ///< [s]; fast: the start of the step
  double size = 0.0;  ///< change in the part of a step with the jump, or of the rate in the kink;
                      ///< fast: how far from the straight line over the step
};

/// The first jump of the curve from 0 to `until` [s], or else the first step in which it is fast:
/// more than a tenth of its range off the straight line. With more than 50000 steps the curve is
/// searched in as many parts, for jumps alone.
std::optional<CurveFault> find_jump(const TimeCurve& curve, double until, double step);

/// The largest jump of the rate of a curve without jumps.
std::optional<CurveFault> find_kink(const TimeCurve& curve, double until, double step);

}  // namespace samara::math
