// The program samara: reads the command line and the case, runs the command, and ends with an exit
// code (docs/case_file.md).
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <sstream>

#include <fcntl.h>
#include <unistd.h>

#include "samara/base/error.hpp"
#include "samara/base/version.hpp"
#include "samara/io/case.hpp"
#include "samara/io/file_lock.hpp"
#include "samara/io/result_file.hpp"
#include "samara/io/result_reader.hpp"
#include "samara/io/schema.hpp"
#include "samara/petsc/blas_kernels.hpp"
#include "samara/petsc/session.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "interruption.hpp"
#include "solver_options.hpp"

namespace samara::drivers {
namespace {

using petsc::Session;

constexpr std::array<Command, 16> commands{{
    {.name = "check",
     .summary = "reports the model of a case: masses, sizes, unknowns; solves nothing",
     .description =
         "Reads a case and reports the model: masses and their centres, sizes, joints, the mesh\n"
         "and the number of unknowns. Solves nothing. A result is written only with -o.\n",
     .example = "inputs/lee2002/baseline.yaml",
     .run = run_check},
    {.name = "static",
     .summary = "the turbine or beam at rest under gravity and loads",
     .description =
         "Finds the equilibrium at rest under gravity and prescribed loads, which grow step by\n"
         "step from nothing; with static.method=arc_length also through limit points.\n",
     .example = "inputs/lee2002/baseline.yaml --set shaft.speed=0 --set gravity=9.81",
     .writes_result = true,
     .has_csv = true,
     .analysis = simulation::Analysis::statics,
     .run = run_static},
    {.name = "modes",
     .summary = "modes of a parked rotor, or of a balanced one in its own axes",
     .description =
         "Finds all modes about the steady state where the coefficients do not depend on the\n"
         "azimuth: a parked rotor, or a balanced one in its own axes. Elsewhere use samara\n"
         "floquet.\n",
     .example = "inputs/lee2002/baseline.yaml --set shaft.speed=0",
     .writes_result = true,
     .has_csv = true,
     .lists_modes = true,
     .analysis = simulation::Analysis::modes,
     .run = run_modes},
    {.name = "trim",
     .summary = "the periodic steady state",
     .description = "Finds the periodic steady state: deflections and loads as harmonics of the "
                    "rotor speed.\n",
     .example = "inputs/lee2002/baseline.yaml --set gravity=9.81 --set trim.harmonics=6",
     .writes_result = true,
     .has_csv = true,
     .analysis = simulation::Analysis::trim,
     .run = run_trim},
    {.name = "floquet",
     .summary = "the stability of the periodic steady state: all modes",
     .description = "Finds the periodic steady state, and all modes about it by Floquet's theory:\n"
                    "multipliers, frequencies, damping, harmonics, and where the energy is.\n",
     .example = "inputs/lee2002/baseline.yaml --set blades.elements=8 --csv modes.csv",
     .writes_result = true,
     .has_csv = true,
     .lists_modes = true,
     .analysis = simulation::Analysis::floquet,
     .run = run_floquet},
    {.name = "transient",
     .summary = "simulation in time, with loads by OpenFAST's channel names",
     .description =
         "Simulates the turbine in time from its periodic steady state, from rest, or from the\n"
         "end of another run. Motions and loads go into the result while it runs, by the channel\n"
         "names of OpenFAST.\n",
     .example = "inputs/lee2002/baseline.yaml --set \"transient={duration: 20, step: 0.005}\"",
     .writes_result = true,
     .analysis = simulation::Analysis::transient,
     .run = run_transient},
    {.name = "linearize",
     .summary = "the linear model about the periodic steady state, for control design",
     .description =
         "Writes the linear model about the periodic steady state over the azimuth: state-space\n"
         "and descriptor form, in multiblade coordinates, averaged, lifted to a constant one, in\n"
         "Lyapunov-Floquet coordinates.\n",
     .example = "inputs/lee2002/baseline.yaml "
                "--set \"linearize={inputs: [yaw_torque], outputs: [NacYaw]}\"",
     .writes_result = true,
     .analysis = simulation::Analysis::linearize,
     .run = run_linearize},
    {.name = "operate",
     .summary = "operating points over the wind speed: speed, pitch, power, thrust",
     .description =
         "Finds the steady operating points over the wind speed: by a law of the generator's\n"
         "torque below the rated power and by the pitch above it, or from a table of speed and\n"
         "pitch. Writes speed, pitch, torque, power, thrust and deflections. A run that was\n"
         "interrupted or ended goes on where it was, by the same command.\n",
     .example = "inputs/nrel5mw/land.yaml --set operation.wind_speeds=[6,8,10,12,14]",
     .writes_result = true,
     .has_csv = true,
     .analysis = simulation::Analysis::operate,
     .run = run_operate},
    {.name = "campbell",
     .summary = "modes over the operating points or a key: a Campbell diagram",
     .description =
         "Finds the modes at each operating point of the case, as samara operate does, or at each\n"
         "value of a key, and joins them to lines by their shapes. Ranks share the points. A run\n"
         "that was interrupted or ended goes on where it was, by the same command.\n",
     .example = "inputs/lee2002/baseline.yaml --sweep shaft.speed=0:4:1",
     .writes_result = true,
     .has_csv = true,
     .has_sweep = true,
     .analysis = simulation::Analysis::campbell,
     .run = run_campbell},
    {.name = "new",
     .summary = "a commented case to start from",
     .description = "Writes a commented case NAME.yaml to start from.\n",
     .example = "three-bladed mine",
     .hand_over = run_new},
    {.name = "import",
     .summary = "a case file from a turbine of OpenFAST, windIO or HAWC2",
     .description =
         "Reads the deck of another program, OpenFAST, windIO or HAWC2 (.htc), structure and air,\n"
         "writes it as a case file, and reports for each key whether it was taken, derived or\n"
         "ignored, and why. See docs/import.md.\n",
     .example = "openfast Main.fst -o turbine.yaml",
     .writes_result = true,
     .formats = "openfast|windio|hawc2",
     .convert = run_import},
    {.name = "export",
     .summary = "a time series as .h5, .csv, .out or .outb; a motion for ParaView, .pvd",
     .description =
         "Writes the time series of a result of samara transient as one file, by its ending: .h5, "
         "the\n"
         "whole result without its folder of parts; .csv; .out or .outb, OpenFAST's text and\n"
         "binary output, for the programs that read those; .outb has 16 bits a value. The ending\n"
         ".pvd, or --format vtk, writes the motion of a mode (--mode N), of the steady state or "
         "of\n"
         "a load path for ParaView: samara export --format vtk --help.\n",
     .example = "RESULT.h5 -o series.csv",
     .writes_result = true,
     .convert = run_export,
     .hands_over = asks_for_vtk,
     .hand_over = run_vtk,
     .most_results = 1},
    {.name = "plot",
     .summary = "pictures of a result: Campbell diagram, multipliers, series, loads",
     .description = "Draws pictures of a result as .svg, .png or .pdf, each kind that it allows.\n",
     .example = "RESULT.h5 -o picture.svg",
     .hand_over = run_plot},
    {.name = "report",
     .summary = "one page for the browser: modes, Campbell diagram, the turbine in motion",
     .description = "Writes results as one page that needs no network: tables, diagrams, and the\n"
                    "turbine moving in its modes.\n",
     .example = "RESULT.h5 -o report.html",
     .hand_over = run_report},
    {.name = "loads",
     .summary = "statistics, extremes, harmonics, cycles, equivalent loads of a result",
     .description =
         "Evaluates the loads in a result of samara transient, or over one revolution of the\n"
         "steady state in a result of samara trim or floquet: statistics, extreme events,\n"
         "harmonics of the rotor speed, rainflow cycles and damage-equivalent loads; of several\n"
         "results also those of a lifetime. --set takes the keys of docs/case_file.md, \"Loads of\n"
         "a result\".\n",
     .example = "RESULT.h5 --set \"channels=[RootMyb1, TwrBsMyt]\" --set \"exponents=[4, 10]\"",
     .has_csv = true,
     .run = run_loads,
     .most_results = 1000},
    {.name = "schema",
     .summary = "the keys of a case file as a JSON Schema, for editors",
     .description =
         "Prints the JSON Schema (draft 7) of case files: every key with its unit, range, default\n"
         "and meaning. Editors with a YAML language server complete and check keys with it, where\n"
         "the first line of a case is\n"
         "  # yaml-language-server: $schema=samara.schema.json\n",
     .example = "> samara.schema.json",
     .print = io::case_schema},
}};

/// Result of a piece of work.
struct Outcome {
  int code = 0;
  std::string message;  ///< whole lines
};

/// Adds the program's name to lines that do not begin with a place in the case.
std::string with_name(const std::string& message, const std::string& case_path) {
  std::istringstream lines(message);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const bool has_place =
        !case_path.empty() && (line.starts_with(case_path + ":") || line.starts_with("--set "));
    text += (has_place ? "" : "samara: ") + line + "\n";
  }
  return text;
}

template <class Work>
Outcome attempt(const std::string& case_path, const Work& work) {
  try {
    work();
    return {};
  } catch (const InputError& error) {
    return {2, with_name(error.what(), case_path)};
  } catch (const ConvergenceError& error) {
    return {3, with_name(error.what(), case_path)};
  } catch (const DomainError& error) {
    return {3, with_name(error.what(), case_path)};
  } catch (const Interrupted& error) {
    return {Interruption::noted(), with_name(error.what(), case_path)};
  } catch (const std::bad_alloc&) {
    return {1, "samara: not enough memory\n"};
  } catch (const InternalError& error) {
    return {1, with_name(error.what(), case_path)};
  } catch (const std::exception& error) {
    return {1, with_name(std::string("unexpected: ") + error.what(), case_path)};
  }
}

/// Finds all faults that can be found before the computation.
Job prepare(const CommandLine& line) {
  Job job;
  if (line.command->most_results > 0) {
    job.input = io::read_result_case(line.case_path);
    job.sources = {line.case_path};
    job.sources.insert(job.sources.end(), line.more_results.begin(), line.more_results.end());
    job.settings = line.settings;
    require_other_path(line.result_path, job.sources);
  } else {
    std::vector<std::string> settings = line.settings;
    if (line.parked) settings.emplace_back("shaft.speed=0");
    job.input = io::read_case(line.case_path, settings);
    if (Session::launch_rank() == 0)
      for (const std::string& note : job.input.notes) std::cerr << note << "\n";
    if (line.sweep.empty()) {
      if (line.command->has_sweep && !(job.input.turbine.wind && job.input.turbine.aero))
        throw InputError("missing --sweep: " + line.case_path +
                         " has no air for operating points; hint: --sweep "
                         "shaft.speed_rpm=0:14:0.5");
      io::require_valid(job.input, simulation::validate(job.input, line.command->analysis));
    } else {
      job.sweep = Sweep(line.sweep, line.case_path, settings);
    }
  }
  if (line.air_part && !(job.input.turbine.wind && job.input.turbine.aero))
    throw InputError("--air: " + line.case_path +
                     " has no air; hint: wind.speed and blades.aero_sections");
  job.command_line = line.text;
  job.result_path = line.result_path;
  job.csv_path = line.csv_path;
  job.restart_path = line.restart_path;
  job.all_modes = line.all_modes;
  job.air_part = line.air_part;
  job.first_modes = line.first_modes;
  job.sensitivity = line.sensitivity;
  job.bands = line.bands;
  if (job.result_path.empty() && line.command->writes_result)
    job.result_path = std::filesystem::path(line.case_path).stem().string() + ".h5";
  if (Session::launch_rank() != 0) return job;
  if (!job.result_path.empty()) io::require_result_path(job.result_path);
  if (!job.csv_path.empty()) io::require_table_path(job.csv_path);
  return job;
}

/// From here on no other run can write the result.
void lock_result(Job& job) {
  if (Session::rank() != 0 || job.result_path.empty()) return;
  const SignalPause pause;  // without it a signal could leave the lock's file behind
  job.lock = std::make_shared<io::FileLock>(job.result_path);
  Interruption::remove_at_end(job.lock->path());
  if (!job.lock->is_held())
    std::cerr << "note: " << job.result_path
              << ": its folder does not support locks; another run with this result would not be "
                 "detected\n";
}

void release_result(Job& job) {
  const SignalPause pause;
  Interruption::remove_at_end("");
  job.lock.reset();
}

void report_unused_options(const std::string& command) {
  const std::string unused = Session::unused_options();
  if (unused.empty()) return;
  std::string hint;
  std::istringstream words(unused);
  for (std::string word; words >> word;)
    if (const std::string whole = prefixed_option(word, command); !whole.empty())
      hint += (hint.empty() ? "did you mean " : ", ") + whole;
  std::cerr << "samara: options that this run did not use: " << unused << "; hint: "
            << (hint.empty() ? "misspelt, or of a solver that this command does not start"
                             : hint + "?")
            << "; samara --help-options lists the prefixes\n";
}

void print_text(const CommandLine& line) {
  if (Session::launch_rank() != 0) return;
  if (line.request == Request::help)
    std::cout << help_text(line, commands);
  else if (line.request == Request::solver_options)
    std::cout << solver_options_text();
  else if (line.request == Request::print)
    std::cout << line.command->print();
  else {
    petsc::choose_blas_kernels();
    std::cout << "samara " << version << "\n"
              << petsc::library_versions() << "\n"
              << io::file_library_version() << "\n";
  }
}

/// The common exit code of all ranks (Session::agree). After a failure that one rank has reported,
/// signals end the ranks without a word: mpiexec sends them as soon as the first rank has ended.
int end_together(const Session& session, const Outcome& outcome) {
  const int code = session.agree(outcome.code, outcome.message);
  if (code != 0) Interruption::silence();
  return code;
}

int run(const std::vector<std::string>& arguments) {
  for (const Command& command : commands)
    if (command.hand_over != nullptr && !arguments.empty() && arguments.front() == command.name) {
      const std::vector<std::string> rest(arguments.begin() + 1, arguments.end());
      if (command.hands_over != nullptr && !command.hands_over(rest)) break;
      if (Session::launch_rank() == 0) command.hand_over(rest);
      return 0;
    }
  CommandLine line;
  Job job;
  Outcome outcome = attempt("", [&] { line = parse_command_line(arguments, commands); });
  if (outcome.code == 0 && line.request != Request::run) {
    print_text(line);
    return 0;
  }
  const bool converts = outcome.code == 0 && line.command->convert != nullptr;
  if (converts && Session::launch_rank() == 0)
    outcome = attempt("", [&] { line.command->convert(line); });
  if (outcome.code == 0 && !converts)
    outcome = attempt(line.case_path, [&] { job = prepare(line); });
  if (converts && outcome.code == 0 && !Session::is_launched()) return 0;
  if (outcome.code != 0 && !Session::is_launched()) {
    std::fputs(outcome.message.c_str(), stderr);
    return outcome.code;
  }
  const Session session(line.petsc_options);
  if (const int code = end_together(session, outcome)) return code;
  if (converts) return 0;
  outcome = attempt("", [] { refuse_unsupported_options(Session::options()); });
  if (const int code = end_together(session, outcome)) return code;
  outcome = attempt(line.case_path, [&] { lock_result(job); });
  if (const int code = end_together(session, outcome)) return code;
  outcome = attempt(line.case_path, [&] { line.command->run(job); });
  release_result(job);
  if (outcome.code == 0 && Interruption::is_asked())  // after all was done
    outcome = {Interruption::noted(), "samara: interrupted; the result is complete\n"};
  const int code = end_together(session, outcome);
  if (code == 0 && Session::rank() == 0) report_unused_options(line.command->name);
  return code;
}

/// Opens the standard streams that are closed. Otherwise the next file that is opened would get the
/// number of the stream, and the printed text would go into that file. The replacement cannot be
/// used.
void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0)  // the lowest free number is this one
      ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

}  // namespace
}  // namespace samara::drivers

int main(int argc, char** argv) {
  using namespace samara::drivers;
  hold_standard_streams();
  int code = 1;
  const Outcome outcome =
      attempt("", [&] { code = run(std::vector<std::string>(argv + 1, argv + argc)); });
  if (outcome.code != 0) {
    std::fputs(outcome.message.c_str(), stderr);
    return outcome.code;
  }
  if (!std::cout.flush()) {
    std::fputs("samara: standard output cannot be written\n", stderr);
    return code != 0 ? code : 1;
  }
  return code;
}
