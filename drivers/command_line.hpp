// Parsed command line, and the help texts of the program.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "samara/decks/import.hpp"
#include "samara/simulation/validation.hpp"

#include "job.hpp"

namespace samara::drivers {

struct CommandLine;

/// A sub-command. One with `formats` reads the deck of another program, not a case; one with
/// `most_results` reads results.
struct Command {
  const char* name = nullptr;
  const char* summary = nullptr;
  const char* description = nullptr;  ///< of its --help, whole lines
  const char* example = nullptr;      ///< the arguments of a command line that works
  bool writes_result = false;         ///< also without -o
  bool has_csv = false;
  bool lists_modes = false;
  /// For which a case must be valid before anything is solved.
  simulation::Analysis analysis = simulation::Analysis::check;
  void (*run)(const Job&) = nullptr;
  std::string (*print)() = nullptr;  ///< instead of all else: it takes no operand
  const char* formats = nullptr;     ///< of decks, with bars between: the word before the path
  void (*convert)(const CommandLine&) = nullptr;  ///< instead of `run`
  int most_results = 0;                           ///< that it reads at once
};

enum class Request { run, help, solver_options, version, print };

struct CommandLine {
  Request request = Request::run;
  const Command* command = nullptr;  ///< null only for --help and --version of the program
  std::string text;                  ///< as typed, quoted for a shell
  std::string format;                ///< of a deck
  std::string case_path;             ///< or the deck, or the first result
  std::vector<std::string> more_results;
  decks::ImportOptions import;
  std::string import_option;  ///< the first that is given of the above; empty: none
  std::string windio_option;  ///< the last of these that only windIO has; empty: none
  bool report = false;        ///< is wanted, if need be without a case
  bool all_modes = false;
  int first_modes = 0;  ///< rows of a table of modes; 0: all
  bool parked = false;
  std::vector<std::string> settings;
  std::string result_path;   ///< of what is written; empty: not given
  std::string csv_path;      ///< empty: none wanted
  std::string restart_path;  ///< of a result to go on from; empty: not given
  std::vector<std::string> petsc_options;
};

/// Everything with one dash that is not -o, with its value, belongs to PETSc.
/// @throws InputError with a suggestion
CommandLine parse_command_line(const std::vector<std::string>& arguments,
                               std::span<const Command> commands);

/// The text of --help, of the program or of one command.
std::string help_text(const CommandLine& line, std::span<const Command> commands);

}  // namespace samara::drivers
