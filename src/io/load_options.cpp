#include <limits>

#include "samara/io/load_result.hpp"

#include "yaml_lists.hpp"
#include "yaml_settings.hpp"

namespace samara::io {
namespace {

constexpr int most_harmonics = 200;
constexpr int most_bins = 10000;
constexpr int most_azimuths = 100000;
constexpr Range woehler{"a number >= 1", 1.0};

/// Reads `bins: 20`, or `bins: [20, 5]` of ranges and means.
void read_bins(MapReader& map, loads::LoadEvaluationOptions& options) {
  const YamlNode* node = map.find("bins");
  if (node == nullptr) return;
  if (node->kind != YamlNode::Kind::list) {
    if (map.read("bins", options.range_bins, 1, most_bins)) options.mean_bins = options.range_bins;
    return;
  }
  YamlNode pair;
  pair.kind = YamlNode::Kind::map;
  pair.children = node->children;
  if (pair.children.size() != 2) {
    map.refuse(
        *node, "bins",
        "expected the numbers of bins of ranges and means, e.g. [20, 5], " + describe(*node));
    return;
  }
  pair.children[0].key = "ranges";
  pair.children[1].key = "means";
  MapReader bins(pair, map.where("bins"), map.errors());
  bins.read("ranges", options.range_bins, 1, most_bins);
  bins.read("means", options.mean_bins, 1, most_bins);
}

void read_goodman(const YamlNode& node, const std::string& where, LoadOptions& options,
                  ErrorList& errors) {
  if (node.kind != YamlNode::Kind::map) {
    errors.add(node.place, where,
               "expected channels, e.g. {RootMyb1: {ultimate_load: 2e4}}, " + describe(node));
    return;
  }
  for (const YamlNode& entry : node.children) {
    MapReader map(entry, join_path(where, entry.key), errors);
    loads::GoodmanCorrection& correction = options.goodman[entry.key];
    map.require("ultimate_load", "in the unit of the channel");
    map.read("ultimate_load", correction.ultimate_load, fields::positive);
    map.read("fixed_mean", correction.fixed_mean, fields::any_number);
    map.finish();
  }
}

void read_optional(MapReader& map, std::string_view key, const Range& range,
                   std::optional<double>& value) {
  double number = 0.0;
  if (map.read(key, number, range)) value = number;
}

}  // namespace

LoadOptions read_load_options(const std::vector<std::string>& settings) {
  LoadOptions options;
  ErrorList errors("--set", settings);
  YamlNode root;
  root.kind = YamlNode::Kind::map;
  apply_settings(settings, root, errors);
  MapReader map(root, "", errors);
  read_words(map, "channels", options.channels);
  read_optional(map, "from", fields::any_number, options.from);
  read_optional(map, "until", fields::any_number, options.until);
  if (options.from && options.until && !(*options.from < *options.until))
    map.refuse(*root.find("until"), "until",
               "expected more than from, " + describe(*root.find("until")));
  map.read("azimuths", options.azimuths, 2, most_azimuths);
  read_numbers(map, "exponents", woehler, options.evaluation.exponents);
  map.read("equivalent_frequency", options.evaluation.frequency, fields::positive);
  options.evaluation.harmonics_are_asked_for =
      map.read("harmonics", options.evaluation.harmonics, 0, most_harmonics);
  read_bins(map, options.evaluation);
  if (const YamlNode* entry = map.find("goodman")) read_goodman(*entry, "goodman", options, errors);
  read_numbers(map, "hours", fields::non_negative, options.hours);
  read_optional(map, "equivalent_cycles", fields::positive, options.equivalent_cycles);
  if (options.equivalent_cycles && options.hours.empty())
    map.refuse(*root.find("equivalent_cycles"), "equivalent_cycles",
               "is of a lifetime; hint: hours=[...], one number a result, makes one");
  map.finish();
  errors.throw_if_any();
  return options;
}

}  // namespace samara::io
