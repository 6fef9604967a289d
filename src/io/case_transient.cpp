#include "case_transient.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

namespace samara::io {
namespace {

/// Of a step: how far from a whole number of steps a time may be.
constexpr double rounding = 1e-6;
constexpr double most_steps = 1e9;

/// Keys of a case that change no model.
constexpr std::array<const char*, 7> other_keys{"samara", "title",     "trim",     "floquet",
                                                "static", "transient", "linearize"};

void read_words(MapReader& map, std::string_view key, std::vector<std::string>& words) {
  const YamlNode* list = map.find(key);
  if (list == nullptr) return;
  if (list->kind != YamlNode::Kind::list || list->children.empty()) {
    map.refuse(*list, key, "expected a list of names, " + describe(*list));
    return;
  }
  for (const YamlNode& entry : list->children) {
    if (entry.kind != YamlNode::Kind::scalar)
      map.refuse(entry, key, "expected a name, " + describe(entry));
    words.push_back(entry.text);
  }
}

/// Reads fractions of a length.
void read_stations(MapReader& map, std::string_view key, std::vector<double>& places) {
  const YamlNode* list = map.find(key);
  if (list == nullptr) return;
  if (list->kind != YamlNode::Kind::list || list->children.empty()) {
    map.refuse(*list, key, "expected a list of fractions of the length, " + describe(*list));
    return;
  }
  places.resize(list->children.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    read_number(list->children[i], join_path(map.where(key), i), fraction_of_one, places[i],
                map.errors());
}

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

void read_output(const YamlNode& node, const std::string& where, TransientCase& transient,
                 ErrorList& errors) {
  MapReader map(node, where, errors);
  read_steps(map, "every", transient.options.step, transient.output_steps);
  read_words(map, "channels", transient.channels);
  read_stations(map, "blade_stations", transient.stations.blade);
  read_stations(map, "tower_stations", transient.stations.tower);
  map.finish();
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

}  // namespace

void read_transient(const YamlNode& node, TransientCase& transient, ErrorList& errors) {
  analysis::TransientOptions& options = transient.options;
  transient.is_given = true;
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
  map.read("start", transient.start,
           {{"trim", TransientOrigin::trim}, {"undeformed", TransientOrigin::undeformed}});
  map.read("method", options.method,
           {{"bdf2", analysis::TransientMethod::bdf2},
            {"midpoint", analysis::TransientMethod::midpoint}});
  map.read("tolerance", options.tolerance, positive);
  options.checkpoint_steps = std::max(1L, std::lround(default_checkpoint / options.step));
  const YamlNode* checkpoint = node.find("checkpoint");
  if (checkpoint != nullptr && checkpoint->text == "none") {
    map.find("checkpoint");
    options.checkpoint_steps = 0;
  } else {
    read_steps(map, "checkpoint", options.step, options.checkpoint_steps);
  }
  if (const YamlNode* entry = map.find("output"))
    read_output(*entry, map.where("output"), transient, errors);
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
