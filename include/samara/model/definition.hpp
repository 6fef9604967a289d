// The turbine as defined by the user: plain data in SI and radians, before any discretization. Axes
// and signs are those of docs/case_file.md.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "samara/base/fault.hpp"
#include "samara/elements/joint_motion.hpp"
#include "samara/elements/torque_line.hpp"
#include "samara/math/types.hpp"
#include "samara/model/air_definition.hpp"

namespace samara::turbine {
class Extension;
}

namespace samara::model {

/// Properties of a beam section. Strain order: axial, shear2, shear3, torsion, bend2, bend3.
struct SectionDefinition {
  double at = 0.0;                      ///< fraction of the beam length, 0 (root) to 1 (tip)
  Matrix6 stiffness = Matrix6::Zero();  ///< S of (4) [N, N m, N m^2]; rigid rows, columns are 0
  std::array<bool, 6> rigid{};          ///< strain components that cannot strain
  Matrix6 mass = Matrix6::Zero();       ///< I6 of (3) about the reference line [kg/m, kg, kg m]
  double twist = 0.0;                   ///< structural twist [rad], about -b1 (toward feather)

  bool operator==(const SectionDefinition&) const = default;
};

/// A mass on a beam, with its rotary inertia.
struct PointMassDefinition {
  double at = 1.0;                    ///< fraction of the beam length, above 0, to 1
  double mass = 0.0;                  ///< [kg], > 0
  Vector3 center = Vector3::Zero();   ///< from the line, section axes b [m]
  Vector3 inertia = Vector3::Zero();  ///< about its own centre, section axes [kg m^2]

  bool operator==(const PointMassDefinition&) const = default;
};

/// Support of an end of a beam. Order of directions: u1 u2 u3 theta1 theta2 theta3, root axes.
struct SupportDefinition {
  Matrix6 stiffness = Matrix6::Zero();  ///< [N/m, N, N m]; rigid and free rows, columns are 0
  std::array<bool, 6> rigid{true, true, true, true, true, true};  ///< directions that cannot move
  std::array<bool, 6> free{};                                     ///< directions without restraint
  double mass = 0.0;                  ///< mass of a rigid body between springs and beam [kg]
  Vector3 center = Vector3::Zero();   ///< from the root, root axes [m]
  Vector3 inertia = Vector3::Zero();  ///< about its own centre, root axes [kg m^2]
  /// Inertia without weight of the water around this body, along and about its axes [kg, kg m^2].
  Vector6 added_mass = Vector6::Zero();
  Vector6 damping = Vector6::Zero();  ///< mu [s] of the springs, by direction

  bool is_clamp() const { return rigid == std::array<bool, 6>{true, true, true, true, true, true}; }
  bool is_none() const { return free == std::array<bool, 6>{true, true, true, true, true, true}; }

  bool operator==(const SupportDefinition&) const = default;
};

/// An end without support.
SupportDefinition free_end();

/// Damping ratios of a clamped beam's first modes: bending about b2, about b3, torsion.
using ModalDamping = std::array<std::optional<double>, 3>;

struct BeamDefinition {
  double length = 0.0;                  ///< arc length [m], > 0
  std::vector<Vector3> reference_line;  ///< points in axes a [m]; empty = straight along b1
  int elements = 4;                     ///< >= 1; point masses move the nearest ends
  /// Lengths of elements by each other, from the root on, > 0; empty: equal. With another number of
  /// elements the ends divide each of these lengths, or several of them, evenly.
  std::vector<double> element_lengths;
  int order = 1;                            ///< Gauss points an element, 1 to 6
  std::vector<SectionDefinition> sections;  ///< sorted by `at`; one = uniform
  Vector6 damping = Vector6::Zero();  ///< mu [s] per strain component; fitted if this is zero and
                                      ///< modal_damping is given
  Vector3 mass_damping = Vector3::Zero();         ///< alpha [1/s] along b1, b2, b3 of the sections
  ModalDamping modal_damping{};                   ///< damping ratios that mu is fitted to
  double tip_mass = 0.0;                          ///< [kg], >= 0
  std::vector<PointMassDefinition> point_masses;  ///< sorted by `at`
  SupportDefinition support;                      ///< support of the root
  SupportDefinition end_support = free_end();     ///< support of the end, without a mass

  bool operator==(const BeamDefinition&) const = default;
};

/// locked: at zero; prescribed: the angle is a given function of time.
enum class JointKind { free, locked, prescribed };

/// angle + amplitude cos(frequency t + phase).
struct PrescribedMotion {
  double angle = 0.0;      ///< mean [rad]
  double amplitude = 0.0;  ///< [rad]
  int per_rev = 0;         ///< frequency as a multiple of the rotor speed; 0: `frequency` applies
  double frequency = 0.0;  ///< [rad/s]
  double phase = 0.0;      ///< [rad]

  bool is_constant() const { return amplitude == 0.0; }

  /// Motion at time t [s] at the given `rotor_speed` [rad/s].
  elements::JointMotion at(double t, double rotor_speed) const;

  bool operator==(const PrescribedMotion&) const = default;
};

/// A second spring and damper beyond an angle, in both senses.
struct StopDefinition {
  double angle = 0.0;      ///< [rad]; 0: no stops
  double stiffness = 0.0;  ///< [N m/rad]
  double damping = 0.0;    ///< [N m s/rad]

  bool operator==(const StopDefinition&) const = default;
};

struct JointDefinition {
  JointKind kind = JointKind::locked;
  double stiffness = 0.0;        ///< [N m/rad]
  double damping = 0.0;          ///< [N m s/rad]
  PrescribedMotion motion = {};  ///< motion of a prescribed joint

  bool operator==(const JointDefinition&) const = default;
};

/// A torque over a speed: value and slope at the mean speed, or a table.
struct TorqueLaw {
  double torque = 0.0;                           ///< [N m]
  double slope = 0.0;                            ///< [N m s/rad]
  std::vector<std::pair<double, double>> table;  ///< ascending speed [rad/s], torque; empty: above

  /// True if a table covers a speed.
  bool covers(double speed) const {
    return table.empty() || (speed >= table.front().first && speed <= table.back().first);
  }
  /// Torque and slope at a speed. A table is linear between its entries; at an inner entry the
  /// slope is the mean of both sides, at the first and the last that of its segment. At rest a
  /// table that does not cover speed 0 gives no torque.
  elements::TorqueLine at(double speed) const;
  /// The whole law of a rotor with this mean speed; zero if the table does not cover it.
  elements::TorqueLine line_at(double mean_speed) const {
    if (!covers(mean_speed)) return {};
    return {torque, slope, mean_speed, table};
  }

  bool operator==(const TorqueLaw&) const = default;
};

struct GeneratorDefinition {
  JointKind kind = JointKind::locked;  ///< locked: the shaft has `speed`; free: its angle varies
  double inertia = 0.0;                ///< about its own axis [kg m^2]
  TorqueLaw law;                       ///< torque against its rotation, over its own speed

  bool operator==(const GeneratorDefinition&) const = default;
};

struct NacelleDefinition {
  double mass = 0.0;                         ///< [kg]
  Vector3 center_of_mass = Vector3::Zero();  ///< from the tower top, nacelle axes y1 y2 y3 [m]
  Vector3 inertia = Vector3::Zero();         ///< about its own centre, y1 y2 y3 [kg m^2]
  JointDefinition yaw;

  bool operator==(const NacelleDefinition&) const = default;
};

struct ShaftDefinition {
  double speed = 0.0;               ///< Omega0 >= 0 [rad/s], about +s2
  double overhang = 0.0;            ///< yaw axis to teeter pin or apex, along s2 [m]
  double tilt = 0.0;                ///< > 0 raises the downwind end [rad]
  double height = 0.0;              ///< tower top to shaft axis along y3 [m]
  double azimuth = 0.0;             ///< azimuth of blade 1 at t = 0 [rad]
  double mass = 0.0;                ///< [kg]
  double center_of_mass = 0.0;      ///< along s2 from the yaw axis [m]
  double inertia_axial = 0.0;       ///< [kg m^2]
  double inertia_transverse = 0.0;  ///< [kg m^2]
  JointDefinition torsion;          ///< between generator and rotor
  GeneratorDefinition generator;
  double gear_ratio =
      1.0;  ///< revolutions of the generator per shaft revolution; < 0: opposite sense; not 0
  TorqueLaw rotor;                 ///< torque on the hub about h2
  double rotor_pitch_slope = 0.0;  ///< that torque per mean pitch of the blades [N m/rad]

  /// Mean speed of the generator relative to the nacelle, positive in its sense of rotation
  /// [rad/s].
  double generator_speed() const { return std::abs(gear_ratio) * speed; }

  bool operator==(const ShaftDefinition&) const = default;
};

/// A mass on the hub.
struct HubMassDefinition {
  double mass = 0.0;                  ///< [kg], > 0
  Vector3 center = Vector3::Zero();   ///< from the teeter pin, h1 h2 h3 [m]
  Vector3 inertia = Vector3::Zero();  ///< about its own centre, h1 h2 h3 [kg m^2]

  bool operator==(const HubMassDefinition&) const = default;
};

struct HubDefinition {
  double mass = 0.0;            ///< [kg]
  double center_of_mass = 0.0;  ///< along s2 from the teeter pin [m]
  Vector3 inertia =
      Vector3::Zero();  ///< about its own centre: h1 (teeter), h2 (shaft), h3 [kg m^2]
  std::vector<HubMassDefinition> point_masses;
  double radius = 0.0;     ///< shaft axis to blade root [m]
  JointDefinition teeter;  ///< locked = rigid hub
  StopDefinition teeter_stops;
  double undersling = 0.0;  ///< along s2 from teeter pin to rotor apex [m]
  double delta3 = 0.0;      ///< teeter axis from h1 toward h3 [rad]

  bool operator==(const HubDefinition&) const = default;
};

/// Positive rotation of the part outboard of a hinge: flap downwind, lag against the rotor's
/// rotation, pitch toward feather.
enum class HingeAxis { flap, lag, pitch };

/// A hinge of a blade's root.
struct HingeDefinition {
  HingeAxis axis = HingeAxis::flap;
  double offset = 0.0;  ///< along b1 from the shaft axis, or from the hinge inboard of it [m], >= 0
  JointDefinition joint;  ///< a motion by `per_rev` is that of blade 1; others follow by azimuth
  /// Skew of a flap hinge: its axis is turned, so that flapping by a small angle beta pitches the
  /// blade by -tan(delta3) beta [rad].
  double delta3 = 0.0;

  bool operator==(const HingeDefinition&) const = default;
};

/// Pitch that follows its command as a second-order system.
struct PitchActuatorDefinition {
  double frequency = 0.0;      ///< undamped natural frequency [rad/s], > 0
  double damping_ratio = 0.0;  ///< > 0
  double rate_limit = std::numeric_limits<double>::infinity();  ///< [rad/s], > 0
  double lowest = -std::numeric_limits<double>::infinity();     ///< limit of the pitch [rad]
  double highest = std::numeric_limits<double>::infinity();

  bool operator==(const PitchActuatorDefinition&) const = default;
};

/// Values of a hinge that differ on one blade.
struct HingeDifference {
  std::optional<double> stiffness;  ///< [N m/rad]
  std::optional<double> damping;    ///< [N m s/rad]

  bool operator==(const HingeDifference&) const = default;
};

/// Values that differ on one blade.
struct BladeDifference {
  double pitch = 0.0;             ///< added to the pitch of all blades [rad]
  double mass_factor = 1.0;       ///< times the section masses, > 0
  double stiffness_factor = 1.0;  ///< times the section stiffnesses, > 0
  std::map<HingeAxis, HingeDifference> hinges;

  bool operator==(const BladeDifference&) const = default;
};

struct BladesDefinition {
  int count = 1;
  double precone = 0.0;  ///< > 0 moves the tips toward +s2 [rad]
  double pitch = 0.0;    ///< > 0 toward feather [rad], at a pitch hinge, or at the root
  std::vector<HingeDefinition> hinges;  ///< from the hub outward, at most one of each axis
  std::optional<PitchActuatorDefinition> actuator;
  /// Pitch by -tan(pitch_link) times the flap angle: the geometry of a pitch link [rad].
  double pitch_link = 0.0;
  BeamDefinition beam;
  std::map<int, BladeDifference> each;  ///< by blade number from 1
  std::map<std::string, AirfoilDefinition> airfoils;
  std::vector<AeroSectionDefinition> aero_sections;  ///< sorted by `at`; empty: no air loads

  bool operator==(const BladesDefinition&) const = default;
};

/// A spring and a damper between a mass and its carrier, along an axis of the carrier.
struct MassDamperAxis {
  int axis = 0;            ///< 0 to 2: b1 b2 b3 of the section, or y1 y2 y3
  double stiffness = 0.0;  ///< [N/m]
  double damping = 0.0;    ///< [N s/m]
  double stop = 0.0;       ///< displacement from which the stop acts, in both senses [m]; 0: none
  double stop_stiffness = 0.0;  ///< [N/m]
  double stop_damping = 0.0;    ///< [N s/m]

  bool operator==(const MassDamperAxis&) const = default;
};

/// A point mass on a beam or on the nacelle that moves along one or two axes.
struct MassDamperDefinition {
  enum class Carrier { tower, nacelle, blade };
  Carrier carrier = Carrier::nacelle;
  int blade = 0;                       ///< from 1; 0: one damper on each blade
  double at = 1.0;                     ///< fraction of the beam's length, above 0, to 1
  Vector3 position = Vector3::Zero();  ///< mass at rest: from the line in the section's axes, or
                                       ///< from the tower top in y1 y2 y3 [m]
  double mass = 0.0;                   ///< [kg], > 0
  std::vector<MassDamperAxis> axes;    ///< one axis or two different ones

  bool operator==(const MassDamperDefinition&) const = default;
};

/// Variation of a load with time: mean + amplitude cos(frequency t + phase), or a table.
struct LoadVariation {
  double mean = 1.0;
  double amplitude = 0.0;
  int per_rev = 0;         ///< frequency as a multiple of the rotor speed; 0: `frequency` applies
  double frequency = 0.0;  ///< [rad/s]
  double phase = 0.0;      ///< [rad]
  std::vector<std::pair<double, double>> table;  ///< t [s], factor; empty: the cosine

  bool is_constant() const { return amplitude == 0.0 && table.empty(); }

  /// The factor at time t [s] at the given `rotor_speed` [rad/s].
  double factor(double t, double rotor_speed) const;

  bool operator==(const LoadVariation&) const = default;
};

/// A prescribed load on a beam: at a point (from = to), or uniform along a part of it.
struct LoadDefinition {
  bool on_tower = false;
  int blade = 0;      ///< from 1; 0: all blades
  double from = 1.0;  ///< fraction of the arc length
  double to = 1.0;
  Vector3 force = Vector3::Zero();   ///< [N], or [N/m] if from < to
  Vector3 moment = Vector3::Zero();  ///< [N m], or [N m/m]
  bool follower = false;  ///< components in the deformed section; false: in the axes of the root
  LoadVariation variation;

  bool operator==(const LoadDefinition&) const = default;
};

/// Gains on the speed error and its integral.
struct ControlLoop {
  double proportional = 0.0;  ///< torque [N m s/rad] or pitch [s] per speed error
  double integral = 0.0;      ///< torque [N m/rad] or pitch [1] per integral of the speed error

  bool operator==(const ControlLoop&) const = default;
};

/// Controller of the generator's speed. All values are on the generator's side of the gear.
struct ControllerDefinition {
  double filter = 0.0;  ///< corner of the first-order filter of the measured speed [rad/s], > 0
  std::optional<double> set_point;    ///< [rad/s]; none: the generator's mean speed
  std::optional<ControlLoop> torque;  ///< torque against the rotation
  std::optional<ControlLoop> pitch;   ///< pitch of all blades, toward feather
  /// The gains of the pitch are divided by 1 + pitch/schedule [rad]; 0: constant gains.
  double schedule = 0.0;

  bool has_integral() const {
    return (torque && torque->integral != 0.0) || (pitch && pitch->integral != 0.0);
  }

  bool operator==(const ControllerDefinition&) const = default;
};

struct TurbineDefinition {
  std::string title;
  double gravity = 9.80665;  ///< along -n3 [m/s^2]
  bool has_tower = false;
  bool has_nacelle = false;
  BeamDefinition tower;
  NacelleDefinition nacelle;
  ShaftDefinition shaft;
  HubDefinition hub;
  BladesDefinition blades;
  std::vector<LoadDefinition> loads;
  std::vector<MassDamperDefinition> mass_dampers;
  std::optional<ControllerDefinition> controller;
  std::optional<WindDefinition> wind;
  std::optional<AeroDefinition> aero;  ///< none: no air loads
  /// Components that a program adds (turbine/extension.hpp).
  std::vector<std::shared_ptr<const turbine::Extension>> extensions;

  bool operator==(const TurbineDefinition&) const = default;
};

/// Returns the fault of a support, or an empty string. The springs must be symmetric, finite and
/// positive definite.
std::string find_support_fault(const SupportDefinition& support);

/// Interpolates the section at `fraction` (0 to 1) of the length. Stiffness, mass and twist are
/// linear between stations and constant before the first and after the last one.
SectionDefinition interpolate_section(const BeamDefinition& beam, double fraction);

/// Returns the fault of a section, or an empty string. Faults: stiffness not symmetric, not finite
/// or not positive definite on its elastic strains; mass not symmetric, not finite or not positive
/// semi-definite, no mass per length, or a massless direction that an elastic strain can move.
std::string find_section_fault(const SectionDefinition& section);

/// Completes a definition: sorts point masses along their beams, makes matrices exactly symmetric,
/// finds mu from damping ratios and the controller's set point. Returns faults: ratios that no mu
/// >= 0 gives.
std::vector<Fault> complete(TurbineDefinition& definition);

/// Arc length [m] of the natural cubic spline through the points of a reference line, with the
/// chord length as its parameter. 0 for fewer than two points; nan if two neighbours coincide.
double compute_arc_length(const std::vector<Vector3>& reference_line);

}  // namespace samara::model
