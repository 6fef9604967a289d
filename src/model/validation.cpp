#include "samara/model/validation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "samara/base/format.hpp"

#include "air_validation.hpp"

namespace samara::model {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
/// Relative difference up to which a set point equals the mean speed.
constexpr double speed_round_off = 1e-6;
/// Relative tolerance between `length` and the arc length of `reference_line`.
constexpr double length_tolerance = 1e-3;

std::string indexed(const std::string& list, std::size_t i) {
  return list + "[" + std::to_string(i) + "]";
}

const char* word_of(HingeAxis axis) {
  return axis == HingeAxis::flap ? "flap" : axis == HingeAxis::lag ? "lag" : "pitch";
}

class Validation {
 public:
  explicit Validation(const TurbineDefinition& turbine) : turbine_(turbine) {}

  std::vector<Fault> find() {
    if (turbine_.has_tower) check_beam("tower", turbine_.tower);
    check_shaft();
    if (turbine_.blades.count > 0) {
      check_beam("blades", turbine_.blades.beam);
      check_teeter();
      check_hinges();
      check_each();
      check_ends();
      if (turbine_.blades.actuator) check_actuator(*turbine_.blades.actuator);
    } else {
      check_tower_alone();
    }
    for (std::size_t i = 0; i < turbine_.loads.size(); ++i) check_load(i);
    for (std::size_t i = 0; i < turbine_.mass_dampers.size(); ++i) check_mass_damper(i);
    if (turbine_.controller) check_controller(*turbine_.controller);
    const std::vector<Fault> of_air = find_air_faults(turbine_);
    faults_.insert(faults_.end(), of_air.begin(), of_air.end());
    return faults_;
  }

 private:
  void add(const std::string& field, const std::string& text,
           const std::vector<std::string>& others = {}) {
    faults_.push_back({field, text, others});
  }

  // ---- beams -----------------------------------------------------------------------------------

  void check_beam(const std::string& key, const BeamDefinition& beam) {
    if (beam.reference_line.empty() && !(beam.length > 0.0))
      add(key + ".length", "expected a number > 0", {key + ".reference_line"});
    check_line(key, beam);
    if (beam.sections.empty()) add(key + ".sections", "expected one section or more");
    for (const double length : beam.element_lengths)
      if (!(length > 0.0)) {
        add(key + ".element_lengths", "expected numbers > 0, got " + general(length, 6));
        break;
      }
    for (std::size_t i = 0; i < beam.sections.size(); ++i) {
      const std::string place = indexed(key + ".sections", i);
      const SectionDefinition& section = beam.sections[i];
      if (const std::string fault = find_section_fault(section); !fault.empty()) add(place, fault);
      if (i == 0) continue;
      if (!(section.at > beam.sections[i - 1].at))
        add(place + ".at",
            "expected more than the section before has, got " + general(section.at, 6));
      if (section.rigid != beam.sections[0].rigid)
        add(place,
            "a strain that is rigid in one section must be rigid in all sections of the beam");
    }
    check_support(key + ".support", beam.support);
    check_support(key + ".end_support", beam.end_support);
    const bool has_ratios =
        std::ranges::any_of(beam.modal_damping, [](const auto& one) { return one.has_value(); });
    if (has_ratios && !beam.mass_damping.isZero(0.0))
      add(key + ".mass_damping",
          "cannot be combined with damping ratios, which are fitted by strain rates alone; hint: "
          "give damping as mu");
  }

  void check_line(const std::string& key, const BeamDefinition& beam) {
    const std::vector<Vector3>& line = beam.reference_line;
    if (line.empty()) return;
    const std::size_t before = faults_.size();
    const std::string field = key + ".reference_line";
    if (line.size() < 2) add(field, "expected at least 2 points");
    if (!line[0].isZero(0.0))
      add(indexed(field, 0), "the first point must be [0, 0, 0], the root of the beam");
    for (std::size_t i = 1; i < line.size(); ++i)
      if (line[i] == line[i - 1]) add(indexed(field, i), "the same point as the one before");
    if (faults_.size() > before) return;
    const double length = compute_arc_length(line);
    if (!std::isfinite(length))
      add(field, "the points are too far apart");
    else if (beam.length != 0.0 && std::abs(beam.length - length) > length_tolerance * length)
      add(key + ".length", "the arc length of reference_line is " + std::to_string(length) +
                               ", got " + general(beam.length, 6) + "; leave length out");
  }

  void check_support(const std::string& key, const SupportDefinition& support) {
    const bool does_something =
        support.mass > 0.0 || !support.added_mass.isZero(0.0) || !support.damping.isZero(0.0);
    if (support.is_clamp() && does_something)
      add(key, "mass and damping of a support that is rigid in all directions have no effect");
    if (const std::string fault = find_support_fault(support); !fault.empty()) add(key, fault);
  }

  // ---- the drive train -------------------------------------------------------------------------

  void check_shaft() {
    const ShaftDefinition& shaft = turbine_.shaft;
    if (shaft.gear_ratio == 0.0) add("shaft.gear_ratio", "expected a number other than 0");
    if (shaft.torsion.kind == JointKind::free && shaft.torsion.stiffness == 0.0)
      add("shaft.torsion.joint", "a shaft that may twist needs a stiffness > 0");
    for (const auto& [field, kind] : {std::pair("shaft.torsion.joint", shaft.torsion.kind),
                                      {"shaft.generator.joint", shaft.generator.kind}})
      if (kind == JointKind::prescribed) add(field, "expected free or locked, got \"prescribed\"");
    for (const auto& [field, law] :
         {std::pair("shaft.generator", &shaft.generator.law), {"shaft.rotor", &shaft.rotor}})
      if (!law->table.empty() && (law->torque != 0.0 || law->slope != 0.0))
        add(std::string(field) + ".torque_table",
            "given together with torque or torque_slope; leave one of them out");
    const bool is_free = shaft.generator.kind == JointKind::free;
    if (is_free && shaft.torsion.kind == JointKind::free && shaft.generator.inertia == 0.0)
      add("shaft.generator", "a free generator behind a shaft that may twist needs an inertia > 0");
    if (is_free)
      check_law("shaft.generator.torque_table", shaft.generator.law,
                shaft.gear_ratio == 1.0 ? "shaft.speed" : "shaft.speed times gear_ratio",
                shaft.generator_speed());
    check_law("shaft.rotor.torque_table", shaft.rotor, "shaft.speed", shaft.speed);
  }

  void check_law(const std::string& key, const TorqueLaw& law, const std::string& speed_words,
                 double speed) {
    if (law.table.size() == 1) add(key, "expected at least 2 entries [speed, torque]");
    if (law.table.size() < 2 || law.covers(speed) || speed == 0.0) return;
    add(key, "the table reaches from " + general(law.table.front().first, 6) + " to " +
                 general(law.table.back().first, 6) + " rad/s, " + speed_words + " is " +
                 general(speed, 6) +
                 " rad/s; hint: entries up to there, or torque and "
                 "torque_slope at this speed");
  }

  void check_controller(const ControllerDefinition& controller) {
    const ShaftDefinition& shaft = turbine_.shaft;
    const double speed = shaft.generator_speed();
    if (controller.has_integral() && speed != 0.0 &&
        std::abs(controller.set_point.value_or(speed) - speed) > speed_round_off * speed)
      add("controller.set_point",
          "the integral holds the generator at " + general(*controller.set_point, 6) +
              " rad/s, shaft.speed times gear_ratio is " + general(speed, 6) +
              " rad/s; hint: leave the set point out; it is then that speed",
          {"controller.set_point_rpm", "shaft.speed", "shaft.speed_rpm", "shaft.gear_ratio"});
    if (shaft.generator.kind != JointKind::free)
      add("controller",
          "the generator is locked, its speed is given; hint: shaft.generator: {joint: free}",
          {"shaft.generator.joint"});
    if (!controller.torque && !controller.pitch)
      add("controller", "expected torque, pitch or both");
    if (controller.schedule > 0.0 && !(controller.schedule + turbine_.blades.pitch > 0.0))
      add("controller.pitch.gain_schedule_deg",
          "the gains are divided by 1 + pitch/gain_schedule, which is not > 0 at blades.pitch_deg");
    if (controller.torque && controller.pitch && controller.torque->integral != 0.0 &&
        controller.pitch->integral != 0.0)
      add("controller.pitch.integral",
          "torque and pitch cannot both have an integral: both would hold the speed, and their "
          "shares of the torque would be undetermined");
    if (controller.pitch && shaft.rotor_pitch_slope == 0.0 && !turbine_.aero)
      add("controller.pitch",
          "the torque of the rotor does not depend on the pitch; hint: give "
          "wind and blades.aero_sections, or shaft.rotor.torque_pitch_slope in their place",
          {"shaft.rotor.torque_pitch_slope"});
  }

  // ---- the rotor -------------------------------------------------------------------------------

  void check_teeter() {
    if (turbine_.hub.teeter.kind == JointKind::locked || turbine_.blades.count <= 2) return;
    add("hub.teeter.joint",
        "a teeter hinge carries two blades, blades.count is " +
            std::to_string(turbine_.blades.count) + "; use joint: locked, or leave teeter out",
        {"blades.count"});
  }

  /// The hinge about an axis; null: there is none.
  const HingeDefinition* find_hinge(HingeAxis axis) const {
    const auto& hinges = turbine_.blades.hinges;
    const auto found = std::ranges::find(hinges, axis, &HingeDefinition::axis);
    return found == hinges.end() ? nullptr : &*found;
  }

  void check_hinges() {
    const std::vector<HingeDefinition>& hinges = turbine_.blades.hinges;
    double along = 0.0;
    for (std::size_t i = 0; i < hinges.size(); ++i) {
      along += hinges[i].offset;
      if (find_hinge(hinges[i].axis) != &hinges[i])
        add(indexed("blades.hinges", i) + ".axis", "given twice; each axis has at most one hinge");
      if (hinges[i].delta3 != 0.0 && hinges[i].axis != HingeAxis::flap)
        add(indexed("blades.hinges", i) + ".delta3_deg", "only the axis of a flap hinge is skewed");
    }
    if (along > turbine_.hub.radius)
      add("blades.hinges",
          "the offsets add to " + general(along, 6) + " m, beyond the root at hub.radius, " +
              general(turbine_.hub.radius, 6) + " m",
          {"hub.radius"});
    const HingeDefinition* flap = find_hinge(HingeAxis::flap);
    if (turbine_.blades.pitch_link != 0.0 &&
        (flap == nullptr || flap->joint.kind != JointKind::free))
      add("blades.pitch_link_delta3_deg", "blades.hinges has no free flap hinge");
  }

  void check_each() {
    for (const auto& [number, difference] : turbine_.blades.each) {
      const std::string place = "blades.each." + std::to_string(number);
      if (number < 1 || number > turbine_.blades.count)
        add("blades.each", "expected a blade number from 1 to " +
                               std::to_string(turbine_.blades.count) + ", got \"" +
                               std::to_string(number) + "\"");
      for (const auto& [axis, own] : difference.hinges) {
        const HingeDefinition* hinge = find_hinge(axis);
        if (hinge == nullptr || hinge->joint.kind != JointKind::free)
          add(place + ".hinges." + word_of(axis), "no free hinge of blades.hinges");
      }
    }
  }

  /// Supports of blade ends. The root of a blade is free only on hinges. A beam between two
  /// supports is free on the supports, in axes that do not turn.
  void check_ends() {
    const BeamDefinition& beam = turbine_.blades.beam;
    if (beam.end_support.is_none()) {
      if (beam.support.free != std::array<bool, 6>{})
        add("blades.support",
            "the root of a blade can be free only on hinges; hint: replace the support by hinges: "
            "[{axis: "
            "flap, joint: free}], axis pitch for theta1, flap for theta2, lag for theta3");
      return;
    }
    if (std::ranges::any_of(turbine_.blades.hinges, [](const HingeDefinition& hinge) {
          return hinge.joint.kind != JointKind::locked;
        }))
      add("blades.end_support",
          "holds the end in axes that blades.hinges turn; hint: a beam between two supports has "
          "support: pinned or stiffness: {theta2: free, ...} instead of hinges");
  }

  void check_actuator(const PitchActuatorDefinition& actuator) {
    const BladesDefinition& blades = turbine_.blades;
    const auto check = [&](double pitch) {
      if (pitch >= actuator.lowest && pitch <= actuator.highest) return;
      add("blades.pitch_actuator", "the pitch of the case, " + general(pitch / degree, 6) +
                                       " deg, is not within lowest_deg and highest_deg");
    };
    check(blades.pitch);
    for (const auto& [number, blade] : blades.each)
      if (blade.pitch != 0.0) check(blades.pitch + blade.pitch);
  }

  /// Without blades there is no shaft that turns.
  void check_tower_alone() {
    constexpr const char* text = "there are no blades; hint: give the body on the tower as nacelle";
    if (!(turbine_.shaft == ShaftDefinition())) add("shaft", text);
    if (!(turbine_.hub == HubDefinition())) add("hub", text);
    const NacelleDefinition& nacelle = turbine_.nacelle;
    const double about_yaw =
        nacelle.inertia(2) + nacelle.mass * nacelle.center_of_mass.head<2>().squaredNorm();
    if (nacelle.yaw.kind == JointKind::free && !(about_yaw > 0.0))
      add("nacelle.yaw",
          "free, but without blades nothing has inertia about the yaw axis; hint: "
          "nacelle.inertia, or joint: locked");
  }

  // ---- loads and dampers -----------------------------------------------------------------------

  void check_load(std::size_t i) {
    const LoadDefinition& load = turbine_.loads[i];
    const std::string place = indexed("loads", i);
    if (load.on_tower && !turbine_.has_tower) add(place + ".beam", "there is no tower");
    if (!load.on_tower && turbine_.blades.count == 0)
      add(place + ".beam", "there are no blades, only a tower");
    else if (!load.on_tower && (load.blade < 0 || load.blade > turbine_.blades.count))
      add(place + ".beam", "expected tower, blades or a blade from 1 to " +
                               std::to_string(turbine_.blades.count) + " (blade 1), got \"blade " +
                               std::to_string(load.blade) + "\"");
    if (load.from > load.to)
      add(place + ".to", "expected more than from, got " + general(load.to, 6));
  }

  void check_mass_damper(std::size_t i) {
    using Carrier = MassDamperDefinition::Carrier;
    const MassDamperDefinition& damper = turbine_.mass_dampers[i];
    const std::string place = indexed("tuned_mass_dampers", i);
    const bool is_on_blade = damper.carrier == Carrier::blade;
    if (!is_on_blade && !turbine_.has_tower)
      add(place + ".on", std::string("there is no tower: nothing moves the ") +
                             (damper.carrier == Carrier::tower ? "tower" : "nacelle"));
    if (is_on_blade &&
        (damper.blade < 0 || damper.blade > turbine_.blades.count || turbine_.blades.count == 0))
      add(place + ".on",
          "there is no such blade, there are " + std::to_string(turbine_.blades.count));
    if (damper.axes.empty() || damper.axes.size() > 2)
      add(place, "a mass damper has one axis or two; leave one of them out");
    for (std::size_t k = 0; k < damper.axes.size(); ++k)
      if (damper.axes[k].axis < 0 || damper.axes[k].axis > 2 ||
          (k > 0 && damper.axes[k].axis == damper.axes[0].axis))
        add(place, "expected different axes from 0, 1 and 2");
    if (is_on_blade && damper.at == 1.0 && !turbine_.blades.beam.end_support.is_none())
      add(place + ".at", "blades.end_support holds the end; hint: at: 0.99", {place + ".on"});
  }

  const TurbineDefinition& turbine_;
  std::vector<Fault> faults_;
};

}  // namespace

std::vector<Fault> find_notes(const TurbineDefinition& turbine) {
  const ShaftDefinition& shaft = turbine.shaft;
  const TorqueLaw& law = shaft.generator.law;
  std::vector<Fault> notes = find_air_notes(turbine);
  const auto check_rest = [&notes](const std::string& field, const TorqueLaw& acting) {
    if (acting.table.size() < 2 || acting.covers(0.0)) return;
    notes.push_back({field + ".torque_table", "the table reaches from " +
                                                  general(acting.table.front().first, 6) + " to " +
                                                  general(acting.table.back().first, 6) +
                                                  " rad/s, the rotor is parked: no torque"});
  };
  if (shaft.generator.kind != JointKind::free) {
    constexpr const char* text = "without effect, the generator is locked";
    if (law.torque != 0.0) notes.push_back({"shaft.generator.torque", text});
    if (law.slope != 0.0) notes.push_back({"shaft.generator.torque_slope", text});
    if (!law.table.empty()) notes.push_back({"shaft.generator.torque_table", text});
  } else if (shaft.speed == 0.0) {
    check_rest("shaft.generator", law);
  }
  if (shaft.speed == 0.0) check_rest("shaft.rotor", shaft.rotor);
  return notes;
}

std::vector<Fault> find_faults(const TurbineDefinition& turbine) {
  return Validation(turbine).find();
}

}  // namespace samara::model
