#include "samara/fields/turbine_fields.hpp"

#include "air_fields.hpp"
#include "beam_fields.hpp"
#include "rotor_fields.hpp"

namespace samara::fields {
namespace {

constexpr const char* three_joints = "free, locked or prescribed";

void declare_nacelle(Visitor& fields, model::NacelleDefinition& nacelle) {
  fields.number({"mass", "kg", non_negative, ""}, nacelle.mass);
  fields.vector({"center_of_mass", "m", "from the tower top, in y1 y2 y3"}, nacelle.center_of_mass);
  fields.vector({"inertia", "kg m^2", non_negative, "about its own centre of mass, axes y1 y2 y3"},
                nacelle.inertia);
  fields.block(Field("yaw",
                     "a [joint](#joints) about y3, counter-clockwise from above; its "
                     "`joint` is required")
                   .or_else("locked"),
               [&] { declare_joint(fields, three_joints, nacelle.yaw); });
}

/// Name of a loaded beam: "tower", "blades" or "blade 2"; `blade` 0: all blades.
std::string name_beam(bool on_tower, int blade) {
  return on_tower ? "tower" : blade == 0 ? "blades" : "blade " + std::to_string(blade);
}

/// Number in "blade 2"; 0 where the text names no blade up to `count`.
int find_blade(const std::string& text, int count) {
  for (int k = 1; k <= count; ++k)
    if (text == "blade " + std::to_string(k)) return k;
  return 0;
}

void declare_loaded_place(Visitor& fields, model::LoadDefinition& load) {
  constexpr double unread = -1.0;
  const Field at("at", "", fraction_of_one,
                 "place of a point load as a fraction of the arc length, 0 (root) to 1 (tip)");
  const Field from("from", "", fraction_of_one,
                   "instead of `at`: a distributed load from here, uniform, force and moment per "
                   "metre");
  const Field to("to", "", fraction_of_one, "to here, more than `from`");
  fields.exclusive({{"at"}, {"from", "to"}});
  fields.at_least_one({"at", "from", "to"}, "a point load, or \"from\" and \"to\"");
  const bool is_point = fields.given("at") || (!fields.wants_all() && load.from == load.to);
  if (fields.describes() || is_point) {
    fields.number(at.or_else("").required("", !fields.wants_all()), load.from);
    if (fields.reads()) load.to = load.from;
  }
  if (is_point) return;
  const bool is_line = fields.given("from") || fields.given("to") || !fields.wants_all();
  if (is_line && fields.reads()) load.from = load.to = unread;
  fields.number(from.or_else("").required("beside \"to\"", is_line), load.from);
  fields.number(to.or_else("").required("beside \"from\"", is_line), load.to);
  if (is_line && load.from != unread && load.to != unread && !(load.from < load.to))
    fields.expected("to", "more than from");
}

void declare_load(Visitor& fields, const model::TurbineDefinition& turbine,
                  model::LoadDefinition& load) {
  std::string beam = name_beam(load.on_tower, load.blade);
  fields.text(Field("beam", "`tower`, `blades` (the same load on each), or one of them: `blade 2`")
                  .required("tower, blades or one of them: blade 1"),
              "tower, blades or a blade", beam);
  if (fields.reads() && fields.given("beam")) {
    load.on_tower = beam == "tower";
    load.blade = find_blade(beam, turbine.blades.count);
    const bool is_known = load.on_tower || beam == "blades" || load.blade != 0;
    if (!is_known && turbine.blades.count == 0)
      fields.refuse("beam", "there are no blades, only a tower");
    else if (!is_known)
      fields.expected("beam", "tower, blades or a blade from 1 to " +
                                  std::to_string(turbine.blades.count) + " (blade 1)");
  }
  declare_loaded_place(fields, load);
  fields.vector({"force", "N or N/m", "components along b1 b2 b3"}, load.force);
  fields.vector({"moment", "N m or N m/m", "the same"}, load.moment);
  fields.at_least_one({"force", "moment"}, "or \"moment\", or both");
  fields.flag({"follower", "whose b1 b2 b3, below"}, load.follower);
  model::LoadVariation& variation = load.variation;
  fields.exclusive({{"harmonic"}, {"table"}});
  fields.block(Field("harmonic", "a factor that oscillates, below").or_else("absent"),
               Presence{[&] { return variation.amplitude != 0.0; },
                        [&] {
                          variation.mean = 0.0;
                          variation.amplitude = 1.0;
                        }},
               [&] {
                 if (fields.describes()) {
                   variation.mean = 0.0;
                   variation.amplitude = 1.0;
                 }
                 declare_frequency(fields, variation.per_rev, variation.frequency);
                 fields.number({"amplitude", "of the factor"}, variation.amplitude);
                 fields.number({"mean", "of the factor"}, variation.mean);
                 fields.number({"phase_deg", deg, ""}, variation.phase);
               });
  fields.pairs(Field("table", "s, 1",
                     "instead of `harmonic`: `[[t, factor], ...]` with rising t, linear between "
                     "the entries; a transient needs it over all of its `duration`, `static` "
                     "takes it at t = 0")
                   .or_else("absent"),
               {"t", "factor"}, variation.table);
}

void declare_loop(Visitor& fields, const Field& field, const Units& units, double* schedule,
                  std::optional<model::ControlLoop>& loop) {
  fields.block(field, loop, [&](model::ControlLoop& gains) {
    fields.number({"proportional", units.proportional, "times the speed error"},
                  gains.proportional);
    fields.number({"integral", units.integral, "times the integral of the speed error"},
                  gains.integral);
    fields.at_least_one({"proportional", "integral"}, "or \"integral\"");
    if (schedule != nullptr)
      fields.number(Field("gain_schedule_deg", deg, positive,
                          "and > -`blades.pitch_deg`: both gains are divided by 1 + "
                          "pitch/gain_schedule, with the pitch that they ask for")
                        .none_at_zero(),
                    *schedule);
  });
}

void declare_controller(Visitor& fields, model::ControllerDefinition& controller) {
  if (fields.reads()) controller.filter = 1.0;  // where it is wrong
  fields.number(Field("speed_filter", "rad/s", positive,
                      "corner frequency of the filter of the measured speed")
                    .required(),
                controller.filter);
  fields.number(
      Field("set_point", "rad/s", non_negative,
            "of the generator. Beside an integral it must be `shaft.speed` times the "
            "gear ratio")
          .or_else("the mean speed"),
      Field("set_point_rpm", rpm, non_negative, "the same, instead of `set_point`").or_else(""),
      controller.set_point);
  declare_loop(fields,
               Field("torque",
                     "torque against the turning of the generator, proportional e + "
                     "integral I, beside `generator.torque` and tables")
                   .or_else("none"),
               {"N m s/rad", "N m/rad"}, nullptr, controller.torque);
  declare_loop(fields,
               Field("pitch",
                     "pitch beside `blades.pitch_deg`, through the "
                     "[actuators](#pitch-actuators) where there are. Needs "
                     "`shaft.rotor.torque_pitch_slope`")
                   .or_else("none"),
               {"s", "1"}, &controller.schedule, controller.pitch);
}

/// The words of the axes b1 b2 b3 of a section or y1 y2 y3 of the nacelle.
using AxisWords = std::array<const char*, 3>;
constexpr AxisWords on_tower{"vertical", "side_side", "fore_aft"};
constexpr AxisWords on_nacelle{"side_side", "fore_aft", "vertical"};
constexpr AxisWords on_blade{"axial", "lead_lag", "flap"};

void declare_damper_axis(Visitor& fields, model::MassDamperAxis& axis) {
  fields.number(Field("stiffness", "N/m", positive, "").required(), axis.stiffness);
  fields.number({"damping", "N s/m", non_negative, ""}, axis.damping);
  fields.block(
      Field("stops", "a second spring and damper beyond a displacement, both ways").or_else("none"),
      Presence{[&] { return axis.stop != 0.0; }, [] {}}, [&] {
        fields.number(Field("displacement", "m", positive, "").required(), axis.stop);
        fields.number(Field("stiffness", "N/m", positive, "").required(), axis.stop_stiffness);
        fields.number({"damping", "N s/m", non_negative, ""}, axis.stop_damping);
      });
}

void declare_damper_axes(Visitor& fields, const AxisWords& words,
                         model::MassDamperDefinition& damper) {
  const auto find = [&damper](std::size_t i) {
    model::MassDamperAxis* found = nullptr;
    for (model::MassDamperAxis& axis : damper.axes)
      if (axis.axis == static_cast<int>(i)) found = &axis;
    return found;
  };
  for (std::size_t i = 0; i < words.size(); ++i)
    fields.block(Field(words[i], "spring and damper along this axis").or_else("absent"),
                 Presence{[&] { return find(i) != nullptr; },
                          [&] {
                            damper.axes.emplace_back();
                            damper.axes.back().axis = static_cast<int>(i);
                          }},
                 [&] {
                   model::MassDamperAxis shown;
                   model::MassDamperAxis* axis = find(i);
                   declare_damper_axis(fields, axis == nullptr ? shown : *axis);
                 });
}

void declare_mass_damper(Visitor& fields, const model::TurbineDefinition& turbine,
                         model::MassDamperDefinition& damper) {
  using Carrier = model::MassDamperDefinition::Carrier;
  const int blades = turbine.blades.count;
  std::string on = damper.carrier == Carrier::nacelle
                       ? "nacelle"
                       : name_beam(damper.carrier == Carrier::tower, damper.blade);
  fields.text(Field("on",
                    "`nacelle`, `tower`, `blades` (one on each) or one of them: `blade 2`. Nacelle "
                    "and tower need a `tower`")
                  .required("nacelle, tower, blades or one of them: blade 1"),
              "nacelle, tower, blades or a blade", on);
  bool is_placed = true;
  if (fields.reads()) {
    damper.carrier = on == "nacelle" ? Carrier::nacelle
                     : on == "tower" ? Carrier::tower
                                     : Carrier::blade;
    damper.blade = find_blade(on, blades);
    is_placed = fields.given("on") && (damper.carrier != Carrier::blade || damper.blade != 0 ||
                                       (on == "blades" && blades > 0));
    if (fields.given("on") && !is_placed)
      fields.expected("on",
                      "nacelle, tower" + (blades == 0 ? std::string()
                                                      : ", blades or a blade from 1 to " +
                                                            std::to_string(blades) + " (blade 1)"));
  }
  fields.number(Field("mass", "kg", positive, "").required(), damper.mass);
  fields.vector({"position", "m",
                 "of the mass where its springs are at rest: from the line, in the section's b1 b2 "
                 "b3, or on the nacelle from the tower top, in y1 y2 y3"},
                damper.position);
  if (!is_placed) {
    fields.accept({"at", "axial", "lead_lag", "flap", "vertical", "side_side", "fore_aft"});
    return;
  }
  if (damper.carrier != Carrier::nacelle || fields.describes())
    fields.number(Field("at", "", beyond_the_root,
                        "place as a fraction of the length of tower or blade; required there, and "
                        "not of a nacelle. The end of an element is moved there, as for [point "
                        "masses](#point-masses)")
                      .required("its place along the beam", !fields.describes()),
                  damper.at);
  if (fields.describes()) {
    declare_damper_axes(fields, on_tower, damper);
    declare_damper_axes(fields, on_blade, damper);
    return;
  }
  const AxisWords& words = damper.carrier == Carrier::nacelle ? on_nacelle
                           : damper.carrier == Carrier::tower ? on_tower
                                                              : on_blade;
  declare_damper_axes(fields, words, damper);
  if (fields.reads() && damper.axes.empty())
    fields.require(words[2], ("or \"" + std::string(words[1]) + "\", \"" + words[0] +
                              "\": spring and damper of an axis")
                                 .c_str());
}

}  // namespace

void declare(Visitor& fields, model::TurbineDefinition& turbine) {
  fields.text({"title", "any text; in quotes where it holds `: ` or ` #`"}, "a text",
              turbine.title);
  fields.number({"gravity", "m/s^2", non_negative, "along -n3"}, turbine.gravity);
  fields.block(Field("tower", "the keys of a [beam](#beams-tower-and-blades)").or_else("absent"),
               turbine.has_tower, [&] { declare_beam(fields, BeamPlace::tower, turbine.tower); });
  fields.block(Field("nacelle", "on the tower, [below](#nacelle)").or_else("absent"),
               turbine.has_nacelle, [&] { declare_nacelle(fields, turbine.nacelle); });
  const auto has_rotor = [&turbine] { return turbine.blades.count > 0; };
  fields.block(Field("shaft", "the drive train, [below](#shaft)").or_else("absent"),
               Presence{has_rotor, [] {}}, [&] { declare_shaft(fields, turbine.shaft); });
  fields.block(Field("hub", "between shaft and blades, [below](#hub)").or_else("absent"),
               Presence{has_rotor, [] {}}, [&] { declare_hub(fields, turbine.hub); });
  if (fields.reads() && turbine.has_tower && !fields.given("blades")) turbine.blades.count = 0;
  fields.block(
      Field("blades", "the blades, [below](#blades); required without `tower`").or_else("absent"),
      Presence{has_rotor, [] {}}, [&] { declare_blades(fields, turbine.blades); });
  fields.at_least_one({"blades", "tower"}, "");
  fields.list(Field("loads", "list of prescribed [loads](#loads) on tower and blades"), "loads", 0,
              turbine.loads,
              [&](model::LoadDefinition& load) { declare_load(fields, turbine, load); });
  fields.list(
      Field("tuned_mass_dampers",
            "list of [masses on springs](#tuned-mass-dampers) on nacelle, tower and "
            "blades"),
      "tuned mass dampers", 0, turbine.mass_dampers,
      [&](model::MassDamperDefinition& damper) { declare_mass_damper(fields, turbine, damper); });
  fields.block(
      Field("controller", "of the generator's speed, [below](#controller)").or_else("none"),
      turbine.controller,
      [&](model::ControllerDefinition& controller) { declare_controller(fields, controller); });
  declare_wind(fields, turbine);
  declare_aero(fields, turbine);
}

}  // namespace samara::fields
