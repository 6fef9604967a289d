// Rigid bodies on joints by Kane's method (docs/theory.md, section 3; Lee, Hodges & Patil (2002),
// eq. (8), (9)): a tree of joints, each with the body behind it, on a base whose motion is given.
//
// The generalized speed of a free joint is the angular velocity, in the inertial frame, of the body
// behind it about the joint's axis. The partial velocities are therefore so sparse that Kane's sums
// need only one walk inward. A joint passes on the moment without the component about its own axis.
// That component, with the joint's spring and damper, is the row of the joint.
//
// The equations are fully nonlinear and hold at any angles.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/elements/joint_motion.hpp"
#include "samara/math/rotation.hpp"
#include "samara/math/scalar.hpp"
#include "samara/math/types.hpp"

namespace samara::elements {

/// A rigid body. Its components are in the frame of the body that it belongs to.
struct RigidBody {
  double mass = 0.0;                  ///< [kg]
  Vector3 center = Vector3::Zero();   ///< from the body's reference point [m]
  Matrix3 inertia = Matrix3::Zero();  ///< about its own centre [kg m^2]

  bool is_none() const { return mass == 0.0 && inertia.isZero(0.0); }
};

/// A torque and its slopes.
struct JointTorque {
  double value = 0.0;     ///< [N m]
  double by_angle = 0.0;  ///< [N m/rad]
  double by_rate = 0.0;   ///< [N m s/rad]
};

/// A torque that depends on the angle and the rate of a joint, or on the angular velocity of a
/// body.
class TorqueFunction {
 public:
  TorqueFunction() = default;
  TorqueFunction(const TorqueFunction&) = delete;
  TorqueFunction& operator=(const TorqueFunction&) = delete;
  virtual ~TorqueFunction() = default;

  /// Torque along the axis on the body behind the joint. With NaN arguments a slope is zero only if
  /// it is zero at all angles and rates.
  virtual JointTorque at(double angle, double rate) const = 0;
};

/// The torque of a law for any scalar type, with its first derivatives.
template <class T>
T torque_of(const TorqueFunction& law, const T& angle, const T& rate) {
  const double angle_value = math::plain_value(angle);
  const double rate_value = math::plain_value(rate);
  const JointTorque torque = law.at(angle_value, rate_value);
  T sum(torque.value);
  if (torque.by_angle != 0.0) sum += (angle - T(angle_value)) * torque.by_angle;
  if (torque.by_rate != 0.0) sum += (rate - T(rate_value)) * torque.by_rate;
  return sum;
}

/// A joint and the body behind it. The joint's point is the reference point of the body.
struct TreeNode {
  int parent = -1;                     ///< node that carries it; -1: the base
  Vector3 place = Vector3::Zero();     ///< position of its point, in the parent's axes [m]
  Matrix3 axes = Matrix3::Identity();  ///< axes at angle zero, as columns in the parent's axes
  Vector3 axis = Vector3::UnitX();     ///< in its own axes
  bool free = false;                   ///< false: it moves as prescribed
  double stiffness = 0.0;              ///< [N m/rad]
  double damping = 0.0;                ///< [N m s/rad]
  std::vector<std::shared_ptr<const TorqueFunction>> laws;  ///< torques over its angle and rate
  /// The parts behind are equal at all angles. Their axes do not turn; the next joint has the same
  /// axis and turns by the sum of both angles.
  bool is_round = false;
  /// A rotor about the same axis that turns `gear_ratio` times as fast relative to the carrier of
  /// the joint. The whole moment of the parts behind goes to the carrier; on its way through the
  /// gear only the inertia of the rotor changes it.
  bool is_geared = false;
  double gear_ratio = 1.0;
  double rotor_inertia = 0.0;  ///< [kg m^2]
  RigidBody body;
  Vector3 spin_axis = Vector3::UnitY();
  /// Torque on the body along `spin_axis`, over its angular velocity about it; null: none.
  std::shared_ptr<const TorqueFunction> spin_law;
};

/// Angle of a joint, speed of the body behind it about its axis, and their rates.
template <class T>
struct JointState {
  T angle, speed, angle_dot, speed_dot;
  T torque = T(0);              ///< on the body behind a free joint, beside its laws [N m]
  JointMotion prescribed = {};  ///< motion of a joint that is not free
  JointMotion carried = {};     ///< further motion, to which the joint's own motion adds
};

/// Velocity and acceleration of a frame and of a point of it, and gravity, components in the frame.
template <class T>
struct FrameMotion {
  Vec3<T> omega, alpha, v, a, gravity;
};

/// Place of a frame's origin and its axes as columns, components in the ground.
template <class T>
struct Pose {
  Vec3<T> place = Vec3<T>::Zero();
  Mat3<T> axes = Mat3<T>::Identity();
};

/// A force, and a moment about a point.
template <class T>
struct Wrench {
  Vec3<T> force, moment;
};

template <class T>
struct JointRows {
  T kinematic;  ///< q_dot - (U - carried speed); not free: U - carried speed - prescribed rate
  T balance;    ///< Kane's row of U [N m]; unused where not free
  T position;   ///< q - prescribed angle; only if not free
};

/// Result of a walk for one node.
template <class T>
struct NodeResult {
  JointRows<T> rows;
  FrameMotion<T> motion;  ///< motion of the body, at the joint's point
  FrameMotion<T> inner;   ///< motion of the carrier, in the same axes
  Mat3<T> turn;           ///< components in its axes from those in its axes at angle zero
  T angle;                ///< angle of its axes (round joint: the angle that they would have)
  T rate;                 ///< rate of the body relative to its carrier
  T held;                 ///< geared joint: torque on the rotor against its rotation [N m]
  Wrench<T> passed;  ///< load on the carrier, about the joint's point, in the axes at angle zero
};

class RigidTree {
 public:
  static constexpr int most_nodes = 6;
  template <class T>
  using States = std::array<JointState<T>, most_nodes>;
  template <class T>
  using Loads = std::array<Wrench<T>, most_nodes>;
  template <class T>
  using Results = std::array<NodeResult<T>, most_nodes>;

  /// Adds a node and returns its number. Parents must be added first.
  int add(const TreeNode& node) {
    const bool is_behind_round = node.parent >= 0 && this->node(node.parent).is_round;
    if (size() == most_nodes || node.parent >= size() || (node.is_round && !node.body.is_none()) ||
        (is_behind_round && node.axis != this->node(node.parent).axis))
      throw InternalError("a joint does not fit in the tree of bodies");
    nodes_.push_back(node);
    return size() - 1;
  }
  int size() const { return static_cast<int>(nodes_.size()); }
  const TreeNode& node(int i) const { return nodes_[static_cast<std::size_t>(i)]; }

  /// Walks from the base outward: computes the motions.
  template <class T>
  void walk_outward(const FrameMotion<T>& base, const States<T>& states, Results<T>& results) const;

  /// Walks inward with loads and inertia: computes the rows. Returns the load of all bodies,
  /// including the base's own, about the base's point. `loads`: external load on each body, about
  /// its joint's point.
  template <class T>
  Wrench<T> walk_inward(const FrameMotion<T>& base, const States<T>& states, const Loads<T>& loads,
                        Results<T>& results) const;

  /// Pose of the body behind joint `i`, at the joint's point. `base`: pose of the base.
  template <class T>
  Pose<T> pose_of(int i, const Pose<T>& base, const States<T>& states) const;

  void set_base_body(const RigidBody& body) { base_body_ = body; }

 private:
  /// Angle of the axes of node `i`, with that of a round joint inboard of it.
  template <class T>
  T angle_of(int i, const States<T>& states) const {
    const TreeNode& node = this->node(i);
    const JointState<T>& state = states[static_cast<std::size_t>(i)];
    T angle = (node.free ? state.angle : T(state.prescribed.angle)) + T(state.carried.angle);
    if (node.parent >= 0 && this->node(node.parent).is_round)
      angle += angle_of<T>(node.parent, states);
    return angle;
  }

  RigidBody base_body_;
  std::vector<TreeNode> nodes_;
};

namespace detail {

/// Changes components from v to C v.
template <class T>
FrameMotion<T> seen_from(const Mat3<T>& C, const FrameMotion<T>& m) {
  return {C * m.omega, C * m.alpha, C * m.v, C * m.a, C * m.gravity};
}

/// The motion of another point of the same frame, at `r`.
template <class T>
FrameMotion<T> moved_to(const Vec3<T>& r, const FrameMotion<T>& m) {
  const Vec3<T> swept = math::cross(m.omega, r);
  const Vec3<T> turning = math::cross(m.alpha, r);
  const Vec3<T> centripetal = math::cross(m.omega, swept);
  return {m.omega, m.alpha, m.v + swept, m.a + turning + centripetal, m.gravity};
}

/// Part of a vector normal to a unit vector. If the unit vector is a base vector, the component
/// along it is an exact zero without derivatives.
template <class T>
Vec3<T> across(const Vec3<T>& axis, const Vec3<T>& v) {
  Mat3<T> projection;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) projection(i, j) = T(i == j ? 1.0 : 0.0) - axis(i) * axis(j);
  return projection * v;
}

/// The frame behind a joint that turns with a given relative rate and acceleration. `inner`: motion
/// of the joint's point, in the axes of the part behind.
template <class T>
FrameMotion<T> with_relative_rate(const Vec3<T>& axis, double rate, double acceleration,
                                  const FrameMotion<T>& inner) {
  FrameMotion<T> outer = inner;
  const Vec3<T> carried = math::cross(axis, inner.omega);
  for (int i = 0; i < 3; ++i) {
    outer.omega(i) += axis(i) * rate;
    outer.alpha(i) -= carried(i) * rate;
    outer.alpha(i) += axis(i) * acceleration;
  }
  return outer;
}

/// The frame behind a free joint: its angular velocity about the axis is `speed`.
template <class T>
FrameMotion<T> with_outer_speed(const Vec3<T>& axis, const T& speed, const T& speed_dot,
                                const FrameMotion<T>& inner) {
  const T rate = speed - math::dot(axis, inner.omega);
  FrameMotion<T> outer = inner;
  const Vec3<T> carried = math::cross(axis, inner.omega);
  outer.omega = across<T>(axis, inner.omega) + axis * speed;
  outer.alpha = across<T>(axis, inner.alpha) + axis * speed_dot - carried * rate;
  return outer;
}

/// Active and inertia loads R - m a and T - I alpha - omega x I omega of a body, about the
/// reference point of `m`.
template <class T>
Wrench<T> active_and_inertia(const RigidBody& body, const FrameMotion<T>& m) {
  const Vec3<T> center = body.center.cast<T>();
  const FrameMotion<T> at_center = moved_to<T>(center, m);
  const Mat3<T> inertia = body.inertia.cast<T>();
  const Vec3<T> spin = inertia * m.omega;
  const Vec3<T> spin_up = inertia * m.alpha;
  Wrench<T> w;
  w.force = (m.gravity - at_center.a) * T(body.mass);
  w.moment = math::cross(center, w.force) - spin_up - math::cross(m.omega, spin);
  return w;
}

/// Adds the rotor's momentum J w along the axis, w = omega_inner + n times the joint's rate. The
/// joint's row receives n times the torque that accelerates the rotor; the carrier receives the
/// whole rate of change of the momentum.
template <class T>
void add_rotor(const TreeNode& node, const Vec3<T>& axis, NodeResult<T>& result, Wrench<T>& w) {
  using math::dot;
  const T along = dot(axis, result.motion.alpha) - dot(axis, result.inner.alpha);
  const T momentum =
      (dot(axis, result.inner.omega) + result.rate * node.gear_ratio) * node.rotor_inertia;
  const T momentum_dot =
      (dot(axis, result.inner.alpha) + along * node.gear_ratio) * node.rotor_inertia;
  result.held = (dot(axis, w.moment) - momentum_dot * node.gear_ratio) / std::abs(node.gear_ratio);
  if (node.free) result.rows.balance -= momentum_dot * node.gear_ratio;
  w.moment -= math::cross(result.inner.omega, Vec3<T>(axis * momentum)) + axis * momentum_dot;
}

}  // namespace detail

template <class T>
void RigidTree::walk_outward(const FrameMotion<T>& base, const States<T>& states,
                             Results<T>& results) const {
  for (int i = 0; i < size(); ++i) {
    const TreeNode& node = this->node(i);
    const JointState<T>& state = states[static_cast<std::size_t>(i)];
    NodeResult<T>& result = results[static_cast<std::size_t>(i)];
    const auto parent = static_cast<std::size_t>(node.parent);
    const bool on_base = node.parent < 0;
    result.angle = angle_of<T>(i, states);
    result.inner = on_base ? base : results[parent].motion;
    if (!node.place.isZero(0.0))
      result.inner = detail::moved_to<T>(node.place.cast<T>(), result.inner);
    if (!node.axes.isIdentity(0.0))
      result.inner = detail::seen_from<T>(node.axes.transpose().cast<T>(), result.inner);
    if (!node.is_round) {
      result.turn = math::turn_about<T>(node.axis, result.angle).transpose();
      result.inner = detail::seen_from<T>(result.turn, result.inner);
    }
    const Vec3<T> axis = node.axis.cast<T>();
    const T own_rate = state.speed - math::dot(axis, result.inner.omega) - T(state.carried.rate);
    result.rate = own_rate + T(state.carried.rate);
    result.motion =
        node.free ? detail::with_outer_speed<T>(axis, state.speed, state.speed_dot, result.inner)
                  : detail::with_relative_rate<T>(
                        axis, state.carried.rate + state.prescribed.rate,
                        state.carried.acceleration + state.prescribed.acceleration, result.inner);
    result.rows.kinematic =
        node.free ? T(state.angle_dot - own_rate) : T(own_rate - T(state.prescribed.rate));
    result.rows.position = state.angle - T(state.prescribed.angle);
  }
}

template <class T>
Pose<T> RigidTree::pose_of(int i, const Pose<T>& base, const States<T>& states) const {
  const TreeNode& node = this->node(i);
  Pose<T> pose = node.parent < 0 ? base : pose_of<T>(node.parent, base, states);
  if (!node.place.isZero(0.0)) pose.place += pose.axes * node.place.cast<T>();
  if (!node.axes.isIdentity(0.0)) pose.axes = (pose.axes * node.axes.cast<T>()).eval();
  if (!node.is_round)
    pose.axes = (pose.axes * math::turn_about<T>(node.axis, angle_of<T>(i, states))).eval();
  return pose;
}

template <class T>
Wrench<T> RigidTree::walk_inward(const FrameMotion<T>& base, const States<T>& states,
                                 const Loads<T>& loads, Results<T>& results) const {
  using math::cross;
  using math::dot;
  Loads<T> sums = loads;
  Wrench<T> total{Vec3<T>::Zero(), Vec3<T>::Zero()};
  if (!base_body_.is_none()) total = detail::active_and_inertia<T>(base_body_, base);
  for (int i = size() - 1; i >= 0; --i) {
    const TreeNode& node = this->node(i);
    const JointState<T>& state = states[static_cast<std::size_t>(i)];
    NodeResult<T>& result = results[static_cast<std::size_t>(i)];
    Wrench<T>& w = sums[static_cast<std::size_t>(i)];
    const Vec3<T> axis = node.axis.cast<T>();
    if (!node.body.is_none()) {
      const Wrench<T> own = detail::active_and_inertia<T>(node.body, result.motion);
      w.force += own.force;
      w.moment += own.moment;
    }
    if (node.spin_law) {
      const Vec3<T> spin_axis = node.spin_axis.cast<T>();
      w.moment +=
          spin_axis * torque_of<T>(*node.spin_law, T(0), dot(spin_axis, result.motion.omega));
    }
    result.rows.balance = T(0);
    if (node.free) {
      const T own_rate = result.rate - T(state.carried.rate);
      T torque = state.torque - state.angle * node.stiffness - own_rate * node.damping;
      for (const auto& law : node.laws) torque += torque_of<T>(*law, state.angle, result.rate);
      result.rows.balance = dot(axis, w.moment) + torque;
      if (!node.is_geared) w.moment = (detail::across<T>(axis, w.moment) - axis * torque).eval();
    }
    if (node.is_geared) detail::add_rotor(node, axis, result, w);
    // Load at the joint's point of the carrier, in the carrier's axes.
    result.passed = w;
    if (!node.is_round) {
      result.passed.force = result.turn.transpose() * w.force;
      result.passed.moment = result.turn.transpose() * w.moment;
    }
    Wrench<T> passed = result.passed;
    if (!node.axes.isIdentity(0.0)) {
      const Mat3<T> axes = node.axes.cast<T>();
      passed.force = (axes * passed.force).eval();
      passed.moment = (axes * passed.moment).eval();
    }
    if (!node.place.isZero(0.0)) passed.moment += cross(node.place.cast<T>().eval(), passed.force);
    Wrench<T>& onto = node.parent < 0 ? total : sums[static_cast<std::size_t>(node.parent)];
    onto.force += passed.force;
    onto.moment += passed.moment;
  }
  return total;
}

}  // namespace samara::elements
