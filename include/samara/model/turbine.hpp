// The turbine, cut into elements and ready for assembly; immutable after build_turbine.
#pragma once

#include <vector>

#include "samara/elements/rigid_chain.hpp"
#include "samara/model/beam.hpp"
#include "samara/model/definition.hpp"

namespace samara::model {

/// Where a blade is fixed to the hub.
struct BladeRoot {
  Vector3 position = Vector3::Zero();  ///< from the apex, components in H [m]
  Matrix3 C_Ha = Matrix3::Identity();  ///< blade axes a to hub axes
  double pitch = 0.0;                  ///< of a about -b1 [rad]
};

struct Turbine {
  bool has_tower = false;
  Beam tower;
  std::vector<Beam> blades;
  std::vector<BladeRoot> roots;  ///< one a blade
  elements::RigidChain chain;
  JointHistory yaw_motion;     ///< of a yaw that is not free
  JointHistory teeter_motion;  ///< of a teeter that is not free
  double speed = 0.0;          ///< Omega0 [rad/s]
  double azimuth = 0.0;        ///< of blade 1 at t = 0 [rad]
  bool identical_blades = true;
  int degrees_of_freedom = 0;  ///< elastic strains of all points + free joints

  double azimuth_at(double t) const { return azimuth + speed * t; }
};

/// @throws InputError where the definition cannot be built.
Turbine build_turbine(const TurbineDefinition& definition);

}  // namespace samara::model
