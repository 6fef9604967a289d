#include "samara/io/transient_start.hpp"

#include <array>
#include <string_view>

#include "samara/base/error.hpp"
#include "samara/io/result_reader.hpp"
#include "samara/io/same_model.hpp"
#include "samara/io/time_series_file.hpp"
#include "samara/simulation/steady_state.hpp"

namespace samara::io {
namespace {

/// Keys in which a transient may differ from the result that it starts from: loads on the turbine,
/// and motions. Motions are compared at the instant of the start.
constexpr std::array<std::string_view, 9> acting_keys{
    "gravity",     "loads",       "shaft.azimuth_deg", "shaft.generator.torque",
    "shaft.rotor", "shaft.speed", "blades.pitch_deg",  "blades.each.*.pitch_deg",
    "wind"};

simulation::TransientState last_state(const std::string& path, const TimeSeriesReader& series,
                                      const Case& before, const turbine::TurbineSystem& system,
                                      analysis::Observer& observer) {
  const TimeSeriesContent& content = series.content();
  if (content.checkpoints.empty())
    throw InputError(series.damage().empty()
                         ? path +
                               ": has no checkpoint; hint: transient.checkpoint sets the time "
                               "between checkpoints"
                         : series.damage() + ", and no checkpoint");
  if (!series.damage().empty()) observer.note(series.damage());
  simulation::TransientState state;
  state.point = content.checkpoints.back().point;
  place_held(system, state.point.held);
  state.events = content.checkpoints.back().events;
  if (state.events.size() != before.transient.events.size())
    throw InputError(path + ": /transient/checkpoint/event_time has " +
                     std::to_string(state.events.size()) + " times, its case has " +
                     std::to_string(before.transient.events.size()) + " events");
  state.azimuth = content.azimuth.value_or(before.turbine.shaft.azimuth);
  state.brake_torque = content.brake_torque;
  state.is_generator_lost = content.is_generator_lost;
  return state;
}

}  // namespace

void restart_from(const std::string& path, const Case& input,
                  simulation::TransientSimulation& simulation, analysis::Observer& observer) {
  const TimeSeriesReader series(path);
  require_same_model(path, series.content().model, input.model_text);
  const Case before = read_result_case(path);
  const simulation::TransientState state =
      last_state(path, series, before, simulation.system(), observer);
  at_place(path, [&] { simulation.restart(before, state); });
}

void start_from(const std::string& path, const Case& input,
                simulation::TransientSimulation& simulation, analysis::Observer& observer) {
  const Case before = read_result_case(path);
  require_same_model(path, before.model_text, input.model_text, acting_keys);
  // A given torque, including 0, is the whole torque of the generator.
  const bool is_new_law =
      !states_alike(before.model_text, input.model_text, "shaft.generator.torque");
  const ResultKind kind = find_result_kind(path);
  if (kind == ResultKind::other)
    throw InputError(
        path + ": has no state to start from; hint: use a result of transient, trim or floquet");
  if (kind == ResultKind::time_series) {
    const TimeSeriesReader series(path);
    const simulation::TransientState end =
        last_state(path, series, before, simulation.system(), observer);
    at_place(path, [&] { simulation.start_after(before, end, observer, is_new_law); });
    return;
  }
  analysis::Trim trim = read_result_trim(path);
  place_held(simulation.system(), trim.held);
  simulation::note_doubts(simulation.system(), trim, observer, path);
  at_place(path, [&] { simulation.start_on(before, trim, is_new_law); });
}

}  // namespace samara::io
