// HAWC2's input file (.htc): blocks of commands, perhaps continued in other files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "deck_text.hpp"

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

/// Words between blanks and commas; quotes hold one together.
std::vector<std::string> split_htc_words(std::string_view line);

}  // namespace samara::decks
