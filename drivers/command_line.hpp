// Parsed command line, and the help texts of the program.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "samara/decks/import.hpp"
#include "samara/simulation/validation.hpp"

#include "job.hpp"

namespace samara::drivers {

struct CommandLine;

/// A sub-command. With `formats` it reads the deck of another program instead of a case; with
/// `most_results` it reads results.
struct Command {
  const char* name = nullptr;
  const char* summary = nullptr;
  const char* description = nullptr;  ///< text of its --help, whole lines
  const char* example = nullptr;      ///< arguments of a valid command line
  bool writes_result = false;         ///< also without -o
  bool has_csv = false;
  bool lists_modes = false;
  bool has_sweep = false;
  /// The case must be valid for this analysis before anything is solved.
  simulation::Analysis analysis = simulation::Analysis::check;
  void (*run)(const Job&) = nullptr;
  std::string (*print)() = nullptr;  ///< prints a text and does nothing else; no operand
  const char* formats = nullptr;  ///< formats of decks, separated by bars: the word before the path
  void (*convert)(const CommandLine&) = nullptr;  ///< instead of `run`
  /// The words that hand_over takes; null: all.
  bool (*hands_over)(const std::vector<std::string>&) = nullptr;
  /// Takes all further words; nothing is parsed. @throws InputError
  void (*hand_over)(const std::vector<std::string>&) = nullptr;
  int most_results = 0;  ///< number of results that it reads at once, at most
};

enum class Request { run, help, solver_options, version, print };

struct CommandLine {
  Request request = Request::run;
  const Command* command = nullptr;  ///< null only for --help and --version of the program
  std::string text;                  ///< as typed, quoted for a shell
  std::string format;                ///< format of a deck
  std::string case_path;             ///< path of the case, of the deck, or of the first result
  std::vector<std::string> more_results;
  decks::ImportOptions import;
  std::string import_option;  ///< first given option of the import; empty: none
  std::string windio_option;  ///< last given option that only windIO has; empty: none
  std::string speed_option;   ///< --rotor-speed-rpm, which windIO and HAWC2 have; empty: not given
  bool report = false;        ///< --report: print the report, even without a case file
  bool all_modes = false;
  bool air_part = false;
  int first_modes = 0;      ///< rows of a table of modes; 0: all
  std::string sensitivity;  ///< patterns of keys, separated by commas
  bool parked = false;
  std::vector<std::string> settings;
  std::string result_path;         ///< path of the output; empty: not given
  std::string csv_path;            ///< empty: no table
  std::string restart_path;        ///< path of a result to continue; empty: not given
  std::vector<std::string> sweep;  ///< keys and values; empty: not given
  std::optional<int> bands;        ///< crossings that are searched; none: not given
  std::vector<std::string> petsc_options;
};

/// Every argument with one dash except -o belongs to PETSc, with its value.
/// @throws InputError with a suggestion
CommandLine parse_command_line(const std::vector<std::string>& arguments,
                               std::span<const Command> commands);

/// The words, with a text between each two.
std::string join(const std::vector<std::string>& words, const std::string& between);

/// The text of --help, of the program or of one command.
std::string help_text(const CommandLine& line, std::span<const Command> commands);

}  // namespace samara::drivers
