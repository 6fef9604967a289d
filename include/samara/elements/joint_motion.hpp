// How a joint moves whose angle is a given function of time.
#pragma once

namespace samara::elements {

/// At one instant; all zero where a joint is locked.
struct JointMotion {
  double angle = 0.0;         ///< [rad]
  double rate = 0.0;          ///< [rad/s]
  double acceleration = 0.0;  ///< [rad/s^2]
};

}  // namespace samara::elements
