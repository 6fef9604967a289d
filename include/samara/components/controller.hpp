// Control of the generator's speed by torque or collective pitch: a filter of the speed, PI laws
// and a gain schedule, with first-order states (docs/theory.md, section 3.6).
#pragma once

#include <vector>

#include "samara/components/component.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

/// The unknowns that the controller measures and the ports that it acts on.
struct ControllerTies {
  int tower_top = -1;            ///< first unknown of the tower's end; -1: there is no tower
  int yaw = 0;                   ///< angle of the yaw joint; its speed follows
  int generator = 0;             ///< angle of the generator joint; its speed follows
  std::vector<int> pitch_ports;  ///< ports of angle and rate, or of the angle; empty: no pitch loop
};

class Controller final : public Stated<Controller> {
 public:
  /// The turbine must have a controller and must outlive the component.
  Controller(const model::Turbine& turbine, int rank);

  void tie(const ControllerTies& ties) { ties_ = ties; }
  void place(Registry& registry) override;
  void describe(Registry& registry) override;
  bool is_conservative() const override { return false; }

  /// Row and unknown of the integral of the speed error; -1: there is none.
  int integral() const { return has_integral() ? first_ + 1 : -1; }

  template <class System>
  void state(System& system) const;

 private:
  // Arguments: Omega of the tower top; q, U of the yaw; U of the generator; speed error, integral
  // and their rates.
  static constexpr int at_yaw = 3;
  static constexpr int at_generator = 5;
  static constexpr int at_states = 6;
  static constexpr int arguments = at_states + 4;
  // Values: two rows, torque on the generator's joint, angle and rate of the pitch.
  static constexpr int torque = 2;
  static constexpr int pitch = 3;
  static constexpr int values = 5;

  const model::ControllerDefinition& law() const { return *turbine_.controller; }
  bool has_integral() const { return law().has_integral(); }
  template <class T>
  void schedule(T& angle, T& rate) const;
  template <class T>
  T generator_speed(const Eigen::Matrix<T, arguments, 1>& x) const;

  const model::Turbine& turbine_;
  int rank_;
  int first_ = 0;
  ControllerTies ties_;
  Connections connections_;
};

extern template class Stated<Controller>;

}  // namespace samara::components
