// Common data of the readers of decks: the case under construction, the report, the errors.
#pragma once

#include <string>
#include <vector>

#include "samara/decks/import.hpp"
#include "samara/io/case_text.hpp"

#include "deck_text.hpp"

namespace samara::decks {

struct DeckImport {
  explicit DeckImport(const ImportOptions& given) : options(given) {}

  ImportOptions options;
  DeckErrors errors;
  model::TurbineDefinition turbine;
  model::OperatingPointsDefinition operation;
  io::CaseComments comments;
  std::vector<ImportLine> report;
  std::vector<std::string> warnings;

  /// The comment behind a key of the case.
  void note(const std::string& key, const std::string& words) { comments.keys[key] = words; }
  /// Adds a warning on standard error about a fact that the user would not expect.
  void warn(const std::string& place, const std::string& words) {
    warnings.push_back(place + ": " + words);
  }
};

}  // namespace samara::decks
