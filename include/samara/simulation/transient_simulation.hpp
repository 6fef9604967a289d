// The time series of a scenario: its start, events and channels, and its continuation.
//
// Between two events the turbine does not change, and the steps are those of
// analysis::run_transient, which distributes large meshes over ranks.
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

/// Time of an event that has not occurred.
inline constexpr double never = std::numeric_limits<double>::quiet_NaN();

/// State from which a simulation continues.
struct TransientState {
  analysis::TransientStart point;
  std::vector<double> events;      ///< time of each event of the scenario [s], or `never`
  double azimuth = 0.0;            ///< azimuth of blade 1 at t = 0 [rad]
  double brake_torque = 0.0;       ///< from t = 0 on [N m]
  bool is_generator_lost = false;  ///< from t = 0 on
};

/// Receives the output of a simulation while it runs.
class TransientOutput : public analysis::Observer {
 public:
  /// Values of the channels, in their units, every `output_steps` steps.
  virtual void row(double t, std::span<const double> values) {
    (void)t;
    (void)values;
  }
  /// Receives a checkpoint: from `state` another simulation continues like this one.
  virtual void checkpoint(const TransientState& state) { (void)state; }
  /// Called after each step; false ends the simulation.
  virtual bool goes_on() { return true; }
};

/// Statistics of the values of a channel over the rows.
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
  std::vector<ChannelRange> ranges;  ///< one per channel
};

/// The requested channels of the setup. The channels of its events must also exist. @throws
/// InputError
std::vector<turbine::Channel> find_channels(const TransientSetup& transient,
                                            const turbine::TurbineSystem& system);

class TransientSimulation {
 public:
  /// `comm`: ranks that share a large mesh. All of them call the same functions, and the outputs of
  /// all get the same rows. Not with a controller, whose library has one process.
  /// @throws InputError if the turbine cannot be built, or has no such channel
  explicit TransientSimulation(Scenario scenario, MPI_Comm comm = PETSC_COMM_SELF);
  ~TransientSimulation();
  TransientSimulation(TransientSimulation&&) noexcept;
  TransientSimulation& operator=(TransientSimulation&&) noexcept;

  /// False: every rank computes the same.
  bool is_distributed() const { return comm_ != PETSC_COMM_SELF; }
  const Scenario& scenario() const { return scenario_; }
  const std::vector<turbine::Channel>& channels() const { return channels_; }
  /// System of the turbine before any event: at t = 0 of the scenario, from a start on at its
  /// state.
  const turbine::TurbineSystem& system() const { return *system_; }
  /// The turbine at the start: at its azimuth, with the effects of earlier events.
  const model::Turbine& turbine() const { return turbine_; }
  const TransientState& state() const { return state_; }

  /// Starts on the steady state or undeformed, as the scenario specifies.
  /// @throws InputError if a prescribed motion does not begin on the steady state
  void start(analysis::Observer& observer);

  /// Continues the simulation of `before` from its checkpoint `state`.
  /// @throws InputError if the scenario has other steps or events, or a controller
  void restart(const Scenario& before, TransientState state);

  /// Starts at the end of the simulation of `before`; this is t = 0 of the new time series. Effects
  /// of events on the drive train remain.
  /// A generator with another law, or one that counts as such (`is_new_law`), gives the torque of
  /// the law only: the torque that held the mean speed before is removed.
  /// @throws InputError if motions do not continue from there, or `before` has a controller
  void start_after(const Scenario& before, const TransientState& end, analysis::Observer& observer,
                   bool is_new_law = false);

  /// Starts on the steady state of `before`.
  /// @throws InputError as start_after
  void start_on(const Scenario& before, const analysis::Trim& trim, bool is_new_law = false);

  /// `controller`: called every `TransientSetup::controller` step; null where there is none.
  /// @throws InputError before a start; ConvergenceError as analysis::run_transient, and of the
  /// controller
  TransientSummary run(TransientOutput& output, SteppedController* controller = nullptr);

 private:
  void require_size(Eigen::Index unknowns) const;
  void use_law(const Scenario& before, bool is_new_law, TransientState& state) const;
  void begin(TransientState state);

  Scenario scenario_;
  MPI_Comm comm_ = PETSC_COMM_SELF;
  std::shared_ptr<const turbine::TurbineSystem> system_;
  std::vector<turbine::Channel> channels_;
  model::Turbine turbine_;
  TransientState state_;
  bool is_started_ = false;
};

}  // namespace samara::simulation
