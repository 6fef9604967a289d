#include "rotor_fields.hpp"

#include "air_fields.hpp"
#include "beam_fields.hpp"

namespace samara::fields {
namespace {

using model::JointKind;

constexpr int most_blades = 100;

void declare_motion(Visitor& fields, model::JointDefinition& joint) {
  const bool is_prescribed = joint.kind == JointKind::prescribed;
  if (fields.reads()) {
    if (!is_prescribed) {
      fields.accept({"angle_deg", "harmonic"});
      for (const char* key : {"angle_deg", "harmonic"})
        if (fields.given(key)) fields.refuse(key, "only a joint: prescribed has a motion");
      return;
    }
    for (const char* key : {"stiffness", "damping"})
      if (fields.given(key))
        fields.refuse(key, "springs and dampers have no effect on a prescribed joint");
    fields.at_least_one({"angle_deg", "harmonic"}, "of a prescribed joint, or \"harmonic\"");
  } else if (!is_prescribed && !fields.describes()) {
    return;
  }
  model::PrescribedMotion& motion = joint.motion;
  fields.number({"angle_deg", deg, half_turn,
                 "mean of a prescribed angle; this key, `harmonic` or both must be given"},
                motion.angle);
  fields.block(Field("harmonic", "of a prescribed angle: amplitude cos(frequency t + phase)")
                   .or_else("absent"),
               Presence{[&] { return motion.amplitude != 0.0; }, [] {}}, [&] {
                 declare_frequency(fields, motion.per_rev, motion.frequency);
                 fields.number(Field("amplitude_deg", deg, half_turn, "").required(),
                               motion.amplitude);
                 fields.number({"phase_deg", deg, ""}, motion.phase);
               });
}

/// Free or locked, with spring and damper.
void declare_torsion(Visitor& fields, model::JointDefinition& torsion) {
  fields.choice(Field("joint", "").required("free or locked"), torsion.kind,
                {{"free", JointKind::free}, {"locked", JointKind::locked}});
  fields.number({"stiffness", "N m/rad", non_negative, "of a free joint, > 0 there"},
                torsion.stiffness);
  fields.number({"damping", "N m s/rad", non_negative, "of a free joint"}, torsion.damping);
}

void declare_torque(Visitor& fields, model::TorqueLaw& law) {
  fields.exclusive({{"torque_table"}, {"torque", "torque_slope"}});
  fields.number({"torque", "N m",
                 "at the mean speed: `speed` of the rotor, `speed` times the size of `gear_ratio` "
                 "of the generator"},
                law.torque);
  fields.number({"torque_slope", "N m s/rad",
                 "by how much the torque grows with the speed; negative where it falls"},
                law.slope);
  fields.pairs(Field("torque_table", "rad/s, N m",
                     "instead of both: `[[speed, torque], ...]`, at least two entries with rising "
                     "speed, the mean speed among them or between (at rest a table that begins "
                     "above 0 gives no torque). The torque is the table's at each speed, linear "
                     "between the entries; small motions see its slope, at an entry the mean of "
                     "those on its two sides. A transient that leaves the table ends there")
                   .or_else("absent"),
               {"speed", "torque"}, law.table);
}

void declare_generator(Visitor& fields, model::GeneratorDefinition& generator) {
  fields.choice(Field("joint",
                      "`locked`: the shaft turns at `speed` there. `free`: `speed` is the mean of "
                      "the steady state, and the trim finds and reports the constant torque that "
                      "holds it, acting between generator and nacelle; the mean azimuth is that of "
                      "a rotor at constant speed")
                    .required("free or locked"),
                generator.kind, {{"free", JointKind::free}, {"locked", JointKind::locked}});
  fields.number({"own_inertia", "kg m^2", non_negative,
                 "of the generator about its own axis, which is parallel to the shaft, in its own "
                 "speed"},
                generator.inertia);
  fields.retired("inertia",
                 "was counted at the speed of the shaft, gears included, and is no longer read; "
                 "hint: own_inertia, of the generator about its own axis, and shaft.gear_ratio (of "
                 "an OpenFAST deck GenIner and GBRatio); without gears own_inertia is the same "
                 "number");
  declare_torque(fields, generator.law);
}

void declare_teeter(Visitor& fields, model::HubDefinition& hub) {
  declare_joint(fields, nullptr, hub.teeter);
  model::StopDefinition& stops = hub.teeter_stops;
  fields.block(
      Field("stops", "a second spring and damper from an angle on, both ways").or_else("none"),
      Presence{[&] { return stops.angle != 0.0; }, [] {}}, [&] {
        fields.number(Field("angle_deg", deg, positive, "").required(), stops.angle);
        fields.number(Field("stiffness", "N m/rad", positive, "").required(), stops.stiffness);
        fields.number({"damping", "N m s/rad", non_negative, ""}, stops.damping);
      });
  fields.number({"undersling", "m", "from the teeter pin to the rotor apex, along the shaft"},
                hub.undersling);
  fields.number({"delta3_deg", deg, quarter_turn,
                 "the teeter axis is turned in the rotor plane, from h1 toward h3, so that a blade "
                 "that flaps downwind also pitches. The sign is OpenFAST's"},
                hub.delta3);
}

void declare_actuator(Visitor& fields, model::PitchActuatorDefinition& actuator) {
  if (fields.reads()) actuator.frequency = actuator.damping_ratio = 1.0;  // where they are wrong
  fields.number(Field("frequency", "rad/s", positive, "undamped natural frequency").required(),
                actuator.frequency);
  fields.number(Field("damping_ratio", "", positive, "").required(), actuator.damping_ratio);
  fields.number(
      Field("rate_limit_deg", deg_per_s, positive, "of the pitch rate").none_at_infinity(),
      actuator.rate_limit);
  fields.number(Field("lowest_deg", deg, half_turn,
                      "lower limit of the demanded pitch; the pitch of the case must be within the "
                      "limits. At a limit a controller of the pitch holds no speed")
                    .none_at_infinity(),
                actuator.lowest);
  fields.number(Field("highest_deg", deg, half_turn, "upper limit").none_at_infinity(),
                actuator.highest);
}

constexpr std::array<std::pair<const char*, model::HingeAxis>, 3> hinge_axes{
    {{"flap", model::HingeAxis::flap},
     {"lag", model::HingeAxis::lag},
     {"pitch", model::HingeAxis::pitch}}};

void declare_hinge(Visitor& fields, model::HingeDefinition& hinge) {
  fields.choice(Field("axis",
                      "`flap` (> 0 downwind), `lag` (> 0 against the rotor's turning) or `pitch` "
                      "(> 0 toward feather), each at most once, in any order")
                    .required("flap, lag or pitch"),
                hinge.axis,
                {{"flap", model::HingeAxis::flap},
                 {"lag", model::HingeAxis::lag},
                 {"pitch", model::HingeAxis::pitch}});
  fields.number({"offset", "m", non_negative,
                 "along b1 from the shaft axis, or from the hinge inboard of it. All offsets end "
                 "before `hub.radius`, where the root is"},
                hinge.offset);
  declare_joint(fields, "free, locked or prescribed", hinge.joint);
  fields.number({"delta3_deg", deg, quarter_turn,
                 "flap only: its axis is turned, so that the blade pitches by -tan(delta3) times a "
                 "small flap angle"},
                hinge.delta3);
}

void declare_difference(Visitor& fields, model::BladeDifference& difference) {
  fields.number({"pitch_deg", deg, half_turn, "added to the pitch of all"}, difference.pitch);
  fields.number({"mass_factor", "", positive, "times the section masses"}, difference.mass_factor);
  fields.number({"stiffness_factor", "", positive, "times the section stiffnesses"},
                difference.stiffness_factor);
  fields.block(Field("hinges",
                     "spring and damper of free hinges on this blade: `{lag: {damping: "
                     "0}}`")
                   .or_else("those of all"),
               [&] {
                 for (const auto& hinge : hinge_axes)
                   fields.block(
                       Field(hinge.first, "").or_else("those of all"),
                       Presence{[&] { return difference.hinges.contains(hinge.second); },
                                [&] { difference.hinges[hinge.second]; }},
                       [&] {
                         model::HingeDifference& own = difference.hinges[hinge.second];
                         fields.number(
                             Field("stiffness", "N m/rad", non_negative, "").or_else("that of all"),
                             own.stiffness);
                         fields.number(
                             Field("damping", "N m s/rad", non_negative, "").or_else("that of all"),
                             own.damping);
                       });
               });
}

}  // namespace

void declare_frequency(Visitor& fields, int& per_rev, double& frequency) {
  fields.exclusive({{"per_rev"}, {"frequency"}});
  fields.integer(Field("per_rev", "", integers(1, most_harmonics), "n, of n times the rotor speed")
                     .none_at_zero(""),
                 per_rev);
  fields.number(Field("frequency", "rad/s", positive, "instead of `per_rev`").none_at_zero(""),
                frequency);
  fields.at_least_one({"per_rev", "frequency"}, "or \"frequency\"");
}

void declare_joint(Visitor& fields, const char* required, model::JointDefinition& joint) {
  const Field kind("joint",
                   "`free` (with the spring and damper below), `locked` at 0, or `prescribed`: its "
                   "angle is angle_deg + amplitude_deg cos(n Omega t + phase_deg), whatever load "
                   "that takes");
  const bool is_known =
      fields.choice(required == nullptr ? kind : kind.required(required), joint.kind,
                    {{"free", JointKind::free},
                     {"locked", JointKind::locked},
                     {"prescribed", JointKind::prescribed}}) ||
      !fields.given("joint");
  fields.number({"stiffness", "N m/rad", non_negative, "of a free joint"}, joint.stiffness);
  fields.number({"damping", "N m s/rad", non_negative, "of a free joint"}, joint.damping);
  if (is_known)
    declare_motion(fields, joint);
  else
    fields.accept({"angle_deg", "harmonic"});
}

void declare_shaft(Visitor& fields, model::ShaftDefinition& shaft) {
  fields.number({"speed", "rad/s", non_negative,
                 "about +s2; 0 is a parked rotor, which `floquet` does not accept"},
                Field("speed_rpm", rpm, non_negative, "the same, instead of `speed`").or_else(""),
                shaft.speed);
  fields.number({"overhang", "m", "from the yaw axis to the teeter pin, along s2"}, shaft.overhang);
  fields.number({"tilt_deg", deg, quarter_turn, "> 0 raises the downwind end"}, shaft.tilt);
  fields.number({"height", "m", "from the tower top to the shaft axis, along y3"}, shaft.height);
  fields.number({"azimuth_deg", deg, "of blade 1 at t = 0"}, shaft.azimuth);
  fields.number({"mass", "kg", non_negative, ""}, shaft.mass);
  fields.number({"center_of_mass", "m", "along s2 from the yaw axis"}, shaft.center_of_mass);
  fields.block({"inertia", "about its own centre of mass"}, [&] {
    fields.number({"axial", "kg m^2", non_negative, "about s2"}, shaft.inertia_axial);
    fields.number({"transverse", "kg m^2", non_negative, "across it"}, shaft.inertia_transverse);
    fields.retired("lateral", "is named transverse; hint: transverse, with the same number");
  });
  fields.block(Field("torsion",
                     "a [joint](#joints) between generator and rotor, free or locked; "
                     "`free` needs a `stiffness`")
                   .or_else("locked"),
               [&] { declare_torsion(fields, shaft.torsion); });
  fields.number({"gear_ratio", "",
                 "n: turns of the generator for one of the shaft, both against the nacelle; not 0, "
                 "< 0 where it turns the other way"},
                shaft.gear_ratio);
  fields.block(Field("generator", "behind the gear").or_else("locked"),
               [&] { declare_generator(fields, shaft.generator); });
  fields.block(Field("rotor",
                     "a [torque law](#torque-laws): a torque on the hub about its axis h2 in the "
                     "sense of its turning, as the wind gives it, over the speed of the hub about "
                     "h2")
                   .or_else("absent"),
               [&] {
                 declare_torque(fields, shaft.rotor);
                 fields.number({"torque_pitch_slope", "N m/rad",
                                "change of the rotor's torque by the mean pitch of the blades, "
                                "`each` and hinges included, from `blades.pitch_deg` on (< 0 where "
                                "the pitch to feather takes torque away)"},
                               shaft.rotor_pitch_slope);
               });
}

void declare_hub(Visitor& fields, model::HubDefinition& hub) {
  fields.number({"mass", "kg", non_negative, ""}, hub.mass);
  fields.number({"center_of_mass", "m", "along the shaft (h2) from the teeter pin"},
                hub.center_of_mass);
  fields.vector({"inertia", "kg m^2", non_negative,
                 "about its own centre of mass: h1 (teeter axis), h2 (shaft), h3"},
                hub.inertia);
  fields.number(
      {"radius", "m", non_negative, "from the shaft axis to the blade root, along the blade"},
      hub.radius);
  fields.list(Field("point_masses",
                    "list of masses on the hub, such as the counterweight of a one-bladed rotor"),
              "point masses", 0, hub.point_masses, [&](model::HubMassDefinition& lump) {
                declare_lump(fields, lump, "in h1 h2 h3 from the teeter pin",
                             "about its own centre, about h1, h2, h3");
              });
  fields.block(Field("teeter",
                     "a [joint](#joints) about h1, for one or two blades: an angle > 0 "
                     "moves blade 1 upwind")
                   .or_else("rigid hub"),
               Presence{[&] {
                          return !(hub.teeter == model::JointDefinition() &&
                                   hub.teeter_stops == model::StopDefinition() &&
                                   hub.undersling == 0.0 && hub.delta3 == 0.0);
                        },
                        [&] { hub.teeter.kind = JointKind::free; }},
               [&] {
                 if (fields.describes()) hub.teeter.kind = JointKind::free;
                 declare_teeter(fields, hub);
               });
}

void declare_blades(Visitor& fields, model::BladesDefinition& blades) {
  fields.integer({"count", "", integers(1, most_blades), "blades, evenly spread"}, blades.count);
  fields.number({"precone_deg", deg, quarter_turn, "> 0 moves the tips downwind"}, blades.precone);
  fields.number({"pitch_deg", deg, half_turn, "> 0 toward feather"}, blades.pitch);
  declare_beam(fields, BeamPlace::blade, blades.beam);
  fields.list(Field("hinges", "of the roots, see [hinges](#hinges)"),
              "hinges, from the hub outward", 0, blades.hinges,
              [&](model::HingeDefinition& hinge) { declare_hinge(fields, hinge); });
  fields.number({"pitch_link_delta3_deg", deg, quarter_turn,
                 "a pitch link pitches each blade by -tan(delta3) times the angle of its free flap "
                 "hinge, at the pitch hinge or, without one, at the root"},
                blades.pitch_link);
  fields.numbered(
      Field("each",
            "keys that differ on one blade, by its number from 1: `{2: {pitch_deg: "
            "0.5, mass_factor: 1.01}}`")
          .or_else("all alike"),
      "blade number", blades.count, blades.each,
      [&](model::BladeDifference& difference) { declare_difference(fields, difference); });
  fields.block(Field("pitch_actuator", "see [pitch actuators](#pitch-actuators)").or_else("none"),
               blades.actuator, [&](model::PitchActuatorDefinition& actuator) {
                 declare_actuator(fields, actuator);
               });
  declare_airfoils(fields, blades);
}

}  // namespace samara::fields
