// samara loads: statistics, extreme events, harmonics, cycles and equivalent loads of results.
#include <algorithm>
#include <array>
#include <string_view>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"
#include "samara/io/load_result.hpp"
#include "samara/io/result_reader.hpp"
#include "samara/io/same_model.hpp"
#include "samara/petsc/session.hpp"

#include "commands.hpp"
#include "load_source.hpp"
#include "load_tables.hpp"
#include "progress.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

void check_hours(const std::vector<std::string>& sources, const io::LoadOptions& options) {
  if (options.hours.empty() ? sources.size() == 1 : options.hours.size() == sources.size()) return;
  throw InputError("--set hours: " + std::to_string(sources.size()) + " results and " +
                   std::to_string(options.hours.size()) +
                   " numbers; hint: hours=[...] gives the hours of the lifetime that each result "
                   "represents");
}

/// Keys in which the results of one lifetime may differ: loads on the turbine, its operation, and
/// differences between blades.
constexpr std::array<std::string_view, 10> operation_keys{
    "gravity",     "loads",       "shaft.azimuth_deg", "shaft.generator",
    "shaft.rotor", "shaft.speed", "blades.pitch_deg",  "blades.each",
    "nacelle.yaw", "hub.teeter"};

/// Checks that all results are from one turbine.
void require_one_turbine(const std::vector<std::string>& sources) {
  const std::string first = io::read_result_case(sources.front()).model_text;
  for (std::size_t i = 1; i < sources.size(); ++i)
    io::require_same_model(sources[i], io::read_result_case(sources[i]).model_text, first,
                           operation_keys);
}

/// The options of the evaluation, with the Goodman corrections by channel.
loads::LoadEvaluationOptions evaluation_options(const io::LoadOptions& options,
                                                const std::vector<std::string>& names) {
  loads::LoadEvaluationOptions evaluation = options.evaluation;
  evaluation.goodman.resize(names.size());
  for (const auto& [name, correction] : options.goodman) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
      throw InputError("--set goodman: \"" + name + "\" is not one of the evaluated channels" +
                       suggest(name, names));
    evaluation.goodman[static_cast<std::size_t>(found - names.begin())] = correction;
  }
  return evaluation;
}

/// Checks that the tables of cycles fit in the memory.
void require_tables(std::size_t channels, const io::LoadOptions& options) {
  constexpr double most_entries = 5e7;
  const loads::LoadEvaluationOptions& evaluation = options.evaluation;
  const double entries = static_cast<double>(channels) * evaluation.range_bins *
                         static_cast<double>(evaluation.mean_bins);
  if (entries <= most_entries) return;
  throw InputError("--set bins: " + std::to_string(evaluation.range_bins) + " x " +
                   std::to_string(evaluation.mean_bins) + " bins of " +
                   count(static_cast<int>(channels), "channel") +
                   " are more than 50 million entries; hint: fewer bins, or channels=[...]");
}

io::LoadReport evaluate(const std::string& path, const io::LoadOptions& options,
                        analysis::Observer& observer) {
  LoadSource source = read_load_source(path, options, observer);
  io::LoadReport& report = source.report;
  require_tables(report.channels.size(), options);
  try {
    report.evaluation = loads::evaluate_loads(report.series, source.azimuth,
                                              evaluation_options(options, report.series.names));
  } catch (const InputError& error) {
    const std::string words = error.what();
    throw InputError(words.starts_with("--set ") ? words : path + ": " + words);
  }
  return report;
}

io::LifetimeReport evaluate_lifetime(const std::vector<io::LoadReport>& reports,
                                     const io::LoadOptions& options) {
  if (options.hours.empty()) return {};
  const std::vector<std::string>& names = reports.front().series.names;
  std::vector<loads::LoadEvaluation> evaluations;
  std::vector<double> durations;
  for (const io::LoadReport& report : reports) {
    if (report.series.names != names)
      throw InputError(report.source + ": has other channels than " + reports.front().source +
                       "; hint: --set channels=[...] names those that all have");
    evaluations.push_back(report.evaluation);
    durations.push_back(loads::duration(report.series));
  }
  return {options.hours,
          loads::evaluate_lifetime(evaluations, durations, options.hours, names,
                                   evaluation_options(options, names), options.equivalent_cycles)};
}

}  // namespace

void run_loads(const Job& job) {
  if (petsc::Session::rank() != 0) return;
  const io::LoadOptions options = io::read_load_options(job.settings);
  check_hours(job.sources, options);
  if (!options.hours.empty()) require_one_turbine(job.sources);
  std::vector<io::LoadReport> reports;
  Progress progress(true);
  for (const std::string& path : job.sources) reports.push_back(evaluate(path, options, progress));
  const io::LifetimeReport lifetime = evaluate_lifetime(reports, options);
  std::string tables;
  for (const io::LoadReport& report : reports) tables += load_tables(report, options);
  tables += lifetime_table(reports, lifetime, options);
  deliver(
      job, tables, [&](io::ResultFile& file) { io::write_loads(file, reports, lifetime, options); },
      [&](const std::string& path) { io::write_load_table(path, reports, lifetime, options); });
}

}  // namespace samara::drivers
