// The text files of OpenFAST: a value, then the name of its key, then a description; tables with a
// line of column names. Everything is found by its name. OpenFAST itself goes by the order of the
// lines; a key with another spelling is therefore found between its neighbours.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "samara/base/number.hpp"
#include "samara/math/types.hpp"

#include "deck_text.hpp"

namespace samara::decks {

struct DeckWord {
  std::string text;
  bool quoted = false;
  bool comma = false;  ///< a comma follows
};

struct DeckEntry {
  std::string key;  ///< as written; empty where a value stands alone
  std::vector<DeckWord> values;
  int line = 0;
  bool used = false;
  bool is_free_text = false;  ///< nothing separates the key from the words behind it
};

/// Rows of numbers under a line of names.
struct DeckTable {
  int line = 0;                              ///< of the names
  std::vector<std::string> names;            ///< as written
  std::vector<std::vector<double>> columns;  ///< the requested ones, in the requested order
  std::vector<int> lines;                    ///< of the rows
};

/// A row of numbers of the body of BeamDyn's blade file.
struct DeckRow {
  int line = 0;
  std::vector<double> numbers;
};

class Deck {
 public:
  /// @throws InputError where the file cannot be read or is no text
  Deck(std::string path, DeckErrors& errors);

  const std::string& path() const { return path_; }
  const std::string& title() const { return title_; }
  std::string place(int line) const { return path_ + ":" + std::to_string(line); }
  std::string place_of(const std::string& key) const;

  /// The keys of this kind of file in their order: one that is not found by its name is the line
  /// between its neighbours.
  void set_order(const std::vector<std::string>& keys);
  /// Of a key that one kind of file has several times, the `number`-th counts, from 0.
  void choose(const std::string& key, std::size_t number);
  /// Keys are compared without case, and `Key(1)` is `Key1`.
  bool has(const std::string& key) const;
  /// Counts the line of the key as read.
  void mark_used(const std::string& key);
  /// Keys found by their place: the requested name, and the line.
  struct FoundByPlace {
    std::string key;
    const DeckEntry* entry = nullptr;
  };
  std::vector<FoundByPlace> found_by_place() const;
  /// First value of the key; a missing key is an error.
  double number(const std::string& key);
  int integer(const std::string& key, int low, int high);
  bool flag(const std::string& key);
  std::string text(const std::string& key);
  /// The same where the key may be missing.
  double number_or(const std::string& key, double value);
  /// The same where it may be missing or `default`.
  double number_or_default(const std::string& key, double value);
  bool flag_or_default(const std::string& key, bool value);
  bool flag_or(const std::string& key, bool value);
  /// The path of a file, relative to this one; an error where there is none.
  std::string file(const std::string& key);
  /// The same, empty where there is none.
  std::string find_file(const std::string& key);
  /// The same of a name in a line without a key of its own; `key` is its name in errors.
  std::string file_named(const std::string& name, int line, const std::string& key);
  /// Three numbers, of one key, or of three with x, y and z before the `ending` of their names.
  Vector3 point(const std::string& key, const std::string& ending);
  Vector3 three_numbers(const std::string& key);

  /// The table whose heading has most of `names`; it has `count` rows, as the key `count_key`
  /// states.
  DeckTable table(const std::vector<std::string>& names, int count, const std::string& count_key);
  /// The heading (a line of dashes) that has this word, without case; 0 where there is none.
  int find_heading(const std::string& word) const;
  /// True where `line` is the last line and the file ends inside it: a number may be cut off.
  bool ends_inside(int line) const {
    return !ends_with_line_ && line == static_cast<int>(lines_.size());
  }
  /// The leading numbers of the next `count` lines behind a key, headings skipped.
  std::vector<std::vector<double>> rows_behind(const std::string& key, int count) const;
  /// The first words of `count` lines from that of a key on, headings and empty lines skipped.
  struct Word {
    int line = 0;
    std::string text;
  };
  std::vector<Word> first_words(const std::string& key, int count) const;
  /// Rows of one or six numbers behind a line, to the end of the file.
  std::vector<DeckRow> rows_after(int line);

  const std::vector<DeckEntry>& entries() const { return entries_; }
  DeckErrors& errors() { return errors_; }

 private:
  DeckEntry* find(const std::string& key, bool required);
  bool is_default(const std::string& key);
  std::string full_path(std::string name) const;
  void parse_line(int number);
  const std::vector<std::size_t>& places_of(const std::string& key) const;
  std::vector<std::size_t> named_so(const std::string& key) const;
  std::optional<std::size_t> between_neighbours(const std::string& key) const;

  std::string path_;
  DeckErrors& errors_;
  std::string title_;
  std::vector<std::vector<DeckWord>> lines_;  ///< from line 1
  std::vector<DeckEntry> entries_;
  using Index = std::unordered_map<std::string, std::vector<std::size_t>>;
  Index index_;                     ///< of entries, by name
  Index free_text_;                 ///< the same of those in free text
  std::vector<std::string> order_;  ///< of keys, without case
  mutable Index by_place_;          ///< entries found between neighbours; empty: none
  bool ends_with_line_ = true;
};

}  // namespace samara::decks
