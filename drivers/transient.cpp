// samara transient: the motion in time.
#include "samara/analysis/transient.hpp"

#include <chrono>
#include <cmath>
#include <iostream>
#include <numbers>

#include "samara/base/error.hpp"
#include "samara/io/history_file.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/petsc/session.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "commands.hpp"
#include "history_legs.hpp"
#include "history_recorder.hpp"
#include "history_start.hpp"
#include "interruption.hpp"
#include "masses.hpp"
#include "motion_faults.hpp"
#include "progress.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

using Clock = std::chrono::steady_clock;

/// The midpoint rule then errs by 0.8 % in frequency, BDF2 by 3 %.
constexpr double steps_a_cycle = 20.0;
constexpr double least_steps_a_revolution = 40.0;

std::string channel_table(const std::vector<turbine::Channel>& channels,
                          const std::vector<Extent>& extents) {
  Table table;
  table.add_column("channel", "", Align::left);
  table.add_column("unit", "", Align::left);
  for (const char* name : {"least", "mean", "largest", "last"}) table.add_column(name, "");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Extent& extent = extents[i];
    if (extent.rows == 0) continue;
    table.add_row({channels[i].name, channels[i].unit, general(extent.least, 4),
                   general(extent.sum / static_cast<double>(extent.rows), 4),
                   general(extent.largest, 4), general(extent.last, 4)});
  }
  return table.text();
}

/// The fastest motion that the steps follow well [Hz].
double followed_frequency(const analysis::TransientOptions& options) {
  return 1.0 / (steps_a_cycle * options.step);
}

/// Too few steps a revolution for the loads that repeat with it.
void note_steps(const io::Case& input, Progress& progress) {
  const analysis::TransientOptions& options = input.transient.options;
  double speed = std::abs(input.turbine.shaft.speed);
  if (input.transient.speed)
    for (double t = 0.0; t <= options.duration; t += std::max(options.step, options.duration / 1e3))
      speed = std::max(speed, std::abs(input.transient.speed->at(t).value));
  if (speed == 0.0) return;
  const double steps = 2.0 * std::numbers::pi / (speed * options.step);
  if (steps >= least_steps_a_revolution) return;
  progress.note("transient.step: " + general(steps, 3) + " steps a revolution at " +
                general(speed, 4) + " rad/s, fewer than " + general(least_steps_a_revolution, 3) +
                "; motions faster than " + general(followed_frequency(options), 3) + " Hz have " +
                "fewer than " + general(steps_a_cycle, 3) + " steps a cycle");
}

std::string summary(const io::Case& input, const analysis::TransientRun& run,
                    const std::vector<double>& fired, double began, double seconds) {
  const double simulated = run.end.time - began;
  std::string text = (input.turbine.title.empty() ? input.path : input.turbine.title) + "\n";
  text += "time         " + general(began, 6) + " to " + general(run.end.time, 6) + " s" +
          (run.reason == analysis::TransientEnd::complete ? "" : ": interrupted") + "\n";
  text += "method       " + run.method + ", " + std::to_string(run.steps) + " steps, " +
          general(static_cast<double>(run.newton_steps) / static_cast<double>(run.steps), 3) +
          " Newton steps each, " + std::to_string(run.factorizations) + " factorizations";
  if (run.cuts > 0) text += ", " + std::to_string(run.cuts) + " cuts of the step";
  text += "\nresolved     motions up to " +
          general(followed_frequency(input.transient.options), 3) + " Hz, with " +
          general(steps_a_cycle, 3) + " steps a cycle";
  for (std::size_t i = 0; i < fired.size(); ++i)
    if (std::isfinite(fired[i]))
      text += "\nevent        transient.events[" + std::to_string(i) +
              "] at t = " + general(fired[i], 6) + " s";
  text += "\nspeed        " + general(seconds, 3) + " s, " + general(simulated / seconds, 3) +
          " times real time\n\n";
  return text;
}

/// An event that never came is one that the user has wrong.
void require_fired(const io::TransientCase& transient, const std::vector<double>& fired) {
  for (std::size_t i = 0; i < fired.size(); ++i) {
    if (std::isfinite(fired[i])) continue;
    const turbine::EventTrigger& trigger = transient.events[i].trigger;
    throw InputError("transient.events[" + std::to_string(i) + "] never came: " + trigger.channel +
                     " was never " + (trigger.above ? "above " : "below ") +
                     general(trigger.level, 6) + "; the result is complete without it");
  }
}

}  // namespace

void require_transient(const io::Case& input) {
  if (!input.transient.is_given)
    throw InputError(input.path +
                     ": missing key \"transient\"; hint: --set \"transient={duration: 60, step: "
                     "0.01}\"");
  if (input.transient.start == io::TransientOrigin::trim) require_motion(input);
  const auto refuse = [&input](const std::string& key, const std::string& why) {
    throw InputError(input.path + ": transient." + key + ": " + why);
  };
  const model::TurbineDefinition& turbine = input.turbine;
  const bool is_free = turbine.shaft.generator.kind == model::JointKind::free;
  const auto require_blades = [&](const std::string& key) {
    if (turbine.blades.count == 0)
      refuse(key, "there are no blades; hint: loads and nacelle.yaw move a tower alone");
  };
  if (input.transient.speed) require_blades("speed");
  if (input.transient.pitch) require_blades("pitch_deg");
  if (input.transient.speed && is_free)
    refuse("speed",
           "the generator is free, its torque makes the speed; hint: "
           "shaft.generator.joint: locked");
  if (input.transient.yaw && turbine.nacelle.yaw.kind != model::JointKind::prescribed)
    refuse("yaw_deg", "only a joint: prescribed has a motion");
  if (input.transient.teeter && turbine.hub.teeter.kind != model::JointKind::prescribed)
    refuse("teeter_deg", "only a joint: prescribed has a motion");
  for (std::size_t i = 0; i < input.transient.events.size(); ++i) {
    const turbine::TurbineEvent& event = input.transient.events[i];
    const std::string place = "events[" + std::to_string(i) + "]";
    require_blades(place);
    if (!is_free && (event.brake > 0.0 || event.generator_off))
      refuse(place,
             "the generator is locked and takes any torque; hint: "
             "shaft.generator.joint: free");
    if (event.pitch && event.pitch->blade > turbine.blades.count)
      refuse(place + ".pitch.blade",
             "there is no such blade, there are " + std::to_string(turbine.blades.count));
  }
  for (std::size_t i = 0; i < turbine.loads.size(); ++i) {
    const auto& table = turbine.loads[i].history.table;
    if (!table.empty() &&
        (table.front().first > 0.0 || table.back().first < input.transient.options.duration))
      throw InputError(input.path + ": loads[" + std::to_string(i) +
                       "].table: does not reach over the run, from 0 to " +
                       general(input.transient.options.duration, 6) +
                       " s; hint: entries at the start and at the end");
  }
  require_followed_motions(input);
}

void run_transient(const Job& job) {
  if (petsc::Session::rank() != 0) return;  // one system, one integrator
  const io::TransientCase& transient = job.input.transient;
  if (transient.start == io::TransientOrigin::result && job.restart_path.empty())
    require_other_path(job.result_path, {transient.start_path});
  const turbine::TurbineSystem system(operated_turbine(job.input), PETSC_COMM_SELF);
  const std::vector<turbine::Channel> channels = find_channels(job.input, system).channels();
  Progress progress(true);
  for (const std::string& note : motion_notes(job.input)) progress.note(note);
  note_steps(job.input, progress);
  const HistoryStart start = find_history_start(job, system, progress);
  const model::Turbine& turbine = start.turbine;
  const turbine::TurbineSystem begun(turbine, PETSC_COMM_SELF);
  const model::Masses masses = model::compute_masses(job.input.turbine, turbine);
  io::HistoryContent content;
  content.channels = channels;
  content.azimuth = turbine.azimuth;
  content.brake_torque = turbine.chain.brake_torque;
  content.is_generator_lost = start.is_generator_lost;
  io::HistoryFile file(job.result_path, job.input, record_of(job), content,
                       [&](io::ResultFile& result) {
                         result.write_model(begun);
                         write_masses(result, masses);
                       });
  if (!job.restart_path.empty() && io::is_same_file(job.restart_path, job.result_path))
    file.resume();
  HistoryRecorder recorder(transient, file, progress);
  const Interruption interruption;
  const Clock::time_point began = Clock::now();
  try {
    HistoryLegs legs(transient, turbine, start.point, start.fired, system.layout().generator(),
                     recorder, file);
    const analysis::TransientRun run = legs.run();
    const bool is_complete = run.reason == analysis::TransientEnd::complete;
    const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
    file.finish(is_complete ? "complete" : "interrupted", is_complete ? &run.end : nullptr);
    progress.finish();
    std::cout << summary(job.input, run, legs.fired(), start.point.time, seconds)
              << channel_table(channels, recorder.extents()) << "result: " << job.result_path
              << "\n"
              << std::flush;
    if (!is_complete)
      throw Interrupted("interrupted at t = " + general(run.end.time, 6) + " s; hint: --restart " +
                        job.result_path + " goes on from its last checkpoint");
    require_fired(transient, legs.fired());
  } catch (const Interrupted&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    progress.finish();
    if (recorder.has_rows()) {
      const bool is_written = file.finish_failed(std::string("failed: ") + error.what());
      std::cerr << "samara: "
                << (is_written ? "what was computed is in "
                               : "the last rows are lost; others may be in ")
                << job.result_path << "\n";
    }
    throw;
  }
}

}  // namespace samara::drivers
