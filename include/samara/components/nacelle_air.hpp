// Drag of the wind on the nacelle (docs/theory.md, section 11.1).
#pragma once

#include "samara/components/beam.hpp"
#include "samara/components/component.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

/// Load rho/2 C_d A |v| v along each axis of the nacelle, with the component v of the undisturbed
/// wind against the place of the load.
class NacelleAir final : public Stated<NacelleAir> {
 public:
  /// `tower`: the beam that carries the nacelle. Both must outlive the component.
  NacelleAir(const model::Turbine& turbine, const Beam& tower) : turbine_(turbine), tower_(tower) {}

  /// First of q, U of the yaw joint.
  void set_yaw(int yaw) { yaw_ = yaw; }

  void place(Registry&) override {}  // tower and joints have the places
  void describe(Registry& registry) override;
  bool is_conservative() const override { return false; }

  template <class System>
  void state(System& system) const;

 private:
  /// u, theta, V, Omega of the tower top; q, U of the yaw.
  static constexpr int at_yaw = 12;
  static constexpr int arguments = at_yaw + 2;
  /// Force and moment on the tower top; moment about the axis of the yaw.
  static constexpr int values = 7;

  /// `yaw`: prescribed motion of a yaw that is not free.
  template <class T, class System>
  Eigen::Matrix<T, values, 1> load_of(const System& system, const Eigen::Matrix<T, arguments, 1>& x,
                                      const elements::JointMotion& yaw) const;

  const model::Turbine& turbine_;
  const Beam& tower_;
  int yaw_ = 0;
  Connections connections_;
};

extern template class Stated<NacelleAir>;

}  // namespace samara::components
