// samara modes: the modes for constant tangents (a parked rotor, or a balanced one in its axes).
#include <optional>

#include "samara/analysis/constant_modes.hpp"
#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/air_part.hpp"
#include "samara/simulation/held_air.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "commands.hpp"
#include "masses.hpp"
#include "mode_report.hpp"
#include "progress.hpp"
#include "steady_state_groups.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

std::string headline(const io::Case& input, const analysis::ModeSet& set, PetscInt unknowns) {
  const std::string rotor = set.rotor_speed > 0.0
                                ? "rotor speed " + general(set.rotor_speed, 6) +
                                      " rad/s, frequencies in the rotor's axes (--parked: at rest)"
                                : "parked rotor";
  const std::string size =
      set.searched && !set.searched->is_of_all
          ? std::to_string(unknowns) + " unknowns; Hill's method without harmonics"
          : count(set.degrees_of_freedom, "degree") + " of freedom";
  return title_of(input) + "\n" + rotor + "; " + size + "\n\n";
}

}  // namespace

void run_modes(const Job& job) {
  analysis::require_whole_spectrum("modes_");
  const model::Turbine turbine = model::build_turbine(job.input.turbine);
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  const bool is_first = petsc::Session::rank() == 0;
  Progress progress(is_first);
  const analysis::Trim trim = simulation::solve_trim(
      job.input, system, simulation::trim_options(job.input), progress, PETSC_COMM_WORLD);
  simulation::require_wake_range(system, trim);
  if (!trim.solution.is_constant())
    throw InputError(
        job.input.path +
        ": the coefficients are periodic, the steady state changes with the "
        "azimuth; hint: samara floquet, or samara modes --parked for the rotor at rest");
  simulation::note_doubts(system, trim, progress);
  const auto held = simulation::hold_wake(system);
  const auto find = [&](const turbine::TurbineSystem& of, const analysis::FloquetOptions& options) {
    return analysis::find_constant_modes(of, trim.solution, options, PETSC_COMM_WORLD, progress);
  };
  const analysis::ModeSet set = find(held ? *held : system, job.input.floquet);
  std::optional<simulation::AirPart> air;
  if (const auto still = job.air_part ? simulation::hold_air(system) : nullptr) {
    const analysis::ModeSet without =
        find(*still, simulation::options_of_held_air(set, job.input.floquet));
    if (is_first) air = simulation::find_air_part(system, trim.solution, set, without);
  }
  progress.finish();
  if (!is_first) return;
  const simulation::StabilityAssessment assessment = simulation::assess_stability(set);
  deliver(
      job,
      headline(job.input, set, system.size()) +
          mode_table(set, assessment, {job.all_modes, job.first_modes, air ? &*air : nullptr}) +
          "\n" + verdict_text(set, assessment, job.all_modes),
      [&](io::ResultFile& file) {
        file.write_model(system);
        write_masses(file, model::compute_masses(job.input.turbine, turbine));
        write_steady_state(file, system, trim);
        file.write_modes(set);
        file.write_geometry(system, trim, "/modes", set);
        if (air) write_air_part(file, "/modes", *air, turbine.blades.size());
      },
      [&](const std::string& path) { io::write_mode_table(path, set); });
  require_verdict(set, assessment);
}

}  // namespace samara::drivers
