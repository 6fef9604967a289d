// Prescribed motions of joints in a system.
#pragma once

#include "samara/model/turbine.hpp"

namespace samara::components {

/// `now`: the motion at the time of the system. `varies`: it changes with time.
template <class System>
elements::JointMotion prescribed_motion(const System& system, const elements::JointMotion& now,
                                        bool varies) {
  if (!varies) return now;
  return {system.varying(now.angle), system.varying(now.rate), system.varying(now.acceleration)};
}

inline bool yaw_varies(const model::Turbine& turbine) {
  return turbine.operation.yaw || !turbine.yaw_motion.is_constant();
}

/// Motion of a yaw that is not free.
template <class System>
elements::JointMotion prescribed_yaw(const System& system, const model::Turbine& turbine) {
  return prescribed_motion(system, turbine.yaw_at(system.time()), yaw_varies(turbine));
}

}  // namespace samara::components
