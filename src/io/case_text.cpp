#include "samara/io/case_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "samara/fields/description.hpp"
#include "samara/fields/turbine_fields.hpp"

#include "case_version.hpp"

namespace samara::io {
namespace {

using fields::Field;

constexpr std::size_t comment_column = 44;
constexpr std::size_t most_in_line = 100;

/// A text that YAML reads back as itself.
std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "\"";
}

/// True if YAML reads the text as itself without quotes.
bool is_plain(const std::string& text) {
  return text.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789 ") ==
         std::string::npos;
}

std::string in_brackets(const std::vector<std::string>& entries, char open, char close) {
  std::string text(1, open);
  for (std::size_t i = 0; i < entries.size(); ++i) text += (i > 0 ? ", " : "") + entries[i];
  return text + close;
}

/// A key and its value: one text, rows of a list, or entries; an item of a list has no key.
struct Entry {
  std::string key;
  std::string value;
  std::vector<std::string> rows;
  std::vector<Entry> entries;
  std::string unit;
  std::string comment;
  bool is_list = false;
};

bool has_comments(const Entry& entry) {
  return !entry.comment.empty() || std::ranges::any_of(entry.entries, has_comments);
}

/// The entry in one line; empty: it needs several lines. A mapping of values may be longer than a
/// mapping of mappings.
std::string in_one_line(const Entry& entry) {
  constexpr std::size_t most_of_values = 200;
  if (entry.entries.empty() && entry.rows.empty()) return entry.value;
  if (!entry.rows.empty() || entry.is_list || std::ranges::any_of(entry.entries, has_comments))
    return "";
  std::vector<std::string> parts;
  bool has_mappings = false;
  for (const Entry& inner : entry.entries) {
    const std::string text = in_one_line(inner);
    if (text.empty()) return "";
    has_mappings |= !inner.entries.empty();
    parts.push_back(inner.key + ": " + text);
  }
  const std::string text = in_brackets(parts, '{', '}');
  const bool fits =
      text.size() <= (has_mappings || entry.key.empty() ? most_in_line : most_of_values);
  return fits && !(has_mappings && entry.key.empty()) ? text : "";
}

void print(const Entry& entry, std::size_t indent, const std::string& bullet, std::string& text) {
  std::string line = std::string(indent, ' ') + bullet;
  const bool is_item = entry.key.empty();
  if (!is_item) line += entry.key + ":";
  // Entries of the top level have lines of their own.
  const std::string value = indent == 0 && !entry.entries.empty() ? "" : in_one_line(entry);
  std::string comment = entry.unit;
  if (!entry.comment.empty()) comment += (comment.empty() ? "" : "; ") + entry.comment;
  if (!value.empty()) line += (is_item ? "" : " ") + value;
  if (value.empty() && !comment.empty() && !is_item &&
      line.size() + comment.size() > most_in_line) {
    text += std::string(indent, ' ') + "# " + comment + "\n";
    comment.clear();
  }
  if (!comment.empty() && !is_item)
    line += std::string(line.size() < comment_column ? comment_column - line.size() : 1, ' ') +
            "# " + comment;
  const std::size_t inner = indent + bullet.size() + (is_item ? 0 : 2);
  if (!value.empty()) {
    text += line + "\n";
    return;
  }
  if (!is_item) text += line + "\n";
  for (const std::string& row : entry.rows) text += std::string(inner, ' ') + "- " + row + "\n";
  for (std::size_t i = 0; i < entry.entries.size(); ++i) {
    if (is_item)  // the bullet comes before its first entry
      print(entry.entries[i], i == 0 ? indent : indent + bullet.size(), i == 0 ? bullet : "", text);
    else
      print(entry.entries[i], inner, entry.is_list ? "- " : "", text);
  }
}

class CaseWriter : public fields::Description {
 public:
  explicit CaseWriter(const CaseComments& comments) : comments_(comments) {}

  bool describes() const override { return defaults_.has_value(); }

  std::vector<Entry> write(model::TurbineDefinition& turbine,
                           model::OperatingPointsDefinition& operation) {
    model::TurbineDefinition nothing;
    model::OperatingPointsDefinition no_points;
    defaults_.emplace();
    declare(*this, nothing);
    fields::declare_operating_points(*this, no_points);
    known_ = *std::exchange(defaults_, std::nullopt);
    entries_.clear();
    declare(*this, turbine);
    fields::declare_operating_points(*this, operation);
    return std::move(entries_);
  }

  const Field& spelling(const Field& field, const Field& other, double value) override {
    const std::string text = exact_in(other.unit, value);
    double read = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    const bool is_shorter = text.size() < exact_in(field.unit, value).size();
    return is_shorter && other.unit.to_si(read) == value ? other : field;
  }

  void number(const Field& field, double& value, std::span<const fields::Word> words) override {
    for (const fields::Word& word : words)
      if (*word.is_given) return add(field, word.text);
    if ((field.zero_is_none && value == 0.0) || !std::isfinite(value)) return;
    add(field, exact_in(field.unit, value));
  }
  void integer(const Field& field, int& value, std::span<const fields::Word>) override {
    if (!field.zero_is_none || value != 0) add(field, std::to_string(value));
  }
  void numbers(const Field& field, std::span<double> values, bool spread,
               std::span<const fields::Word> words) override {
    for (const fields::Word& word : words)
      if (*word.is_given) return add(field, word.text);
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(exact_in(field.unit, value));
    const bool is_one =
        spread && std::ranges::all_of(texts, [&](const auto& text) { return text == texts[0]; });
    add(field, is_one ? texts[0] : in_brackets(texts, '[', ']'));
  }
  void number_list(const Field& field, const char*, std::vector<double>& values) override {
    if (!values.empty()) numbers(field, values, false, {});
  }
  void name_list(const Field& field, std::vector<std::string>& names) override {
    if (!names.empty()) add(field, in_brackets(names, '[', ']'));
  }
  void pairs(const Field& field, const std::array<const char*, 2>&,
             std::vector<std::pair<double, double>>& pairs) override {
    std::vector<std::string> texts;
    for (const auto& [x, y] : pairs) texts.push_back("[" + exact(x) + ", " + exact(y) + "]");
    if (!texts.empty()) add(field, in_brackets(texts, '[', ']'));
  }
  void table(const Field& field, std::span<const fields::Column> columns) override {
    std::vector<std::string> rows(columns[0].values->size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      std::vector<std::string> row;
      for (const fields::Column& column : columns)
        row.push_back(exact_in(column.unit, column.values->at(i)));
      rows[i] = in_brackets(row, '[', ']');
    }
    if (!rows.empty()) add_rows(field, std::move(rows));
  }
  bool text(const Field& field, const char*, std::string& value) override {
    if (!value.empty()) add(field, is_plain(value) && field.key != "title" ? value : quote(value));
    return false;
  }
  bool choice(const Field& field, std::span<const char* const> words, std::size_t& place) override {
    if (place < words.size()) add(field, words[place]);
    return false;
  }
  void matrix(const Field& field, Matrix6& matrix, std::array<bool, 6>* rigid) override {
    std::vector<std::string> rows;
    for (Eigen::Index i = 0; i < 6; ++i) {
      std::vector<std::string> row;
      for (Eigen::Index j = 0; j < 6; ++j)
        row.push_back(i == j && rigid != nullptr && (*rigid)[static_cast<std::size_t>(i)]
                          ? "rigid"
                          : exact(matrix(i, j)));
      rows.push_back(in_brackets(row, '[', ']'));
    }
    add_rows(field, std::move(rows));
  }
  void points(const Field& field, const Matrix3& to_a, std::vector<Vector3>& points) override {
    std::vector<std::string> rows;
    for (const Vector3& point : points) {
      const Vector3 shown = to_a.transpose() * point;
      rows.push_back(in_brackets({exact(shown(0)), exact(shown(1)), exact(shown(2))}, '[', ']'));
    }
    if (!rows.empty()) add_rows(field, std::move(rows));
  }

  void block(const Field& field, const fields::Presence& presence,
             const std::function<void()>& inside) override {
    if (!describes() && !presence.is_there()) return;
    std::vector<Entry> entries = within(std::string(field.key), inside);
    if (!entries.empty()) {
      add_entries(field, std::move(entries), false);
    } else if (presence.may_be_absent && !describes()) {
      Entry entry = named(field);
      entry.value = "{}";
      entries_.push_back(std::move(entry));
    }
  }
  void list(const Field& field, const fields::Items& items) override {
    if (describes()) {
      within(std::string(field.key) + "[]", [&] { items.declare(0); });
      return;
    }
    std::vector<Entry> all;
    for (std::size_t i = 0; i < items.size(); ++i) {
      Entry item;
      const bool was_item = std::exchange(is_item_, true);
      item.entries = within(std::string(field.key) + "[]", [&] { items.declare(i); });
      is_item_ = was_item;
      all.push_back(std::move(item));
    }
    if (!all.empty()) add_entries(field, std::move(all), true);
  }
  void numbered(const Field& field, const fields::Numbered& entries) override {
    if (describes()) {
      within(std::string(field.key) + "[]", [&] { entries.declare(1); });
      return;
    }
    std::vector<Entry> all;
    for (int k = 1; k <= entries.count; ++k) {
      if (!entries.is_there(k)) continue;
      Entry entry;
      entry.key = std::to_string(k);
      entry.entries = within(std::string(field.key) + "[]", [&] { entries.declare(k); });
      if (!entry.entries.empty()) all.push_back(std::move(entry));
    }
    if (!all.empty()) add_entries(field, std::move(all), false);
  }
  void named(const Field& field, const fields::Named& entries) override {
    if (describes()) {
      within(std::string(field.key) + "[]", [&] { entries.declare(""); });
      return;
    }
    std::vector<Entry> all;
    for (const std::string& name : entries.names()) {
      Entry entry;
      entry.key = is_plain(name) ? name : quote(name);
      entry.entries = within(std::string(field.key) + "[]", [&] { entries.declare(name); });
      if (entry.entries.empty()) entry.value = "{}";
      all.push_back(std::move(entry));
    }
    if (!all.empty()) add_entries(field, std::move(all), false);
  }

 private:
  std::string path_of(const Field& field) const { return where_ + std::string(field.key); }

  void add(const Field& field, const std::string& value) {
    const std::string path = path_of(field);
    const auto comment = comments_.keys.find(path);
    if (defaults_) {
      (*defaults_)[path] = value;
      return;
    }
    const auto fallback = known_.find(path);
    const bool is_default = fallback != known_.end() && fallback->second == value;
    if (is_default && !field.is_compulsory && comment == comments_.keys.end()) return;
    Entry entry = named(field);
    entry.value = value;
    entries_.push_back(std::move(entry));
  }

  void add_rows(const Field& field, std::vector<std::string> rows) {
    Entry entry = named(field);
    entry.rows = std::move(rows);
    entries_.push_back(std::move(entry));
  }

  void add_entries(const Field& field, std::vector<Entry> entries, bool is_list) {
    if (entries.empty()) return;
    Entry entry = named(field);
    entry.unit.clear();
    entry.is_list = is_list;
    entry.entries = std::move(entries);
    entries_.push_back(std::move(entry));
  }

  Entry named(const Field& field) const {
    Entry entry;
    entry.key = field.key;
    const bool is_in_key = std::string_view(field.unit.name) == "deg";
    if (!is_in_key && !is_item_) entry.unit = field.unit.name;
    const auto comment = comments_.keys.find(path_of(field));
    if (comment != comments_.keys.end()) entry.comment = comment->second;
    return entry;
  }

  std::vector<Entry> within(const std::string& key, const std::function<void()>& inside) {
    const std::string outer = std::exchange(where_, where_ + key + ".");
    std::vector<Entry> others = std::exchange(entries_, {});
    inside();
    where_ = outer;
    return std::exchange(entries_, std::move(others));
  }

  const CaseComments& comments_;
  std::optional<std::map<std::string, std::string>> defaults_;  ///< while they are collected
  std::map<std::string, std::string> known_;                    ///< defaults by path
  std::string where_;
  bool is_item_ = false;  ///< inside an item of a list
  std::vector<Entry> entries_;
};

}  // namespace

std::string exact(double value) {
  if (value == 0.0) return "0";  // no -0
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

std::string exact_in(const fields::Unit& unit, double value) {
  const double converted = unit.from_si(value);
  if (unit.factor == unit.divisor) return exact(converted);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr int most_digits = 17;
  std::array<char, 48> text{};
  for (const double near :
       {converted, std::nextafter(converted, infinity), std::nextafter(converted, -infinity)})
    for (int digits = 1; digits <= most_digits; ++digits) {
      const int size = std::snprintf(text.data(), text.size(), "%.*g", digits, near);
      double read = 0.0;
      std::from_chars(text.data(), text.data() + size, read);
      if (unit.to_si(read) == value) return exact(read);
    }
  return exact(converted);
}

std::string write_case_text(const model::TurbineDefinition& turbine, const CaseComments& comments,
                            const model::OperatingPointsDefinition& operation) {
  std::string text;
  for (const std::string& line : comments.head) text += line.empty() ? "#\n" : "# " + line + "\n";
  if (!text.empty()) text += "\n";
  Entry version;
  version.key = "samara";
  version.value = std::to_string(case_version);
  version.comment = "version of the case file";
  print(version, 0, "", text);
  model::TurbineDefinition shown = turbine;
  model::OperatingPointsDefinition points = operation;
  for (const Entry& entry : CaseWriter(comments).write(shown, points)) {
    if (!entry.entries.empty()) text += "\n";
    print(entry, 0, "", text);
  }
  return text;
}

}  // namespace samara::io
