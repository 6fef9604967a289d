// Common parts of the readers of OpenFAST's files.
#pragma once

#include <memory>
#include <string>

#include "deck_import.hpp"
#include "openfast_deck.hpp"

namespace samara::decks {

struct OpenfastImport : DeckImport {
  using DeckImport::DeckImport;

  /// Adds a line to the report; the key counts as read.
  void say(Deck& deck, const std::string& key, Fate fate, const std::string& words);
  /// The same for the lines of a table.
  void say_line(const Deck& deck, int line, const std::string& key, Fate fate,
                const std::string& words) {
    report.push_back({deck.place(line), key, fate, words});
  }

  /// A number that stands in the case as it is.
  double take(Deck& deck, const std::string& key, const std::string& target);
  double derive(Deck& deck, const std::string& key, const std::string& words);
  void ignore(Deck& deck, const std::string& key, const std::string& why);
  /// An error where the key is there and the condition `holds` is false.
  void require(bool holds, Deck& deck, const std::string& key, const std::string& what);
  /// Reports the keys that nothing has read.
  void report_unused(Deck& deck);

  /// Opens another file; null, with an error, where it cannot be read.
  std::unique_ptr<Deck> open(const std::string& path);
};

}  // namespace samara::decks
