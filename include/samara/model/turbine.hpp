// The turbine with meshed beams, ready for assembly; immutable after build_turbine.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "samara/elements/air_station.hpp"
#include "samara/elements/rigid_chain.hpp"
#include "samara/model/beam.hpp"
#include "samara/model/definition.hpp"
#include "samara/model/operation.hpp"

namespace samara::model {

/// A free hinge of a blade's root.
struct RootHinge {
  HingeAxis axis = HingeAxis::flap;
  double stiffness = 0.0;  ///< [N m/rad]
  double damping = 0.0;    ///< [N m s/rad]
};

/// A link of the chain from the apex of the rotor to the root of a blade.
struct RootLink {
  Vector3 arm = Vector3::Zero();       ///< arm to its point, in the axes before it [m]
  Matrix3 axes = Matrix3::Identity();  ///< axes behind it before it turns, as columns
  Vector3 axis = -Vector3::UnitX();    ///< its axis of rotation, in the axes behind it
  bool is_pitch = false;               ///< turns by the pitch of the blade
  int hinge = -1;                      ///< turns by the angle of this hinge; -1: no hinge
  PrescribedMotion motion = {};        ///< prescribed rotation

  bool is_prescribed() const { return !motion.is_constant() || motion.angle != 0.0; }
};

/// Attachment of a blade to the hub.
struct BladeRoot {
  Vector3 position = Vector3::Zero();  ///< from the apex, components in H, no hinge turned [m]
  Matrix3 C_Ha = Matrix3::Identity();  ///< blade axes a to hub axes, no hinge turned
  double pitch = 0.0;                  ///< rotation of a about -b1 [rad]
  std::vector<RootLink> links;         ///< from the apex outward
  std::vector<RootHinge> hinges;
  double pitch_by_flap = 0.0;  ///< rad/rad, from a pitch link
  int flap_hinge = -1;         ///< index in hinges; -1: none
};

/// A mass damper on its carrier.
struct MassDamper {
  MassDamperDefinition definition;
  int number = 1;  ///< from 1, counted on the tower, on the nacelle or on each blade
  int blade = -1;  ///< from 0; -1: not on a blade
  int node = -1;   ///< mass node of the carrying beam; -1: the end of the beam
  Matrix3 axes = Matrix3::Identity();  ///< axes of the definition, as columns in the node's axes
  Vector3 place = Vector3::Zero();     ///< mass at rest, from the node, in the node's axes [m]

  bool is_on_nacelle() const {
    return definition.carrier == MassDamperDefinition::Carrier::nacelle;
  }
  Vector3 axis(std::size_t i) const { return axes.col(definition.axes[i].axis); }
};

/// The air around the rotor.
struct Air {
  elements::AirRotor rotor;
  double hub_height = 0.0;      ///< of the apex of the undeformed rotor above the foot [m]
  double hub_wind = 0.0;        ///< speed of the wind there [m/s]
  double hub_wind_axial = 0.0;  ///< its component along the shaft, downwind [m/s]
  std::vector<std::vector<elements::AirStation>> stations;  ///< of each blade, at its points
  bool tower_has_drag = false;                              ///< the wind loads the tower
  std::optional<NacelleDragDefinition> nacelle;             ///< the wind loads it
};

struct Turbine {
  bool has_tower = false;
  Beam tower;
  std::vector<Beam> blades;
  std::vector<BladeRoot> roots;  ///< one per blade
  std::vector<MassDamper> mass_dampers;
  std::optional<PitchActuatorDefinition> pitch_actuator;  ///< one per blade, all equal
  std::optional<ControllerDefinition> controller;
  std::optional<Air> air;
  std::vector<std::shared_ptr<const turbine::Extension>> extensions;
  double rotor_pitch_slope = 0.0;  ///< torque on the hub per mean pitch [N m/rad]
  double pitch = 0.0;              ///< common to all blades [rad]
  elements::RigidChain chain;
  PrescribedMotion yaw_motion;     ///< motion of a yaw that is not free
  PrescribedMotion teeter_motion;  ///< motion of a teeter that is not free
  double speed = 0.0;              ///< Omega0 [rad/s]
  double azimuth = 0.0;            ///< azimuth of blade 1 at t = 0 [rad]
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
  /// Visits the prescribed motions of all joints, including constant ones.
  template <class Visit>
  void for_each_motion(const Visit& visit) {
    visit(yaw_motion);
    visit(teeter_motion);
    for (BladeRoot& root : roots)
      for (RootLink& link : root.links) visit(link.motion);
  }

  /// Motion of a yaw or teeter that is not free.
  elements::JointMotion yaw_at(double t) const { return motion_at(operation.yaw, yaw_motion, t); }
  elements::JointMotion teeter_at(double t) const {
    return motion_at(operation.teeter, teeter_motion, t);
  }
  /// True if a curve gives the pitch of blade k.
  bool has_pitch_curve(std::size_t k) const {
    return k < operation.pitch.size() && operation.pitch[k].has_value();
  }
  /// Pitch of blade k (0-based) and its rates; with actuators, their command.
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

/// Completes the definition and builds it. @throws InputError if that is not possible. It does not
/// look for the faults that `find_faults` (validation.hpp) finds.
Turbine build_turbine(const TurbineDefinition& definition);

}  // namespace samara::model
