// samara floquet: the stability of the periodic steady state.
#include "samara/analysis/floquet.hpp"

#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/air_part.hpp"
#include "samara/simulation/held_air.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/simulation/validation.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "commands.hpp"
#include "interruption.hpp"
#include "masses.hpp"
#include "mode_report.hpp"
#include "progress.hpp"
#include "sensitivity_report.hpp"
#include "steady_state_groups.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

std::string headline(const io::Case& input, const analysis::Floquet& floquet, PetscInt unknowns) {
  const double speed = floquet.set.rotor_speed;
  const std::string title = title_of(input) + "\nrotor speed " + general(speed, 6) + " rad/s; ";
  if (floquet.harmonics > 0)
    return title + std::to_string(unknowns) + " unknowns; Hill's method, shapes of up to " +
           count(floquet.harmonics, "harmonic") + "\n\n";
  const std::string span = floquet.sectors == 1
                               ? "one revolution"
                               : "1/" + std::to_string(floquet.sectors) + " revolution";
  return title + count(floquet.set.degrees_of_freedom, "degree") + " of freedom; " +
         std::to_string(floquet.steps) + " steps of order " + std::to_string(floquet.order) +
         " a revolution, integrated over " + span + "\n\n";
}

simulation::ScenarioAt scenarios_of(const Job& job) {
  return [&job](const simulation::Parameter& parameter, double value) {
    if (Interruption::is_asked()) throw Interrupted("interrupted");
    std::vector<std::string> settings = job.input.settings;
    settings.push_back(parameter.key + "=" + shortest(value));
    try {
      io::Case input = io::parse_case(job.input.path, job.input.file_text(), settings);
      io::require_valid(input, simulation::validate(input, simulation::Analysis::floquet));
      return input;
    } catch (const InputError& error) {
      // The number is not one of --set.
      const std::string message = error.what();
      const std::string option = "--set ";
      throw InputError(
          message.starts_with(option) ? "--sensitivity " + message.substr(option.size()) : message);
    }
  };
}

std::vector<simulation::Parameter> all_parameters(const std::vector<ParameterGroup>& groups) {
  std::vector<simulation::Parameter> parameters;
  for (const ParameterGroup& group : groups)
    parameters.insert(parameters.end(), group.parameters.begin(), group.parameters.end());
  return parameters;
}

/// Those of the listed modes to the numbers of --sensitivity.
Sensitivities find_sensitivities(const Job& job, std::vector<ParameterGroup> groups,
                                 const turbine::TurbineSystem& system, const analysis::Trim& trim,
                                 const analysis::ModeSet& set, Progress& progress) {
  Sensitivities result;
  const bool is_first = petsc::Session::rank() == 0;  // it has all modes
  const simulation::StabilityAssessment assessment =
      is_first ? simulation::assess_stability(set) : simulation::StabilityAssessment();
  if (is_first)
    for (const std::size_t m : listed_modes(set, assessment, {false, job.first_modes, nullptr}))
      if (!is_of_medium(set.modes[m])) result.modes.push_back(m);
  const std::vector<simulation::Sensitivity> found = simulation::find_sensitivities(
      job.input, system, trim, set, result.modes, all_parameters(groups), scenarios_of(job),
      progress, PETSC_COMM_WORLD);
  auto next = found.begin();
  for (const ParameterGroup& group : groups) {
    const auto end = next + static_cast<std::ptrdiff_t>(group.parameters.size());
    result.found.emplace_back(next, end);
    next = end;
  }
  result.groups = std::move(groups);
  return result;
}

}  // namespace

void run_floquet(const Job& job) {
  analysis::require_whole_spectrum("floquet_");
  const model::Turbine turbine = model::build_turbine(job.input.turbine);
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  const bool is_first = petsc::Session::rank() == 0;
  std::vector<ParameterGroup> groups = find_parameters(job);
  simulation::require_range(all_parameters(groups), scenarios_of(job));
  Progress progress(is_first);
  const analysis::Trim trim = simulation::find_trim(job.input, system, progress, PETSC_COMM_WORLD);
  const auto held = simulation::hold_wake(system);
  const analysis::Floquet floquet = analysis::find_floquet_modes(
      held ? *held : system, trim.solution, job.input.floquet, PETSC_COMM_WORLD, progress);
  std::optional<simulation::AirPart> air;
  if (const auto still = job.air_part ? simulation::hold_air(system) : nullptr) {
    const analysis::Floquet without = analysis::find_floquet_modes(
        *still, trim.solution, simulation::options_of_held_air(floquet.set, job.input.floquet),
        PETSC_COMM_WORLD, progress);
    if (is_first)  // others have no shapes
      air = simulation::find_air_part(system, trim.solution, floquet.set, without.set);
  }
  std::optional<Sensitivities> sensitivities;
  std::exception_ptr failure;  // of the sensitivities: the modes are delivered all the same
  std::optional<Interruption> interruption;  // likewise
  try {
    if (!groups.empty()) {
      interruption.emplace("samara: ends after the present derivatives; again to end at once\n");
      sensitivities =
          find_sensitivities(job, std::move(groups), system, trim, floquet.set, progress);
    }
  } catch (const std::exception&) {
    failure = Interruption::is_asked()
                  ? std::make_exception_ptr(Interrupted("interrupted before the derivatives were "
                                                        "found: the modes are complete"))
                  : std::current_exception();
  }
  progress.finish();
  if (!is_first) {
    if (failure) std::rethrow_exception(failure);
    return;
  }
  const simulation::StabilityAssessment assessment = simulation::assess_stability(floquet.set);
  deliver(
      job,
      headline(job.input, floquet, system.size()) +
          mode_table(floquet.set, assessment,
                     {job.all_modes, job.first_modes, air ? &*air : nullptr}) +
          "\n" + verdict_text(floquet.set, assessment, job.all_modes) +
          (sensitivities ? sensitivity_tables(floquet.set, *sensitivities) : ""),
      [&](io::ResultFile& file) {
        file.write_model(system);
        write_masses(file, model::compute_masses(job.input.turbine, turbine));
        write_steady_state(file, system, trim);
        file.write_floquet(floquet);
        file.write_geometry(system, trim, "/floquet", floquet.set);
        if (sensitivities) write_sensitivities(file, floquet.set, *sensitivities);
        if (air) write_air_part(file, "/floquet", *air, turbine.blades.size());
      },
      [&](const std::string& path) { io::write_mode_table(path, floquet.set); });
  if (failure) std::rethrow_exception(failure);
  require_verdict(floquet.set, assessment);
}

}  // namespace samara::drivers
