// samara import: the deck of another program as a case file.
#include "samara/io/import.hpp"

#include <array>
#include <filesystem>
#include <iostream>

#include "samara/base/error.hpp"

#include "commands.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

/// The lines of one fate, in the order of the deck.
std::string report_table(const io::Import& import, io::Fate fate) {
  Table table;
  table.add_column("file", "", Align::left);
  table.add_column("key", "", Align::left);
  table.add_column("", "", Align::left);
  int rows = 0;
  for (const io::ImportLine& line : import.report) {
    if (line.fate != fate) continue;
    table.add_row({std::filesystem::path(line.place).filename().string(), line.key, line.words});
    ++rows;
  }
  return rows == 0 ? "none\n" : table.text();
}

}  // namespace

void run_import(const CommandLine& line) {
  if (!line.result_path.empty()) io::require_case_path(line.result_path);
  const io::ImportOptions options{line.tower_only};
  const io::Import import = line.format == "openfast" ? io::import_openfast(line.case_path, options)
                                                      : io::import_windio(line.case_path, options);
  if (!line.result_path.empty()) io::write_case(line.result_path, import);
  constexpr std::array<std::pair<const char*, io::Fate>, 3> blocks{
      {{"taken: the value stands in the case", io::Fate::taken},
       {"derived: the case holds what follows from it", io::Fate::derived},
       {"ignored: the case holds nothing of it", io::Fate::ignored}}};
  for (const auto& [title, fate] : blocks)
    std::cout << title << "\n\n" << report_table(import, fate) << "\n";
  if (!line.result_path.empty()) std::cout << "case: " << line.result_path << "\n";
  std::cout << std::flush;
  if (!std::cout) throw InternalError("standard output cannot be written");
}

}  // namespace samara::drivers
