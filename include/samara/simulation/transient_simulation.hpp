// The time series of a scenario: its start, its events, its channels, and how it goes on.
//
// From event to event the turbine is the same, and the steps are those of
// analysis::run_transient. A simulation is serial: every rank computes the same.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/transient.hpp"
#include "samara/simulation/scenario.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// Time of an event that did not come yet.
inline constexpr double never = std::numeric_limits<double>::quiet_NaN();

/// From where a simulation goes on.
struct TransientState {
  analysis::TransientStart point;
  std::vector<double> events;      ///< when each one of the scenario came [s], or `never`
  double azimuth = 0.0;            ///< of blade 1 at t = 0 [rad]
  double brake_torque = 0.0;       ///< from t = 0 on [N m]
  bool is_generator_lost = false;  ///< from t = 0 on
};

/// Takes what a simulation gives, while it runs.
class TransientOutput : public analysis::Observer {
 public:
  /// Values of the channels, in their units, every `output_steps` steps.
  virtual void row(double t, std::span<const double> values) {
    (void)t;
    (void)values;
  }
  /// From `state` another simulation goes on as this one does.
  virtual void checkpoint(const TransientState& state) { (void)state; }
  /// After each step: false ends the simulation there.
  virtual bool goes_on() { return true; }
};

/// The values of a channel, over the rows.
struct ChannelRange {
  double least = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();
  double sum = 0.0;
  double last = 0.0;
  long rows = 0;

  void add(double value);
  double mean() const { return sum / static_cast<double>(rows); }
};

struct TransientSummary {
  analysis::TransientRun run;
  double began = 0.0;  ///< [s]
  TransientState end;
  std::vector<ChannelRange> ranges;  ///< one for each channel
};

/// The channels that the setup asks for; those of its events must exist, too. @throws InputError
std::vector<turbine::Channel> find_channels(const TransientSetup& transient,
                                            const turbine::TurbineSystem& system);

class TransientSimulation {
 public:
  /// @throws InputError where the turbine cannot be built, or has no such channel
  explicit TransientSimulation(Scenario scenario);
  ~TransientSimulation();
  TransientSimulation(TransientSimulation&&) noexcept;
  TransientSimulation& operator=(TransientSimulation&&) noexcept;

  const Scenario& scenario() const { return scenario_; }
  const std::vector<turbine::Channel>& channels() const { return channels_; }
  /// System of the turbine at t = 0 of the scenario, before any event.
  const turbine::TurbineSystem& system() const { return *system_; }
  /// The turbine as it is at the start: at its azimuth, with what events before did to it.
  const model::Turbine& turbine() const { return turbine_; }
  const TransientState& state() const { return state_; }

  /// Starts on the steady state or undeformed, as the scenario says.
  /// @throws InputError where a prescribed motion does not begin on the steady state
  void start(analysis::Observer& observer);

  /// Goes on with the simulation of `before` where `state` is a checkpoint of it.
  /// @throws InputError where the scenario has other steps or events
  void restart(const Scenario& before, TransientState state);

  /// Starts at the end of the simulation of `before`, which is t = 0 here. Effects of events on the
  /// drive train remain.
  /// A generator with another law, or one that counts as such (`is_new_law`), gives the torque of
  /// the law only: the torque that held the mean speed before is removed.
  /// @throws InputError where motions do not go on from there
  void start_after(const Scenario& before, const TransientState& end, analysis::Observer& observer,
                   bool is_new_law = false);

  /// Starts on the steady state of `before`.
  /// @throws InputError as start_after
  void start_on(const Scenario& before, const analysis::Trim& trim, bool is_new_law = false);

  /// @throws InputError before a start; ConvergenceError as analysis::run_transient
  TransientSummary run(TransientOutput& output);

 private:
  void require_size(Eigen::Index unknowns) const;
  void use_law(const Scenario& before, bool is_new_law, TransientState& state) const;
  void begin(TransientState state);

  Scenario scenario_;
  std::unique_ptr<turbine::TurbineSystem> system_;
  std::vector<turbine::Channel> channels_;
  model::Turbine turbine_;
  TransientState state_;
  bool is_started_ = false;
};

}  // namespace samara::simulation
