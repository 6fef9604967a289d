// The turbine, cut into elements and ready for assembly; immutable after build_turbine.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "samara/elements/rigid_chain.hpp"
#include "samara/model/beam.hpp"
#include "samara/model/definition.hpp"
#include "samara/model/operation.hpp"

namespace samara::model {

/// A hinge of a blade's root that turns freely.
struct RootHinge {
  HingeAxis axis = HingeAxis::flap;
  double stiffness = 0.0;  ///< [N m/rad]
  double damping = 0.0;    ///< [N m s/rad]
};

/// A step from the apex of the rotor to the root of a blade.
struct RootLink {
  Vector3 arm = Vector3::Zero();       ///< to its point, in the axes before it [m]
  Matrix3 axes = Matrix3::Identity();  ///< those behind it where it has not turned, as columns
  Vector3 axis = -Vector3::UnitX();    ///< that it turns about, in the axes behind it
  bool is_pitch = false;               ///< it turns as the blade is pitched
  int hinge = -1;                      ///< and as this hinge does; -1: as none
  PrescribedMotion motion = {};        ///< and as prescribed

  bool is_prescribed() const { return !motion.is_constant() || motion.angle != 0.0; }
};

/// Where a blade is fixed to the hub.
struct BladeRoot {
  Vector3 position = Vector3::Zero();  ///< from the apex, components in H, no hinge turned [m]
  Matrix3 C_Ha = Matrix3::Identity();  ///< blade axes a to hub axes, no hinge turned
  double pitch = 0.0;                  ///< of a about -b1 [rad]
  std::vector<RootLink> links;         ///< from the apex outward
  std::vector<RootHinge> hinges;
  double pitch_by_flap = 0.0;  ///< rad/rad, of a pitch link
  int flap_hinge = -1;         ///< among hinges; -1: none
};

/// A mass damper in its place.
struct MassDamper {
  MassDamperDefinition definition;
  int number = 1;                      ///< from 1, among those on the tower, the nacelle or a blade
  int blade = -1;                      ///< from 0; -1: on none
  int node = -1;                       ///< mass node of the beam that carries it; -1: its end
  Matrix3 axes = Matrix3::Identity();  ///< of the definition, as columns in those of the node
  Vector3 place = Vector3::Zero();     ///< of the mass at rest, from the node, in its axes [m]

  bool is_on_nacelle() const {
    return definition.carrier == MassDamperDefinition::Carrier::nacelle;
  }
  Vector3 axis(std::size_t i) const { return axes.col(definition.axes[i].axis); }
};

struct Turbine {
  bool has_tower = false;
  Beam tower;
  std::vector<Beam> blades;
  std::vector<BladeRoot> roots;  ///< one a blade
  std::vector<MassDamper> mass_dampers;
  std::optional<PitchActuatorDefinition> pitch_actuator;  ///< one a blade, all alike
  std::optional<ControllerDefinition> controller;
  std::vector<std::shared_ptr<const turbine::Extension>> extensions;
  double rotor_pitch_slope = 0.0;  ///< torque on the hub by the mean pitch [N m/rad]
  double pitch = 0.0;              ///< common to all blades [rad]
  elements::RigidChain chain;
  PrescribedMotion yaw_motion;     ///< of a yaw that is not free
  PrescribedMotion teeter_motion;  ///< of a teeter that is not free
  double speed = 0.0;              ///< Omega0 [rad/s]
  double azimuth = 0.0;            ///< of blade 1 at t = 0 [rad]
  bool identical_blades = true;
  int degrees_of_freedom = 0;  ///< elastic strains of all points + free joints

  Operation operation;

  /// Azimuth of the generator, its rate and acceleration.
  math::TimeCurve::Value turning_at(double t) const {
    if (!operation.turning) return {azimuth + speed * t, speed, 0.0};
    math::TimeCurve::Value turned = operation.turning->at(t);
    turned.value += azimuth;
    return turned;
  }
  /// Visits the prescribed motions of all joints, those that are constant too.
  template <class Visit>
  void for_each_motion(const Visit& visit) {
    visit(yaw_motion);
    visit(teeter_motion);
    for (BladeRoot& root : roots)
      for (RootLink& link : root.links) visit(link.motion);
  }

  /// The motion of a yaw or teeter that is not free.
  elements::JointMotion yaw_at(double t) const { return motion_at(operation.yaw, yaw_motion, t); }
  elements::JointMotion teeter_at(double t) const {
    return motion_at(operation.teeter, teeter_motion, t);
  }
  /// Whether a curve gives the pitch of blade k.
  bool has_pitch_curve(std::size_t k) const {
    return k < operation.pitch.size() && operation.pitch[k].has_value();
  }
  /// Pitch of blade k (0-based) and its rates; with actuators, what they are to make.
  math::TimeCurve::Value pitch_at(std::size_t k, double t) const {
    if (!has_pitch_curve(k)) return {roots[k].pitch, 0.0, 0.0};
    return operation.pitch[k]->at(t);
  }

 private:
  elements::JointMotion motion_at(const std::optional<math::TimeCurve>& curve,
                                  const PrescribedMotion& motion, double t) const {
    if (!curve) return motion.at(t, speed);
    const math::TimeCurve::Value now = curve->at(t);
    return {now.value, now.rate, now.acceleration};
  }
};

/// Completes the definition and builds it. @throws InputError where that is not possible; faults
/// that `find_faults` (validation.hpp) finds are not looked for.
Turbine build_turbine(const TurbineDefinition& definition);

}  // namespace samara::model
