// A stepped controller in a transient: what it measures, and how its demands move the turbine.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "samara/simulation/transient_simulation.hpp"

namespace samara::simulation {

/// A number that keeps its value from one call to the next. At the instant of a call it has the
/// value from before.
class HeldValue {
 public:
  explicit HeldValue(double value) : before_(value), now_(value) {}
  void set(double t, double value);
  double at(double t) const { return has_begun_ && t > begin_ ? now_ : before_; }

 private:
  double before_;
  double now_;
  double begin_ = 0.0;
  bool has_begun_ = false;
};

/// An angle that moves to each demand in the interval after it, by a straight line that is averaged
/// over one interval: the rate is continuous, and within its limit.
class FollowingAngle {
 public:
  /// At rest before the first demand. Demands come at multiples of `interval`.
  FollowingAngle(double angle, double interval, double largest_rate);
  void set(double t, double demand);
  math::TimeCurve::Value at(double t) const;
  /// The straight line at the end of the interval, without the mean.
  double line() const { return line_ + slope_ * interval_; }

 private:
  /// The motion in an interval.
  struct Part {
    double begin = 0.0;
    double angle = 0.0;
    double rate = 0.0;
    double acceleration = 0.0;
  };

  double interval_;
  double largest_rate_;
  double line_;         ///< the straight line at the last call
  double slope_ = 0.0;  ///< of the straight line after the last call
  Part before_;
  Part now_;
  bool has_begun_ = false;
};

class ControlLoop {
 public:
  /// All arguments must outlive the object.
  ControlLoop(const TransientSetup& transient, SteppedController& controller,
              TransientOutput& output);

  /// Takes over pitch and generator torque of a turbine at the start of the run. The torque that
  /// held the mean speed ends. `generator`: unknown of the generator's angle.
  void take_over(model::Turbine& turbine, TransientState& state, int generator);

  /// The following samples are of this system. The first leg makes the first call.
  void begin_leg(const turbine::TurbineSystem& system, const analysis::TransientStart& point);
  /// Calls the controller where its interval ends, but for the end of the run.
  void sample(const analysis::TransientSample& sample);
  /// Makes the last call. The run is complete: a failure is noted.
  void end();

 private:
  /// A channel and its place in the measurement.
  struct Reading {
    std::string channel;
    double factor = 1.0;  ///< to SI
    double* target = nullptr;
  };

  void list_readings(const model::Turbine& turbine);
  void measure(double t, Vec z, Vec z_dot);
  void measure_pitch(double t);
  void measure_nacelle(Vec z, Vec z_dot);
  void call(ControlMeasurement::Call call);

  const TransientSetup& transient_;
  const ControllerSetup& setup_;
  SteppedController& controller_;
  TransientOutput& output_;
  long every_;      ///< steps between calls
  long last_step_;  ///< of the run
  double interval_;
  std::vector<double> offsets_;  ///< own pitch of each blade, which the controller does not see
  std::shared_ptr<HeldValue> torque_;
  std::vector<std::shared_ptr<HeldValue>> commands_;     ///< with actuators
  std::vector<std::shared_ptr<FollowingAngle>> angles_;  ///< without
  const turbine::TurbineSystem* system_ = nullptr;
  ControlMeasurement measured_;
  std::array<double, 2> wind_{};
  std::vector<Reading> readings_;
  std::optional<turbine::TurbineChannels> channels_;
  long called_ = -1;  ///< step of the last call; -1: none
};

}  // namespace samara::simulation
