// samara import: converts the deck of another program to a case file.
#include "samara/decks/import.hpp"

#include <array>
#include <filesystem>
#include <iostream>

#include "samara/base/error.hpp"

#include "commands.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

/// The lines with the same fate, in the order of the deck.
std::string report_table(const decks::Import& import, decks::Fate fate) {
  Table table;
  table.add_column("file", "", Align::left);
  table.add_column("key", "", Align::left);
  table.add_column("", "", Align::left);
  int rows = 0;
  for (const decks::ImportLine& line : import.report) {
    if (line.fate != fate) continue;
    table.add_row({std::filesystem::path(line.place).filename().string(), line.key, line.words});
    ++rows;
  }
  return rows == 0 ? "none\n" : table.text();
}

}  // namespace

void run_import(const CommandLine& line) {
  if (!line.result_path.empty()) decks::require_case_path(line.result_path);
  const decks::Import import =
      line.format == "openfast" ? decks::import_openfast(line.case_path, line.import)
      : line.format == "windio" ? decks::import_windio(line.case_path, line.import)
                                : decks::import_hawc2(line.case_path, line.import);
  if (!line.result_path.empty()) decks::write_case(line.result_path, import);
  for (const std::string& warning : import.warnings) std::cerr << warning << "\n";
  constexpr std::array<std::pair<const char*, decks::Fate>, 3> blocks{
      {{"taken: the value is in the case", decks::Fate::taken},
       {"derived: the case has values that follow from it", decks::Fate::derived},
       {"ignored: the case has nothing from it", decks::Fate::ignored}}};
  for (const auto& [title, fate] : blocks)
    std::cout << title << "\n\n" << report_table(import, fate) << "\n";
  if (!line.result_path.empty()) std::cout << "case: " << line.result_path << "\n";
}

}  // namespace samara::drivers
