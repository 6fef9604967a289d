// samara linearize: the linear model about the periodic steady state.
#include "samara/base/error.hpp"
#include "samara/io/mat_file.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/linear/linearization.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/held_air.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/turbine/turbine_input_output.hpp"

#include "commands.hpp"
#include "masses.hpp"
#include "progress.hpp"
#include "steady_state_groups.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

std::string summary(const io::Case& input, const linear::Linearization& linear) {
  std::string text = title_of(input) + "\n";
  text += linear.rotor_speed > 0.0 ? "rotor speed " + general(linear.rotor_speed, 6) + " rad/s, " +
                                         count(linear.series_azimuths, "azimuth")
                                   : std::string("parked rotor");
  if (linear.is_constant) text += "; nothing changes with the azimuth";
  return text + "\n\n";
}

std::string form_table(const linear::Linearization& linear,
                       const linear::SeriesResolution& options) {
  Table table;
  table.add_column("form", "", Align::left);
  for (const char* name : {"states", "inputs", "outputs", "harmonics", "residual"})
    table.add_column(name, "");
  for (const linear::NamedForm& form : linear.forms)
    table.add_row({form.name, std::to_string(form.states.size()),
                   std::to_string(form.inputs.size()), std::to_string(form.outputs.size()),
                   std::to_string(form.series.harmonics()),
                   form.series.samples().empty() && form.series.residual() == 0.0
                       ? ""
                       : scientific(form.series.residual(), 1)});
  if (linear.rotor_speed == 0.0) return table.text();
  std::string text =
      table.text() + "residual: relative residual of the series midway between the azimuths";
  if (!options.automatic_azimuths || !options.automatic_harmonics)
    text += "; if it is not small,\nlinearize.azimuths and harmonics: auto choose enough of them";
  return text + "\n";
}

}  // namespace

turbine::TurbineInputOutput make_input_output(const io::Case& input,
                                              const turbine::TurbineSystem& system) {
  const simulation::LinearizeSetup& asked = input.linearize;
  return at_place(input.path + ": linearize", [&] {
    return turbine::TurbineInputOutput(system, asked.inputs, asked.stations, asked.outputs);
  });
}

void run_linearize(const Job& job) {
  const simulation::LinearizeSetup& asked = job.input.linearize;
  if (!job.input.linearize.mat_path.empty()) {
    io::require_mat_path(job.input.linearize.mat_path);
    if (io::is_same_file(job.input.linearize.mat_path, job.result_path))
      throw InputError(job.input.path +
                       ": linearize.mat and -o name the same file; give each its own");
  }
  const model::Turbine turbine = model::build_turbine(job.input.turbine);
  const turbine::TurbineSystem system(turbine, PETSC_COMM_SELF);
  const turbine::TurbineInputOutput input_output = make_input_output(job.input, system);
  const bool is_first = petsc::Session::rank() == 0;
  Progress progress(is_first);
  const analysis::Trim trim = simulation::find_trim(job.input, system, progress, PETSC_COMM_WORLD);
  const auto held = simulation::hold_wake(system);
  const linear::Linearization linear = linear::linearize(
      held ? *held : system, input_output, trim.solution, turbine.azimuth, asked.options, progress);
  progress.finish();
  if (!is_first) return;
  std::string text = summary(job.input, linear) + form_table(linear, asked.options.series);
  if (!job.input.linearize.mat_path.empty()) {
    io::write_mat_file(job.input.linearize.mat_path, linear);
    text += "MAT-file: " + job.input.linearize.mat_path + "\n";
  }
  deliver(job, text,
          [&](io::ResultFile& file) {
            file.write_model(system);
            write_masses(file, model::compute_masses(job.input.turbine, turbine));
            write_steady_state(file, system, trim);
            file.write_linearization(linear);
          },
          {});
}

}  // namespace samara::drivers
