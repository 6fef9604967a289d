#include "samara/simulation/scenario_fields.hpp"

#include <cmath>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/fields/ranges.hpp"

namespace samara::simulation {
namespace {

using fields::deg;
using fields::deg_per_s;
using fields::Field;
using fields::integers;
using fields::non_negative;
using fields::positive;
using fields::Presence;
using fields::Range;
using fields::rpm;
using fields::Visitor;

constexpr int least_steps = 4;
constexpr int most_steps = 10000000;
constexpr int most_load_steps = 100000;
constexpr int most_modes = 10000;
constexpr int most_azimuths = 3600;
constexpr int most_order = 100000;
constexpr int least_growth_steps = 16;
constexpr int most_growth_steps = 100000;
constexpr double most_time_steps = 1e9;
/// How far from a whole number of steps a time may be, of a step.
constexpr double step_round_off = 1e-6;
/// Range of step errors of positions [m, rad].
constexpr Range step_error{"a number from 1e-12 to 0.1", 1e-12, 0.1};
/// Range of relative errors of modes by time steps.
constexpr Range mode_accuracy{"a number from 1e-10 to 0.1", 1e-10, 0.1};

void declare_trim(Visitor& fields, analysis::TrimOptions& trim) {
  fields.choice(Field("method", "how the periodic steady state is found"), trim.method,
                {{"harmonic_balance", analysis::TrimMethod::harmonic_balance},
                 {"shooting", analysis::TrimMethod::shooting}});
  fields.integer({"harmonics", "", integers(0, fields::most_harmonics),
                  "harmonics of the rotor speed, or `auto`: 1, 2, 3, 4, 6, 8, 11 ... 60, until the "
                  "residual between the samples is small enough. For two blades take an even "
                  "number"},
                 trim.harmonics, {{"auto", &trim.automatic}});
  fields.number({"tolerance", "", fields::tolerance, "relative, of the nonlinear solve"},
                trim.tolerance);
  fields.number({"auto_tolerance", "", fields::tolerance,
                 "of `harmonics: auto`: the residual between the samples that is small enough, "
                 "relative to the largest internal load"},
                trim.auto_tolerance);
  fields.integer(
      {"steps", "", integers(least_steps, most_steps), "steps a revolution, of `shooting`"},
      trim.steps);
}

void declare_floquet(Visitor& fields, analysis::FloquetOptions& floquet) {
  fields.integer(
      Field("steps", "", integers(least_steps, most_steps),
            "steps a revolution; rounded up to a multiple of the number of blades where one blade "
            "passage is enough")
          .none_at_zero("as many as the ten slowest modes need, and at least 36"),
      floquet.steps);
  fields.choice(Field("period",
                      "`full`: one revolution; `blade`: one blade passage, for blades "
                      "that are alike; `auto` takes the shorter one where it is right"),
                floquet.period,
                {{"auto", analysis::FloquetPeriod::automatic},
                 {"full", analysis::FloquetPeriod::full},
                 {"blade", analysis::FloquetPeriod::blade}});
  fields.choice(Field("time_order",
                      "order of the time steps: 2 (central differences), 4 or 6 (Gauss collocation "
                      "with 2 or 3 stages)"),
                floquet.order, {{"2", 2}, {"4", 4}, {"6", 6}});
  fields.number({"accuracy", "", mode_accuracy,
                 "largest relative error of a mode by the time steps: a mode whose error is larger "
                 "counts as not resolved. Where `steps` is left out their number is raised until "
                 "the ten slowest modes are below it"},
                floquet.accuracy);
  fields.integer(
      Field("modes", "", integers(1, most_modes),
            "number of modes to report, also by `samara modes`: the slowest ones, or those nearest "
            "to `near_hz`, and other ones that are known to grow. Modes of the air alone are left "
            "out. The output states the range in which they are complete")
          .none_at_zero("all modes"),
      floquet.modes);
  fields.number({"near_hz", "Hz", positive, "frequency next to which `modes` are searched"},
                floquet.near_hz);
  fields.integer(
      Field("least_damped", "", integers(1, most_modes),
            "number of modes that decay slowest, and of those that grow, in a range of frequencies "
            "that the output states; without modes of the air alone")
          .none_at_zero("all modes"),
      floquet.least_damped);
  fields.choice(
      Field(
          "search",
          "the way to `modes` or `least_damped`: `all` computes all modes, and reports those; "
          "`hill` is Hill's method for these alone, for large meshes, where `steps`, `period`, "
          "`time_order` and `accuracy` do not count, and, in the air, slow modes of strong damping "
          "may be left out; `auto` takes the one that is likely to take less time, and in `samara "
          "modes` Hill's method"),
      floquet.search,
      {{"auto", analysis::ModeSearch::automatic},
       {"all", analysis::ModeSearch::all},
       {"hill", analysis::ModeSearch::hill}});
}

void declare_static(Visitor& fields, analysis::StaticOptions& statics) {
  fields.integer({"steps", "", integers(1, most_load_steps),
                  "steps of the load factor from 0 to 1; with `arc_length` 1/steps is the first"},
                 statics.steps);
  fields.choice(
      Field("method",
            "`load`: the factor is prescribed step after step; `arc_length`: it is an unknown, and "
            "the path is followed through limit points, where the load must fall for the "
            "deflection to go on (snap-through), until the factor is 1"),
      statics.method,
      {{"load", analysis::StaticMethod::load}, {"arc_length", analysis::StaticMethod::arc_length}});
  fields.number({"tolerance", "", fields::tolerance,
                 "of the last Newton correction relative to the solution"},
                statics.tolerance);
  fields.integer({"max_steps", "", integers(1, most_steps),
                  "steps of the path, cut ones included, before it is given up"},
                 statics.most_steps);
}

void declare_stations(Visitor& fields, const model::TurbineDefinition& turbine,
                      turbine::ChannelStations& stations) {
  const auto declare = [&fields](const char* key, const char* text, bool has_beam,
                                 const char* missing, std::vector<double>& places) {
    fields.number_list(Field(key, "", fields::fraction_of_one, text).or_else("the Gauss points"),
                       "fractions of the length", places);
    if (!has_beam && !places.empty()) fields.refuse(key, missing);
  };
  declare("blade_stations",
          "fractions of the length: stations 1, 2, ... of section loads and motions",
          turbine.blades.count > 0, "there are no blades; hint: tower_stations", stations.blade);
  declare("tower_stations", "the same of the tower", turbine.has_tower,
          "there is no tower; hint: blade_stations", stations.tower);
}

/// A time that is a whole number of steps.
void declare_step_count(Visitor& fields, const Field& field, double step, double& time,
                        std::initializer_list<fields::Word> words = {}) {
  if (!fields.reads()) {
    fields.number(field, time, words);
    return;
  }
  double given = 0.0;
  fields.number(field, given, words);
  if (given == 0.0 || !(step > 0.0)) return;
  const double count = std::round(given / step);
  if (count < 1.0 || std::abs(given / step - count) > step_round_off) {
    fields.expected(field.key, "a multiple of transient.step (" + general(step, 6) + " s)");
    return;
  }
  time = count * step;
}

/// `table` or `formula` of a quantity in time.
void declare_curve(Visitor& fields, const Field& field, double duration,
                   std::optional<math::TimeCurve>& curve) {
  const bool is_speed = field.key == "speed";
  fields.block(field, Presence{[&] { return curve.has_value(); }, [] {}}, [&] {
    std::vector<math::TimeCurve::Point> points;
    std::string formula;
    fields.exclusive({{"table"}, {"formula"}});
    fields.pairs(
        Field("table", "s, as of the key",
              "`[[t, value], ...]` that reaches over the run: speeds are joined by straight "
              "lines, angles by a curve without kinks or overshoot")
            .or_else(""),
        {"t", "value"}, points);
    fields.text(Field("formula", "of `t`, in the language of muParser").or_else(""), "a formula",
                formula);
    fields.at_least_one({"table", "formula"}, "or \"formula\"");
    if (!fields.reads()) return;
    if (!points.empty()) {
      if (points.front().first > 0.0 || points.back().first < duration || points.size() < 2) {
        fields.refuse("table", "the table reaches from " + general(points.front().first, 6) +
                                   " to " + general(points.back().first, 6) +
                                   " s, the run from 0 to " + general(duration, 6) + " s");
        return;
      }
      for (math::TimeCurve::Point& point : points) point.second = field.unit.to_si(point.second);
      curve = is_speed ? math::TimeCurve::along(points) : math::TimeCurve::through(points);
    } else if (!formula.empty()) {
      try {
        math::TimeCurve::formula(formula);  // whose errors show the user's own words
        const double unit = field.unit.to_si(1.0);
        curve = math::TimeCurve::formula(unit == 1.0 ? formula
                                                     : "(" + formula + ")*" + general(unit, 17));
      } catch (const InputError& error) {
        fields.refuse("formula", error.what());
      }
    }
  });
}

void declare_gust(Visitor& fields, model::GustDefinition& gust) {
  using Type = model::GustDefinition::Type;
  fields.choice(Field("type",
                      "of IEC 61400-1: `eog`, extreme operating gust; `edc`, extreme direction "
                      "change; `ecd`, extreme coherent gust with direction change; `ews_vertical` "
                      "and `ews_horizontal`, extreme wind shear")
                    .required("eog, edc, ecd, ews_vertical or ews_horizontal"),
                gust.type,
                {{"eog", Type::operating},
                 {"edc", Type::direction},
                 {"ecd", Type::coherent},
                 {"ews_vertical", Type::vertical_shear},
                 {"ews_horizontal", Type::horizontal_shear}});
  fields.number({"start", "s", fields::non_negative, ""}, gust.start);
  fields.number({"turbulence", "", positive, "I_ref: 0.16 of class A, 0.14 of B, 0.12 of C"},
                gust.turbulence);
  fields.number(
      {"reference_speed", "m/s", positive, "V_ref: 50 of class I, 42.5 of II, 37.5 of III"},
      gust.reference_speed);
  fields.flag({"negative", "change of direction or shear with the other sign"}, gust.is_negative);
}

void declare_box(Visitor& fields, model::WindChange& wind) {
  fields.exclusive({{"file"}, {"files"}});
  fields.at_least_one({"file", "files"}, "or \"files\"");
  std::string turbsim = wind.box_path.size() == 1 ? wind.box_path[0] : "";
  std::vector<std::string> hawc =
      wind.box_path.size() == 3 ? wind.box_path : std::vector<std::string>();
  fields.text(Field("file", "of TurbSim, NAME.bts: the whole wind").or_else(""),
              "the name of a file", turbsim);
  fields.name_list(Field("files",
                         "`[u, v, w]`, three files of HAWC2: fluctuations, which are added to the "
                         "mean wind, with the centre of the box at `height`")
                       .or_else(""),
                   hawc);
  if (fields.reads()) wind.box_path = hawc;
  if (fields.reads() && !turbsim.empty()) wind.box_path = {turbsim};
  if (fields.reads() && !hawc.empty() && hawc.size() != 3)
    fields.refuse("files", "expected three files: u, v, w");
  if (!fields.describes() && wind.box_path.size() != 3) return;
  model::WindBox& box = wind.box_shape;
  std::array<int, 3> points{box.times, box.columns, box.rows};
  std::array<double, 3> distances{box.step, box.width, box.height};
  double center = box.bottom + 0.5 * box.height * (box.rows - 1);
  fields.integer(Field("times", "", integers(2, 1000000), "planes along the wind, of `files`")
                     .required("the number of planes"),
                 points[0]);
  fields.integer(Field("columns", "", integers(2, 10000), "points across the wind")
                     .required("the number of points"),
                 points[1]);
  fields.integer(
      Field("rows", "", integers(2, 10000), "points up").required("the number of points"),
      points[2]);
  fields.numbers(Field("distances", "m", positive, "`[along the wind, across, up]` of the points")
                     .required("[along the wind, across, up]"),
                 distances, false);
  fields.number(Field("height", "m", positive, "of the centre of the box above the foot")
                    .required("the height of the centre of the box"),
                center);
  fields.numbers({"scale", "", fields::any_number, "factors of u, v and w"}, wind.box_scale, false);
  if (!fields.reads()) return;
  box.times = points[0];
  box.columns = points[1];
  box.rows = points[2];
  box.step = distances[0];
  box.width = distances[1];
  box.height = distances[2];
  box.bottom = center - 0.5 * box.height * (box.rows - 1);
}

void declare_wind_change(Visitor& fields, double duration, model::WindChange& wind) {
  const auto curve = [&](const Field& field, std::optional<math::TimeCurve>& value) {
    declare_curve(fields, field, duration, value);
  };
  curve(Field("speed", "m/s",
              "at `wind.height`: `{table: [[t, value], ...]}`, straight lines that reach over the "
              "run, or `{formula: ...}`")
            .or_else("`wind.speed`"),
        wind.speed);
  curve(Field("direction_deg", deg, "a table is joined by a curve without kinks or overshoot")
            .or_else("`wind.direction_deg`"),
        wind.direction);
  curve(Field("upflow_deg", deg, "the same way").or_else("`wind.upflow_deg`"), wind.upflow);
  curve(Field("power", "", "exponent of the power law").or_else("`wind.shear.power`"),
        wind.exponent);
  curve(Field("left", "", "as of `wind.shear`, whose `length` counts").or_else("`wind.shear.left`"),
        wind.shear_left);
  curve(Field("up", "", "the same").or_else("`wind.shear.up`"), wind.shear_up);
  fields.text(
      Field("table",
            "file of a uniform wind of InflowWind: time, speed, direction, vertical speed, "
            "horizontal shear, power law, linear shear, gust and upflow, joined by straight "
            "lines; the keys above have priority")
          .or_else("none"),
      "the name of a file", wind.table_path);
  fields.block(Field("gust", "of IEC 61400-1, on the mean wind").or_else("none"), wind.standard,
               [&](model::GustDefinition& gust) { declare_gust(fields, gust); });
  fields.block(Field("box", "turbulence").or_else("none"),
               Presence{[&] { return !wind.box_path.empty(); }, [] {}},
               [&] { declare_box(fields, wind); });
}

void declare_trigger(Visitor& fields, double duration, turbine::EventTrigger& trigger) {
  fields.exclusive({{"at"}, {"when"}});
  double time = trigger.time.value_or(0.0);
  fields.number(Field("at", "s", non_negative, "a time before the end").or_else(""), time);
  if (fields.reads() && fields.given("at")) {
    trigger.time = time;
    if (!(time < duration))
      fields.refuse("at", "never comes: transient.duration is " + general(duration, 6) + " s");
  }
  fields.block(Field("when",
                     "a channel of [channels.md](channels.md) beyond a level in its unit; the "
                     "event comes at the first instant at which it is. One that never comes is an "
                     "error at the end of the run, whose result stands")
                   .or_else(""),
               Presence{[&] { return !trigger.time; }, [] {}}, [&] {
                 fields.exclusive({{"above"}, {"below"}});
                 fields.text(Field("channel", "").required("e.g. RotSpeed"), "a channel",
                             trigger.channel);
                 const bool is_above = fields.reads() ? fields.given("above") : trigger.above;
                 trigger.above = is_above;
                 if (is_above || fields.describes() || fields.given("above"))
                   fields.number(Field("above", "of the channel", "").or_else(""), trigger.level);
                 if (!is_above || fields.describes() || fields.given("below"))
                   fields.number(Field("below", "of the channel", "").or_else(""), trigger.level);
                 fields.accept({"above", "below"});
                 fields.at_least_one({"above", "below"}, "or \"below\"");
               });
  fields.at_least_one({"at", "when"}, "a time, or \"when\"");
}

void declare_event(Visitor& fields, double duration, turbine::TurbineEvent& event) {
  declare_trigger(fields, duration, event.trigger);
  fields.flag({"generator_off",
               "the torque of a free generator is gone, and the constant torque that held the mean "
               "speed in the trim (`start: undeformed` has none)"},
              event.generator_off);
  fields.number(Field("brake", "N m", positive,
                      "on a free generator, behind the gear (`gear_ratio` times as much at the "
                      "shaft), against its turning; falls to nothing where the shaft turns by less "
                      "than 0.01 rad/s, so that a rotor under load creeps")
                    .none_at_zero(),
                event.brake);
  fields.block(Field("pitch", "the pitch moves to an angle").or_else("none"), event.pitch,
               [&](turbine::PitchAction& action) {
                 fields.number(Field("to_deg", deg, fields::half_turn, "").required(), action.to);
                 fields.number(Field("rate_deg", deg_per_s, positive,
                                     "the largest rate of half a cosine in time")
                                   .required(),
                               action.rate);
                 fields.integer(
                     Field("blade", "", integers(1, 1000), "one of them alone").none_at_zero("all"),
                     action.blade);
               });
  if (fields.reads() && !event.pitch && !event.generator_off && event.brake == 0.0 &&
      !fields.given("brake"))
    fields.refuse("", "does nothing; expected pitch, generator_off or brake");
}

/// `step`: of the transient.
void declare_library(Visitor& fields, double step, ControllerSetup& controller) {
  const auto declare_text = [&fields](const Field& field, const char* expected, std::string& text) {
    const bool is_given = fields.text(field, expected, text);
    if (is_given && text.empty()) fields.expected(field.key, expected);
  };
  declare_text(Field("library", "shared library with the interface of Bladed, DISCON")
                   .required("the name of a library, NAME.so"),
               "the name of a file", controller.library);
  declare_text(Field("input", "its input file, argument `INFILE`").or_else("none"),
               "the name of a file", controller.input);
  declare_text({"procedure", "name of the procedure in the library"}, "the name of a procedure",
               controller.procedure);
  declare_step_count(
      fields,
      Field("step", "s", positive, "between calls, a multiple of `step` of the transient")
          .none_at_zero("`step` of the transient"),
      step, controller.step);
  fields.number(
      {"timeout", "s", positive, "longest time of a call by the clock; a slower one ends the run"},
      controller.timeout);
  fields.flag({"individual_pitch",
               "each blade follows its own demand, records 42 to 44; else all follow record 45"},
              controller.is_individual);
  fields.number({"pitch_rate_limit_deg", deg_per_s, positive,
                 "largest rate of the pitch without `blades.pitch_actuator`"},
                controller.pitch_rate);
  fields.number({"efficiency", "", fields::beyond_the_root,
                 "of the generator, for the measured electrical power, record 15"},
                controller.efficiency);
}

/// A word, or the name of a result.
void declare_start(Visitor& fields, TransientSetup& transient) {
  std::string start = transient.start == TransientOrigin::trim         ? "trim"
                      : transient.start == TransientOrigin::undeformed ? "undeformed"
                                                                       : transient.start_path;
  const char* expected = "trim, undeformed or the name of a result, RESULT.h5";
  fields.text({"start",
               "`trim`: on the periodic steady state of the case, loads that hold a coordinate "
               "included; `undeformed`: without strain, in the prescribed motion; or a result, "
               "`RESULT.h5`, see below"},
              expected, start);
  if (!fields.reads() || !fields.given("start")) return;
  if (start == "trim") {
    transient.start = TransientOrigin::trim;
  } else if (start == "undeformed") {
    transient.start = TransientOrigin::undeformed;
  } else if (start.ends_with(".h5")) {
    transient.start = TransientOrigin::result;
    transient.start_path = start;
  } else {
    fields.expected("start", expected);
  }
}

void declare_output(Visitor& fields, const model::TurbineDefinition& turbine,
                    TransientSetup& transient) {
  const double step = transient.options.step;
  double every = static_cast<double>(transient.output_steps) * step;
  declare_step_count(
      fields,
      Field("every", "s", positive, "between rows, a multiple of `step`").none_at_zero("`step`"),
      step, every);
  if (fields.reads() && step > 0.0) transient.output_steps = std::lround(every / step);
  fields.name_list(
      Field("channels", "names of [channels.md](channels.md)").or_else("all but those of stations"),
      transient.channels);
  declare_stations(fields, turbine, transient.stations);
  fields.flag({"places", "adds the places of the turbine's nodes, for animations"},
              transient.has_places);
}

void declare_transient(Visitor& fields, const model::TurbineDefinition& turbine,
                       TransientSetup& transient) {
  analysis::TransientOptions& options = transient.options;
  fields.number(Field("duration", "s", positive, "from t = 0; rounded up to whole steps")
                    .required("the time to compute [s]"),
                options.duration);
  fields.number(Field("step", "s", positive, "").required("the time step [s]"), options.step);
  if (fields.reads() && options.duration > 0.0 && options.step > 0.0) {
    const std::string duration = general(options.duration, 6) + " s";
    if (options.step > options.duration)
      fields.refuse("step", "longer than transient.duration (" + duration + ")");
    else if (options.duration / options.step > most_time_steps)
      fields.refuse("step", "transient.duration (" + duration + ") has more than " +
                                general(most_time_steps, 6) + " of it");
  }
  declare_start(fields, transient);
  fields.choice(Field("method",
                      "`bdf2`, or `midpoint`, which damps nothing, costs more and whose "
                      "rows are in the middle of the steps"),
                options.method,
                {{"bdf2", analysis::TransientMethod::bdf2},
                 {"midpoint", analysis::TransientMethod::midpoint}});
  fields.number(
      {"tolerance", "", fields::tolerance, "error of Newton's iteration, relative to the state"},
      options.tolerance);
  fields.number(Field("step_tolerance", "m, rad", step_error,
                      "of the error of a step in the positions, absolute and relative: steps "
                      "between rows become as short as that asks for, and no longer than `step`. "
                      "Internal loads do not count, nor do velocities")
                    .none_at_zero("all steps alike"),
                options.step_tolerance);
  bool has_none = false;
  double checkpoint = transient.checkpoint;
  declare_step_count(
      fields,
      Field("checkpoint", "s", positive, "between restart points, a multiple of `step`; or `none`")
          .none_at_zero("60, rounded to steps"),
      options.step, checkpoint, {{"none", &has_none}});
  if (fields.reads()) transient.checkpoint = has_none ? 0.0 : checkpoint;
  declare_curve(fields,
                Field("speed", "rad/s",
                      "of the shaft at a locked generator: `{table: [[t, value], ...]}`, straight "
                      "lines that reach over the run, or `{formula: ...}`")
                    .or_else("`shaft.speed`"),
                options.duration, transient.speed);
  declare_curve(fields,
                Field("pitch_deg", deg,
                      "of all blades, the same way; a table is joined by a curve without kinks or "
                      "overshoot")
                    .or_else("`blades.pitch_deg`"),
                options.duration, transient.pitch);
  const char* prescribed = "of a `joint: prescribed`, the same way";
  declare_curve(fields, Field("yaw_deg", deg, prescribed).or_else(""), options.duration,
                transient.yaw);
  declare_curve(fields, Field("teeter_deg", deg, prescribed).or_else(""), options.duration,
                transient.teeter);
  fields.block(Field("wind", "a wind that changes with time, [below](#wind-in-time)")
                   .or_else("`wind` of the case"),
               transient.wind, [&](model::WindChange& wind) {
                 declare_wind_change(fields, options.duration, wind);
               });
  fields.list(
      Field("events", "a list, see below"), "events", 1, transient.events,
      [&](turbine::TurbineEvent& event) { declare_event(fields, options.duration, event); });
  fields.block(Field("controller",
                     "library of a controller that sets pitch and torque, "
                     "[below](#controller-libraries)")
                   .or_else("none"),
               transient.controller, [&](ControllerSetup& controller) {
                 declare_library(fields, options.step, controller);
               });
  fields.block({"output", "channels and rows of the time series"},
               [&] { declare_output(fields, turbine, transient); });
}

void declare_forms(Visitor& fields, linear::LinearizeOptions& options) {
  const std::array<std::pair<const char*, bool*>, 6> known{
      {{"descriptor", &options.descriptor},
       {"state_space", &options.state_space},
       {"multiblade", &options.multiblade},
       {"average", &options.average},
       {"hill", &options.hill},
       {"lyapunov_floquet", &options.lyapunov_floquet}}};
  std::vector<std::string> forms;
  if (!fields.reads())
    for (const auto& [word, is_asked_for] : known)
      if (*is_asked_for) forms.emplace_back(word);
  fields.name_list(
      {"forms",
       "forms to write: `state_space`; `descriptor` (all unknowns); `multiblade` (three and more "
       "blades); `average` (mean over the azimuth, in multiblade coordinates where `multiblade` is "
       "there too); `hill` (constant, by harmonic lifting); `lyapunov_floquet` (A constant, B and "
       "C "
       "periodic, and `lyapunov_floquet_map` between its coordinates and the states)"},
      forms);
  if (!fields.reads() || forms.empty()) return;
  options.state_space = false;
  for (const std::string& form : forms) {
    bool is_known = false;
    for (const auto& [word, is_asked_for] : known) {
      if (form != word) continue;
      *is_asked_for = is_known = true;
    }
    if (!is_known)
      fields.refuse("forms",
                    "expected descriptor, state_space, multiblade, average, hill or "
                    "lyapunov_floquet, got \"" +
                        form + "\"");
  }
}

void declare_linearize(Visitor& fields, const model::TurbineDefinition& turbine,
                       LinearizeSetup& linearize) {
  linear::LinearizeOptions& options = linearize.options;
  linear::SeriesResolution& series = options.series;
  fields.integer({"azimuths", "", integers(1, most_azimuths),
                  "azimuths, equally spaced, from which the series are made, or `auto`: 12, 24, 48 "
                  "... 768, until the residual of the series midway between them is small enough; "
                  "a parked rotor has one"},
                 series.azimuths, {{"auto", &series.automatic_azimuths}});
  fields.integer({"harmonics", "", integers(0, fields::most_harmonics),
                  "of the series in the azimuth, at most (azimuths - 1)/2, or `auto`: all that are "
                  "not small. The table shows the residual of the series"},
                 series.harmonics, {{"auto", &series.automatic_harmonics}});
  fields.number({"auto_tolerance", "", fields::tolerance,
                 "of `azimuths: auto` and `harmonics: auto`: the residual that is small enough, "
                 "relative to the largest entries of row and column"},
                series.tolerance);
  if (!series.automatic_azimuths && !series.automatic_harmonics &&
      2 * series.harmonics + 1 > series.azimuths)
    fields.refuse("harmonics", "need at least " + std::to_string(2 * series.harmonics + 1) +
                                   " linearize.azimuths, there are " +
                                   std::to_string(series.azimuths));
  fields.name_list(Field("inputs", "names of the table below").or_else("all"), linearize.inputs);
  fields.name_list(Field("outputs", "[channels](channels.md) in their units")
                       .or_else("all but those of stations"),
                   linearize.outputs);
  declare_stations(fields, turbine, linearize.stations);
  declare_forms(fields, options);
  fields.integer({"hill_harmonics", "", integers(1, fields::most_harmonics), "of `hill`"},
                 options.hill_harmonics);
  fields.integer(
      Field("lyapunov_floquet_states", "", integers(1, most_order),
            "states of the slowest modes, two for each that oscillates; the others answer by "
            "their static part")
          .none_at_zero("all that are resolved"),
      options.lyapunov_floquet_states);
  fields.integer(
      {"lyapunov_floquet_steps", "", integers(least_growth_steps, most_growth_steps),
       "steps a revolution: more for P and Q of fast or stiff turbines, half of them tell the "
       "error"},
      options.lyapunov_floquet_steps);
  fields.number_list(Field("at_deg", deg,
                           "azimuths at which the matrices themselves are written, beside their "
                           "series: `[0, 22.5, 90]`")
                         .or_else("those"),
                     "numbers", options.at);
  fields.block(Field("reduce",
                     "constant forms with fewer states, as `FORM_reduced`; neutral and "
                     "unstable modes are "
                     "kept. A turbine whose matrices do not change with the azimuth has one of "
                     "`state_space`; else of `average` and `hill`")
                   .or_else("absent"),
               Presence{[&] { return options.order > 0; }, [] {}}, [&] {
                 fields.integer(Field("order", "", integers(1, most_order), "number of states")
                                    .required("the number of states")
                                    .none_at_zero(""),
                                options.order);
                 fields.choice(Field("method", "balanced truncation, or the slowest modes"),
                               options.reduction,
                               {{"balanced", linear::ReductionMethod::balanced},
                                {"modal", linear::ReductionMethod::modal}});
               });
  const bool has_name =
      fields.text(Field("mat",
                        "name of a MAT-file (level 5: MATLAB, Octave, `scipy.io.loadmat`) with "
                        "the same matrices")
                      .or_else("absent"),
                  "the name of a file", linearize.mat_path);
  if (has_name && linearize.mat_path.empty()) fields.expected("mat", "the name of a file");
}

}  // namespace

void declare(fields::Visitor& fields, Scenario& scenario) {
  fields::declare(fields, scenario.turbine);
  fields.block({"trim", "options of the steady state, [below](#trim)"},
               [&] { declare_trim(fields, scenario.trim); });
  fields.block({"floquet", "options of the stability, [below](#floquet)"},
               [&] { declare_floquet(fields, scenario.floquet); });
  fields.block({"static", "options of the state at rest, [below](#static)"},
               [&] { declare_static(fields, scenario.statics); });
  TransientSetup& transient = scenario.transient;
  fields.block(Field("transient", "the simulation in time, [below](#transient)").or_else("none"),
               Presence{[&] { return transient.options.duration != 0.0; }, [] {}},
               [&] { declare_transient(fields, scenario.turbine, transient); });
  fields.block({"linearize", "options of the linear model, [below](#linearize)"},
               [&] { declare_linearize(fields, scenario.turbine, scenario.linearize); });
  fields::declare_operating_points(fields, scenario.operation);
}

std::vector<Fault> find_range_faults(const Scenario& scenario) {
  Scenario shown = scenario;
  return fields::find_range_faults([&](Visitor& fields) { declare(fields, shown); });
}

}  // namespace samara::simulation
