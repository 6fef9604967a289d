// Actions on a turbine in time beside its steady operation.
#pragma once

#include <optional>
#include <vector>

#include "samara/math/time_curve.hpp"

namespace samara::model {

struct Operation {
  /// Turned by the generator since t = 0, its speed and acceleration; none: at constant speed.
  std::optional<math::IntegratedCurve> turning;
  /// Pitch of each blade [rad] instead of the definition's; empty, or none: constant.
  std::vector<std::optional<math::TimeCurve>> pitch;
  /// Angle [rad] of a prescribed joint instead of the definition's.
  std::optional<math::TimeCurve> yaw;
  std::optional<math::TimeCurve> teeter;
  /// The generator is lost: the controller gives no torque.
  bool generator_off = false;
};

}  // namespace samara::model
