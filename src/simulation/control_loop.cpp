#include "control_loop.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/turbine/torque_in_time.hpp"

namespace samara::simulation {

void HeldValue::set(double t, double value) {
  before_ = now_;
  now_ = value;
  begin_ = t;
  has_begun_ = true;
}

FollowingAngle::FollowingAngle(double angle, double interval, double largest_rate)
    : interval_(interval), largest_rate_(largest_rate), line_(angle) {
  before_.angle = now_.angle = angle;
}

/// The mean of a line of straight parts over one interval: its rate changes linearly from the slope
/// of one part to that of the next.
void FollowingAngle::set(double t, double demand) {
  if (has_begun_) line_ += slope_ * interval_;
  const double before = slope_;
  slope_ = std::clamp((demand - line_) / interval_, -largest_rate_, largest_rate_);
  before_ = now_;
  now_ = {t, line_ - 0.5 * before * interval_, before, (slope_ - before) / interval_};
  has_begun_ = true;
}

math::TimeCurve::Value FollowingAngle::at(double t) const {
  const Part& part = has_begun_ && t > now_.begin ? now_ : before_;
  const double inside = std::clamp(t - part.begin, 0.0, interval_);
  math::TimeCurve::Value value{part.angle + (part.rate + 0.5 * part.acceleration * inside) * inside,
                               part.rate + part.acceleration * inside, part.acceleration};
  value.value += value.rate * (t - part.begin - inside);
  return value;
}

ControlLoop::ControlLoop(const TransientSetup& transient, SteppedController& controller,
                         TransientOutput& output)
    : transient_(transient),
      setup_(*transient.controller),
      controller_(controller),
      output_(output),
      every_(setup_.step > 0.0 ? std::lround(setup_.step / transient.options.step) : 1),
      last_step_(std::lround(
          std::ceil(transient.options.duration / transient.options.step * (1.0 - 1e-9)))),
      interval_(static_cast<double>(every_) * transient.options.step) {
  measured_.interval = interval_;
}

void ControlLoop::take_over(model::Turbine& turbine, TransientState& state, int generator) {
  turbine.chain.generator_torque = {};
  if (state.is_generator_lost) turbine.operation.generator_off = true;
  std::erase_if(state.point.held, [generator](const analysis::HeldCoordinate& one) {
    return one.unknown == generator;
  });
  torque_ = std::make_shared<HeldValue>(0.0);
  turbine.extensions.push_back(std::make_shared<turbine::TorqueInTime>(
      [torque = torque_](double t) { return torque->at(t); }));
  turbine.operation.pitch.resize(turbine.blades.size());
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
    const double offset = turbine.roots[k].pitch - turbine.pitch;
    offsets_.push_back(offset);
    if (turbine.pitch_actuator) {
      commands_.push_back(std::make_shared<HeldValue>(turbine.pitch));
      turbine.operation.pitch[k] =
          math::TimeCurve::of([command = commands_.back(), offset](double t) {
            return math::TimeCurve::Value{command->at(t) + offset, 0.0, 0.0};
          });
      continue;
    }
    angles_.push_back(
        std::make_shared<FollowingAngle>(turbine.pitch, interval_, setup_.pitch_rate));
    turbine.operation.pitch[k] = math::TimeCurve::of([angle = angles_.back(), offset](double t) {
      math::TimeCurve::Value value = angle->at(t);
      value.value += offset;
      return value;
    });
  }
  list_readings(turbine);
}

void ControlLoop::list_readings(const model::Turbine& turbine) {
  constexpr double kilo = 1e3;
  constexpr double degree = std::numbers::pi / 180.0;
  constexpr double rpm = std::numbers::pi / 30.0;
  ControlMeasurement& m = measured_;
  readings_ = {{"RotSpeed", rpm, &m.rotor_speed},
               {"GenSpeed", rpm, &m.generator_speed},
               {"GenTq", kilo, &m.generator_torque},
               {"RotPwr", kilo, &m.shaft_power},
               {"Azimuth", degree, &m.azimuth},
               {"NacYaw", degree, &m.yaw},
               {"RotTorq", kilo, &m.shaft_torque},
               {"RotThrust", kilo, &m.thrust},
               {"LSShftFys", kilo, &m.shaft_force[0]},
               {"LSShftFzs", kilo, &m.shaft_force[1]},
               {"LSSTipMya", kilo, &m.turning_hub_moment[0]},
               {"LSSTipMza", kilo, &m.turning_hub_moment[1]},
               {"LSSTipMys", kilo, &m.hub_moment[0]},
               {"LSSTipMzs", kilo, &m.hub_moment[1]},
               {"YawBrMyn", kilo, &m.yaw_bearing_moment[0]},
               {"YawBrMzn", kilo, &m.yaw_bearing_moment[1]}};
  if (turbine.has_tower) {
    readings_.push_back({"YawBrTAxp", 1.0, &m.fore_aft_acceleration});
    readings_.push_back({"YawBrTAyp", 1.0, &m.side_side_acceleration});
  }
  if (turbine.air) {
    readings_.push_back({"Wind1VelX", 1.0, &wind_[0]});
    readings_.push_back({"Wind1VelY", 1.0, &wind_[1]});
  }
  const std::size_t blades = turbine.blades.size();
  for (std::vector<double>* each : {&m.pitch, &m.out_of_plane, &m.in_plane})
    each->assign(blades, 0.0);
  for (std::size_t k = 0; k < blades; ++k) {
    const std::string number = std::to_string(k + 1);
    readings_.push_back({"BldPitch" + number, degree, &m.pitch[k]});
    readings_.push_back({"RootMyc" + number, kilo, &m.out_of_plane[k]});
    readings_.push_back({"RootMxc" + number, kilo, &m.in_plane[k]});
  }
}

void ControlLoop::begin_leg(const turbine::TurbineSystem& system,
                            const analysis::TransientStart& point) {
  system_ = &system;
  std::vector<std::string> names;
  for (const Reading& reading : readings_) names.push_back(reading.channel);
  channels_.emplace(system, transient_.stations, names);
  if (called_ >= 0) return;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const auto put = [](const Eigen::VectorXd& values, Vec target) {
    const petsc::WriteView view(target);
    for (Eigen::Index i = 0; i < values.size(); ++i) view[static_cast<PetscInt>(i)] = values(i);
  };
  put(point.z, z.get());
  // Unknown rates count as zero.
  put(point.z_dot.size() > 0 ? point.z_dot : Eigen::VectorXd::Zero(point.z.size()), z_dot.get());
  measure(point.time, z.get(), z_dot.get());
  called_ = point.step;
  call(ControlMeasurement::Call::first);
}

void ControlLoop::sample(const analysis::TransientSample& sample) {
  if (!sample.on_grid || sample.step <= called_ || sample.step % every_ != 0) return;
  called_ = sample.step;
  measure(static_cast<double>(sample.step) * transient_.options.step, sample.z, sample.z_dot);
  if (sample.step < last_step_) call(ControlMeasurement::Call::next);
}

void ControlLoop::end() {
  measured_.call = ControlMeasurement::Call::last;
  try {
    controller_.call(measured_);
  } catch (const ConvergenceError& error) {
    output_.note(std::string(error.what()) + "; this was its last call, the result is complete");
  }
}

void ControlLoop::measure(double t, Vec z, Vec z_dot) {
  std::vector<double> values(readings_.size());
  channels_->evaluate(t, z, z_dot, values);
  for (std::size_t i = 0; i < values.size(); ++i)
    *readings_[i].target = values[i] * readings_[i].factor;
  measure_pitch(t);
  measured_.time = t;
  measured_.electrical_power =
      measured_.generator_torque * measured_.generator_speed * setup_.efficiency;
  measured_.wind_speed = std::hypot(wind_[0], wind_[1]);
  measured_.yaw_error =
      measured_.wind_speed > 0.0
          ? std::remainder(std::atan2(wind_[1], wind_[0]) - measured_.yaw, 2.0 * std::numbers::pi)
          : 0.0;
  measure_nacelle(z, z_dot);
}

/// A pitch that follows its demand is half an interval behind its line. Libraries limit the rate of
/// their demands from the measured pitch, and would reach two thirds of their limit: they get the
/// line, unless an event has taken the blade.
void ControlLoop::measure_pitch(double t) {
  constexpr double round_off = 1e-9;  // [rad]
  for (std::size_t k = 0; k < offsets_.size(); ++k) {
    double& pitch = measured_.pitch[k];
    pitch -= offsets_[k];
    if (k < angles_.size() && std::abs(angles_[k]->at(t).value - pitch) < round_off)
      pitch = angles_[k]->line();
  }
}

/// The rates of the components of the nacelle's angular velocity are those of its angular
/// acceleration. Axes: x downwind, y to the left, z up; then tilted with the shaft.
void ControlLoop::measure_nacelle(Vec z, Vec z_dot) {
  const turbine::TurbineLayout& layout = system_->layout();
  const petsc::ReadView values(z);
  const petsc::ReadView rates(z_dot);
  std::array<double, 3> turning{};  // of the tower top
  std::array<double, 3> turning_dot{};
  if (system_->turbine().has_tower) {
    const int at = layout.tower_tip() + 9;  // about t3, t1, t2
    turning = {values[at + 2], -values[at + 1], values[at]};
    turning_dot = {rates[at + 2], -rates[at + 1], rates[at]};
  }
  const double yaw = values[layout.yaw()];
  const double yaw_rate = values[layout.yaw() + 1] - turning[2];
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  const double roll =
      c * turning_dot[0] + s * turning_dot[1] + yaw_rate * (c * turning[1] - s * turning[0]);
  const double nod =
      c * turning_dot[1] - s * turning_dot[0] - yaw_rate * (c * turning[0] + s * turning[1]);
  const double up = rates[layout.yaw() + 1];
  const double tilt = system_->turbine().chain.tilt;
  measured_.nacelle_turning = {std::cos(tilt) * roll + std::sin(tilt) * up, nod,
                               std::cos(tilt) * up - std::sin(tilt) * roll};
}

void ControlLoop::call(ControlMeasurement::Call call) {
  measured_.call = call;
  const ControlDemand demand = controller_.call(measured_);
  if (demand.pitch.size() != offsets_.size())
    throw InternalError("the controller demands the pitch of " +
                        std::to_string(demand.pitch.size()) + " blades, there are " +
                        std::to_string(offsets_.size()));
  for (const std::string& note : demand.notes) output_.note(note);
  const double t = measured_.time;
  torque_->set(t, demand.torque);
  for (std::size_t k = 0; k < commands_.size(); ++k) commands_[k]->set(t, demand.pitch[k]);
  for (std::size_t k = 0; k < angles_.size(); ++k) angles_[k]->set(t, demand.pitch[k]);
}

}  // namespace samara::simulation
