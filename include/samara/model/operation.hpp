// Prescribed variations in time beside the steady operation of a turbine.
#pragma once

#include <optional>
#include <vector>

#include "samara/math/time_curve.hpp"

namespace samara::model {

struct Operation {
  /// Rotation of the generator since t = 0, its speed and acceleration; none: constant speed.
  std::optional<math::IntegratedCurve> turning;
  /// Pitch of each blade [rad] instead of the definition's value; empty or none: constant.
  std::vector<std::optional<math::TimeCurve>> pitch;
  /// Angle [rad] of a prescribed joint instead of the definition's motion.
  std::optional<math::TimeCurve> yaw;
  std::optional<math::TimeCurve> teeter;
  /// The generator has failed: the controller gives no torque.
  bool generator_off = false;
};

}  // namespace samara::model
