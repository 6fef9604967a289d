#include "field_reader.hpp"

#include <algorithm>
#include <utility>

#include "yaml_lists.hpp"

namespace samara::io {
namespace {

using fields::Field;
using fields::Range;
using fields::Word;

bool is_word(const YamlNode& node, std::string_view word) {
  return node.kind == YamlNode::Kind::scalar && node.text == word;
}

/// Whether the node is one of the words; sets their flags.
bool read_words(const YamlNode& node, std::span<const Word> words) {
  bool is_one = false;
  for (const Word& word : words) is_one |= * word.is_given = is_word(node, word.text);
  return is_one;
}

bool read_number(const YamlNode& node, const std::string& where, const Range& range,
                 const std::string& expected, double& value, ErrorList& errors) {
  Range named = range;
  named.words = expected.c_str();
  return read_number(node, where, named, value, errors);
}

}  // namespace

const YamlNode* FieldReader::find(const Field& field) {
  if (std::ranges::find(refused_, field.key) != refused_.end()) return nullptr;
  return field.is_compulsory ? map_->require(field.key, field.hint) : map_->find(field.key);
}

bool FieldReader::given(std::string_view key) const { return map_->node().find(key) != nullptr; }

void FieldReader::number(const Field& field, double& value, std::span<const Word> words) {
  const YamlNode* entry = find(field);
  if (entry == nullptr || read_words(*entry, words)) return;
  double number = 0.0;
  if (read_number(*entry, map_->where(field.key), field.range,
                  fields::join_words(field.range.words, words), number, map_->errors()))
    value = field.unit.to_si(number);
}

void FieldReader::integer(const Field& field, int& value, std::span<const Word> words) {
  const YamlNode* entry = find(field);
  if (entry == nullptr || read_words(*entry, words)) return;
  read_integer(*entry, map_->where(field.key), static_cast<int>(field.range.low),
               static_cast<int>(field.range.high), fields::join_words("", words), value,
               map_->errors());
}

void FieldReader::integers(const Field& field, std::span<int> values) {
  const YamlNode* entry = find(field);
  if (entry == nullptr) return;
  const int low = static_cast<int>(field.range.low);
  const int high = static_cast<int>(field.range.high);
  const std::string where = map_->where(field.key);
  const bool is_list = entry->kind == YamlNode::Kind::list;
  if (is_list && entry->children.size() != values.size())
    return expected(field.key,
                    "an integer or a list of " + std::to_string(values.size()) + " integers");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const YamlNode& node = is_list ? entry->children[i] : *entry;
    if (!read_integer(node, is_list ? fields::join_path(where, i) : where, low, high, "", values[i],
                      map_->errors()) &&
        !is_list)
      return;
  }
}

void FieldReader::numbers(const Field& field, std::span<double> values, bool spread,
                          std::span<const Word> words) {
  const YamlNode* entry = find(field);
  if (entry == nullptr || read_words(*entry, words)) return;
  const std::string where = map_->where(field.key);
  std::vector<double> given(values.size());
  if (!words.empty() && entry->kind != YamlNode::Kind::list)
    return expected(
        field.key,
        fields::join_words("a list of " + std::to_string(values.size()) + " numbers", words));
  if (spread && entry->kind != YamlNode::Kind::list) {
    std::vector<std::string> others{"a list of " + std::to_string(values.size())};
    if (mapping_words_ != nullptr) others.emplace_back(mapping_words_);
    if (!read_number(*entry, where, field.range, fields::join_words(field.range.words, others),
                     given[0], map_->errors()))
      return;
    std::ranges::fill(given, given[0]);
  } else if (!read_numbers(*entry, where, field.range, given, map_->errors())) {
    return;
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = field.unit.to_si(given[i]);
}

void FieldReader::number_list(const Field& field, const char* items, std::vector<double>& values) {
  if (find(field) == nullptr) return;
  read_numbers(*map_, field.key, field.range, values, items);
  for (double& value : values) value = field.unit.to_si(value);
}

void FieldReader::name_list(const Field& field, std::vector<std::string>& names) {
  if (find(field) == nullptr) return;
  names.clear();
  read_words(*map_, field.key, names);
}

void FieldReader::pairs(const Field& field, const std::array<const char*, 2>& names,
                        std::vector<std::pair<double, double>>& pairs) {
  const YamlNode* entry = find(field);
  if (entry == nullptr) return;
  const std::size_t errors_before = map_->errors().size();
  read_pairs(*map_, field.key, *entry, names, pairs);
  if (map_->errors().size() > errors_before) pairs.clear();
}

void FieldReader::table(const Field& field, std::span<const fields::Column> columns) {
  const YamlNode* node = find(field);
  if (node == nullptr) return;
  if (node->kind != YamlNode::Kind::list || node->children.empty()) {
    std::string names;
    for (const fields::Column& column : columns)
      names += (names.empty() ? "[" : ", ") + std::string(column.name);
    return expected(field.key, "a list of rows " + names + "]");
  }
  const std::string where = map_->where(field.key);
  const std::size_t errors_before = map_->errors().size();
  std::vector<double> row(columns.size());
  for (const fields::Column& column : columns) column.values->clear();
  for (std::size_t i = 0; i < node->children.size(); ++i) {
    read_numbers(node->children[i], fields::join_path(where, i), field.range, row, map_->errors());
    for (std::size_t k = 0; k < columns.size(); ++k)
      columns[k].values->push_back(columns[k].unit.to_si(row[k]));
  }
  if (map_->errors().size() == errors_before) return;
  for (const fields::Column& column : columns) column.values->clear();
}

bool FieldReader::text(const Field& field, const char* expected, std::string& value) {
  const YamlNode* entry = find(field);
  if (entry == nullptr) return false;
  if (entry->kind != YamlNode::Kind::scalar) {
    this->expected(field.key, expected);
    return false;
  }
  value = entry->text;
  return true;
}

bool FieldReader::choice(const Field& field, std::span<const char* const> words,
                         std::size_t& place) {
  const YamlNode* entry = find(field);
  if (entry == nullptr) return false;
  const auto found =
      std::ranges::find_if(words, [entry](const char* word) { return is_word(*entry, word); });
  if (found != words.end()) {
    place = static_cast<std::size_t>(found - words.begin());
    return true;
  }
  std::vector<std::string> all(words.begin(), words.end());
  if (mapping_words_ != nullptr) all.emplace_back(mapping_words_);
  map_->refuse_word(*entry, field.key, all);
  return false;
}

void FieldReader::matrix(const Field& field, Matrix6& matrix, std::array<bool, 6>* rigid) {
  const YamlNode* node = find(field);
  if (node == nullptr) return;
  ErrorList& errors = map_->errors();
  const std::string where = map_->where(field.key);
  if (node->kind != YamlNode::Kind::list || node->children.size() != 6) {
    errors.add(node->place, where, "expected a list of 6 rows of 6 numbers, " + describe(*node));
    return;
  }
  const std::size_t errors_before = errors.size();
  if (rigid != nullptr) rigid->fill(false);
  for (std::size_t i = 0; i < 6; ++i) {
    const YamlNode& row = node->children[i];
    const std::string row_where = fields::join_path(where, i);
    if (row.kind != YamlNode::Kind::list || row.children.size() != 6) {
      errors.add(row.place, row_where, "expected a list of 6 numbers, " + describe(row));
      continue;
    }
    for (std::size_t j = 0; j < 6; ++j) {
      const bool may_be_rigid = i == j && rigid != nullptr;
      if (may_be_rigid && is_word(row.children[j], "rigid")) {
        (*rigid)[i] = true;
        continue;
      }
      std::vector<std::string> others;
      if (may_be_rigid) others.emplace_back("rigid");
      read_number(row.children[j], fields::join_path(row_where, j), field.range,
                  fields::join_words(field.range.words, others),
                  matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), errors);
    }
  }
  if (errors.size() > errors_before) matrix.setZero();
}

void FieldReader::points(const Field& field, const Matrix3& to_a, std::vector<Vector3>& points) {
  const YamlNode* node = find(field);
  if (node == nullptr) return;
  if (node->kind != YamlNode::Kind::list || node->children.size() < 2) {
    expected(field.key, "a list of at least 2 points of 3 numbers");
    return;
  }
  const std::size_t errors_before = map_->errors().size();
  for (std::size_t i = 0; i < node->children.size(); ++i) {
    Vector3 point = Vector3::Zero();
    read_numbers(node->children[i], fields::join_path(map_->where(field.key), i), field.range,
                 std::span<double>(point.data(), 3), map_->errors());
    points.emplace_back(to_a * point);
  }
  if (map_->errors().size() > errors_before) points.clear();
}

void FieldReader::read_entries(const YamlNode& node, const std::string& where,
                               const std::function<void()>& inside) {
  MapReader entries(node, where, map_->errors());
  MapReader* outer = std::exchange(map_, &entries);
  std::vector<std::string_view> refused = std::exchange(refused_, {});
  inside();
  map_ = outer;
  refused_ = std::move(refused);
  entries.finish();
}

void FieldReader::block(const Field& field, const fields::Presence& presence,
                        const std::function<void()>& inside) {
  const YamlNode* entry = find(field);
  if (entry == nullptr) return;
  presence.make();
  read_entries(*entry, map_->where(field.key), inside);
}

void FieldReader::list(const Field& field, const fields::Items& items) {
  const YamlNode* entry = find(field);
  if (entry == nullptr) return;
  if (entry->kind != YamlNode::Kind::list || entry->children.size() < items.least) {
    expected(field.key, std::string("a list of ") + items.words + " (each starts with \"- \")");
    return;
  }
  const std::string where = map_->where(field.key);
  items.resize(entry->children.size());
  for (std::size_t i = 0; i < entry->children.size(); ++i)
    read_entries(entry->children[i], fields::join_path(where, i), [&] { items.declare(i); });
}

void FieldReader::numbered(const Field& field, const fields::Numbered& entries) {
  const YamlNode* node = find(field);
  if (node == nullptr) return;
  const std::string where = map_->where(field.key);
  read_entries(*node, where, [&] {
    std::vector<std::string> keys;
    for (int number = 1; number <= entries.count; ++number) {
      const std::string key = std::to_string(number);
      const YamlNode* entry = map_->find(key);
      if (entry == nullptr) continue;
      keys.push_back(key);
      read_entries(*entry, fields::join_path(where, key), [&] { entries.declare(number); });
    }
    if (node->kind != YamlNode::Kind::map) return;
    for (const YamlNode& entry : node->children) {
      if (std::ranges::find(keys, entry.key) != keys.end()) continue;
      map_->find(entry.key);
      map_->errors().add(entry.place, where,
                         std::string("expected a ") + entries.words + " from 1 to " +
                             std::to_string(entries.count) + ", got \"" + entry.key + "\"");
    }
  });
}

void FieldReader::named(const Field& field, const fields::Named& entries) {
  const YamlNode* node = find(field);
  if (node == nullptr) return;
  if (node->kind != YamlNode::Kind::map) return expected(field.key, entries.words);
  const std::string where = map_->where(field.key);
  MapReader(*node, where, map_->errors());  // reports keys that are given twice
  for (const YamlNode& entry : node->children) {
    if (entry.key.empty())
      map_->errors().add(entry.place, where, "a name is empty");
    else
      read_entries(entry, fields::join_path(where, entry.key), [&] { entries.declare(entry.key); });
  }
}

void FieldReader::two_ways(const Field& field, const char* words,
                           const std::function<void()>& plain,
                           const std::function<void()>& mapping) {
  const YamlNode* entry = find(field);
  if (entry == nullptr) return;
  if (entry->kind == YamlNode::Kind::map) {
    mapping();
    return;
  }
  mapping_words_ = words;
  plain();
  mapping_words_ = nullptr;
}

void FieldReader::exclusive(std::initializer_list<Keys> groups) {
  const char* first = nullptr;
  const Keys* of_first = nullptr;
  for (const Keys& group : groups)
    for (const char* key : group) {
      const YamlNode* entry = map_->find(key);
      if (entry == nullptr) continue;
      if (of_first == nullptr) {
        first = key;
        of_first = &group;
      } else if (of_first != &group) {
        map_->refuse(*entry, key,
                     std::string("given together with ") + first + "; leave one of them out");
        refused_.emplace_back(key);
      }
    }
}

void FieldReader::at_least_one(Keys keys, const char* hint) {
  if (std::ranges::none_of(keys, [this](const char* key) { return map_->find(key) != nullptr; }))
    map_->require(*keys.begin(), hint);
}

void FieldReader::retired(std::string_view key, const char* where_it_went) {
  if (map_->find(key) != nullptr) refuse(key, where_it_went);
}

void FieldReader::accept(Keys keys) {
  for (const char* key : keys) map_->find(key);
}

void FieldReader::require(std::string_view key, const char* hint) { map_->require(key, hint); }

void FieldReader::refuse(std::string_view key, const std::string& text) {
  const YamlNode* entry = key.empty() ? nullptr : map_->node().find(key);
  map_->refuse(entry == nullptr ? map_->node() : *entry, key, text);
}

void FieldReader::expected(std::string_view key, const std::string& words) {
  const YamlNode* entry = map_->node().find(key);
  if (entry != nullptr) map_->refuse(*entry, key, "expected " + words + ", " + describe(*entry));
}

}  // namespace samara::io
