// samara floquet: the stability of the periodic steady state.
#include "samara/analysis/floquet.hpp"

#include <optional>

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

}  // namespace

void run_floquet(const Job& job) {
  analysis::require_whole_spectrum("floquet_");
  const model::Turbine turbine = model::build_turbine(job.input.turbine);
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  const bool is_first = petsc::Session::rank() == 0;
  Progress progress(is_first);
  const analysis::Trim trim = simulation::find_trim(job.input, system, progress, PETSC_COMM_WORLD);
  const auto held = simulation::hold_wake(system);
  const analysis::Floquet floquet = analysis::find_floquet_modes(
      held ? *held : system, trim.solution, job.input.floquet, PETSC_COMM_WORLD, progress);
  std::optional<simulation::AirPart> air;
  if (const auto still = job.air_part ? simulation::hold_air(system) : nullptr)
    air = simulation::find_air_part(
        system, trim.solution, floquet.set,
        analysis::find_floquet_modes(*still, trim.solution, job.input.floquet, PETSC_COMM_WORLD,
                                     progress)
            .set);
  progress.finish();
  if (!is_first) return;
  const simulation::StabilityAssessment assessment = simulation::assess_stability(floquet.set);
  deliver(
      job,
      headline(job.input, floquet, system.size()) +
          mode_table(floquet.set, assessment,
                     {job.all_modes, job.first_modes, air ? &*air : nullptr}) +
          "\n" + verdict_text(floquet.set, assessment, job.all_modes),
      [&](io::ResultFile& file) {
        file.write_model(system);
        write_masses(file, model::compute_masses(job.input.turbine, turbine));
        file.write_trim(trim);
        file.write_floquet(floquet);
        file.write_geometry(system, trim, "/floquet", floquet.set);
        if (air) write_air_part(file, "/floquet", *air, turbine.blades.size());
      },
      [&](const std::string& path) { io::write_mode_table(path, floquet.set); });
  require_verdict(floquet.set, assessment);
}

}  // namespace samara::drivers
