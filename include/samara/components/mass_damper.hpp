// A tuned mass damper: a point mass on a beam or on the nacelle. It moves along one or two axes of
// its carrier, on springs, dampers and stops (docs/theory.md, section 3.4).
#pragma once

#include <string>

#include "samara/components/beam.hpp"
#include "samara/components/component.hpp"
#include "samara/elements/rigid_tree.hpp"
#include "samara/model/turbine.hpp"

namespace samara::components {

/// Data of a mass damper in a system. The objects it points to must outlive the component.
struct MassDamperSetting {
  const model::Turbine* turbine = nullptr;
  const model::MassDamper* damper = nullptr;
  const Beam* beam = nullptr;  ///< beam that carries the damper or the nacelle
  int shared_rank = 0;         ///< elimination rank
};

class MassDamper final : public Stated<MassDamper> {
 public:
  explicit MassDamper(const MassDamperSetting& setting);

  void place(Registry& registry) override;
  /// `yaw`: first unknown of the yaw joint (angle, speed).
  void set_yaw(int yaw) { yaw_ = yaw; }
  void describe(Registry& registry) override;
  bool is_conservative() const override;

  /// Index of q of axis i; U follows.
  int first(std::size_t i) const { return first_ + 2 * static_cast<int>(i); }
  const model::MassDamperDefinition& definition() const { return setting_.damper->definition; }
  /// "nacelle mass damper", or "blade mass damper (2)" for a damper of a blade
  system::Owner owner() const;
  /// Direction of axis i, for example "fore-aft"
  std::string direction(std::size_t i) const;

  template <class System>
  void state(System& system) const;

 private:
  static constexpr int most_axes = 2;
  // Arguments: theta; V, Omega and their rates; motion of the beam's root; q, U of the yaw and the
  // rate of U; q, U of each axis and their rates.
  static constexpr int at_velocity = 3;
  static constexpr int at_velocity_dot = 9;
  static constexpr int at_root = 15;
  static constexpr int at_yaw = at_root + 9;
  static constexpr int at_axes = at_yaw + 3;
  static constexpr int arguments = at_axes + 4 * most_axes;
  // Values: two rows of each axis, force and moment on the node, the row of the yaw.
  static constexpr int node_force = 2 * most_axes;
  static constexpr int node_moment = node_force + 3;
  static constexpr int yaw_row = node_moment + 3;
  static constexpr int values = yaw_row + 1;

  /// True at the tower's end, whose balance is the balance of the bodies on it.
  bool is_on_bodies() const { return setting_.damper->blade < 0 && setting_.damper->node < 0; }
  std::size_t axis_count() const { return definition().axes.size(); }
  int node() const;
  system::Frame frame() const;
  void describe_axis(Registry& registry, std::size_t i) const;
  void describe_channels(Registry& registry, std::size_t i) const;
  void describe_mass(Registry& registry) const;
  void connect();
  template <class T>
  elements::FrameMotion<T> node_motion(const Eigen::Matrix<T, arguments, 1>& x,
                                       const Mat3<T>& R) const;
  template <class T, class System>
  elements::FrameMotion<T> nacelle_motion(const System& system,
                                          const Eigen::Matrix<T, arguments, 1>& x,
                                          const elements::FrameMotion<T>& top, Mat3<T>& turn) const;

  MassDamperSetting setting_;
  int yaw_ = 0;
  int first_ = 0;
  Connections connections_;
};

extern template class Stated<MassDamper>;

}  // namespace samara::components
