// samara check: reports the model of a case; solves nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "samara/elements/rotor_wake.hpp"
#include "samara/model/airfoil.hpp"
#include "samara/model/beam_modes.hpp"
#include "samara/model/radius.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/transient_simulation.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "commands.hpp"
#include "masses.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

/// Smaller coordinates of a centre of mass are round-off [m].
constexpr double small_length = 1e-9;
/// Relative limit: a rotor with a smaller unbalance counts as balanced.
constexpr double balanced = 1e-9;
/// A damping ratio below it is round-off.
constexpr double no_damping = 1e-12;
/// Limits that no turbine exceeds [m/s], [m].
constexpr double usual_tip_speed = 120.0;
constexpr double usual_tower = 300.0;
/// Of airfoils and aerodynamic sections.
constexpr double least_lift_slope = 4.0;  // [1/rad]
constexpr double largest_lift_slope = 9.0;
constexpr double usual_zero_lift = 10.0 * std::numbers::pi / 180.0;
constexpr double usual_lift = 2.5;
constexpr double usual_chord = 0.3;  // of the length of a blade
constexpr double usual_ratio = 2.0;  // of neighbouring chords
constexpr double usual_turn = 15.0 * std::numbers::pi / 180.0;

std::string triple(const Vector3& v) {
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += (i > 0 ? ", " : "") + (std::abs(v(i)) < small_length ? "0" : general(v(i), 5));
  return text;
}

std::string mass_table(const model::Turbine& turbine, const model::Masses& masses) {
  Table table;
  table.add_column("part", "", Align::left);
  table.add_column("mass", "kg");
  table.add_column("centre of mass", "m");
  table.add_column("in, from", "", Align::left);
  const auto add = [&table](const std::string& name, const model::MassProperties& part,
                            const std::string& frame) {
    table.add_row(
        {name, general(part.mass, 6), part.mass > 0.0 ? triple(part.center()) : "-", frame});
  };
  if (turbine.has_tower) add("tower", masses.tower, "n1 n2 n3, foot of the tower");
  add("nacelle", masses.nacelle, "y1 y2 y3, tower top");
  add("shaft", masses.shaft, "s1 s2 s3, yaw axis");
  add("hub", masses.hub, "h1 h2 h3, teeter pin");
  const std::size_t shown = turbine.identical_blades
                                ? std::min<std::size_t>(1, masses.blades.size())
                                : masses.blades.size();
  for (std::size_t k = 0; k < shown; ++k)
    add(turbine.identical_blades && turbine.blades.size() > 1 ? "each blade"
                                                              : turbine.blades[k].name,
        masses.blades[k], "b1 b2 b3, blade root");
  add("rotor", masses.rotor, "h1 h2 h3, teeter pin");
  add("turbine", masses.whole, "n1 n2 n3, foot of the tower");
  return table.text();
}

std::string degrees(double radians) { return general(radians * 180.0 / std::numbers::pi, 5); }

std::string joint_words(const elements::Hinge& hinge, const model::PrescribedMotion& motion = {}) {
  if (!hinge.free && motion.angle == 0.0 && motion.is_constant()) return "locked";
  if (!hinge.free && motion.is_constant()) return "held at " + degrees(motion.angle) + " deg";
  if (!hinge.free)
    return "prescribed, " + degrees(motion.amplitude) + " deg about " + degrees(motion.angle) +
           " deg at " +
           (motion.per_rev > 0 ? std::to_string(motion.per_rev) + "P"
                               : general(motion.frequency, 5) + " rad/s");
  std::string text = "free";
  if (hinge.stiffness > 0.0) text += ", " + general(hinge.stiffness, 4) + " N m/rad";
  if (hinge.damping > 0.0) text += ", " + general(hinge.damping, 4) + " N m s/rad";
  if (hinge.stiffness == 0.0 && hinge.damping == 0.0) text += ", no spring, no damper";
  return text;
}

/// Inertia about the shaft, and the relative difference of the meshed rotor.
std::string inertia_words(const model::Masses& masses) {
  const double exact = masses.rotor.inertia(1, 1);
  const double meshed = masses.meshed_rotor.inertia(1, 1);
  std::string text = general(exact, 6) + " kg m^2 about the shaft";
  if (exact > 0.0 && std::abs(meshed - exact) > 5e-5 * exact)
    text += " (as meshed " + fixed(100.0 * (meshed / exact - 1.0), 2) + " %)";
  return text;
}

/// Mass times distance of its centre from the shaft.
std::string balance_words(const model::Masses& masses) {
  const Vector3& moment = masses.rotor.moment;
  const double off = std::hypot(moment(0), moment(2));
  const double size = masses.rotor.mass *
                      std::sqrt(masses.rotor.inertia.trace() / std::max(masses.rotor.mass, 1e-300));
  if (!(off > balanced * size)) return "its centre of mass is on the shaft";
  const double azimuth = std::atan2(moment(0), moment(2)) * 180.0 / std::numbers::pi;
  return general(off, 5) + " kg m off the shaft, " + general(azimuth, 5) + " deg ahead of blade 1";
}

/// The mu that follow from the damping ratios of a beam, and the ratios of its modes: one line per
/// direction.
std::vector<std::string> damping_lines(const model::BeamDefinition& definition,
                                       const model::Beam& beam,
                                       const std::array<const char*, 3>& names) {
  const model::ModalDamping& given = definition.modal_damping;
  std::vector<std::string> lines;
  if (!given[0] && !given[1] && !given[2]) return lines;
  constexpr std::array<int, 3> strain{4, 5, 3};
  const std::array<std::vector<model::BeamMode>, 3> modes = model::first_modes(beam);
  for (std::size_t d = 0; d < names.size(); ++d) {
    std::string text =
        std::string(names[d]) + " mu " + general(definition.damping(strain[d]), 4) + " s";
    for (std::size_t m = 0; m < modes[d].size(); ++m) {
      const model::BeamMode& mode = modes[d][m];
      const double ratio = mode.damping_ratio(definition.damping);
      text += (m == 0 ? ": mode " : ", mode ") + std::to_string(m + 1) + " " +
              (ratio < no_damping ? "0" : general(100.0 * ratio, 4)) + " % at " +
              general(0.5 * mode.frequency / std::numbers::pi, 4) + " Hz";
      if (m == 0 && given[d]) text += " (given " + general(100.0 * *given[d], 4) + " %)";
    }
    if (!modes[d].empty()) lines.push_back(text);
  }
  return lines;
}

std::string mesh_words(const model::Beam& beam) {
  return count(beam.elements, "element") + " of order " + std::to_string(beam.order);
}

std::string support_words(const model::SupportDefinition& support) {
  if (support.is_clamp()) return "clamped";
  int springs = 0;
  int free = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    if (support.free[i]) ++free;
    if (!support.free[i] && !support.rigid[i]) ++springs;
  }
  std::string text = "on springs in " + count(springs, "direction") + ", free in " +
                     std::to_string(free) + ", with " + general(support.mass, 6) +
                     " kg, included in the mass of the beam";
  if (!support.added_mass.isZero(0.0)) text += ", and an added mass, not included";
  return text;
}

/// Warnings on figures that no turbine has, one line each; the usual cause is a wrong unit.
std::string unusual_air(const model::BladesDefinition& blades, double length) {
  std::string text;
  const auto say = [&text](const std::string& what, const std::string& hint) {
    text += "unusual: " + what + "; hint: " + hint + "\n";
  };
  for (const auto& [name, airfoil] : blades.airfoils) {
    const model::PolarDefinition& polar = airfoil.polars.front();
    const elements::AirfoilCurves curves =
        model::make_curves(model::on_grid(polar), airfoil.lift_slope);
    const std::string of = " of airfoil \"" + name + "\"";
    if (curves.has_dynamics &&
        (curves.lift_slope < least_lift_slope || curves.lift_slope > largest_lift_slope))
      say("slope of the lift" + of + ", " + general(curves.lift_slope, 3) + " by rad",
          "angles of attack are in degrees; 2 pi belongs to a thin plate");
    if (curves.has_dynamics && std::abs(curves.zero_lift) > usual_zero_lift)
      say("zero of the lift" + of + " at " + degrees(curves.zero_lift) + " deg",
          "the columns are the angle, Cl, Cd, Cm");
    const double largest = *std::ranges::max_element(polar.lift);
    if (largest > usual_lift)
      say("lift coefficient" + of + " of " + general(largest, 3),
          "the columns are the angle, Cl, Cd, Cm");
  }
  for (std::size_t i = 0; i < blades.aero_sections.size(); ++i) {
    const model::AeroSectionDefinition& section = blades.aero_sections[i];
    const std::string of = " of blades.aero_sections[" + std::to_string(i) + "]";
    if (section.chord > usual_chord * length)
      say("chord" + of + ", " + general(section.chord, 4) + " m on a blade of " +
              general(length, 4) + " m",
          "chord is in m");
    if (std::hypot(section.center[0], section.center[1]) > section.chord)
      say("aerodynamic centre" + of + ", more than a chord off the reference line",
          "center is in m, from the reference line");
    if (i == 0) continue;
    const model::AeroSectionDefinition& before = blades.aero_sections[i - 1];
    const double ratio = section.chord / before.chord;
    // A tip may be narrow.
    const bool is_tip = i + 1 == blades.aero_sections.size();
    if (ratio > usual_ratio || (ratio < 1.0 / usual_ratio && !is_tip))
      say("chord" + of + " is " + general(ratio, 3) + " times that before it", "chord is in m");
    if (std::abs(section.twist - before.twist) > usual_turn)
      say("twist" + of + " differs by " + degrees(section.twist - before.twist) +
              " deg from that before it",
          "twist_deg is in degrees");
  }
  return text;
}

std::string unusual_figures(const model::TurbineDefinition& definition, double rotor_radius) {
  std::string text = unusual_air(definition.blades, definition.blades.beam.length);
  const double tip_speed = std::abs(definition.shaft.speed) * rotor_radius;
  if (tip_speed > usual_tip_speed)
    text += "unusual: tip speed " + general(tip_speed, 4) + " m/s, above " +
            general(usual_tip_speed, 3) +
            " m/s; hint: shaft.speed is in rad/s, shaft.speed_rpm in "
            "revolutions per minute\n";
  if (definition.has_tower && definition.tower.length > usual_tower)
    text += "unusual: tower of " + general(definition.tower.length, 5) + " m, above " +
            general(usual_tower, 3) + " m; hint: tower.length is in m\n";
  return text.empty() ? text : "\n" + text;
}

/// Hinges from the hub outward, with their distances from the shaft axis.
std::string hinge_words(const model::BladesDefinition& blades) {
  std::string text;
  double along = 0.0;
  for (const model::HingeDefinition& hinge : blades.hinges) {
    along += hinge.offset;
    const model::JointDefinition& joint = hinge.joint;
    text += (text.empty() ? "" : "; ") + std::string(components::hinge_name(hinge.axis)) + " at " +
            general(along, 5) + " m " +
            joint_words({joint.kind == model::JointKind::free, joint.stiffness, joint.damping},
                        joint.motion);
  }
  return text;
}

/// One line per damper of the case: "20000 kg, fore-aft 0.3281 Hz 3.834 %, side-side ...".
std::vector<std::string> mass_damper_lines(const turbine::TurbineSystem& system) {
  std::vector<std::string> lines;
  for (const auto& damper : system.equations().mass_dampers()) {
    const model::MassDamperDefinition& definition = damper->definition();
    if (definition.blade == 0 && damper->owner().instance > 1) continue;  // as on blade 1
    system::Owner owner = damper->owner();
    if (definition.blade == 0) owner.instance = 0;
    std::string text = owner.name() + ": " + general(definition.mass, 6) + " kg";
    for (std::size_t i = 0; i < definition.axes.size(); ++i) {
      const model::MassDamperAxis& axis = definition.axes[i];
      const double omega = std::sqrt(axis.stiffness / definition.mass);
      text += std::string(i == 0 ? ", " : "; ") + damper->direction(i) + " " +
              general(omega / (2.0 * std::numbers::pi), 4) + " Hz, damping " +
              general(50.0 * axis.damping / (omega * definition.mass), 4) + " %";
      if (axis.stop > 0.0) text += ", stops at " + general(axis.stop, 4) + " m";
    }
    lines.push_back(text);
  }
  return lines;
}

/// The controller, the pitch actuators and the slope of the rotor torque over the pitch.
std::vector<std::pair<std::string, std::string>> control_lines(
    const model::TurbineDefinition& definition, const model::Turbine& turbine) {
  std::vector<std::pair<std::string, std::string>> lines;
  if (turbine.rotor_pitch_slope != 0.0)
    lines.emplace_back("torque by pitch", general(turbine.rotor_pitch_slope, 5) + " N m/rad");
  if (turbine.pitch_actuator) {
    const model::PitchActuatorDefinition& actuator = *turbine.pitch_actuator;
    std::string text = general(actuator.frequency / (2.0 * std::numbers::pi), 4) + " Hz, damping " +
                       general(100.0 * actuator.damping_ratio, 4) + " %";
    if (std::isfinite(actuator.rate_limit))
      text += ", at most " + degrees(actuator.rate_limit) + " deg/s";
    lines.emplace_back("pitch actuators", text);
  }
  if (!definition.controller) return lines;
  if (!turbine.controller) {
    lines.emplace_back("controller", "none, the rotor is parked");
    return lines;
  }
  const model::ControllerDefinition& law = *turbine.controller;
  std::string text = "set point " + general(*law.set_point, 6) + " rad/s, filter " +
                     general(law.filter, 4) + " rad/s";
  const auto add = [&text](const char* name, const std::optional<model::ControlLoop>& loop,
                           const char* p_unit, const char* i_unit) {
    if (loop)
      text += std::string("; ") + name + " " + general(loop->proportional, 5) + p_unit +
              ", integral " + general(loop->integral, 5) + i_unit;
  };
  add("torque", law.torque, " N m s/rad", " N m/rad");
  add("pitch", law.pitch, " s", "");
  if (law.schedule > 0.0) text += ", gains halved at " + degrees(law.schedule) + " deg";
  lines.emplace_back("controller", text);
  return lines;
}

/// The wind and the models of the air.
std::vector<std::pair<std::string, std::string>> air_lines(
    const model::TurbineDefinition& definition, const model::Turbine& turbine) {
  if (!turbine.air) {
    if (definition.blades.aero_sections.empty()) return {};
    return {{"air", definition.wind ? "none (aero: none)" : "none: no wind is given"}};
  }
  const model::Air& air = *turbine.air;
  const elements::AirModels& models = air.rotor.models;
  std::vector<std::pair<std::string, std::string>> lines;
  std::string wind = general(air.hub_wind, 4) + " m/s at the hub, " +
                     general(air.hub_wind_axial, 4) + " m/s along the shaft";
  if (turbine.speed > 0.0 && air.hub_wind > 0.0)
    wind += "; tip-speed ratio " + general(turbine.speed * air.rotor.tip_radius / air.hub_wind, 4);
  lines.emplace_back("wind", wind);
  int still = 0;
  for (const elements::AirStation& station : air.stations.front())
    if (!station.has_dynamics(models)) ++still;
  const char* dynamics[] = {"hgm", "oye", "quasi_steady", "static", "peters"};
  const char* thrust[] = {"glauert_skew", "buhl", "buhl_f", "madsen"};
  std::string words = count(static_cast<int>(air.stations.front().size()), "station") +
                      " a blade; airfoil dynamics " +
                      dynamics[static_cast<std::size_t>(models.dynamics)];
  const bool has_lags = models.dynamics == elements::AirfoilDynamics::hgm ||
                        models.dynamics == elements::AirfoilDynamics::oye ||
                        models.dynamics == elements::AirfoilDynamics::peters;
  if (has_lags && still > 0)
    words += " (" + std::to_string(still) + " without: their polars have no attached lift)";
  if (models.induction == elements::Induction::none)
    words += "; no induction";
  else if (models.has_rotor_wake()) {
    int states = 0;
    for (const elements::WakeShape& shape : elements::make_wake_shapes(models.wake_shapes))
      states += shape.parts();
    words += "; finite-state wake of Peters and He with " + count(states, "state");
  } else
    words += std::string("; thrust ") + thrust[static_cast<std::size_t>(models.thrust)] +
             (models.inflow == elements::Inflow::oye
                  ? ", dynamic inflow with tau1 " + general(air.rotor.tau1, 4) + " s"
              : models.inflow == elements::Inflow::frozen ? ", frozen wake"
                                                          : ", inflow in equilibrium");
  lines.emplace_back("air", words);
  return lines;
}

/// The airfoils of the blades by their first polar, at angles of attack in degrees.
std::string airfoil_table(const model::BladesDefinition& blades) {
  Table table;
  table.add_column("airfoil", "", Align::left);
  table.add_column("thickness", "");
  table.add_column("polars", "");
  table.add_column("points", "");
  table.add_column("zero lift", "deg");
  table.add_column("slope", "1/rad");
  table.add_column("largest Cl", "");
  table.add_column("at", "deg");
  table.add_column("least Cd", "");
  table.add_column("separated below", "deg");
  table.add_column("above", "deg");
  for (const auto& [name, airfoil] : blades.airfoils) {
    const model::PolarDefinition& polar = airfoil.polars.front();
    const model::PolarDefinition grid = model::on_grid(polar);
    const elements::AirfoilCurves curves = model::make_curves(grid, airfoil.lift_slope);
    // Of the flow from the front.
    std::size_t most = grid.angles.size() / 2;
    for (std::size_t i = 0; i < grid.angles.size(); ++i)
      if (std::abs(grid.angles[i]) < 0.25 * std::numbers::pi && grid.lift[i] > grid.lift[most])
        most = i;
    double below = grid.angles.front();
    double above = grid.angles.back();
    for (const double angle : grid.angles) {
      if (!curves.has_dynamics || curves.separation_at(angle) > 0.0) continue;
      if (angle < curves.zero_lift) below = angle;
      if (angle > curves.zero_lift) above = std::min(above, angle);
    }
    const auto known = [&curves](const std::string& words) {
      return curves.has_dynamics ? words : std::string("-");
    };
    table.add_row({name, airfoil.thickness ? general(*airfoil.thickness, 4) : "-",
                   std::to_string(airfoil.polars.size()), std::to_string(polar.angles.size()),
                   known(degrees(curves.zero_lift)), known(fixed(curves.lift_slope, 3)),
                   fixed(grid.lift[most], 3), degrees(grid.angles[most]),
                   fixed(*std::ranges::min_element(polar.drag), 4), known(degrees(below)),
                   known(degrees(above))});
  }
  return table.text();
}

/// The aerodynamic sections of a blade.
std::string section_table(const model::BladesDefinition& blades) {
  Table table;
  table.add_column("section", "");
  table.add_column("at", "");
  table.add_column("chord", "m");
  table.add_column("twist", "deg");
  table.add_column("airfoil or thickness", "", Align::left);
  for (std::size_t i = 0; i < blades.aero_sections.size(); ++i) {
    const model::AeroSectionDefinition& section = blades.aero_sections[i];
    table.add_row({std::to_string(i + 1), fixed(section.at, 4), fixed(section.chord, 3),
                   fixed(section.twist * 180.0 / std::numbers::pi, 3),
                   section.thickness ? general(*section.thickness, 4) : section.airfoil});
  }
  return table.text();
}

std::string air_tables(const model::BladesDefinition& blades) {
  if (blades.aero_sections.empty()) return {};
  return "\n" + section_table(blades) + "\n" + airfoil_table(blades);
}

std::string facts(const io::Case& input, const turbine::TurbineSystem& system,
                  const model::Masses& masses) {
  const model::TurbineDefinition& definition = input.turbine;
  const model::Turbine& turbine = system.turbine();
  const double radius = model::rotor_radius(turbine);
  const double speed = definition.shaft.speed;
  std::string text;
  const auto line = [&text](const std::string& name, const std::string& words) {
    text += name + std::string(17 - name.size(), ' ') + words + "\n";
  };
  const bool has_rotor = !turbine.blades.empty();
  if (has_rotor) {
    line("rotor speed", speed == 0.0
                            ? "0, parked"
                            : general(speed, 6) + " rad/s, " +
                                  general(speed * 30.0 / std::numbers::pi, 5) + " rpm; tip speed " +
                                  general(speed * radius, 4) + " m/s");
    line("rotor radius", general(radius, 6) + " m: hub " + general(definition.hub.radius, 5) +
                             " m, along the blade " + general(definition.blades.beam.length, 5) +
                             " m");
  }
  if (turbine.has_tower) line("tower", general(definition.tower.length, 6) + " m");
  if (has_rotor) {
    line("rotor inertia", inertia_words(masses));
    line("rotor balance", balance_words(masses));
  }
  if (has_rotor)
    line("blades", count(static_cast<int>(turbine.blades.size()), "blade") +
                       (turbine.blades.size() == 1 ? ""
                        : turbine.identical_blades ? ", alike"
                                                   : ", not alike"));
  if (has_rotor)
    line("rotor symmetry",
         system.symmetry().sectors > 1
             ? "repeats every 1/" + std::to_string(system.symmetry().sectors) + " revolution"
             : "none, the period is a whole revolution");
  line("joints", "yaw " + joint_words(turbine.chain.yaw, turbine.yaw_motion) + "; teeter " +
                     joint_words(turbine.chain.teeter, turbine.teeter_motion) + "; shaft torsion " +
                     joint_words(turbine.chain.torsion) + "; generator " +
                     joint_words(turbine.chain.generator));
  if (has_rotor && !definition.blades.hinges.empty())
    line("hinges", hinge_words(definition.blades));
  const model::ShaftDefinition& shaft = definition.shaft;
  if (shaft.generator.inertia > 0.0 || shaft.gear_ratio != 1.0)
    line("generator",
         "inertia " + general(shaft.generator.inertia, 5) + " kg m^2 about its own axis" +
             (shaft.gear_ratio == 1.0
                  ? ""
                  : ", gear ratio " + general(shaft.gear_ratio, 5) + ": " +
                        general(shaft.generator_speed() * 30.0 / std::numbers::pi, 5) + " rpm"));
  const auto torque = [&](const std::string& name, const model::TorqueLaw& law,
                          const std::string& whose, double at) {
    const elements::TorqueLine at_speed = law.at(at);
    if (at_speed.torque != 0.0 || at_speed.slope != 0.0)
      line(name, general(at_speed.torque, 5) + " N m at " + whose + " speed, slope " +
                     general(at_speed.slope, 5) + " N m s/rad");
  };
  if (turbine.chain.generator.free)
    torque("generator torque", shaft.generator.law,
           shaft.gear_ratio == 1.0 ? "the rotor" : "its own", shaft.generator_speed());
  torque("rotor torque", shaft.rotor, "the rotor", shaft.speed);
  if (definition.has_tower) line("tower foot", support_words(definition.tower.support));
  if (has_rotor && !definition.blades.beam.support.is_clamp())
    line("blade roots", support_words(definition.blades.beam.support));
  for (const auto& [name, words] : control_lines(definition, turbine)) line(name, words);
  for (const auto& [name, words] : air_lines(definition, turbine)) line(name, words);
  std::string dampers = "mass dampers";
  for (const std::string& words : mass_damper_lines(system)) {
    line(dampers, words);
    dampers.clear();
  }
  line("gravity", general(definition.gravity, 6) + " m/s^2");
  if (!definition.loads.empty())
    line("loads", count(static_cast<int>(definition.loads.size()), "prescribed load"));
  std::string mesh;
  if (has_rotor) mesh = "blades " + mesh_words(turbine.blades.front());
  if (turbine.has_tower) mesh += (mesh.empty() ? "tower " : "; tower ") + mesh_words(turbine.tower);
  line("mesh", mesh);
  const auto damping = [&line](std::string name, const std::vector<std::string>& lines) {
    for (const std::string& words : lines) {
      line(name, words);
      name.clear();
    }
  };
  if (has_rotor)
    damping("blade damping", damping_lines(definition.blades.beam,
                                           model::build_beam("blade", definition.blades.beam),
                                           {"flap", "lead-lag", "torsion"}));
  if (turbine.has_tower)
    damping("tower damping",
            damping_lines(definition.tower, turbine.tower, {"fore-aft", "side-side", "torsion"}));
  line("unknowns", std::to_string(system.size()) + ", " +
                       count(turbine.degrees_of_freedom, "degree") + " of freedom");
  return text;
}

}  // namespace

void run_check(const Job& job) {
  const model::Turbine turbine = model::build_turbine(job.input.turbine);
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  if (petsc::Session::rank() != 0) return;
  const simulation::TransientSetup& transient = job.input.transient;
  if (transient.options.duration > 0.0)
    at_place(job.input.path, [&] { simulation::find_channels(transient, system); });
  const simulation::LinearizeSetup& linearize = job.input.linearize;
  if (!linearize.inputs.empty() || !linearize.outputs.empty()) make_input_output(job.input, system);
  const model::Masses masses = model::compute_masses(job.input.turbine, turbine);
  const std::string& title = job.input.turbine.title;
  deliver(
      job,
      (title.empty() ? job.input.path : title) + "\n\n" + mass_table(turbine, masses) + "\n" +
          facts(job.input, system, masses) + air_tables(job.input.turbine.blades) +
          unusual_figures(job.input.turbine, model::rotor_radius(system.turbine())),
      [&](io::ResultFile& file) {
        file.write_model(system);
        write_masses(file, masses);
      },
      nullptr);
}

}  // namespace samara::drivers
