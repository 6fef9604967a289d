// Prescribed motion of a joint.
#pragma once

namespace samara::elements {

/// Motion at one instant; all values are zero for a locked joint.
struct JointMotion {
  double angle = 0.0;         ///< [rad]
  double rate = 0.0;          ///< [rad/s]
  double acceleration = 0.0;  ///< [rad/s^2]
};

}  // namespace samara::elements
