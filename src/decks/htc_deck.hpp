// HAWC2's input file (.htc): blocks of commands, perhaps continued in other files; and the tables
// that it names (.st, .ae, .pc).
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "openfast_deck.hpp"

namespace samara::decks {

/// A line `name words ;`.
struct HtcCommand {
  std::string name;                ///< in lower case
  std::vector<std::string> words;  ///< behind the name, as written
  std::string place;               ///< file and line
  mutable bool used = false;
};

/// `begin name ;` to `end name ;`.
struct HtcBlock {
  std::string name;  ///< in lower case; empty: the whole deck
  std::string place;
  std::vector<HtcCommand> commands;  ///< in their order
  std::vector<HtcBlock> blocks;      ///< in their order
  mutable bool used = false;

  /// The last command of this name, which HAWC2 takes, or of its other name; null: there is none.
  const HtcCommand* find(const std::string& name, const std::string& other = {}) const;
  const HtcBlock* find_block(const std::string& name) const;
};

class HtcDeck {
 public:
  /// @throws InputError where the main file cannot be read or is no text; other faults are added to
  /// `errors`
  HtcDeck(std::string path, DeckErrors& errors);

  const std::string& path() const { return path_; }
  const HtcBlock& root() const { return root_; }
  /// Files that end without `exit`.
  const std::vector<std::string>& without_exit() const { return without_exit_; }

  /// The path of a file as a command names it, relative to the folder of the main file or to the
  /// one above, from which HAWC2 usually runs. Empty, with an error, where there is none.
  std::string find_file(const std::string& name, const std::string& place);

  /// A file that a command names.
  struct FoundFile {
    std::string place;  ///< of the command
    std::string name;   ///< as written
    std::string path;
    bool is_above = false;          ///< found from the folder above that of the main file
    bool is_in_other_case = false;  ///< its name differs by upper and lower case
  };
  const std::vector<FoundFile>& found_files() const { return found_; }

 private:
  void read(const std::string& path, std::vector<HtcBlock*>& open);
  void take_line(const std::string& place, const std::vector<std::string>& words,
                 std::vector<HtcBlock*>& open, std::size_t outer);
  void end_block(const std::string& place, const std::vector<std::string>& words,
                 std::vector<HtcBlock*>& open, std::size_t outer);

  std::string path_;
  DeckErrors& errors_;
  HtcBlock root_;
  std::vector<std::string> reading_;  ///< files that are being read, the main file first
  std::vector<std::string> without_exit_;
  std::vector<FoundFile> found_;
  std::size_t lines_ = 0;
};

/// Lower case.
std::string fold_word(const std::string& word);

/// A table of sections: 19 columns, or 30 with a full stiffness matrix (`full`).
struct StTable {
  static constexpr std::size_t classic_columns = 19;
  static constexpr std::size_t full_columns = 30;

  std::string path;
  bool full = false;
  std::vector<std::vector<double>> rows;
  std::vector<int> lines;
  bool is_open = false;  ///< its last row is the end of a file without a final newline

  std::string place(std::size_t row) const { return path + ":" + std::to_string(lines[row]); }
};

/// The rows of a set and its subset, `set 1 2`. No rows, with an error, where they are not there.
StTable read_st(const std::string& path, int set, int subset, bool full, DeckErrors& errors);

struct AeRow {
  double r = 0.0;          ///< along the half-chord line [m]
  double chord = 0.0;      ///< [m]
  double thickness = 0.0;  ///< relative to the chord
  int set = 1;             ///< of the polars
  int line = 0;
};

std::vector<AeRow> read_ae(const std::string& path, int set, DeckErrors& errors);

struct PcPolar {
  double thickness = 0.0;      ///< relative to the chord
  std::vector<double> angles;  ///< [rad]
  std::vector<double> lift;
  std::vector<double> drag;
  std::vector<double> moment;
  int line = 0;
};

/// The polars of the sets that are asked for, by their numbers.
std::map<int, std::vector<PcPolar>> read_pc(const std::string& path, const std::vector<int>& sets,
                                            DeckErrors& errors);

}  // namespace samara::decks
