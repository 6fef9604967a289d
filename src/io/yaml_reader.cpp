#include "yaml_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"

namespace samara::io {
namespace {

constexpr std::size_t max_errors_shown = 100;
constexpr std::size_t max_text_shown = 40;

/// Quotes a text of the user, shortened and without line breaks.
std::string quote(std::string_view text) {
  std::string shown = "\"";
  for (const char c : text.substr(0, max_text_shown)) shown += c == '\n' || c == '\r' ? ' ' : c;
  if (text.size() > max_text_shown) {
    while (!shown.empty() && (static_cast<unsigned char>(shown.back()) & 0x80) != 0) {
      shown.pop_back();
    }
    shown += "...";
  }
  return shown + "\"";
}

/// Parses a number of YAML 1.2; also its words for infinity and nan, to refuse them by name.
std::optional<double> parse_number(std::string_view text) {
  std::string_view digits = text;
  bool negative = false;
  if (!digits.empty() && (digits.front() == '+' || digits.front() == '-')) {
    negative = digits.front() == '-';
    digits.remove_prefix(1);
  }
  std::string word;
  for (const char c : digits) word += to_lower(c);
  double value = 0.0;
  if (word == ".inf" || word == "inf" || word == "infinity") {
    value = std::numeric_limits<double>::infinity();
  } else if (word == ".nan" || word == "nan") {
    value = std::numeric_limits<double>::quiet_NaN();
  } else {
    if (digits.empty() || digits.front() == '+' || digits.front() == '-') return std::nullopt;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    if (stop != end || error == std::errc::invalid_argument) return std::nullopt;
    if (error == std::errc::result_out_of_range) {
      value = std::numeric_limits<double>::infinity();
    }
  }
  return negative ? -value : value;
}

std::optional<double> parse_number(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::scalar || node.quoted) return std::nullopt;
  return parse_number(node.text);
}

/// Suggests the number that a text was probably meant to be; empty: no suggestion.
std::string suggest_number(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::scalar) return {};
  if (node.quoted && parse_number(node.text)) return " in quotes; leave the quotes out";
  std::string mended = node.text;
  std::replace(mended.begin(), mended.end(), ',', '.');
  if (mended != node.text && parse_number(mended)) return "; did you mean " + mended + "?";
  mended = node.text;
  for (char& c : mended) c = c == 'd' || c == 'D' ? 'e' : c;
  if (mended != node.text && parse_number(mended)) return "; did you mean " + mended + "?";
  return {};
}

/// A setting may state a whole polar.
std::string shorten(const std::string& setting) {
  constexpr std::size_t most = 200;
  return setting.size() > most ? setting.substr(0, most) + "..." : setting;
}

std::string list_words(const std::vector<std::string>& words, const char* last_link) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) list += i + 1 == words.size() ? last_link : ", ";
    list += words[i];
  }
  return list;
}

/// `blades.sections[0].mass` as --set writes it: `blades.sections.0.mass`.
std::string to_setting_path(const std::string& where) {
  std::string path;
  for (const char c : where) {
    if (c == '[') path += '.';
    if (c != '[' && c != ']') path += c;
  }
  return path;
}

/// The node of a field, or the innermost one around a field that is left out.
struct FieldNode {
  const YamlNode* node;
  bool is_given;
};

FieldNode find_node(const YamlNode& root, const std::string& field) {
  const YamlNode* node = &root;
  std::istringstream keys(to_setting_path(field));
  for (std::string key; std::getline(keys, key, '.');) {
    const YamlNode* next = nullptr;
    if (node->kind == YamlNode::Kind::list) {
      std::size_t index = node->children.size();
      std::from_chars(key.data(), key.data() + key.size(), index);
      if (index < node->children.size()) next = &node->children[index];
    } else {
      next = node->find(key);
    }
    if (next == nullptr) return {node, false};
    node = next;
  }
  return {node, true};
}

/// The place of the last --set argument in a field, else that of the field. For a field that is
/// left out: the place of the innermost field around it.
Place find_place(const YamlNode& root, const std::string& field) {
  if (field.empty()) return {};
  const FieldNode found = find_node(root, field);
  return found.is_given ? find_blame(*found.node) : found.node->place;
}

/// The field of a fault by the key that is given: `speed_rpm` instead of `speed`.
std::string given_key(const YamlNode& root, const Fault& fault) {
  if (fault.field.empty() || find_node(root, fault.field).is_given) return fault.field;
  for (const std::string& other : fault.others)
    if (other.starts_with(fault.field + "_") && find_node(root, other).is_given) return other;
  return fault.field;
}

}  // namespace

std::string ErrorList::compose(const Place& place, const std::string& where,
                               const std::string& what) const {
  std::string message;
  std::string subject = where;
  if (place.setting >= 0) {
    const std::string& setting = settings_[static_cast<std::size_t>(place.setting)];
    message = "--set " + shorten(setting) + ": ";
    if (to_setting_path(where) == setting.substr(0, setting.find('='))) subject.clear();
  } else {
    message = path_ + ":";
    if (place.line > 0) {
      message += std::to_string(place.line) + ":" + std::to_string(place.column) + ":";
    }
    message += " ";
  }
  if (!subject.empty()) message += subject + ": ";
  return message + what;
}

void ErrorList::add(const Place& place, const std::string& where, const std::string& what,
                    const std::string& mapping) {
  errors_.push_back({place, mapping, compose(place, where, what)});
}

bool ErrorList::has_error_at(const std::string& field) const {
  return std::ranges::any_of(errors_, [&field](const Error& error) {
    return is_within(field, error.where) || is_within(error.where, field);
  });
}

void ErrorList::add(const std::vector<Fault>& faults, const YamlNode& root) {
  std::vector<Error> found;
  for (const Fault& fault : faults) {
    std::vector<std::string> fields = fault.others;
    fields.push_back(fault.field);
    if (std::ranges::any_of(fields, [this](const auto& field) { return has_error_at(field); }))
      continue;
    const std::string field = given_key(root, fault);
    Place blame = find_place(root, field);
    for (const std::string& other : fault.others)
      if (const Place place = find_place(root, other); place.setting > blame.setting) blame = place;
    found.push_back({blame, field, compose(blame, field, fault.text)});
  }
  errors_.insert(errors_.end(), found.begin(), found.end());
}

void ErrorList::note(const std::vector<Fault>& notes, const YamlNode& root) {
  for (const Fault& note : notes)
    notes_.push_back(compose(find_place(root, note.field), note.field, "note: " + note.text));
}

void ErrorList::throw_if_any() const {
  if (errors_.empty()) return;
  std::vector<Error> sorted = errors_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Error& a, const Error& b) {
    return std::pair(a.place.setting, std::pair(a.place.line, a.place.column)) <
           std::pair(b.place.setting, std::pair(b.place.line, b.place.column));
  });
  std::string text;
  for (std::size_t i = 0; i < std::min(sorted.size(), max_errors_shown); ++i) {
    text += (i > 0 ? "\n" : "") + sorted[i].message;
  }
  if (sorted.size() > max_errors_shown) {
    text +=
        "\n" + path_ + ": and " + std::to_string(sorted.size() - max_errors_shown) + " more errors";
  }
  throw InputError(text);
}

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::empty:
      return "got nothing";
    case YamlNode::Kind::list:
      return "got a list of " + std::to_string(node.children.size());
    case YamlNode::Kind::map:
      return "got a mapping";
    case YamlNode::Kind::scalar:
      break;
  }
  return "got " + (parse_number(node) ? node.text : quote(node.text));
}

Place find_blame(const YamlNode& node) {
  Place blame = node.place;
  for (const YamlNode& child : node.children) {
    const Place place = find_blame(child);
    if (place.setting > blame.setting) blame = place;
  }
  return blame;
}

bool read_number(const YamlNode& node, const std::string& where, const Range& range, double& value,
                 ErrorList& errors) {
  const std::optional<double> number = parse_number(node);
  const bool accepted = number && std::isfinite(*number) &&
                        (range.open ? *number > range.low && *number < range.high
                                    : *number >= range.low && *number <= range.high);
  if (!accepted) {
    errors.add(
        node.place, where,
        std::string("expected ") + range.words + ", " + describe(node) + suggest_number(node));
    return false;
  }
  if (*number != 0.0 &&
      (std::abs(*number) > fields::largest_number || std::abs(*number) < fields::least_number)) {
    errors.add(node.place, where,
               "expected 0 or a number from 1e-30 to 1e30 in size, " + describe(node));
    return false;
  }
  value = *number;
  return true;
}

bool read_integer(const YamlNode& node, const std::string& where, int low, int high,
                  const std::string& others, int& value, ErrorList& errors) {
  int number = 0;
  const char* begin = node.text.data();
  const char* end = begin + node.text.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  const bool is_integer = node.kind == YamlNode::Kind::scalar && !node.quoted && stop == end &&
                          error == std::errc() && begin != end;
  if (!is_integer || number < low || number > high) {
    errors.add(node.place, where,
               "expected an integer from " + std::to_string(low) + " to " + std::to_string(high) +
                   others + ", " + describe(node));
    return false;
  }
  value = number;
  return true;
}

bool read_numbers(const YamlNode& node, const std::string& where, const Range& range,
                  std::span<double> values, ErrorList& errors) {
  if (node.kind != YamlNode::Kind::list || node.children.size() != values.size()) {
    errors.add(
        node.place, where,
        "expected a list of " + std::to_string(values.size()) + " numbers, " + describe(node));
    return false;
  }
  bool accepted = true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    accepted &= read_number(node.children[i], join_path(where, i), range, values[i], errors);
  }
  return accepted;
}

MapReader::MapReader(const YamlNode& node, std::string where, ErrorList& errors)
    : node_(node), where_(std::move(where)), errors_(errors) {
  if (node_.kind != YamlNode::Kind::map) {
    const char* hint =
        node_.kind == YamlNode::Kind::empty ? "; leave the key out, or write {}" : "";
    errors_.add(node_.place, where_, "expected keys with values, " + describe(node_) + hint);
    return;
  }
  std::map<std::string_view, const YamlNode*> firsts;
  for (const YamlNode& entry : node_.children) {
    const YamlNode* first = firsts.try_emplace(entry.key, &entry).first->second;
    if (first == &entry) continue;
    std::string what = "duplicate key " + quote(entry.key);
    if (!where_.empty()) what += " in " + where_;
    if (first->place.line > 0) what += ", first given in line " + std::to_string(first->place.line);
    errors_.add(entry.place, "", what, where_);
  }
}

const YamlNode* MapReader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return node_.find(key);
}

const YamlNode* MapReader::require(std::string_view key, std::string_view hint) {
  const YamlNode* entry = find(key);
  if (entry == nullptr && node_.kind == YamlNode::Kind::map) {
    missing_.push_back({std::string(key), std::string(hint)});
  }
  return entry;
}

void MapReader::refuse(const YamlNode& entry, std::string_view key, const std::string& what) const {
  errors_.add(entry.place, key.empty() ? where_ : where(key), what);
}

void MapReader::refuse_word(const YamlNode& entry, std::string_view key,
                            const std::vector<std::string>& words) const {
  refuse(entry, key,
         "expected " + list_words(words, " or ") + ", " + describe(entry) +
             suggest(entry.text, words));
}

std::string MapReader::report_unknown(const YamlNode& entry) const {
  std::string what = "unknown key " + quote(entry.key);
  if (!where_.empty() && entry.place.setting < 0) what += " in " + where_;
  // A fault that is not shown needs no suggestion.
  const std::string similar =
      errors_.size() < max_errors_shown ? find_similar(entry.key, known_) : "";
  if (!similar.empty()) {
    what += "; did you mean \"" + similar + "\"?";
  } else {
    what += "; known keys: " + list_words(known_, ", ");
  }
  // A key that is similar to no known key is not meant for one of them.
  errors_.add(entry.place, "", what, similar.empty() ? where(entry.key) : where_);
  return similar;
}

void MapReader::finish() {
  std::vector<std::string> meant;
  std::set<std::string_view> seen;
  for (const YamlNode& entry : node_.children) {
    if (node_.kind != YamlNode::Kind::map || !seen.insert(entry.key).second) continue;
    if (std::find(known_.begin(), known_.end(), entry.key) == known_.end()) {
      meant.push_back(report_unknown(entry));
    }
  }
  for (const Missing& missing : missing_) {
    if (std::find(meant.begin(), meant.end(), missing.key) != meant.end()) continue;
    std::string what = "missing key \"" + missing.key + "\"";
    if (!missing.hint.empty()) what += " (" + missing.hint + ")";
    errors_.add(node_.place, where_, what);
  }
}

void read_pairs(MapReader& map, std::string_view key, const YamlNode& node,
                const std::array<const char*, 2>& names,
                std::vector<std::pair<double, double>>& pairs) {
  if (node.kind != YamlNode::Kind::list || node.children.empty()) {
    map.refuse(
        node, key,
        std::string("expected a list of [") + names[0] + ", " + names[1] + "], " + describe(node));
    return;
  }
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const std::string where = join_path(map.where(key), i);
    std::array<double, 2> entry{};
    if (!read_numbers(node.children[i], where, fields::any_number, std::span<double>(entry),
                      map.errors())) {
      continue;
    }
    if (!pairs.empty() && !(entry[0] > pairs.back().first))
      map.errors().add(find_blame(node.children[i]), where,
                       std::string(names[0]) + " must be more than in the entry before");
    pairs.emplace_back(entry[0], entry[1]);
  }
}

}  // namespace samara::io
