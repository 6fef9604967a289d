// samara transient: simulation in time.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "samara/analysis/ranks.hpp"
#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/io/controller_library.hpp"
#include "samara/io/time_series_file.hpp"
#include "samara/io/transient_start.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/io/wind_files.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/output_channels.hpp"
#include "samara/simulation/transient_simulation.hpp"
#include "samara/simulation/validation.hpp"

#include "commands.hpp"
#include "interruption.hpp"
#include "masses.hpp"
#include "progress.hpp"
#include "table.hpp"
#include "time_series_output.hpp"

namespace samara::drivers {
namespace {

using Clock = std::chrono::steady_clock;

/// The first `count` channels.
std::string channel_table(const std::vector<turbine::Channel>& channels,
                          const std::vector<simulation::ChannelRange>& ranges, std::size_t count) {
  Table table;
  table.add_column("channel", "", Align::left);
  table.add_column("unit", "", Align::left);
  for (const char* name : {"least", "mean", "largest", "last"}) table.add_column(name, "");
  for (std::size_t i = 0; i < count; ++i) {
    const simulation::ChannelRange& range = ranges[i];
    if (range.rows == 0) continue;
    table.add_row({channels[i].name, channels[i].unit, general(range.least, 4),
                   general(range.mean(), 4), general(range.largest, 4), general(range.last, 4)});
  }
  return table.text() + (count < channels.size() ? "and places of nodes\n" : "");
}

std::string summary(const io::Case& input, const simulation::TransientSummary& done,
                    double seconds) {
  const analysis::TransientRun& run = done.run;
  const double simulated = run.end.time - done.began;
  const double followed = 1.0 / (simulation::steps_a_cycle * input.transient.options.step);
  std::string text = title_of(input) + "\n";
  text += "time         " + general(done.began, 6) + " to " + general(run.end.time, 6) + " s" +
          (run.reason == analysis::TransientEnd::complete ? "" : ": interrupted") + "\n";
  text += "method       " + run.method + ", " + std::to_string(run.steps) + " steps, " +
          general(static_cast<double>(run.newton_steps) / static_cast<double>(run.steps), 3) +
          " Newton steps each, " + std::to_string(run.factorizations) + " factorizations";
  if (run.cuts > 0) text += ", " + std::to_string(run.cuts) + " cuts of the step";
  if (run.ranks > 1) text += ", mesh on " + std::to_string(run.ranks) + " ranks";
  text += "\nresolved     motions up to " + general(followed, 3) + " Hz, with " +
          general(simulation::steps_a_cycle, 3) + " steps a cycle";
  if (const auto& controller = input.transient.controller)
    text += "\ncontroller   " + controller->library + ", called every " +
            general(controller->step > 0.0 ? controller->step : input.transient.options.step, 6) +
            " s";
  for (std::size_t i = 0; i < done.end.events.size(); ++i)
    if (std::isfinite(done.end.events[i]))
      text += "\nevent        transient.events[" + std::to_string(i) +
              "] at t = " + general(done.end.events[i], 6) + " s";
  text += "\nspeed        " + general(seconds, 3) + " s, " + general(simulated / seconds, 3) +
          " times real time\n\n";
  return text;
}

/// Events that never occurred are an input error.
void require_fired(const simulation::TransientSetup& transient, const std::vector<double>& fired) {
  std::string text;
  int count = 0;
  for (std::size_t i = 0; i < fired.size(); ++i) {
    if (std::isfinite(fired[i])) continue;
    const turbine::EventTrigger& trigger = transient.events[i].trigger;
    text += "transient.events[" + std::to_string(i) + "] never came: " + trigger.channel +
            " was never " + (trigger.above ? "above " : "below ") + general(trigger.level, 6) +
            "; ";
    ++count;
  }
  if (count > 0)
    throw InputError(text + "the result is complete without " + (count == 1 ? "it" : "them"));
}

void start(const Job& job, simulation::TransientSimulation& simulation, Progress& progress) {
  const io::Case& input = job.input;
  if (!job.restart_path.empty())
    io::restart_from(job.restart_path, input, simulation, progress);
  else if (input.transient.start == simulation::TransientOrigin::result)
    at_place(input.path + ": transient.start",
             [&] { io::start_from(input.transient.start_path, input, simulation, progress); });
  else
    at_place(input.path, [&] { simulation.start(progress); });
}

/// Null where the case has none.
std::unique_ptr<simulation::SteppedController> start_controller(const Job& job) {
  const std::optional<simulation::ControllerSetup>& setup = job.input.transient.controller;
  if (!setup) return nullptr;
  if (!job.restart_path.empty())
    throw InputError(
        "--restart: not with transient.controller: the library's memory was lost with its process; "
        "hint: a run from the start");
  io::ControllerFiles files;
  files.folder = io::folder_of(job.input.path);
  files.output =
      std::filesystem::absolute(job.result_path).replace_extension().lexically_normal().string();
  return at_place(job.input.path,
                  [&] { return std::make_unique<io::ControllerLibrary>(*setup, files); });
}

/// The result of a simulation that has been started. Both must outlive it.
std::unique_ptr<io::TimeSeriesFile> create_file(const Job& job,
                                                const simulation::TransientSimulation& simulation) {
  const model::Turbine& turbine = simulation.turbine();
  const analysis::TransientStart& begin = simulation.state().point;
  io::TimeSeriesContent content;
  content.channels = simulation.channels();
  content.azimuth = turbine.azimuth;
  content.brake_torque = turbine.chain.brake_torque;
  content.is_generator_lost = simulation.state().is_generator_lost;
  const auto write_rest =
      [&job, &begun = simulation.system(), time = begin.time, z = begin.z,
       masses = model::compute_masses(job.input.turbine, turbine)](io::ResultFile& result) {
        result.write_model(begun);
        write_masses(result, masses);
        if (job.input.transient.has_places) result.write_geometry(begun, time, z);
      };
  auto file = std::make_unique<io::TimeSeriesFile>(job.result_path, job.input, record_of(job),
                                                   content, write_rest);
  if (!job.restart_path.empty() && io::is_same_file(job.restart_path, job.result_path))
    file->resume();
  file->note_events(simulation.state().events);
  return file;
}

}  // namespace

void run_transient(const Job& job) {
  const bool is_first = petsc::Session::rank() == 0;
  const simulation::TransientSetup& transient = job.input.transient;
  if (transient.start == simulation::TransientOrigin::result && job.restart_path.empty())
    require_other_path(job.result_path, {transient.start_path});
  io::Case input = job.input;
  if (input.transient.wind && input.turbine.wind)
    at_place(input.path + ": transient.wind", [&] {
      io::read_wind_files(*input.transient.wind, io::folder_of(input.path), *input.turbine.wind);
    });
  simulation::TransientSimulation simulation = at_place(
      input.path, [&] { return simulation::TransientSimulation(input, PETSC_COMM_WORLD); });
  if (!is_first && !simulation.is_distributed()) return;
  const analysis::Ranks ranks(simulation.is_distributed() ? PETSC_COMM_WORLD : PETSC_COMM_SELF);
  const std::unique_ptr<simulation::SteppedController> controller = start_controller(job);
  Progress progress(is_first);
  for (const std::string& note : simulation::transient_notes(job.input)) progress.note(note);
  ranks.attempt([&] { start(job, simulation, progress); });
  std::unique_ptr<io::TimeSeriesFile> file;
  ranks.attempt([&] {
    if (is_first) file = create_file(job, simulation);
  });
  TimeSeriesOutput output(file.get(), progress);
  const Interruption interruption("samara: ends after the present step; again to end at once\n");
  const Clock::time_point began = Clock::now();
  try {
    const simulation::TransientSummary done = simulation.run(output, controller.get());
    const bool is_complete = done.run.reason == analysis::TransientEnd::complete;
    const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
    if (is_first) {
      std::size_t listed = simulation.channels().size();
      if (transient.has_places) listed -= simulation::channels_of_places(simulation.system());
      file->note_events(done.end.events);
      file->finish(is_complete ? "complete" : "interrupted", is_complete ? &done.run.end : nullptr);
      progress.finish();
      std::cout << summary(job.input, done, seconds)
                << channel_table(simulation.channels(), done.ranges, listed)
                << "result: " << job.result_path << "\n"
                << std::flush;
    }
    if (!is_complete)
      throw Interrupted("interrupted at t = " + general(done.run.end.time, 6) + " s" +
                        (controller ? ""
                                    : "; hint: --restart " + job.result_path +
                                          " goes on from its last checkpoint"));
    require_fired(transient, done.end.events);
  } catch (const Interrupted&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    progress.finish();
    if (output.has_rows()) {
      const bool is_written = file->finish_failed(std::string("failed: ") + error.what());
      std::cerr << "samara: "
                << (is_written ? "the computed rows are in "
                               : "the last rows are lost; others may be in ")
                << job.result_path << "\n";
    }
    throw;
  }
}

}  // namespace samara::drivers
