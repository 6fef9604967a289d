#include "openfast_deck.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"

namespace samara::decks {
namespace {

namespace fs = std::filesystem;

/// The name of a key as it is compared: lower case, without parentheses.
std::string fold(const std::string& key) {
  std::string folded;
  for (const char c : key)
    if (c != '(' && c != ')') folded += to_lower(c);
  return folded;
}

bool is_key(const std::string& word) {
  if (word.empty() || (std::isalpha(static_cast<unsigned char>(word[0])) == 0)) return false;
  return std::all_of(word.begin(), word.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '(' || c == ')';
  });
}

/// The flag that a word states; such words cannot be keys.
std::optional<bool> parse_flag(const std::string& word) {
  const std::string folded = fold(word);
  if (folded == "true" || folded == "t" || folded == ".true.") return true;
  if (folded == "false" || folded == "f" || folded == ".false.") return false;
  return {};
}

/// A flag as Fortran reads it: T or F, perhaps behind a point; further letters have no effect.
std::optional<bool> parse_fortran_flag(const std::string& word) {
  const std::size_t first = word.starts_with('.') ? 1 : 0;
  if (word.size() == first) return {};
  const char c = to_lower(word[first]);
  if (c != 't' && c != 'f') return {};
  return c == 't';
}

/// Lines that hold no values: rules, headings, comments.
bool is_heading(const std::string& word) {
  return word.starts_with("--") || word.starts_with("==") || word.starts_with("!") ||
         word.starts_with("#") || word.starts_with("%");
}

std::vector<DeckWord> split(std::string_view line) {
  std::vector<DeckWord> words;
  std::size_t i = 0;
  while (i < line.size()) {
    const char c = line[i];
    if (c == ' ' || c == '\t' || c == '\f' || c == '\v') {
      ++i;
    } else if (c == ',') {
      if (!words.empty()) words.back().comma = true;
      ++i;
    } else if (c == '"' || c == '\'') {
      const std::size_t end = line.find(c, i + 1);
      const std::size_t stop = end == std::string_view::npos ? line.size() : end;
      words.push_back({std::string(line.substr(i + 1, stop - i - 1)), true, false});
      i = stop + 1;
    } else {
      const std::size_t end = line.find_first_of(" \t\f\v,\"", i);
      const std::size_t stop = end == std::string_view::npos ? line.size() : end;
      words.push_back({std::string(line.substr(i, stop - i)), false, false});
      i = stop;
    }
  }
  return words;
}

std::string got(const std::string& word) { return ", got \"" + word + "\""; }

}  // namespace

Deck::Deck(std::string path, DeckErrors& errors) : path_(std::move(path)), errors_(errors) {
  const std::string text = read_deck_text(path_);
  ends_with_line_ = decks::ends_with_line(text);
  const std::vector<std::string_view> lines = split_lines(text);
  bool in_output_list = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines_.push_back(split(lines[i]));
    const std::vector<DeckWord>& words = lines_.back();
    if (words.empty()) continue;
    // The second line is free text; it could look like a key.
    if (i == 1 && is_heading(lines_[0].empty() ? "" : lines_[0][0].text)) {
      const bool could_be_value =
          words[0].quoted || parse_number(words[0].text) || parse_flag(words[0].text);
      if (!could_be_value) {
        if (!is_heading(words[0].text)) title_ = lines[i].substr(lines[i].find_first_not_of(" \t"));
        continue;
      }
    }
    if (in_output_list) {
      in_output_list = fold(words[0].text) != "end";
      continue;
    }
    if (!words[0].quoted && fold(words[0].text) == "outlist") {
      in_output_list = true;
      continue;
    }
    parse_line(static_cast<int>(i + 1));
  }
}

void Deck::parse_line(int number) {
  const std::vector<DeckWord>& words = lines_[static_cast<std::size_t>(number - 1)];
  if (!words[0].quoted && is_heading(words[0].text)) return;
  DeckEntry entry;
  entry.line = number;
  entry.values.push_back(words[0]);
  std::size_t i = 1;
  while (i < words.size() && (words[i].quoted || words[i - 1].comma ||
                              parse_number(words[i].text) || parse_flag(words[i].text)))
    entry.values.push_back(words[i++]);
  const bool starts_with_value =
      words[0].quoted || parse_number(words[0].text) || parse_flag(words[0].text);
  if (i < words.size() && !words[i].quoted && is_key(words[i].text)) {
    entry.key = words[i].text;
    if (const bool ends = words[i++].comma || i == words.size(); !ends) {
      const char c = words[i].text.empty() ? ' ' : words[i].text[0];
      entry.is_free_text = !words[i].quoted && c != '-' && c != '!' && c != '#' && c != '(' &&
                           c != '{' && c != '[' && c != ':' && c != '=';
    }
    if (entry.is_free_text && !starts_with_value) return;
  } else {  // perhaps a value without the name of its key
    if (!starts_with_value || entry.values.size() != 1) return;
    entry.is_free_text = true;
  }
  if (!entry.key.empty())
    (entry.is_free_text ? free_text_ : index_)[fold(entry.key)].push_back(entries_.size());
  entries_.push_back(std::move(entry));
}

void Deck::set_order(const std::vector<std::string>& keys) {
  for (const std::string& key : keys) order_.push_back(fold(key));
}

void Deck::choose(const std::string& key, std::size_t number) {
  for (Index* index : {&index_, &free_text_})
    if (const auto found = index->find(fold(key));
        found != index->end() && number < found->second.size())
      found->second = {found->second[number]};
}

std::vector<std::size_t> Deck::named_so(const std::string& folded) const {
  for (const Index* index : {&index_, &free_text_})
    if (const auto found = index->find(folded); found != index->end()) return found->second;
  return {};
}

std::optional<std::size_t> Deck::between_neighbours(const std::string& folded) const {
  const auto self = std::find(order_.begin(), order_.end(), folded);
  if (self == order_.end()) return {};
  int first = 0;
  int last = static_cast<int>(lines_.size()) + 1;
  std::vector<std::string> missing{folded};
  for (auto before = self; before != order_.begin();) {
    --before;
    if (const auto found = named_so(*before); !found.empty()) {
      first = entries_[found.front()].line;
      break;
    }
    missing.insert(missing.begin(), *before);
  }
  const auto at = static_cast<std::ptrdiff_t>(missing.size()) - 1;
  for (auto behind = self + 1; behind != order_.end(); ++behind) {
    if (const auto found = named_so(*behind); !found.empty()) {
      last = entries_[found.front()].line;
      break;
    }
    missing.push_back(*behind);
  }
  std::vector<std::size_t> unknown;
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (entries_[i].line > first && entries_[i].line < last &&
        std::find(order_.begin(), order_.end(), fold(entries_[i].key)) == order_.end())
      unknown.push_back(i);
  if (unknown.size() != missing.size()) return {};
  return unknown[static_cast<std::size_t>(at)];
}

const std::vector<std::size_t>& Deck::places_of(const std::string& key) const {
  const std::string folded = fold(key);
  for (const Index* index : {&index_, &free_text_, static_cast<const Index*>(&by_place_)})
    if (const auto found = index->find(folded); found != index->end()) return found->second;
  std::vector<std::size_t>& places = by_place_[folded];
  if (const std::optional<std::size_t> place = between_neighbours(folded)) places = {*place};
  return places;
}

std::vector<Deck::FoundByPlace> Deck::found_by_place() const {
  std::vector<FoundByPlace> found;
  for (const std::string& key : order_)
    if (const auto place = by_place_.find(key); place != by_place_.end())
      for (const std::size_t entry : place->second) found.push_back({key, &entries_[entry]});
  return found;
}

void Deck::mark_used(const std::string& key) {
  for (const std::size_t place : places_of(key)) entries_[place].used = true;
}

DeckEntry* Deck::find(const std::string& key, bool required) {
  DeckEntry* found = nullptr;
  for (const std::size_t at : places_of(key)) {
    DeckEntry& entry = entries_[at];
    if (found != nullptr) {
      errors_.add(place(entry.line), key + ": given twice, first in line " +
                                         std::to_string(found->line) + "; leave one of them out");
      continue;
    }
    found = &entry;
    found->used = true;
  }
  if (found == nullptr && required) errors_.add(path_, "missing key \"" + key + "\"");
  return found;
}

bool Deck::has(const std::string& key) const { return !places_of(key).empty(); }

std::string Deck::place_of(const std::string& key) const {
  const std::vector<std::size_t>& places = places_of(key);
  return places.empty() ? path_ : place(entries_[places.front()].line);
}

double Deck::number(const std::string& key) {
  const DeckEntry* entry = find(key, true);
  if (entry == nullptr) return 0.0;
  const DeckWord& word = entry->values[0];
  const std::optional<double> value = parse_number(word.text);
  if (!value) errors_.add(place(entry->line), key + ": expected a number" + got(word.text));
  if (value && entry->values.size() > 1)
    errors_.add(place(entry->line), key + ": expected one number, got " +
                                        std::to_string(entry->values.size()) + " values");
  return value.value_or(0.0);
}

int Deck::integer(const std::string& key, int low, int high) {
  const std::size_t before = has(key) ? 1 : 0;
  const double value = number(key);
  if (before == 0) return low;
  if (value >= low && value <= high && value == std::floor(value)) return static_cast<int>(value);
  errors_.add(place_of(key), key + ": expected an integer from " + std::to_string(low) + " to " +
                                 std::to_string(high) + got(find(key, true)->values[0].text));
  return low;
}

bool Deck::flag(const std::string& key) {
  const DeckEntry* entry = find(key, true);
  if (entry == nullptr) return false;
  const std::optional<bool> value = parse_fortran_flag(entry->values[0].text);
  if (!value)
    errors_.add(place(entry->line), key + ": expected True or False" + got(entry->values[0].text));
  return value.value_or(false);
}

std::string Deck::text(const std::string& key) {
  const DeckEntry* entry = find(key, true);
  return entry == nullptr ? "" : entry->values[0].text;
}

double Deck::number_or(const std::string& key, double value) {
  return has(key) ? number(key) : value;
}

bool Deck::flag_or(const std::string& key, bool value) { return has(key) ? flag(key) : value; }

bool Deck::is_default(const std::string& key) { return !has(key) || fold(text(key)) == "default"; }

double Deck::number_or_default(const std::string& key, double value) {
  return is_default(key) ? value : number(key);
}

bool Deck::flag_or_default(const std::string& key, bool value) {
  return is_default(key) ? value : flag(key);
}

std::string Deck::full_path(std::string name) const {
  if (name.empty()) return name;
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path path(name);
  const fs::path folder = fs::path(path_).parent_path();
  return (path.is_absolute() ? path : (folder / path)).lexically_normal().string();
}

std::string Deck::find_file(const std::string& key) {
  std::string full = has(key) ? full_path(text(key)) : std::string();
  std::error_code error;
  return fs::is_regular_file(full, error) ? full : std::string();
}

Vector3 Deck::point(const std::string& key, const std::string& ending) {
  const std::string whole = key + "_" + ending;
  if (!has(whole))
    return {number(key + "x" + ending), number(key + "y" + ending), number(key + "z" + ending)};
  return three_numbers(whole);
}

Vector3 Deck::three_numbers(const std::string& key) {
  const DeckEntry* entry = find(key, true);
  Vector3 point = Vector3::Zero();
  if (entry == nullptr) return point;
  bool is_whole = entry->values.size() == 3;
  for (std::size_t i = 0; i < 3 && is_whole; ++i) {
    const std::optional<double> value = parse_number(entry->values[i].text);
    is_whole = value.has_value();
    point(static_cast<Eigen::Index>(i)) = value.value_or(0.0);
  }
  if (!is_whole) errors_.add(place(entry->line), key + ": expected three numbers");
  return point;
}

std::string Deck::file(const std::string& key) {
  const DeckEntry* entry = find(key, true);
  return entry == nullptr ? "" : file_named(entry->values[0].text, entry->line, key);
}

std::string Deck::file_named(const std::string& name, int line, const std::string& key) {
  const std::string full = full_path(name);
  if (full.empty()) return full;
  std::error_code error;
  if (fs::exists(full, error)) return full;
  const std::string other = find_in_other_case(full);
  errors_.add(place(line), key + ": no such file " + full +
                               (other.empty() ? std::string()
                                              : "; hint: there is " + other +
                                                    ", upper and lower case are not the same "
                                                    "on this system"));
  return "";
}

int Deck::find_heading(const std::string& word) const {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i].empty() || !is_heading(lines_[i][0].text)) continue;
    for (const DeckWord& candidate : lines_[i])
      if (fold(candidate.text) == fold(word)) return static_cast<int>(i + 1);
  }
  return 0;
}

DeckTable Deck::table(const std::vector<std::string>& names, int count,
                      const std::string& count_key) {
  DeckTable table;
  table.columns.resize(names.size());
  // The line that has most of the names, for one of them could stand in a comment.
  std::size_t most = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    std::size_t matches = 0;
    for (const std::string& name : names)
      for (const DeckWord& word : lines_[i])
        if (fold(word.text) == fold(name)) {
          ++matches;
          break;
        }
    if (matches <= most) continue;
    most = matches;
    table.line = static_cast<int>(i + 1);
  }
  if (table.line == 0) {
    std::string words;
    for (const std::string& name : names) words += (words.empty() ? "" : ", ") + name;
    errors_.add(path_, "missing table with the columns " + words);
    return table;
  }
  const auto header = static_cast<std::size_t>(table.line - 1);
  for (const DeckWord& word : lines_[header]) {
    if (is_heading(word.text)) break;
    table.names.push_back(word.text);
  }
  std::vector<std::size_t> which;
  for (const std::string& name : names) {
    const auto found =
        std::find_if(table.names.begin(), table.names.end(),
                     [&](const std::string& word) { return fold(word) == fold(name); });
    if (found == table.names.end())
      errors_.add(place(table.line), "the table has no column \"" + name + "\"");
    else
      which.push_back(static_cast<std::size_t>(found - table.names.begin()));
  }
  if (which.size() < names.size()) return table;

  std::size_t i = header + 1;
  if (i < lines_.size() && !lines_[i].empty() && lines_[i][0].text.starts_with("(")) ++i;
  for (; i < lines_.size(); ++i) {
    const std::vector<DeckWord>& words = lines_[i];
    if (words.empty()) continue;
    const bool is_complete = static_cast<int>(table.lines.size()) >= count;
    if (!is_complete && words[0].text.starts_with("!")) continue;  // a comment between rows
    if (is_heading(words[0].text)) break;
    // A number and the name of its key: the table has ended.
    if (words.size() > 1 && is_key(words[1].text) && !parse_number(words[1].text)) break;
    if (is_complete && !parse_number(words[0].text)) break;
    const int line = static_cast<int>(i + 1);
    std::vector<double> row;
    std::string bad;
    for (std::size_t k = 0; k < table.names.size(); ++k) {
      const std::optional<double> value =
          k < words.size() ? parse_number(words[k].text) : std::nullopt;
      if (!value) {
        bad = k < words.size()
                  ? "column " + table.names[k] + ": expected a number" + got(words[k].text)
                  : "expected " + std::to_string(table.names.size()) +
                        " numbers in this row of the table, got " + std::to_string(words.size());
        break;
      }
      row.push_back(*value);
    }
    if (bad.empty() && words.size() > table.names.size() &&
        parse_number(words[table.names.size()].text))
      bad = "expected " + std::to_string(table.names.size()) +
            " numbers in this row of the table, got more";
    if (!bad.empty()) {
      errors_.add(place(line), bad);
      return table;
    }
    for (std::size_t c = 0; c < which.size(); ++c) table.columns[c].push_back(row[which[c]]);
    table.lines.push_back(line);
  }
  if (count >= 0 && static_cast<int>(table.lines.size()) != count)
    errors_.add(place(table.line), "the table has " + std::to_string(table.lines.size()) +
                                       " rows, " + count_key + " states " + std::to_string(count));
  return table;
}

std::vector<std::vector<double>> Deck::rows_behind(const std::string& key, int count) const {
  std::vector<std::vector<double>> rows;
  const std::vector<std::size_t>& places = places_of(key);
  if (places.empty()) return rows;
  for (auto i = static_cast<std::size_t>(entries_[places.front()].line);
       i < lines_.size() && static_cast<int>(rows.size()) < count; ++i) {
    if (lines_[i].empty() || is_heading(lines_[i][0].text)) continue;
    rows.emplace_back();
    for (const DeckWord& word : lines_[i]) {
      const std::optional<double> value = parse_number(word.text);
      if (!value) break;
      rows.back().push_back(*value);
    }
  }
  return rows;
}

std::vector<Deck::Word> Deck::first_words(const std::string& key, int count) const {
  std::vector<Word> found;
  const std::vector<std::size_t>& places = places_of(key);
  if (places.empty()) return found;
  for (auto i = static_cast<std::size_t>(entries_[places.front()].line) - 1;
       i < lines_.size() && static_cast<int>(found.size()) < count; ++i) {
    const std::vector<DeckWord>& words = lines_[i];
    if (words.empty() || (!words[0].quoted && is_heading(words[0].text))) continue;
    found.push_back({static_cast<int>(i + 1), words[0].text});
  }
  return found;
}

std::vector<DeckRow> Deck::rows_after(int line) {
  std::vector<DeckRow> rows;
  for (auto i = static_cast<std::size_t>(line); i < lines_.size(); ++i) {
    const std::vector<DeckWord>& words = lines_[i];
    if (words.empty() || is_heading(words[0].text)) continue;
    DeckRow row;
    row.line = static_cast<int>(i + 1);
    for (const DeckWord& word : words) {
      if (is_heading(word.text)) break;
      const std::optional<double> value = parse_number(word.text);
      if (!value) {
        // Text behind one or six numbers is a comment.
        const bool is_row = row.numbers.size() == 1 || row.numbers.size() == 6;
        const bool is_text = std::isalpha(static_cast<unsigned char>(word.text[0])) != 0;
        if (!is_row || !is_text) errors_.add(place(row.line), "expected a number" + got(word.text));
        break;
      }
      row.numbers.push_back(*value);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace samara::decks
