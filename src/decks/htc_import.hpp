// Common parts of the readers of HAWC2's decks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deck_import.hpp"
#include "htc_deck.hpp"

namespace samara::decks {

struct HtcImport : DeckImport {
  HtcImport(const std::string& path, const ImportOptions& given)
      : DeckImport(given), deck(path, errors) {}

  HtcDeck deck;

  /// Adds a line to the report; the command counts as read. `owner` stands before its name.
  void say(const std::string& owner, const HtcCommand& command, Fate fate,
           const std::string& words) {
    command.used = true;
    report.push_back(
        {command.place, owner.empty() ? command.name : owner + "." + command.name, fate, words});
  }
  /// The same for a block, with all that is in it.
  void say(const HtcBlock& block, const std::string& name, Fate fate, const std::string& words) {
    block.used = true;
    if (fate == Fate::ignored) use_all(block);
    report.push_back({block.place, name, fate, words});
  }
  /// Counts all commands of a block as read.
  static void use_all(const HtcBlock& block);

  /// A number of a command; none, with an error, where it is missing or no number.
  std::optional<double> number(const HtcCommand& command, std::size_t index);
  /// The same of an integer in a range.
  std::optional<int> integer(const HtcCommand& command, std::size_t index, int low, int high);
  /// `count` numbers from `first` on.
  std::optional<std::vector<double>> numbers(const HtcCommand& command, std::size_t first,
                                             std::size_t count);
  /// A word of a command; empty, with an error, where it is missing.
  std::string word(const HtcCommand& command, std::size_t index, const std::string& what);
  /// A command that must be there; null, with an error, where it is not.
  const HtcCommand* require(const HtcBlock& block, const std::string& name,
                            const std::string& other = {});
};

}  // namespace samara::decks
