// The pitch actuator of a blade: a second-order law whose angle and rate are first-order states
// (docs/theory.md, section 3.5).
#pragma once

#include "samara/components/component.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

class PitchActuator final : public Stated<PitchActuator> {
 public:
  /// Actuator of blade `k`, from 0. The turbine must have actuators and must outlive the component.
  PitchActuator(const model::Turbine& turbine, std::size_t k, int rank);

  /// Port of one value: pitch of a controller beside that of the blade [rad].
  int command_port() const { return command_port_; }
  /// Sets the port of angle and rate that the actuator adds to the blade's own pitch [rad, rad/s].
  void set_pitch(int port) { pitch_port_ = port; }

  void place(Registry& registry) override;
  void describe(Registry& registry) override;
  bool is_conservative() const override { return false; }

  template <class System>
  void state(System& system) const;

 private:
  static constexpr int arguments = 5;  ///< angle, rate, their rates, command
  static constexpr int values = 4;     ///< two rows, angle and rate

  const model::Turbine& turbine_;
  std::size_t k_;
  int rank_;
  int first_ = 0;
  int command_port_ = 0;
  int pitch_port_ = 0;
  Connections connections_;
};

extern template class Stated<PitchActuator>;

}  // namespace samara::components
