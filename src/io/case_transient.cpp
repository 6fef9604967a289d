#include "case_transient.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "samara/base/error.hpp"

#include "case_stations.hpp"
#include "yaml_lists.hpp"

namespace samara::io {
namespace {

/// Of a step: how far from a whole number of steps a time may be.
constexpr double rounding = 1e-6;
constexpr double most_steps = 1e9;
/// Of positions [m, rad].
constexpr NumberRule step_error{"a number from 1e-12 to 0.1", 1e-12, 0.1};

/// Keys of a case that change no model.
constexpr std::array<const char*, 7> other_keys{"samara", "title",     "trim",     "floquet",
                                                "static", "transient", "linearize"};

/// Reads a time that is some steps long.
void read_steps(MapReader& map, std::string_view key, double step, long& steps) {
  double time = 0.0;
  if (!map.read(key, time, positive) || !(step > 0.0)) return;
  const double count = std::round(time / step);
  if (count < 1.0 || std::abs(time / step - count) > rounding) {
    std::ostringstream text;
    text << "expected a multiple of transient.step (" << step << " s), "
         << describe(*map.node().find(key));
    map.refuse(*map.node().find(key), key, text.str());
    return;
  }
  steps = static_cast<long>(count);
}

void read_output(const YamlNode& node, const std::string& where,
                 const model::TurbineDefinition& turbine, simulation::TransientSetup& transient,
                 ErrorList& errors) {
  MapReader map(node, where, errors);
  read_steps(map, "every", transient.options.step, transient.output_steps);
  read_words(map, "channels", transient.channels);
  read_stations(map, turbine, transient.stations);
  map.finish();
}

/// Reads `table` or `formula` of a quantity in time; what is read is times `unit`.
void read_curve(MapReader& block, std::string_view key, double unit, bool is_speed, double duration,
                std::optional<math::TimeCurve>& curve) {
  const YamlNode* node = block.find(key);
  if (node == nullptr) return;
  MapReader map(*node, block.where(key), block.errors());
  const YamlNode* table = map.find("table");
  const YamlNode* formula = map.find("formula");
  if (table == nullptr && formula == nullptr) map.require("table", "or \"formula\"");
  if (table != nullptr && formula != nullptr)
    map.refuse(*formula, "formula", "given together with table; leave one of them out");
  const std::size_t errors_before = map.errors().size();
  if (table != nullptr) {
    std::vector<math::TimeCurve::Point> points;
    read_pairs(map, "table", *table, {"t", "value"}, points);
    if (map.errors().size() == errors_before &&
        (points.front().first > 0.0 || points.back().first < duration || points.size() < 2)) {
      std::ostringstream text;
      text << "the table reaches from " << points.front().first << " to " << points.back().first
           << " s, the run from 0 to " << duration << " s";
      map.refuse(*table, "table", text.str());
    }
    for (math::TimeCurve::Point& point : points) point.second *= unit;
    if (map.errors().size() == errors_before)
      curve = is_speed ? math::TimeCurve::along(points) : math::TimeCurve::through(points);
  } else if (formula != nullptr) {
    try {
      std::ostringstream scaled;
      scaled.precision(17);
      scaled << "(" << formula->text << ")*" << unit;
      math::TimeCurve::formula(formula->text);  // whose errors show the user's own words
      curve = math::TimeCurve::formula(scaled.str());
    } catch (const InputError& error) {
      map.refuse(*formula, "formula", error.what());
    }
  }
  map.finish();
}

void read_trigger(MapReader& map, double duration, turbine::EventTrigger& trigger) {
  const YamlNode* at = map.find("at");
  const YamlNode* when = map.find("when");
  if (at == nullptr && when == nullptr) map.require("at", "a time, or \"when\"");
  if (at != nullptr && when != nullptr)
    map.refuse(*when, "when", "given together with at; leave one of them out");
  double time = 0.0;
  if (at != nullptr && map.read("at", time, non_negative)) {
    trigger.time = time;
    if (!(time < duration)) {
      std::ostringstream text;
      text << "never comes: transient.duration is " << duration << " s";
      map.refuse(*at, "at", text.str());
    }
  }
  if (when == nullptr) return;
  MapReader condition(*when, map.where("when"), map.errors());
  if (const YamlNode* channel = condition.require("channel", "e.g. RotSpeed"))
    trigger.channel = channel->text;
  const YamlNode* above = condition.find("above");
  const YamlNode* below = condition.find("below");
  if ((above == nullptr) == (below == nullptr))
    condition.refuse(*when, "", "expected one of above and below");
  trigger.above = above != nullptr;
  condition.read(trigger.above ? "above" : "below", trigger.level, any_number);
  condition.finish();
}

void read_event(const YamlNode& node, const std::string& where, double duration,
                turbine::TurbineEvent& event, ErrorList& errors) {
  MapReader map(node, where, errors);
  read_trigger(map, duration, event.trigger);
  if (const YamlNode* entry = map.find("pitch")) {
    turbine::PitchAction& action = event.pitch.emplace();
    MapReader pitch(*entry, map.where("pitch"), errors);
    for (const char* key : {"to_deg", "rate_deg"}) pitch.require(key);
    read_angle(pitch, "to_deg", action.to, half_turn);
    read_angle(pitch, "rate_deg", action.rate, positive);
    pitch.read("blade", action.blade, 1, 1000);
    pitch.finish();
  }
  map.read("generator_off", event.generator_off, {{"true", true}, {"false", false}});
  map.read("brake", event.brake, positive);
  if (!event.pitch && !event.generator_off && event.brake == 0.0 && errors.size() == 0)
    map.refuse(node, "", "does nothing; expected pitch, generator_off or brake");
  map.finish();
}

void read_events(MapReader& map, double duration, std::vector<turbine::TurbineEvent>& events) {
  const YamlNode* list = map.find("events");
  if (list == nullptr) return;
  if (list->kind != YamlNode::Kind::list || list->children.empty()) {
    map.refuse(*list, "events",
               "expected a list of events (each starts with \"- \"), " + describe(*list));
    return;
  }
  for (std::size_t i = 0; i < list->children.size(); ++i)
    read_event(list->children[i], join_path(map.where("events"), i), duration,
               events.emplace_back(), map.errors());
}

/// One spelling of every number.
std::string canonical(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::scalar || node.quoted) return node.text;
  std::istringstream stream(node.text);
  double value = 0.0;
  if (!(stream >> value) || !stream.eof()) return node.text;
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

void add_lines(const YamlNode& node, const std::string& where,
               std::map<std::string, std::string>& lines) {
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const YamlNode& child = node.children[i];
    const std::string place =
        node.kind == YamlNode::Kind::list ? join_path(where, i) : join_path(where, child.key);
    add_lines(child, place, lines);
  }
  if (node.children.empty()) lines[where] = canonical(node);
}

/// A word, or the name of a result.
void read_start(MapReader& map, simulation::TransientSetup& transient) {
  const YamlNode* start = map.node().find("start");
  if (start != nullptr && start->kind == YamlNode::Kind::scalar && start->text.ends_with(".h5")) {
    map.find("start");
    transient.start = simulation::TransientOrigin::result;
    transient.start_path = start->text;
    return;
  }
  if (start != nullptr && start->text != "trim" && start->text != "undeformed") {
    map.find("start");
    map.refuse(*start, "start",
               "expected trim, undeformed or the name of a result, RESULT.h5, " + describe(*start));
    return;
  }
  map.read("start", transient.start,
           {{"trim", simulation::TransientOrigin::trim},
            {"undeformed", simulation::TransientOrigin::undeformed}});
}

}  // namespace

void read_transient(const YamlNode& node, const model::TurbineDefinition& turbine,
                    simulation::TransientSetup& transient, ErrorList& errors) {
  analysis::TransientOptions& options = transient.options;
  MapReader map(node, "transient", errors);
  map.require("duration", "the time to compute [s]");
  map.require("step", "the time step [s]");
  const bool has_duration = map.read("duration", options.duration, positive);
  const bool has_step = map.read("step", options.step, positive);
  if (has_duration && has_step) {
    std::ostringstream text;
    if (options.step > options.duration)
      text << "longer than transient.duration (" << options.duration << " s)";
    else if (options.duration / options.step > most_steps)
      text << "transient.duration (" << options.duration << " s) has more than " << most_steps
           << " of it";
    if (!text.str().empty()) map.refuse(*node.find("step"), "step", text.str());
  }
  read_start(map, transient);
  map.read("method", options.method,
           {{"bdf2", analysis::TransientMethod::bdf2},
            {"midpoint", analysis::TransientMethod::midpoint}});
  map.read("tolerance", options.tolerance, tolerance);
  map.read("step_tolerance", options.step_tolerance, step_error);
  const YamlNode* checkpoint = node.find("checkpoint");
  if (checkpoint != nullptr && checkpoint->text == "none") {
    map.find("checkpoint");
    transient.checkpoint = 0.0;
  } else {
    long steps = 0;
    read_steps(map, "checkpoint", options.step, steps);
    if (steps > 0) transient.checkpoint = static_cast<double>(steps) * options.step;
  }
  constexpr double degree = std::numbers::pi / 180.0;
  read_curve(map, "speed", 1.0, true, options.duration, transient.speed);
  read_curve(map, "pitch_deg", degree, false, options.duration, transient.pitch);
  read_curve(map, "yaw_deg", degree, false, options.duration, transient.yaw);
  read_curve(map, "teeter_deg", degree, false, options.duration, transient.teeter);
  read_events(map, options.duration, transient.events);
  if (const YamlNode* entry = map.find("output"))
    read_output(*entry, map.where("output"), turbine, transient, errors);
  map.finish();
}

std::string model_text_of(const YamlNode& root) {
  std::map<std::string, std::string> lines;
  for (const YamlNode& child : root.children) {
    const bool is_other = std::any_of(other_keys.begin(), other_keys.end(),
                                      [&child](const char* key) { return child.key == key; });
    if (!is_other) add_lines(child, child.key, lines);
  }
  std::string text;
  for (const auto& [key, value] : lines) text.append(key).append(": ").append(value).append("\n");
  return text;
}

}  // namespace samara::io
