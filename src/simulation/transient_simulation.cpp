#include "samara/simulation/transient_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/simulation/output_channels.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/simulation/validation.hpp"

#include "control_loop.hpp"
#include "transient_legs.hpp"

namespace samara::simulation {
namespace {

/// Tolerance of motions at the start: rates relative to the largest, angles [rad].
constexpr double motion_tolerance = 2e-6;
/// Largest distance of a checkpoint from the grid, relative to a step.
constexpr double grid_tolerance = 1e-9;

/// Turns the rotor at t = 0. Harmonic loads and motions keep their phase relative to the azimuth.
void set_azimuth(model::Turbine& turbine, double azimuth) {
  const double gained = azimuth - turbine.azimuth;
  turbine.azimuth = azimuth;
  const auto turn = [gained](auto& variation) { variation.phase += variation.per_rev * gained; };
  turbine.for_each_motion(turn);
  for (model::BeamLoad& load : turbine.tower.loads) turn(load.variation);
  for (model::Beam& blade : turbine.blades)
    for (model::BeamLoad& load : blade.loads) turn(load.variation);
}

/// The turbine at t = 0 of a simulation that starts with this state.
model::Turbine turbine_at_start(model::Turbine turbine, const TransientState& state) {
  set_azimuth(turbine, state.azimuth);
  turbine.chain.brake_torque = state.brake_torque;
  if (state.is_generator_lost) turbine.chain.generator_torque = {};
  return turbine;
}

/// Prescribed motions must continue from their values at the checkpoint.
void require_same_motion(const model::Turbine& there, double t, const model::Turbine& here) {
  const auto compare = [](const std::string& what, double before, double now, double size,
                          double unit, const std::string& unit_name) {
    if (std::abs(before - now) <= motion_tolerance * size) return;
    throw InputError(
        "has " + what + " " + general(before / unit, 10) + " " + unit_name +
        ", this time series begins with " + general(now / unit, 10) +
        "; hint: prescribed motions must continue from there, a jump causes an infinite load");
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

bool loses_generator(const TransientSetup& transient, const std::vector<double>& events) {
  for (std::size_t i = 0; i < events.size(); ++i)
    if (std::isfinite(events[i]) && transient.events[i].generator_off) return true;
  return false;
}

/// True if both are the same model; the title does not matter.
bool is_same_turbine(const model::TurbineDefinition& a, model::TurbineDefinition b) {
  b.title = a.title;
  return a == b;
}

}  // namespace

void ChannelRange::add(double value) {
  least = std::min(least, value);
  largest = std::max(largest, value);
  sum += value;
  last = value;
  ++rows;
}

TransientSimulation::TransientSimulation(Scenario scenario, MPI_Comm comm)
    : scenario_(std::move(scenario)) {
  require_none(validate(scenario_, Analysis::transient), "");
  turbine_ = build_operated_turbine(scenario_);
  system_ = std::make_shared<const turbine::TurbineSystem>(turbine_, PETSC_COMM_SELF);
  channels_ = find_channels(scenario_.transient, *system_);
  if (!scenario_.transient.controller &&
      analysis::is_distributed(*system_, scenario_.transient.options, comm))
    comm_ = comm;
}

TransientSimulation::~TransientSimulation() = default;
TransientSimulation::TransientSimulation(TransientSimulation&&) noexcept = default;
TransientSimulation& TransientSimulation::operator=(TransientSimulation&&) noexcept = default;

void TransientSimulation::start(analysis::Observer& observer) {
  if (scenario_.transient.start == TransientOrigin::result)
    throw InputError(
        "transient.start: the start is a result; hint: call start_after or start_on with it");
  TransientState state;
  state.events.assign(scenario_.transient.events.size(), never);
  state.azimuth = system_->turbine().azimuth;
  if (scenario_.transient.start == TransientOrigin::undeformed) {
    state.point = analysis::start_undeformed(*system_, 0.0);
  } else {
    // Motions in time must begin at their values in the steady state.
    const model::Turbine steady = model::build_turbine(scenario_.turbine);
    at_place("transient.start: trim",
             [&] { require_same_motion(steady, 0.0, system_->turbine()); });
    const turbine::TurbineSystem repeating(steady, PETSC_COMM_SELF);
    const analysis::Trim trim = find_trim(scenario_, repeating, observer, comm_);
    state.point = analysis::start_on(repeating, trim, 0.0);
  }
  begin(std::move(state));
}

void TransientSimulation::restart(const Scenario& before, TransientState state) {
  require_size(state.point.z.size());
  if (!is_same_turbine(before.turbine, scenario_.turbine))
    throw InputError(
        "was run with another turbine; hint: give this result as transient.start for a new time "
        "series");
  const analysis::TransientOptions& options = scenario_.transient.options;
  const analysis::TransientOptions& ran = before.transient.options;
  if (scenario_.transient.controller)
    throw InputError(
        "cannot be continued with transient.controller: the library's memory is lost with its "
        "process");
  const std::string hint = "; hint: give this result as transient.start for a new time series";
  const analysis::TransientStart& point = state.point;
  const double grid = point.origin + static_cast<double>(point.step) * options.step;
  if (std::abs(grid - point.time) > grid_tolerance * options.step)
    throw InputError("was run with another transient.step" + hint);
  if (ran.method != options.method || ran.step_tolerance != options.step_tolerance)
    throw InputError("was run with another transient.method or step_tolerance" + hint);
  if (point.time >= point.origin + options.duration * (1.0 - 1e-12))
    throw InputError("reaches to t = " + general(point.time, 6) +
                     " s already; hint: a longer transient.duration");
  if (state.events.size() != scenario_.transient.events.size())
    throw InputError("was run with other transient.events" + hint);
  begin(std::move(state));
}

void TransientSimulation::start_after(const Scenario& before, const TransientState& end,
                                      analysis::Observer& observer, bool is_new_law) {
  require_size(end.point.z.size());
  if (before.transient.controller)
    throw InputError(
        "is of a run with transient.controller: the demands at its end are lost with the "
        "library's process; hint: start on a result of samara trim");
  if (end.events.size() != before.transient.events.size())
    throw InputError("has times of " + std::to_string(end.events.size()) +
                     " events, its case has " + std::to_string(before.transient.events.size()));
  const model::Turbine last = turbine_after(
      before.transient, turbine_at_start(build_operated_turbine(before), end), end.events);
  TransientState state;
  state.events.assign(scenario_.transient.events.size(), never);
  state.point = end.point;
  state.azimuth = last.turning_at(end.point.time).value;
  state.brake_torque = last.chain.brake_torque;
  state.is_generator_lost = end.is_generator_lost || loses_generator(before.transient, end.events);
  model::Turbine here = system_->turbine();
  set_azimuth(here, state.azimuth);
  require_same_motion(last, end.point.time, here);
  if (state.is_generator_lost) observer.note("transient.start: the generator stays lost");
  if (state.brake_torque > 0.0) observer.note("transient.start: the brake stays set");
  state.point.time = 0.0;
  state.point.origin = 0.0;
  state.point.step = 0;
  // With other loads, or from the middle of a step, rates are not known. Differences of the state
  // would then show the errors that a step leaves in the constraints.
  state.point.is_row =
      state.point.z_dot.size() > 0 && is_same_turbine(before.turbine, scenario_.turbine);
  use_law(before, is_new_law, state);
  begin(std::move(state));
}

void TransientSimulation::start_on(const Scenario& before, const analysis::Trim& trim,
                                   bool is_new_law) {
  require_size(trim.solution.coefficients().rows());
  const model::Turbine steady = model::build_turbine(before.turbine);
  TransientState state;
  state.events.assign(scenario_.transient.events.size(), never);
  state.azimuth = steady.azimuth;
  model::Turbine here = system_->turbine();
  set_azimuth(here, state.azimuth);
  require_same_motion(steady, 0.0, here);
  state.point = analysis::start_on(*system_, trim, 0.0);
  if (!is_same_turbine(before.turbine, scenario_.turbine)) state.point.z_dot.resize(0);
  use_law(before, is_new_law, state);
  begin(std::move(state));
}

TransientSummary TransientSimulation::run(TransientOutput& output, SteppedController* controller) {
  if (!is_started_) throw InputError("a simulation must be started before it runs");
  if (scenario_.transient.controller.has_value() != (controller != nullptr))
    throw InputError(controller == nullptr ? "transient.controller: the run has no controller"
                                           : "the scenario has no transient.controller");
  const analysis::TransientStart& point = state_.point;
  if (point.time >= point.origin + scenario_.transient.options.duration * (1.0 - 1e-12))
    throw InputError("the simulation has reached its end, t = " + general(point.time, 6) + " s");
  const int generator = system_->layout().generator();
  model::Turbine turbine = turbine_;
  TransientState state = state_;
  std::optional<ControlLoop> loop;
  if (controller != nullptr) {
    loop.emplace(scenario_.transient, *controller, output);
    loop->take_over(turbine, state, generator);
  }
  TransientLegs legs(scenario_.transient, system_, turbine, state, generator, output,
                     loop ? &*loop : nullptr, comm_);
  TransientSummary summary = legs.run();
  state_ = summary.end;
  return summary;
}

void TransientSimulation::require_size(Eigen::Index unknowns) const {
  if (unknowns != system_->size())
    throw InputError("its state has " + std::to_string(unknowns) + " unknowns, the model has " +
                     std::to_string(system_->size()));
}

/// A new law gives the whole torque. The torque that held the mean speed under the old law is
/// removed.
void TransientSimulation::use_law(const Scenario& before, bool is_new_law,
                                  TransientState& state) const {
  if (!is_new_law && before.turbine.shaft.generator.law == scenario_.turbine.shaft.generator.law)
    return;
  std::erase_if(state.point.held, [this](const analysis::HeldCoordinate& one) {
    return one.unknown == system_->layout().generator();
  });
}

void TransientSimulation::begin(TransientState state) {
  turbine_ = turbine_at_start(system_->turbine(), state);
  system_ = std::make_shared<const turbine::TurbineSystem>(turbine_, PETSC_COMM_SELF);
  state_ = std::move(state);
  is_started_ = true;
}

std::vector<turbine::Channel> find_channels(const TransientSetup& transient,
                                            const turbine::TurbineSystem& system) {
  for (std::size_t i = 0; i < transient.events.size(); ++i)
    if (const turbine::EventTrigger& trigger = transient.events[i].trigger; !trigger.time)
      at_place("transient.events[" + std::to_string(i) + "].when.channel", [&] {
        return turbine::TurbineChannels(system, transient.stations, {trigger.channel});
      });
  return at_place("transient.output.channels",
                  [&] { return OutputChannels(system, transient).channels(); });
}

}  // namespace samara::simulation
