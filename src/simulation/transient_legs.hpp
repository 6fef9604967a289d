// A simulation in legs. Between two events the turbine does not change.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "samara/simulation/output_channels.hpp"
#include "samara/simulation/transient_simulation.hpp"

#include "control_loop.hpp"

namespace samara::simulation {

/// The turbine after the events with the times `fired`, one time for each event of the setup.
model::Turbine turbine_after(const TransientSetup& transient, model::Turbine turbine,
                             const std::vector<double>& fired);

/// A state event that a step has passed.
struct Crossing {
  std::size_t event = 0;
  double time = 0.0;  ///< from the secant of its channel over the step
};

/// Evaluates channels after each step, for the rows of the output and for the levels of events.
class ChannelWatch final : public analysis::TransientObserver {
 public:
  /// All arguments must outlive the object. `loop`: null without a controller.
  ChannelWatch(const TransientSetup& transient, TransientOutput& output, ControlLoop* loop);

  /// The following steps use this system; `watched`: events that have not occurred yet. The system
  /// must outlive the leg. `state`: state for checkpoints, except the point.
  void begin_leg(const turbine::TurbineSystem& system, const std::vector<std::size_t>& watched,
                 const TransientState& state);

  bool sample(const analysis::TransientSample& sample) override;
  void checkpoint(const analysis::TransientStart& point) override;
  void note(const std::string& text) override { output_.note(text); }

  /// One range per channel.
  const std::vector<ChannelRange>& ranges() const { return ranges_; }
  /// The event that ended the leg.
  const std::optional<Crossing>& crossing() const { return crossing_; }

 private:
  void take_row(const analysis::TransientSample& sample);
  bool find_crossing(const analysis::TransientSample& sample);

  const TransientSetup& transient_;
  TransientOutput& output_;
  ControlLoop* loop_;
  TransientState state_;
  std::optional<OutputChannels> channels_;
  std::optional<turbine::TurbineChannels> watch_;
  std::vector<std::size_t> watched_;
  std::vector<double> levels_;  ///< levels of the watched channels at the last sample
  bool has_level_ = false;
  double time_ = 0.0;  ///< time of the last sample
  std::optional<Crossing> crossing_;
  std::vector<double> values_;
  std::vector<ChannelRange> ranges_;
  long steps_;
  std::optional<double> last_row_;  ///< [s]
};

class TransientLegs {
 public:
  /// `begun`: at the start, before the events that have occurred according to `state`. `turbine`:
  /// the same, or with a controller in the place of its laws.
  /// `generator`: unknown of the generator's angle. `loop`: null without a controller. Setup,
  /// output and loop must outlive the object. `comm`: ranks that share a large mesh.
  TransientLegs(const TransientSetup& transient,
                std::shared_ptr<const turbine::TurbineSystem> begun, const model::Turbine& turbine,
                TransientState state, int generator, TransientOutput& output, ControlLoop* loop,
                MPI_Comm comm);

  /// @throws ConvergenceError as `analysis::run_transient`
  TransientSummary run();

 private:
  analysis::TransientRun run_leg(std::optional<double> stop, const std::vector<std::size_t>& watch);
  void pass(Crossing crossing, const analysis::TransientRun& leg);
  void fire(std::size_t i);
  void fire_at(double time);
  double on_grid(double time) const;
  std::optional<double> next_time() const;
  std::vector<std::size_t> to_watch() const;

  const TransientSetup& transient_;
  analysis::TransientOptions options_;
  model::Turbine turbine_;
  std::shared_ptr<const turbine::TurbineSystem> system_;  ///< of the turbine; null: not made yet
  TransientState state_;
  int generator_;
  ControlLoop* loop_;
  MPI_Comm comm_;
  ChannelWatch watch_;
  analysis::TransientRun total_;
};

}  // namespace samara::simulation
