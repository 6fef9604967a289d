#include "samara/io/polar_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

#include "samara/base/error.hpp"
#include "samara/base/number.hpp"
#include "samara/base/words.hpp"
#include "samara/fields/field.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::io {
namespace {

using model::PolarDefinition;

constexpr std::size_t max_megabytes = 16;
constexpr int most_rows = 5000;  ///< of a table
constexpr int most_tables = 100;
constexpr std::size_t most_shown = 40;
constexpr double million = 1e6;

/// A line that is neither empty nor a comment.
struct Line {
  int number = 0;
  std::vector<std::string_view> words;
};

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\f' || c == '\v';
}

/// Words up to a comment. Quotes hold a word together and stay.
std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t i = 0;
  while (i < line.size() && line[i] != '!' && line[i] != '#' && line[i] != '%') {
    if (is_space(line[i])) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    if (line[i] == '"' || line[i] == '\'')
      i = std::min(line.find(line[i], i + 1), line.size() - 1) + 1;
    else
      while (i < line.size() && !is_space(line[i]) && line[i] != '!') ++i;
    words.push_back(line.substr(begin, i - begin));
  }
  return words;
}

/// Lines with words.
std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  int number = 0;
  for (const std::string_view line : split_lines(text))
    if (Line next{++number, split(line)}; !next.words.empty()) lines.push_back(std::move(next));
  return lines;
}

/// No value where the word is no finite number of usual size. A number that is next to nothing is
/// 0.
std::optional<double> parse_usual_number(std::string_view word) {
  const std::optional<double> value = parse_number(std::string(word));
  if (!value || std::abs(*value) > fields::largest_number) return {};
  return std::abs(*value) < fields::least_number ? 0.0 : *value;
}

/// A word in quotes, shortened, without characters that no terminal shows.
std::string quote(std::string_view word) {
  std::string shown = "\"";
  for (const char c : word.substr(0, most_shown))
    shown += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? ' ' : c;
  return shown + (word.size() > most_shown ? "...\"" : "\"");
}

/// The key of a line `value key`; empty: it has none.
std::string key_of(const Line& line) {
  return line.words.size() < 2 ? "" : to_lower(line.words[1]);
}

class PolarReader {
 public:
  PolarReader(std::string path, std::string_view text)
      : path_(std::move(path)), lines_(lines_of(text)) {}

  std::vector<PolarDefinition> read() {
    const bool is_aerodyn =
        std::ranges::any_of(lines_, [](const Line& line) { return key_of(line) == "numalf"; });
    if (is_aerodyn)
      read_tables();
    else
      read_columns();
    return std::move(polars_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& what) const {
    throw InputError(path_ + (line > 0 ? ":" + std::to_string(line) : "") + ": " + what);
  }

  /// The numbers of a row: the angle, Cl, Cd and, where it is there, Cm.
  std::vector<double> numbers_of(const Line& line) const {
    std::vector<double> numbers;
    for (const std::string_view word : line.words) {
      const std::optional<double> number = parse_usual_number(word);
      if (!number) break;
      numbers.push_back(*number);
    }
    return numbers;
  }

  static void add_row(const std::vector<double>& row, PolarDefinition& polar) {
    polar.angles.push_back(fields::deg.to_si(row[0]));
    polar.lift.push_back(row[1]);
    polar.drag.push_back(row[2]);
    polar.moment.push_back(row.size() > 3 ? row[3] : 0.0);
  }

  // ---- columns ---------------------------------------------------------------------------------

  void read_columns() {
    constexpr std::size_t least_columns = 3;
    constexpr std::size_t most_columns = 4;
    if (lines_.empty())
      fail(0,
           "has no polar; hint: lines of angle [deg], Cl, Cd and Cm, or an airfoil file of "
           "AeroDyn");
    PolarDefinition polar;
    const std::size_t columns = lines_[0].words.size();
    for (const Line& line : lines_) {
      const std::vector<double> row = numbers_of(line);
      if (row.size() < line.words.size())
        fail(line.number, "expected numbers: angle [deg], Cl, Cd, Cm; got " +
                              quote(line.words[row.size()]) +
                              "; hint: comments start with #, ! or %");
      if (row.size() < least_columns || row.size() > most_columns)
        fail(line.number, "expected 3 or 4 columns (angle [deg], Cl, Cd, Cm), got " +
                              std::to_string(row.size()));
      if (row.size() != columns)
        fail(line.number, "has " + std::to_string(row.size()) + " columns, line " +
                              std::to_string(lines_[0].number) + " has " + std::to_string(columns));
      if (polar.angles.size() >= static_cast<std::size_t>(most_rows))
        fail(line.number, "more than " + std::to_string(most_rows) + " rows");
      add_row(row, polar);
    }
    polars_.push_back(std::move(polar));
  }

  // ---- airfoil files of AeroDyn ----------------------------------------------------------------

  int integer_of(const Line& line, const char* key, int low, int high) const {
    const std::string_view word = line.words[0];
    int value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < low || value > high)
      fail(line.number, std::string(key) + ": expected an integer from " + std::to_string(low) +
                            " to " + std::to_string(high) + ", got " + quote(word));
    return value;
  }

  /// Reynolds number of a line `value Re`, in millions there; 0: not known.
  double reynolds_of(const Line& line) const {
    if (to_lower(line.words[0]).find("default") != std::string::npos) return 0.0;
    const std::optional<double> value = parse_usual_number(line.words[0]);
    if (!value || *value < 0.0)
      fail(line.number, "Re: expected a number >= 0, in millions, got " + quote(line.words[0]));
    return million * *value;
  }

  /// Reads the rows behind line `i` and returns the place of the last one.
  std::size_t read_rows(std::size_t i, PolarDefinition& polar) const {
    const Line& head = lines_[i];
    const int count = integer_of(head, "NumAlf", 1, most_rows);
    const std::string stated =
        "NumAlf in line " + std::to_string(head.number) + " states " + std::to_string(count);
    const auto ends = [&](int line, int found) {
      fail(line, "expected a row of the table: Alpha, Cl, Cd, Cm; hint: " + stated +
                     " rows, there are " + std::to_string(found));
    };
    for (int k = 0; k < count; ++k) {
      if (++i >= lines_.size()) ends(lines_.back().number, k);
      const std::vector<double> row = numbers_of(lines_[i]);
      if (row.size() < 3) ends(lines_[i].number, k);
      add_row(row, polar);
    }
    if (i + 1 < lines_.size() && numbers_of(lines_[i + 1]).size() >= 3)
      fail(lines_[i + 1].number, "one more row of the table; hint: " + stated + " rows");
    return i;
  }

  /// Reads as many tables as NumTabs states, as AeroDyn does; others may follow.
  void read_tables() {
    double reynolds = 0.0;
    int stated = 0;
    int stated_line = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const Line& line = lines_[i];
      const std::string key = key_of(line);
      if (key == "numtabs") {
        stated = integer_of(line, "NumTabs", 1, most_tables);
        stated_line = line.number;
      } else if (key == "re") {
        reynolds = reynolds_of(line);
      } else if (key == "numalf") {
        if (polars_.size() >= static_cast<std::size_t>(most_tables))
          fail(line.number, "more than " + std::to_string(most_tables) + " tables");
        PolarDefinition polar;
        polar.reynolds = reynolds;
        i = read_rows(i, polar);
        add_table(std::move(polar), line.number);
        reynolds = 0.0;
        if (static_cast<int>(polars_.size()) == stated) break;
      } else if (const std::size_t columns = numbers_of(line).size();
                 columns > 2 && columns == line.words.size()) {
        fail(line.number, "a row of numbers outside a table; hint: NumAlf stands above a table");
      }
    }
    if (stated > 0 && stated != static_cast<int>(polars_.size()))
      fail(stated_line, "NumTabs is " + std::to_string(stated) + ", the file has " +
                            std::to_string(polars_.size()) +
                            (polars_.size() == 1 ? " table" : " tables"));
    std::ranges::sort(polars_, {}, &PolarDefinition::reynolds);
  }

  /// Tables are told apart by their Reynolds number only.
  void add_table(PolarDefinition polar, int line) {
    for (const PolarDefinition& other : polars_)
      if (other.reynolds == polar.reynolds)
        fail(line,
             "a second table for the Reynolds number of another one; hint: keep the table of "
             "one control setting");
    polars_.push_back(std::move(polar));
  }

  std::string path_;
  std::vector<Line> lines_;
  std::vector<PolarDefinition> polars_;
};

}  // namespace

std::vector<PolarDefinition> parse_polars(const std::string& path, const std::string& text) {
  if (text.find('\0') != std::string::npos)
    throw InputError(path + ": not a plain text file; hint: UTF-16 must be saved as UTF-8");
  std::string_view rest = text;
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  return PolarReader(path, rest).read();
}

std::vector<PolarDefinition> read_polar_file(const std::string& path) {
  return parse_polars(path, read_whole_file(path, max_megabytes, "polar file"));
}

}  // namespace samara::io
