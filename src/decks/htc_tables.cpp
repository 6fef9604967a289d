#include "htc_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/base/number.hpp"
#include "samara/base/words.hpp"

#include "htc_deck.hpp"

namespace samara::decks {
namespace {

constexpr int most_rows = 5000;  ///< of a table
constexpr double percent = 100.0;
constexpr double degree = std::numbers::pi / 180.0;

std::optional<int> parse_integer(const std::string& word) {
  const std::optional<double> value = parse_number(word);
  if (!value || *value != std::floor(*value) || std::abs(*value) > 1e9) return {};
  return static_cast<int>(*value);
}

/// Lines of a table with their words, blank ones left out.
class TableText {
 public:
  TableText(std::string path, DeckErrors& errors) : path_(std::move(path)), errors_(errors) {
    try {
      text_ = read_deck_text(path_);
      lines_ = split_lines(text_);
    } catch (const InputError& error) {
      errors_.add_message(error.what());
    }
    skip_blank();
  }

  bool at_end() const { return next_ >= lines_.size(); }
  int line() const { return static_cast<int>(next_) + 1; }
  std::string place() const {
    return path_ + ":" +
           std::to_string(
               std::min<std::size_t>(next_ + 1, std::max<std::size_t>(lines_.size(), 1)));
  }
  std::string_view text() const { return lines_[next_]; }
  std::vector<std::string> words() const { return split_htc_words(lines_[next_]); }
  void advance() {
    ++next_;
    skip_blank();
  }
  /// The line before is the end of a file without a final newline.
  bool is_open() const { return at_end() && !ends_with_line(text_); }

  /// `count` integers at the beginning of a line, which is passed.
  std::optional<std::vector<int>> integers(std::size_t count, const std::string& what) {
    if (!has_line(what)) return {};
    const std::vector<std::string> all = words();
    std::vector<int> values;
    for (std::size_t i = 0; i < count; ++i) {
      const std::optional<int> value =
          i < all.size() ? parse_integer(all[i]) : std::optional<int>();
      if (!value || *value < 0) {
        errors_.add(place(),
                    "expected " + what + ", got \"" + std::string(text().substr(0, 40)) + "\"");
        return {};
      }
      values.push_back(*value);
    }
    advance();
    return values;
  }

  /// `count` numbers at the beginning of a line, which is passed.
  std::optional<std::vector<double>> numbers(std::size_t count, const std::string& what) {
    if (!has_line(what)) return {};
    const std::vector<std::string> all = words();
    std::vector<double> values;
    for (std::size_t i = 0; i < count && i < all.size(); ++i) {
      const std::optional<double> value = parse_number(all[i]);
      if (!value) {
        errors_.add(place(), "expected " + what + ", got \"" + all[i].substr(0, 40) + "\"");
        return {};
      }
      values.push_back(*value);
    }
    if (values.size() < count) {
      errors_.add(place(), "expected " + what + ", got " + std::to_string(values.size()) + " of " +
                               std::to_string(count) + " numbers");
      return {};
    }
    advance();
    return values;
  }

 private:
  bool has_line(const std::string& what) {
    if (at_end())
      errors_.add(path_, "the file ends where " + what + " should follow; hint: it may be cut off");
    return !at_end();
  }
  void skip_blank() {
    while (next_ < lines_.size() &&
           lines_[next_].find_first_not_of(" \t\f\v") == std::string_view::npos)
      ++next_;
  }

  std::string path_;
  DeckErrors& errors_;
  std::string text_;
  std::vector<std::string_view> lines_;  ///< of the text
  std::size_t next_ = 0;
};

/// The integers behind a mark, "#1" or "$2 26"; blanks may follow the mark.
std::vector<int> integers_behind(std::string_view line, std::size_t mark) {
  std::vector<int> values;
  for (const std::string& word : split_htc_words(line.substr(mark + 1))) {
    const std::optional<int> value = parse_integer(word);
    if (!value) break;
    values.push_back(*value);
  }
  return values;
}

}  // namespace

StTable read_st(const std::string& path, int set, int subset, bool full, DeckErrors& errors) {
  StTable table;
  table.path = path;
  table.full = full;
  const std::size_t columns = full ? StTable::full_columns : StTable::classic_columns;
  const std::size_t errors_before = errors.size();
  TableText text(path, errors);
  int open_set = 0;
  bool has_set = false;
  bool has_subset = false;
  while (!text.at_end() && !has_subset) {
    const std::string_view line = text.text();
    const std::size_t first = line.find_first_not_of(" \t");
    if (line[first] == '#') {
      const std::vector<int> numbers = integers_behind(line, first);
      // A line of comment may begin with # as well.
      if (!numbers.empty()) open_set = numbers[0];
      has_set = has_set || open_set == set;
      text.advance();
    } else if (line[first] == '$' && open_set == set) {
      const std::vector<int> numbers = integers_behind(line, first);
      if (numbers.size() < 2 || numbers[1] < 1 || numbers[1] > most_rows) {
        errors.add(text.place(),
                   "expected \"$subset rows\", got \"" + std::string(line.substr(0, 40)) + "\"");
        return table;
      }
      text.advance();
      if (numbers[0] != subset) continue;
      has_subset = true;
      for (int row = 0; row < numbers[1]; ++row) {
        const int number = text.line();
        const std::string place = text.at_end() ? path : text.place();
        if (!text.at_end() && text.words().size() > columns &&
            text.words().size() >= StTable::full_columns && !full) {
          errors.add(place, "the row has " + std::to_string(text.words().size()) +
                                " numbers; hint: \"FPM 1\" in timoschenko_input reads tables of 30 "
                                "columns");
          return table;
        }
        const auto values = text.numbers(columns, "row " + std::to_string(row + 1) + " of " +
                                                      std::to_string(numbers[1]) + " with " +
                                                      std::to_string(columns) + " numbers");
        if (!values) {
          table.rows.clear();
          table.lines.clear();
          return table;
        }
        table.rows.push_back(*values);
        table.lines.push_back(number);
      }
      table.is_open = text.is_open();
    } else {
      text.advance();
    }
  }
  if (!has_subset && errors.size() == errors_before)
    errors.add(path, has_set ? "set " + std::to_string(set) + " has no subset \"$" +
                                   std::to_string(subset) + "\""
                             : "there is no set \"#" + std::to_string(set) + "\"");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double r = table.rows[i][0];
    if (r < 0.0 || (i > 0 && r < table.rows[i - 1][0])) {
      errors.add(table.place(i),
                 "r: expected numbers >= 0 that do not decrease, got " + general(r, 6));
      break;
    }
  }
  return table;
}

std::vector<AeRow> read_ae(const std::string& path, int set, DeckErrors& errors) {
  std::vector<AeRow> rows;
  const std::size_t errors_before = errors.size();
  TableText text(path, errors);
  if (errors.size() > errors_before) return rows;
  const auto sets = text.integers(1, "the number of sets");
  if (!sets) return rows;
  for (int i = 0; i < (*sets)[0]; ++i) {
    const auto head = text.integers(2, "the number of a set and that of its rows");
    if (!head) return {};
    const int count = (*head)[1];
    if (count < 1 || count > most_rows) {
      errors.add(path, "set " + std::to_string((*head)[0]) + ": expected 1 to " +
                           std::to_string(most_rows) + " rows, got " + std::to_string(count));
      return {};
    }
    for (int k = 0; k < count; ++k) {
      const int line = text.line();
      const std::string place = text.at_end() ? path : text.place();
      const auto values =
          text.numbers(4, "row " + std::to_string(k + 1) + " of " + std::to_string(count) +
                              " with r, chord, thickness and set of polars");
      if (!values) return {};
      if ((*head)[0] != set) continue;
      AeRow row;
      row.r = (*values)[0];
      row.chord = (*values)[1];
      row.thickness = (*values)[2] / percent;
      row.line = line;
      const double polars = (*values)[3];
      if (!(row.chord > 0.0))
        errors.add(place, "chord: expected a number > 0, got " + general(row.chord, 6));
      if (!(row.thickness > 0.0 && row.thickness <= 1.0 + 1e-6))
        errors.add(place,
                   "thickness: expected a number above 0, to 100 (percent of the chord), got " +
                       general((*values)[2], 6));
      if (!(polars >= 1.0 && polars <= 1e6 && polars == std::floor(polars)))
        errors.add(place, "set of polars: expected an integer >= 1, got " + general(polars, 6));
      else
        row.set = static_cast<int>(polars);
      if (row.r < 0.0 || (!rows.empty() && !(row.r > rows.back().r)))
        errors.add(place, "r: expected numbers >= 0 that rise, got " + general(row.r, 6));
      if (errors.size() > errors_before) return {};
      rows.push_back(row);
    }
  }
  if (rows.empty())
    errors.add(path,
               "there is no set " + std::to_string(set) + " of " + std::to_string((*sets)[0]));
  return rows;
}

std::map<int, std::vector<PcPolar>> read_pc(const std::string& path, const std::vector<int>& sets,
                                            DeckErrors& errors) {
  std::map<int, std::vector<PcPolar>> all;
  const std::size_t errors_before = errors.size();
  TableText text(path, errors);
  if (errors.size() > errors_before) return all;
  const auto count = text.integers(1, "the number of sets");
  if (!count) return all;
  const int last = *std::ranges::max_element(sets);
  if (last > (*count)[0]) {
    errors.add(path,
               "there is no set " + std::to_string(last) + " of " + std::to_string((*count)[0]));
    return all;
  }
  for (int set = 1; set <= last; ++set) {
    const auto polars = text.integers(1, "the number of polars of set " + std::to_string(set));
    if (!polars) return {};
    if ((*polars)[0] < 1 || (*polars)[0] > most_rows) {
      errors.add(path, "set " + std::to_string(set) + ": expected at least one polar");
      return {};
    }
    std::vector<PcPolar> found;
    for (int i = 0; i < (*polars)[0]; ++i) {
      const std::string place = text.at_end() ? path : text.place();
      const std::string name = "polar " + std::to_string(i + 1) + " of set " + std::to_string(set);
      PcPolar polar;
      polar.line = text.line();
      const auto head = text.numbers(3, name + ": number, rows and thickness");
      if (!head) return {};
      const double rows = (*head)[1];
      if (!(rows >= 2.0 && rows <= most_rows && rows == std::floor(rows))) {
        errors.add(place, name + ": expected at least 2 rows, got " + general(rows, 6));
        return {};
      }
      polar.thickness = (*head)[2] / percent;
      if (!(polar.thickness > 0.0 && polar.thickness <= 1.0 + 1e-6)) {
        errors.add(place,
                   name + ": expected a thickness above 0, to 100 (percent of the chord), got " +
                       general((*head)[2], 6));
        return {};
      }
      if (!found.empty() && !(polar.thickness > found.back().thickness)) {
        errors.add(place, name + ": the thickness must rise from polar to polar, got " +
                              general((*head)[2], 6) + " behind " +
                              general(percent * found.back().thickness, 6));
        return {};
      }
      for (int k = 0; k < static_cast<int>(rows); ++k) {
        const auto values = text.numbers(4, name + ": row " + std::to_string(k + 1) + " of " +
                                                std::to_string(static_cast<int>(rows)) +
                                                " with angle, Cl, Cd and Cm");
        if (!values) return {};
        polar.angles.push_back((*values)[0] * degree);
        polar.lift.push_back((*values)[1]);
        polar.drag.push_back((*values)[2]);
        polar.moment.push_back((*values)[3]);
      }
      found.push_back(std::move(polar));
    }
    if (std::ranges::find(sets, set) != sets.end()) all[set] = std::move(found);
  }
  return all;
}

}  // namespace samara::decks
