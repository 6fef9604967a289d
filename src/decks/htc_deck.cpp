#include "htc_deck.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/base/number.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::decks {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_megabytes = 64;
constexpr std::size_t most_files = 16;       ///< one inside the other
constexpr std::size_t most_blocks = 64;      ///< one inside the other
constexpr std::size_t most_lines = 2000000;  ///< of all files
constexpr int most_rows = 5000;              ///< of a table
constexpr double percent = 100.0;
constexpr double degree = std::numbers::pi / 180.0;

std::string read_text(const std::string& path) {
  std::string text = io::read_whole_file(path, max_megabytes, "deck");
  if (text.find('\0') != std::string::npos)
    throw InputError(path + ": not a plain text file; hint: UTF-16 must be saved as UTF-8");
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  return text;
}

/// Lines end with LF, CR LF or CR.
std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r' || text[i] == '\n') {
      if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') ++i;
      lines.push_back(std::exchange(line, {}));
    } else {
      line += text[i];
    }
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

bool ends_with_line(const std::string& text) {
  return text.empty() || text.back() == '\n' || text.back() == '\r';
}

/// Words between blanks and commas; quotes hold one together.
std::vector<std::string> split_words(const std::string& line) {
  std::vector<std::string> words;
  std::size_t i = 0;
  while (i < line.size()) {
    const char c = line[i];
    if (std::isspace(static_cast<unsigned char>(c)) != 0 || c == ',') {
      ++i;
    } else if (c == '"' || c == '\'') {
      const std::size_t stop = std::min(line.find(c, i + 1), line.size());
      words.push_back(line.substr(i + 1, stop - i - 1));
      i = stop + 1;
    } else {
      const std::size_t stop = std::min(line.find_first_of(" \t\f\v,\"'", i), line.size());
      words.push_back(line.substr(i, stop - i));
      i = stop;
    }
  }
  return words;
}

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
      const std::string text = read_text(path_);
      ends_with_line_ = decks::ends_with_line(text);
      lines_ = split_lines(text);
    } catch (const InputError& error) {
      errors_.add_message(error.what());
    }
    next_ = 0;
    skip_blank();
  }

  bool at_end() const { return next_ >= lines_.size(); }
  int line() const { return static_cast<int>(next_) + 1; }
  std::string place() const {
    return path_ + ":" +
           std::to_string(
               std::min<std::size_t>(next_ + 1, std::max<std::size_t>(lines_.size(), 1)));
  }
  const std::string& text() const { return lines_[next_]; }
  std::vector<std::string> words() const { return split_words(lines_[next_]); }
  void advance() {
    ++next_;
    skip_blank();
  }
  /// The line before is the end of a file without a final newline.
  bool is_open() const { return at_end() && !ends_with_line_; }
  DeckErrors& errors() { return errors_; }
  const std::string& path() const { return path_; }

  /// `count` integers at the beginning of a line, which is passed.
  std::optional<std::vector<int>> integers(std::size_t count, const std::string& what) {
    if (at_end()) {
      errors_.add(path_, "the file ends where " + what + " should follow; hint: it may be cut off");
      return {};
    }
    const std::vector<std::string> all = words();
    std::vector<int> values;
    for (std::size_t i = 0; i < count; ++i) {
      const std::optional<int> value =
          i < all.size() ? parse_integer(all[i]) : std::optional<int>();
      if (!value || *value < 0) {
        errors_.add(place(), "expected " + what + ", got \"" + text().substr(0, 40) + "\"");
        return {};
      }
      values.push_back(*value);
    }
    advance();
    return values;
  }

  /// `count` numbers at the beginning of a line, which is passed.
  std::optional<std::vector<double>> numbers(std::size_t count, const std::string& what) {
    if (at_end()) {
      errors_.add(path_, "the file ends where " + what + " should follow; hint: it may be cut off");
      return {};
    }
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
  void skip_blank() {
    while (next_ < lines_.size() && lines_[next_].find_first_not_of(" \t\f\v") == std::string::npos)
      ++next_;
  }

  std::string path_;
  DeckErrors& errors_;
  std::vector<std::string> lines_;
  std::size_t next_ = 0;
  bool ends_with_line_ = true;
};

/// The integers behind a mark, "#1" or "$2 26"; blanks may follow the mark.
std::vector<int> integers_behind(const std::string& line, std::size_t mark) {
  std::vector<int> values;
  for (const std::string& word : split_words(line.substr(mark + 1))) {
    const std::optional<int> value = parse_integer(word);
    if (!value) break;
    values.push_back(*value);
  }
  return values;
}

}  // namespace

std::string fold_word(const std::string& word) {
  std::string folded = word;
  for (char& c : folded) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return folded;
}

const HtcCommand* HtcBlock::find(const std::string& wanted, const std::string& other) const {
  const auto found = std::find_if(commands.rbegin(), commands.rend(), [&](const auto& command) {
    return command.name == wanted || (!other.empty() && command.name == other);
  });
  return found == commands.rend() ? nullptr : &*found;
}

const HtcBlock* HtcBlock::find_block(const std::string& wanted) const {
  const auto found = std::ranges::find(blocks, wanted, &HtcBlock::name);
  return found == blocks.end() ? nullptr : &*found;
}

HtcDeck::HtcDeck(std::string path, DeckErrors& errors) : path_(std::move(path)), errors_(errors) {
  root_.place = path_;
  // Pointers to open blocks stay valid: only the innermost open block gets new members.
  std::vector<HtcBlock*> open{&root_};
  read(path_, open);
}

void HtcDeck::read(const std::string& path, std::vector<HtcBlock*>& open) {
  const std::string text = read_text(path);
  const std::vector<std::string> lines = split_lines(text);
  const std::size_t outer = open.size();
  reading_.push_back(path);
  bool has_exit = false;
  for (std::size_t i = 0; i < lines.size() && !has_exit; ++i) {
    if (++lines_ > most_lines) {
      errors_.add(path, "the deck has more than " + std::to_string(most_lines) + " lines");
      break;
    }
    const std::string place = path + ":" + std::to_string(i + 1);
    const std::size_t comment = lines[i].find(';');
    const std::vector<std::string> words = split_words(lines[i].substr(0, comment));
    if (words.empty()) continue;
    has_exit = fold_word(words[0]) == "exit";
    const bool is_cut = comment == std::string::npos && i + 1 == lines.size() &&
                        !decks::ends_with_line(text) && !has_exit;
    if (is_cut)
      errors_.add(place, "the file ends inside this line; hint: a command ends with \";\"");
    else if (!has_exit)
      take_line(place, words, open, outer);
  }
  while (open.size() > outer) {
    errors_.add(open.back()->place, "begin " + open.back()->name +
                                        ": its end is missing; hint: the file may be cut off");
    open.pop_back();
  }
  if (!has_exit) without_exit_.push_back(path);
  reading_.pop_back();
}

void HtcDeck::take_line(const std::string& place, const std::vector<std::string>& words,
                        std::vector<HtcBlock*>& open, std::size_t outer) {
  const std::string first = fold_word(words[0]);
  if (first == "begin") {
    if (words.size() < 2) {
      errors_.add(place, "begin: the name of the block is missing");
      return;
    }
    if (open.size() > most_blocks)
      throw InputError(place + ": more than " + std::to_string(most_blocks) +
                       " blocks one inside the other");
    HtcBlock block;
    block.name = fold_word(words[1]);
    block.place = place;
    open.back()->blocks.push_back(std::move(block));
    open.push_back(&open.back()->blocks.back());
    return;
  }
  if (first == "end") {
    end_block(place, words, open, outer);
    return;
  }
  if (first == "continue_in_file") {
    if (words.size() < 2) {
      errors_.add(place, "continue_in_file: the name of the file is missing");
      return;
    }
    const std::string next = find_file(words[1], place);
    if (next.empty()) return;
    const bool is_open = std::ranges::any_of(
        reading_, [&](const std::string& other) { return io::is_same_file(other, next); });
    if (is_open || reading_.size() >= most_files) {
      errors_.add(place, "continue_in_file: " + words[1] +
                             (is_open ? ": the file continues in itself"
                                      : ": more than " + std::to_string(most_files) +
                                            " files one inside the other"));
      return;
    }
    try {
      read(next, open);
    } catch (const InputError& error) {
      errors_.add_message(error.what());
    }
    return;
  }
  HtcCommand command;
  command.name = first;
  command.words.assign(words.begin() + 1, words.end());
  command.place = place;
  open.back()->commands.push_back(std::move(command));
}

void HtcDeck::end_block(const std::string& place, const std::vector<std::string>& words,
                        std::vector<HtcBlock*>& open, std::size_t outer) {
  const std::string name = words.size() < 2 ? std::string() : fold_word(words[1]);
  if (open.size() <= outer) {
    errors_.add(place, "end " + name + ": no block has begun in this file");
    return;
  }
  if (name.empty() || open.back()->name == name) {
    open.pop_back();
    return;
  }
  errors_.add(place, "end " + name + ": the open block is " + open.back()->name + ", begun at " +
                         open.back()->place);
  const auto known = std::find_if(open.rbegin(), open.rend() - static_cast<std::ptrdiff_t>(outer),
                                  [&](const HtcBlock* block) { return block->name == name; });
  if (known != open.rend() - static_cast<std::ptrdiff_t>(outer))
    open.resize(open.size() - static_cast<std::size_t>(known - open.rbegin()) - 1);
}

std::string HtcDeck::find_file(const std::string& name, const std::string& place) {
  std::string plain = name;
  std::ranges::replace(plain, '\\', '/');
  const auto known = std::ranges::find_if(
      found_, [&](const FoundFile& file) { return file.name == name && file.place == place; });
  if (known != found_.end()) return known->path;
  const fs::path folder = io::folder_of(path_);
  std::error_code ignored;
  const std::array<fs::path, 2> bases{folder, folder / ".."};
  for (const bool any_case : {false, true})
    for (std::size_t i = 0; i < bases.size(); ++i) {
      fs::path full = fs::path(plain).is_absolute() ? fs::path(plain) : bases[i] / plain;
      std::string path = full.lexically_normal().string();
      if (any_case) path = find_in_other_case(path);
      if (path.empty() || !fs::is_regular_file(path, ignored)) continue;
      found_.push_back({place, name, path, i == 1 && !fs::path(plain).is_absolute(), any_case});
      return path;
    }
  errors_.add(place, name + ": there is no such file, neither from the folder of " +
                         fs::path(path_).filename().string() + " nor from the one above");
  return "";
}

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
    const std::string& line = text.text();
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
        errors.add(text.place(), "expected \"$subset rows\", got \"" + line.substr(0, 40) + "\"");
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
