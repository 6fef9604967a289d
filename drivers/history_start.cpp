#include "history_start.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "samara/base/error.hpp"
#include "samara/io/history_file.hpp"
#include "samara/io/result_reader.hpp"

#include "history_legs.hpp"
#include "same_model.hpp"
#include "table.hpp"
#include "trim_accuracy.hpp"

namespace samara::drivers {
namespace {

using analysis::TransientStart;

/// Keys in which a history may differ from the result that it starts from: what acts on the
/// turbine, and motions, which are compared as they are at that instant.
constexpr std::array<std::string_view, 8> acting_keys{
    "gravity",     "loads",       "shaft.azimuth_deg", "shaft.generator.torque",
    "shaft.rotor", "shaft.speed", "blades.pitch_deg",  "blades.each.*.pitch_deg"};
/// Of motions at the start: rates relative to the largest, angles [rad].
constexpr double motion_tolerance = 2e-6;

/// The torque law of the generator.
ModelKeys law_of(const std::string& text) {
  ModelKeys keys = model_keys(text);
  std::erase_if(keys,
                [](const auto& one) { return !one.first.starts_with("shaft.generator.torque"); });
  return keys;
}

/// Turns the rotor at t = 0; what goes with it keeps its azimuth.
void set_azimuth(model::Turbine& turbine, double azimuth) {
  const double gained = azimuth - turbine.azimuth;
  turbine.azimuth = azimuth;
  const auto turn = [gained](auto& history) { history.phase += history.per_rev * gained; };
  turbine.for_each_motion(turn);
  for (model::BeamLoad& load : turbine.tower.loads) turn(load.history);
  for (model::Beam& blade : turbine.blades)
    for (model::BeamLoad& load : blade.loads) turn(load.history);
}

io::HistoryCheckpoint checkpoint_of(const std::string& path, const io::HistoryReader& history,
                                    const turbine::TurbineSystem& system, Progress& progress) {
  if (history.content().checkpoints.empty())
    throw InputError(history.damage().empty()
                         ? path +
                               ": has no checkpoint; hint: transient.checkpoint sets their distance"
                         : history.damage() + ", and no checkpoint");
  if (!history.damage().empty()) progress.note(history.damage());
  io::HistoryCheckpoint last = history.content().checkpoints.back();
  io::place_held(system, last.point.held);
  if (last.point.z.size() != system.size())
    throw InputError(path + ": its state has " + std::to_string(last.point.z.size()) +
                     " unknowns, the model " + std::to_string(system.size()));
  return last;
}

HistoryStart restart(const Job& job, const turbine::TurbineSystem& system, Progress& progress) {
  const io::HistoryReader history(job.restart_path);
  const io::HistoryContent& content = history.content();
  require_same_model(job.restart_path, content.model, job.input.model_text);
  const io::HistoryCheckpoint checkpoint =
      checkpoint_of(job.restart_path, history, system, progress);
  const TransientStart& point = checkpoint.point;
  const analysis::TransientOptions& options = job.input.transient.options;
  const double grid = point.origin + static_cast<double>(point.step) * options.step;
  if (std::abs(grid - point.time) > 1e-9 * options.step)
    throw InputError(job.restart_path +
                     ": was run with another transient.step; hint: transient.start: " +
                     job.restart_path + " begins a history of its own there");
  const analysis::TransientOptions& before =
      io::read_result_case(job.restart_path).transient.options;
  if (before.method != options.method || before.step_tolerance != options.step_tolerance)
    throw InputError(job.restart_path +
                     ": was run with another transient.method or step_tolerance; hint: "
                     "transient.start: " +
                     job.restart_path + " begins a history of its own there");
  if (point.time >= point.origin + options.duration * (1.0 - 1e-12))
    throw InputError(job.restart_path + ": reaches to t = " + general(point.time, 6) +
                     " s already; hint: a longer transient.duration");
  if (checkpoint.events.size() != job.input.transient.events.size())
    throw InputError(job.restart_path +
                     ": was run with other transient.events; hint: transient.start: " +
                     job.restart_path + " takes new ones");
  HistoryStart start{point, checkpoint.events, system.turbine(), content.is_generator_lost};
  set_azimuth(start.turbine, content.azimuth.value_or(system.turbine().azimuth));
  start.turbine.chain.brake_torque = content.brake_torque;
  if (start.is_generator_lost) start.turbine.chain.generator_torque = {};
  return start;
}

/// What is prescribed goes on where it was.
void require_same_motion(const std::string& path, const model::Turbine& there, double t,
                         const model::Turbine& here) {
  const auto compare = [&path](const std::string& what, double before, double now, double size,
                               double unit, const std::string& unit_name) {
    if (std::abs(before - now) <= motion_tolerance * size) return;
    throw InputError(path + ": has " + what + " " + general(before / unit, 10) + " " + unit_name +
                     ", this history begins with " + general(now / unit, 10) +
                     "; hint: what moves goes on from there, for a jump would be an infinite load");
  };
  constexpr double degree = std::numbers::pi / 180.0;
  const double speed = there.turning_at(t).rate;
  compare("the speed", speed, here.turning_at(0.0).rate, std::max(1.0, std::abs(speed)), 1.0,
          "rad/s");
  for (std::size_t k = 0; k < here.blades.size(); ++k) {
    const math::TimeCurve::Value before = there.pitch_at(k, t);
    const math::TimeCurve::Value now = here.pitch_at(k, 0.0);
    const std::string of_blade = " of blade " + std::to_string(k + 1);
    compare("the pitch" + of_blade, before.value, now.value, 1.0, degree, "deg");
    compare("the pitch rate" + of_blade, before.rate, now.rate, 1.0, degree, "deg/s");
  }
  const auto compare_joint = [&](const std::string& name, const elements::JointMotion& before,
                                 const elements::JointMotion& now) {
    compare("the angle of the " + name, before.angle, now.angle, 1.0, degree, "deg");
    compare("the rate of the " + name, before.rate, now.rate, 1.0, degree, "deg/s");
  };
  compare_joint("yaw", there.yaw_at(t), here.yaw_at(0.0));
  compare_joint("teeter", there.teeter_at(t), here.teeter_at(0.0));
}

bool is_generator_lost(const io::TransientCase& transient, const std::vector<double>& fired) {
  for (std::size_t i = 0; i < fired.size(); ++i)
    if (std::isfinite(fired[i]) && transient.events[i].generator_off) return true;
  return false;
}

/// The end of a history: with it t = 0 comes.
HistoryStart start_behind(const std::string& path, const io::Case& before, const io::Case& input,
                          const turbine::TurbineSystem& system, Progress& progress) {
  const io::HistoryReader history(path);
  const io::HistoryContent& content = history.content();
  model::Turbine there = operated_turbine(before);
  set_azimuth(there, content.azimuth.value_or(there.azimuth));
  there.chain.brake_torque = content.brake_torque;
  const io::HistoryCheckpoint checkpoint = checkpoint_of(path, history, system, progress);
  if (checkpoint.events.size() != before.transient.events.size())
    throw InputError(path + ": /transient/checkpoint/event_time has " +
                     std::to_string(checkpoint.events.size()) + " times, its case has " +
                     std::to_string(before.transient.events.size()) + " events");
  const model::Turbine last = turbine_after(before.transient, there, checkpoint.events);
  HistoryStart start{checkpoint.point, {}, system.turbine()};
  TransientStart& point = start.point;
  set_azimuth(start.turbine, last.turning_at(point.time).value);
  require_same_motion(path, last, point.time, start.turbine);
  // What events did to the drive train stays done.
  const bool is_braked = last.chain.brake_torque > 0.0;
  start.turbine.chain.brake_torque = last.chain.brake_torque;
  start.is_generator_lost =
      content.is_generator_lost || is_generator_lost(before.transient, checkpoint.events);
  if (start.is_generator_lost) start.turbine.chain.generator_torque = {};
  if (start.is_generator_lost || is_braked)
    progress.note(path + " left " + (start.is_generator_lost ? "its generator lost" : "") +
                  (start.is_generator_lost && is_braked ? " and " : "") +
                  (is_braked ? "its brake set" : "") + ", and so it stays");
  point.time = 0.0;
  point.origin = 0.0;
  point.step = 0;
  // With other loads, or from the middle of a step, rates are not known, and differences of the
  // state would show what a step leaves in the constraints.
  point.is_row = point.z_dot.size() > 0 && before.model_text == input.model_text;
  return start;
}

HistoryStart start_on_steady_state(const std::string& path, const io::Case& before,
                                   const io::Case& input, const turbine::TurbineSystem& system,
                                   Progress& progress) {
  const model::Turbine steady = model::build_turbine(before.turbine);
  HistoryStart start{{}, {}, system.turbine()};
  set_azimuth(start.turbine, steady.azimuth);
  require_same_motion(path, steady, 0.0, start.turbine);
  analysis::Trim trim = io::read_result_trim(path);
  io::place_held(system, trim.held);
  note_roughness(trim, progress, path);
  if (trim.solution.coefficients().rows() != system.size())
    throw InputError(path + ": its steady state has " +
                     std::to_string(trim.solution.coefficients().rows()) + " unknowns, the model " +
                     std::to_string(system.size()));
  start.point = analysis::start_on(system, trim, 0.0);
  if (before.model_text != input.model_text) start.point.z_dot.resize(0);
  return start;
}

HistoryStart start_from(const std::string& path, const io::Case& input,
                        const turbine::TurbineSystem& system, Progress& progress) {
  const io::Case before = io::read_result_case(path);
  require_same_model(path, before.model_text, input.model_text, acting_keys);
  const io::ResultKind kind = io::find_result_kind(path);
  if (kind == io::ResultKind::other)
    throw InputError(
        path + ": has no state to start from; hint: results of transient, trim and floquet have");
  HistoryStart start = kind == io::ResultKind::history
                           ? start_behind(path, before, input, system, progress)
                           : start_on_steady_state(path, before, input, system, progress);
  // A new law is all of the torque: what held the mean speed under the old one goes.
  if (law_of(before.model_text) != law_of(input.model_text))
    std::erase_if(start.point.held, [&system](const analysis::HeldCoordinate& one) {
      return one.unknown == system.layout().generator();
    });
  return start;
}

}  // namespace

HistoryStart find_history_start(const Job& job, const turbine::TurbineSystem& system,
                                Progress& progress) {
  const io::TransientCase& transient = job.input.transient;
  if (!job.restart_path.empty()) return restart(job, system, progress);
  switch (transient.start) {
    case io::TransientOrigin::undeformed:
      return {analysis::start_undeformed(system, 0.0), {}, system.turbine()};
    case io::TransientOrigin::result:
      return at_place(job.input.path + ": transient.start", [&] {
        return start_from(transient.start_path, job.input, system, progress);
      });
    case io::TransientOrigin::trim:
      break;
  }
  // What moves in time begins where the steady state is.
  const model::Turbine steady = model::build_turbine(job.input.turbine);
  require_same_motion(job.input.path + ": transient.start: trim", steady, 0.0, system.turbine());
  const turbine::TurbineSystem repeating(steady, PETSC_COMM_SELF);
  const analysis::Trim trim = analysis::find_trim(repeating, job.input.trim, progress);
  note_roughness(trim, progress);
  return {analysis::start_on(repeating, trim, 0.0), {}, system.turbine()};
}

}  // namespace samara::drivers
