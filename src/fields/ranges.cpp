#include "samara/fields/ranges.hpp"

#include <algorithm>
#include <cmath>

#include "samara/base/format.hpp"
#include "samara/fields/turbine_fields.hpp"

namespace samara::fields {
namespace {

class RangeCheck : public Visitor {
 public:
  std::vector<Fault> take() { return std::move(faults_); }

  void number(const Field& field, double& value, std::span<const Word> words) override {
    const bool is_word =
        std::ranges::any_of(words, [](const Word& word) { return *word.is_given; });
    if (!is_word) check(field, field.key, value, join_words(field.range.words, words));
  }

  void integer(const Field& field, int& value, std::span<const Word> words) override {
    const bool is_word =
        std::ranges::any_of(words, [](const Word& word) { return *word.is_given; });
    if (is_word || (field.zero_is_none && value == 0)) return;
    if (value >= field.range.low && value <= field.range.high) return;
    add(field.key, "expected an integer from " + general(field.range.low, 10) + " to " +
                       general(field.range.high, 10) + ", got " + std::to_string(value));
  }

  void integers(const Field& field, std::span<int> values) override {
    for (int& value : values) integer(field, value, {});
  }

  void numbers(const Field& field, std::span<double> values, bool,
               std::span<const Word> words) override {
    if (std::ranges::any_of(words, [](const Word& word) { return *word.is_given; })) return;
    for (std::size_t i = 0; i < values.size(); ++i)
      check(field, join_path(std::string(field.key), i), values[i]);
  }

  void number_list(const Field& field, const char*, std::vector<double>& values) override {
    numbers(field, values, false, {});
  }

  void pairs(const Field& field, const std::array<const char*, 2>& names,
             std::vector<std::pair<double, double>>& pairs) override {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const std::string entry = join_path(std::string(field.key), i);
      check(field, entry, pairs[i].first);
      check(field, entry, pairs[i].second);
      if (i > 0 && !(pairs[i].first > pairs[i - 1].first))
        add(entry, std::string(names[0]) + " must be more than in the entry before");
    }
  }

  void table(const Field& field, std::span<const Column> columns) override {
    for (const Column& column : columns)
      for (std::size_t i = 0; i < column.values->size(); ++i)
        check(Field(field.key, column.unit, field.range, ""), join_path(std::string(field.key), i),
              (*column.values)[i]);
  }

  void matrix(const Field& field, Matrix6& matrix, std::array<bool, 6>*) override {
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = 0; j < 6; ++j)
        if (!std::isfinite(matrix(i, j)))
          add(field.key, "expected finite numbers, got " + general(matrix(i, j), 6));
  }

  void points(const Field& field, const Matrix3&, std::vector<Vector3>& points) override {
    for (std::size_t i = 0; i < points.size(); ++i)
      for (const double component : points[i])
        check(field, join_path(std::string(field.key), i), component);
  }

  void name_list(const Field&, std::vector<std::string>&) override {}
  bool text(const Field&, const char*, std::string&) override { return false; }
  bool choice(const Field&, std::span<const char* const>, std::size_t&) override { return false; }

  void block(const Field& field, const Presence& presence,
             const std::function<void()>& inside) override {
    if (presence.is_there()) within(join_path(where_, field.key), inside);
  }

  void list(const Field& field, const Items& items) override {
    for (std::size_t i = 0; i < items.size(); ++i)
      within(join_path(join_path(where_, field.key), i), [&] { items.declare(i); });
  }

  void numbered(const Field& field, const Numbered& entries) override {
    for (int k = 1; k <= entries.count; ++k)
      if (entries.is_there(k))
        within(join_path(join_path(where_, field.key), std::to_string(k)),
               [&] { entries.declare(k); });
  }

  void named(const Field& field, const Named& entries) override {
    for (const std::string& name : entries.names())
      within(join_path(join_path(where_, field.key), name), [&] { entries.declare(name); });
  }

  void two_ways(const Field&, const char*, const std::function<void()>& plain,
                const std::function<void()>& mapping) override {
    plain();
    mapping();
  }

 private:
  void add(std::string_view key, const std::string& text) {
    faults_.push_back({join_path(where_, key), text});
  }

  void within(const std::string& where, const std::function<void()>& inside) {
    const std::string outer = std::exchange(where_, where);
    inside();
    where_ = outer;
  }

  void check(const Field& field, std::string_view key, double value) {
    check(field, key, value, field.range.words);
  }

  /// Limits are converted as the value was, so that round-off moves both alike.
  void check(const Field& field, std::string_view key, double value, const std::string& words) {
    if ((field.zero_is_none && value == 0.0) || (field.infinity_is_none && std::isinf(value)))
      return;
    const Range& range = field.range;
    const bool is_above = range.open ? value > field.unit.to_si(range.low) || std::isinf(range.low)
                                     : value >= field.unit.to_si(range.low);
    const bool is_below = range.open
                              ? value < field.unit.to_si(range.high) || std::isinf(range.high)
                              : value <= field.unit.to_si(range.high);
    const std::string given = ", got " + general(field.unit.from_si(value), 6);
    if (!std::isfinite(value) || !is_above || !is_below)
      add(key, "expected " + words + given);
    else if (value != 0.0 && (std::abs(value) > largest_number || std::abs(value) < least_number))
      add(key, "expected 0 or a number from 1e-30 to 1e30 in size" + given);
  }

  std::string where_;
  std::vector<Fault> faults_;
};

}  // namespace

std::string join_path(const std::string& where, std::string_view key) {
  return where.empty() ? std::string(key) : where + "." + std::string(key);
}

std::string join_path(const std::string& where, std::size_t index) {
  return where + "[" + std::to_string(index) + "]";
}

std::vector<Fault> find_range_faults(const std::function<void(Visitor&)>& declare) {
  RangeCheck check;
  declare(check);
  return check.take();
}

std::vector<Fault> find_range_faults(const model::TurbineDefinition& turbine) {
  model::TurbineDefinition shown = turbine;
  return find_range_faults([&shown](Visitor& fields) { declare(fields, shown); });
}

}  // namespace samara::fields
