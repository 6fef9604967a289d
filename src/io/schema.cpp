#include "samara/io/schema.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include "samara/fields/description.hpp"
#include "samara/io/load_result.hpp"
#include "samara/simulation/scenario_fields.hpp"

#include "case_version.hpp"

namespace samara::io {
namespace {

using fields::Field;
using fields::Range;
using Json = nlohmann::ordered_json;

Json number_schema(const Range& range) {
  Json schema{{"type", "number"}};
  // The smallest number above 0 stands for the open limit 0.
  const bool is_above_zero = range.low == std::numeric_limits<double>::min();
  if (std::isfinite(range.low))
    schema[range.open || is_above_zero ? "exclusiveMinimum" : "minimum"] =
        is_above_zero ? 0.0 : range.low;
  if (std::isfinite(range.high)) schema[range.open ? "exclusiveMaximum" : "maximum"] = range.high;
  return schema;
}

Json integer_schema(const Range& range) {
  return {{"type", "integer"},
          {"minimum", static_cast<long>(range.low)},
          {"maximum", static_cast<long>(range.high)}};
}

Json list_schema(Json items, std::size_t least, std::size_t most) {
  Json schema{{"type", "array"}, {"items", std::move(items)}, {"minItems", least}};
  if (most > 0) schema["maxItems"] = most;
  return schema;
}

Json either(Json one, Json other) {
  return {{"anyOf", Json::array({std::move(one), std::move(other)})}};
}

Json with_words(Json schema, std::span<const fields::Word> words) {
  if (words.empty()) return schema;
  Json texts = Json::array();
  for (const fields::Word& word : words) texts.push_back(word.text);
  return either(std::move(schema), {{"enum", std::move(texts)}});
}

/// A word as YAML reads it: true, 2, or itself.
Json value_of(const std::string& word) {
  if (word == "true" || word == "false") return word == "true";
  int number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error == std::errc() && end == word.data() + word.size()) return number;
  return word;
}

/// Whole numbers have no decimal point.
Json value_of(double value) {
  constexpr double largest_exact = 1e15;
  if (value == std::round(value) && std::abs(value) < largest_exact)
    return static_cast<long>(value);
  return value;
}

class SchemaWriter : public fields::Description {
 public:
  Json take() { return take_mapping(); }

  void number(const Field& field, double& value, std::span<const fields::Word> words) override {
    const bool is_word =
        std::ranges::any_of(words, [](const auto& word) { return *word.is_given; });
    Json schema = with_words(number_schema(field.range), words);
    if (is_word)
      schema["default"] =
          std::ranges::find_if(words, [](const auto& word) { return *word.is_given; })->text;
    else if (std::isfinite(value))
      schema["default"] = value_of(field.unit.from_si(value));
    add(field, std::move(schema));
  }

  void integer(const Field& field, int& value, std::span<const fields::Word> words) override {
    Json schema = with_words(integer_schema(field.range), words);
    schema["default"] = value;
    add(field, std::move(schema));
  }

  void integers(const Field& field, std::span<int> values) override {
    const Json one = integer_schema(field.range);
    Json schema = either(one, list_schema(one, values.size(), values.size()));
    schema["default"] = values[0];
    add(field, std::move(schema));
  }

  void numbers(const Field& field, std::span<double> values, bool spread,
               std::span<const fields::Word> words) override {
    Json schema =
        with_words(list_schema(number_schema(field.range), values.size(), values.size()), words);
    if (spread) schema = either(number_schema(field.range), std::move(schema));
    Json fallback = Json::array();
    for (const double value : values) fallback.push_back(value_of(field.unit.from_si(value)));
    const bool is_uniform =
        std::ranges::all_of(fallback, [&](const Json& one) { return one == fallback[0]; });
    schema["default"] = spread && is_uniform ? fallback[0] : fallback;
    for (const fields::Word& word : words)
      if (*word.is_given) schema["default"] = word.text;
    add(field, std::move(schema));
  }

  void number_list(const Field& field, const char*, std::vector<double>& values) override {
    Json schema = list_schema(number_schema(field.range), 1, 0);
    for (const double value : values)
      schema["default"].push_back(value_of(field.unit.from_si(value)));
    add(field, std::move(schema));
  }

  void name_list(const Field& field, std::vector<std::string>& names) override {
    Json schema = list_schema({{"type", "string"}}, 1, 0);
    if (!names.empty()) schema["default"] = names;
    add(field, std::move(schema));
  }

  void pairs(const Field& field, const std::array<const char*, 2>&,
             std::vector<std::pair<double, double>>&) override {
    add(field, list_schema(list_schema({{"type", "number"}}, 2, 2), 1, 0));
  }

  void table(const Field& field, std::span<const fields::Column> columns) override {
    add(field,
        list_schema(list_schema({{"type", "number"}}, columns.size(), columns.size()), 1, 0));
  }

  bool text(const Field& field, const char*, std::string& value) override {
    Json schema{{"type", Json::array({"string", "number", "boolean"})}};
    if (!value.empty()) schema["default"] = value;
    add(field, std::move(schema));
    return false;
  }

  bool choice(const Field& field, std::span<const char* const> words, std::size_t& place) override {
    Json values = Json::array();
    for (const char* word : words) values.push_back(value_of(std::string(word)));
    Json schema{{"enum", values}};
    if (place < values.size()) schema["default"] = values[place];
    add(field, std::move(schema));
    return false;
  }

  void matrix(const Field& field, Matrix6&, std::array<bool, 6>* rigid) override {
    Json entry{{"type", "number"}};
    if (rigid != nullptr) entry = either(std::move(entry), {{"enum", {"rigid"}}});
    add(field, list_schema(list_schema(std::move(entry), 6, 6), 6, 6));
  }

  void points(const Field& field, const Matrix3&, std::vector<Vector3>&) override {
    add(field, list_schema(list_schema({{"type", "number"}}, 3, 3), 2, 0));
  }

  void block(const Field& field, const fields::Presence&,
             const std::function<void()>& inside) override {
    add(field, describe(inside));
  }

  void list(const Field& field, const fields::Items& items) override {
    add(field, list_schema(describe([&] { items.declare(items.size()); }), items.least, 0));
  }

  void numbered(const Field& field, const fields::Numbered& entries) override {
    add(field, {{"type", "object"},
                {"patternProperties", {{"^[1-9][0-9]*$", describe([&] { entries.declare(1); })}}},
                {"additionalProperties", false}});
  }

  void named(const Field& field, const fields::Named& entries) override {
    add(field,
        {{"type", "object"}, {"additionalProperties", describe([&] { entries.declare(""); })}});
  }

  void two_ways(const Field& field, const char*, const std::function<void()>& plain,
                const std::function<void()>& mapping) override {
    plain();
    const Json first = properties_[std::string(field.key)];
    mapping();
    Json& both = properties_[std::string(field.key)];
    Json schema = either(first, both);
    for (Json& way : schema["anyOf"])
      for (const char* word : {"description", "default", "x-unit", "x-range", "x-default"})
        way.erase(word);
    for (const char* word : {"description", "default", "x-unit", "x-range", "x-default"})
      if (first.contains(word)) schema[word] = first[word];
    both = std::move(schema);
  }

  void exclusive(std::initializer_list<Keys> groups) override {
    std::vector<std::vector<std::string>> all;
    for (const Keys& group : groups) all.emplace_back(group.begin(), group.end());
    exclusive_.push_back(std::move(all));
  }

  void at_least_one(Keys keys, const char*) override {
    needed_.emplace_back(keys.begin(), keys.end());
  }

 private:
  void add(const Field& field, Json schema) {
    const std::string key(field.key);
    schema["description"] = field.text;
    if (*field.unit.name != '\0') schema["x-unit"] = field.unit.name;
    schema["x-range"] = field.range.words;
    if (field.has_fallback) {
      schema.erase("default");
      schema["x-default"] = field.fallback;
    }
    if (field.is_compulsory) {
      schema.erase("default");
      required_.push_back(key);
    }
    properties_[key] = std::move(schema);
  }

  Json describe(const std::function<void()>& inside) {
    SchemaWriter outer = std::exchange(*this, SchemaWriter());
    inside();
    Json mapping = take_mapping();
    *this = std::move(outer);
    return mapping;
  }

  Json take_mapping() {
    Json mapping{{"type", "object"}, {"additionalProperties", false}};
    Json rules = Json::array();
    for (const auto& groups : exclusive_) add_exclusive(groups, rules);
    for (const auto& keys : needed_) {
      Json ways = Json::array();
      for (const std::string& key : keys) ways.push_back({{"required", {key}}});
      rules.push_back({{"anyOf", std::move(ways)}});
    }
    if (!required_.empty()) mapping["required"] = required_;
    mapping["properties"] = std::move(properties_);
    if (!rules.empty()) mapping["allOf"] = std::move(rules);
    *this = SchemaWriter();
    return mapping;
  }

  /// Allows at most one of the groups; exactly one if keys of a group are compulsory.
  void add_exclusive(const std::vector<std::vector<std::string>>& groups, Json& rules) {
    Json ways = Json::array();
    bool is_needed = false;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      std::vector<std::string> compulsory;
      for (const std::string& key : groups[i])
        if (std::erase(required_, key) > 0) compulsory.push_back(key);
      is_needed |= !compulsory.empty();
      if (compulsory.empty()) compulsory.push_back(groups[i][0]);
      ways.push_back({{"required", compulsory}});
      for (const std::string& key : groups[i])
        for (std::size_t j = i + 1; j < groups.size(); ++j)
          for (const std::string& other : groups[j])
            rules.push_back({{"not", {{"required", {key, other}}}}});
    }
    if (is_needed) rules.push_back({{"anyOf", std::move(ways)}});
  }

  Json properties_ = Json::object();
  std::vector<std::string> required_;
  std::vector<std::vector<std::vector<std::string>>> exclusive_;
  std::vector<std::vector<std::string>> needed_;
};

/// The entry of a schema for the next word of a path, in any of the forms that a value may have;
/// null: there is none.
const Json* find_entry(const Json& schema, const std::string& word) {
  const bool is_number = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isdigit(c) != 0;
  });
  if (const auto properties = schema.find("properties");
      properties != schema.end() && properties->contains(word))
    return &(*properties)[word];
  if (is_number && schema.contains("items") && schema["items"].is_object()) return &schema["items"];
  for (const char* others : {"patternProperties", "additionalProperties"})
    if (const auto found = schema.find(others);
        found != schema.end() && found->is_object() && !found->empty())
      return others[0] == 'p' ? &found->front() : &*found;
  if (const auto ways = schema.find("anyOf"); ways != schema.end())
    for (const Json& way : *ways)
      if (const Json* entry = find_entry(way, word)) return entry;
  return nullptr;
}

}  // namespace

std::string case_schema() {
  SchemaWriter writer;
  simulation::Scenario scenario;
  int version = 0;
  const std::string words = std::to_string(case_version);
  fields::Visitor& visitor = writer;
  visitor.choice(Field("samara", "version of the case file").required(), version,
                 {{words.c_str(), case_version}});
  simulation::declare(visitor, scenario);
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "A case file of Samara"}};
  schema.update(writer.take());
  LoadOptions loads;
  declare(visitor, loads);
  schema["definitions"]["loads"] = writer.take();
  return schema.dump(2) + "\n";
}

std::string unit_of_key(const std::string& path) {
  static const Json schema = Json::parse(case_schema());
  const Json* entry = &schema;
  std::string unit = "1";
  std::istringstream words(path);
  for (std::string word; std::getline(words, word, '.');) {
    entry = find_entry(*entry, word);
    if (entry == nullptr) return "1";
    // The numbers of a list have the unit of the list.
    if (entry->contains("x-unit")) unit = entry->value("x-unit", unit);
  }
  return unit;
}

}  // namespace samara::io
