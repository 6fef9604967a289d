// A torque that depends on a speed as a straight line.
#pragma once

namespace samara::elements {

struct TorqueLine {
  double torque = 0.0;  ///< at the mean speed [N m]
  double slope = 0.0;   ///< by the speed [N m s/rad]
};

}  // namespace samara::elements
