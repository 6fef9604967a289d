// Torques on joints and bodies that depend on speeds and angles.
#pragma once

#include <cmath>
#include <utility>

#include "samara/elements/rigid_tree.hpp"
#include "samara/elements/torque_line.hpp"

namespace samara::elements {

/// Torque of a rotor's torque line, over the angular velocity of its hub.
class SpinTorque final : public TorqueFunction {
 public:
  explicit SpinTorque(TorqueLine line) : line_(std::move(line)) {}
  JointTorque at(double, double rate) const override {
    const TorqueLine::Value torque = line_.at(rate);
    return {torque.torque, 0.0, torque.slope};
  }

 private:
  TorqueLine line_;
};

/// Torque of a torque line against the rotation behind a gear, which is `gear` times as fast as the
/// joint.
class GearedTorque final : public TorqueFunction {
 public:
  GearedTorque(TorqueLine line, double gear) : line_(std::move(line)), gear_(gear) {}
  JointTorque at(double, double rate) const override {
    const TorqueLine::Value torque = line_.at(rate * gear_);
    return {-gear_ * torque.torque, 0.0, -gear_ * gear_ * torque.slope};
  }

 private:
  TorqueLine line_;
  double gear_;
};

/// Torque of a brake, against the rotation in either sense. Below `brake_speed` it falls to zero at
/// rest.
class BrakeTorque final : public TorqueFunction {
 public:
  static constexpr double brake_speed = 1e-2;  ///< joint rate [rad/s]

  explicit BrakeTorque(double torque) : torque_(torque) {}
  JointTorque at(double, double rate) const override {
    const double relative = rate / brake_speed;
    const double length = std::sqrt(relative * relative + 1.0);
    return {-torque_ * relative / length, 0.0, -torque_ / (brake_speed * length * length * length)};
  }

 private:
  double torque_;
};

/// Torque of stops: a second spring and damper beyond an angle, in both senses.
class StopTorque final : public TorqueFunction {
 public:
  StopTorque(double angle, double stiffness, double damping)
      : angle_(angle), stiffness_(stiffness), damping_(damping) {}
  JointTorque at(double angle, double rate) const override {
    if (std::abs(angle) <= angle_) return {};
    const double end = angle > 0.0 ? angle_ : -angle_;
    return {-(angle - end) * stiffness_ - rate * damping_, -stiffness_, -damping_};
  }

 private:
  double angle_;
  double stiffness_;
  double damping_;
};

}  // namespace samara::elements
