// The rigid bodies between tower and blades by Kane's method (docs/theory.md, section 3; Lee,
// Hodges & Patil (2002), eq. (8), (9)): tower top T, yaw q_y about t3, nacelle Y, tilted shaft
// bearing, low-speed end L of the generator's gear turned by psi + q_g about s2, shaft S turned by
// q_s more (torsion), teeter q_h about the hinge axis e of S and H, hub H. psi is the azimuth at
// constant speed. The generator turns n times as fast as L against the nacelle, n its gear ratio.
//
// Generalized speeds: U1 = omega_Y.y3, U2 = omega_H.e, U3..5 = omega_T in t1 t2 t3, U6..8 = v_T in
// t1 t2 t3, U_g = omega_L.s2, U_s = omega_S.s2. "Speed of the outer body in the inertial frame"
// makes the partial velocities so sparse that Kane's sums are one walk inward: a joint passes on
// the moment without its component about its own axis, and that component, with the joint's spring
// and damper, is the joint's row.
//
// The full nonlinear equations; valid for any angles (theta_T below 180 degrees).
#pragma once

#include <cmath>

#include "samara/elements/beam_point.hpp"
#include "samara/elements/joint_motion.hpp"
#include "samara/elements/torque_line.hpp"
#include "samara/math/rotation.hpp"
#include "samara/math/scalar.hpp"

namespace samara::elements {

/// A rigid body; its frame is that of the body it belongs to.
struct RigidBody {
  double mass = 0.0;                  ///< [kg]
  Vector3 center = Vector3::Zero();   ///< from the body's reference point [m]
  Matrix3 inertia = Matrix3::Zero();  ///< about its own centre [kg m^2]
};

struct Hinge {
  bool free = false;
  double stiffness = 0.0;  ///< [N m/rad]
  double damping = 0.0;    ///< [N m s/rad]
  /// Stops: a second spring and damper from this angle on, both ways; 0: none [rad].
  double stop_angle = 0.0;
  double stop_stiffness = 0.0;  ///< [N m/rad]
  double stop_damping = 0.0;    ///< [N m s/rad]
};

/// Below it the torque of a brake falls, to nothing at rest [rad/s].
inline constexpr double brake_speed = 1e-2;

struct RigidChain {
  double gravity = 0.0;  ///< along -n3 [m/s^2]
  Hinge yaw;
  Hinge generator;              ///< of L, about psi
  TorqueLine generator_torque;  ///< against the turning, by the generator's speed in the nacelle
  double brake_torque = 0.0;    ///< on the generator against its turning, whichever way [N m]
  double gear_ratio = 1.0;      ///< n: turns of the generator for one of L, < 0 the other way
  TorqueLine rotor_torque;      ///< on H along h2, by omega_H . h2
  Hinge torsion;
  Hinge teeter;
  RigidBody tower_top;                     ///< reference point: tower top; axes t1 t2 t3
  RigidBody nacelle;                       ///< reference point: tower top; axes y1 y2 y3
  double generator_inertia = 0.0;          ///< J_g, about its own axis, which is along s2 [kg m^2]
  RigidBody shaft;                         ///< reference: yaw axis on the shaft; axes s1 s2 s3
  RigidBody hub;                           ///< reference: teeter pin; axes h1 h2 h3
  double height = 0.0;                     ///< tower top to shaft axis, along y3 [m]
  double tilt = 0.0;                       ///< > 0 raises s2 [rad]
  double overhang = 0.0;                   ///< yaw axis to teeter pin along s2 [m]
  double undersling = 0.0;                 ///< teeter pin to apex along h2 [m]
  Vector3 teeter_axis = Vector3::UnitX();  ///< e, fixed in S and in H
};

/// Angle of a joint, speed of the body behind it about its axis, and their rates.
template <class T>
struct JointState {
  T angle, speed, angle_dot, speed_dot;
  JointMotion prescribed = {};  ///< of a joint that is not free
};

/// Coordinates, speeds and their rates. The tower-top quantities are in the order of a beam's tip:
/// components along (t3, t1, t2), as the tower's axes are (n3, n1, n2).
template <class T>
struct ChainState {
  Vec3<T> theta;         ///< Rodrigues parameters of T, components in the tower's a
  Vec6<T> top_velocity;  ///< V, Omega of T: (U8, U6, U7, U5, U3, U4)
  Vec6<T> top_velocity_dot;
  JointState<T> yaw;          ///< q_y, U1
  JointState<T> teeter;       ///< q_h, U2
  JointState<T> torsion;      ///< q_s, U_s
  JointState<T> generator;    ///< q_g, U_g
  Vec6<T> top_load;           ///< F_hat, M_hat at the tower tip, components in the tower's a
  Vec6<T> hub_load;           ///< sum of the blade-root loads: force, moment about the apex, in H
  double azimuth = 0.0;       ///< psi [rad]
  double speed = 0.0;         ///< psi_dot [rad/s]
  double speed_dot = 0.0;     ///< of a generator that is not free, at L [rad/s^2]
  T generator_torque = T(0);  ///< on the generator beside the chain's, against its turning [N m]
  T yaw_torque = T(0);        ///< of the tower top on a free nacelle, about y3 [N m]
  Vec3<T> up = Vec3<T>::UnitX();  ///< n3, components in the tower's a
};

/// The hub as the blades see it, components in H.
template <class T>
struct HubMotion {
  Vec3<T> velocity;  ///< of the apex [m/s]
  Vec3<T> omega;     ///< [rad/s]
  Vec3<T> gravity;   ///< [m/s^2]
};

template <class T>
struct JointRows {
  T kinematic;  ///< q_dot - (U - speed it is carried with); of a joint that is not free U - that
                ///< speed - the prescribed rate
  T balance;    ///< Kane's row of U [N m]; unused where not free
  T position;   ///< q - the prescribed angle, of a joint that is not free
};

/// Residual rows. A joint that is locked or prescribed has its kinematic row instead of Kane's.
template <class T>
struct ChainRows {
  Vec6<T> top;  ///< Kane's rows of (U8, U6, U7, U5, U3, U4) [N, N m]
  JointRows<T> yaw, teeter, torsion;
  JointRows<T> generator;  ///< its balance is that of L's rate against the nacelle: a constant
                           ///< torque that is added to it acts at L, and back on the nacelle
};

/// What is asked of the chain beside its rows. It is only given where torque tables reach.
template <class T>
struct ChainReport {
  T azimuth;         ///< of S against the bearing [rad]
  T yaw, teeter;     ///< angles [rad]
  T yaw_rate;        ///< [rad/s]
  T generator_rate;  ///< of the generator against the nacelle, in the sense of its turning [rad/s]
  T generator_torque;  ///< of the nacelle on it, against its turning, without the brake [N m]
  T brake_torque;      ///< the same way [N m]
  T shaft_rate;        ///< of S against the nacelle [rad/s]
  T teeter_rate;       ///< [rad/s]
  Vec6<T>
      rotor_load;    ///< force and moment of the hub on the shaft at the teeter pin, in S [N, N m]
  Vec6<T> top_load;  ///< of the nacelle on T at the tower top, in t1 t2 t3 [N, N m]
  Vec3<T> top_acceleration;  ///< of T, in t1 t2 t3 [m/s^2]
};

namespace detail {

/// Velocity and acceleration of a frame and of a point of it, components in the frame.
template <class T>
struct Motion {
  Vec3<T> omega, alpha, v, a;
};

/// Components change from v to C v.
template <class T>
Motion<T> seen_from(const Mat3<T>& C, const Motion<T>& m) {
  return {C * m.omega, C * m.alpha, C * m.v, C * m.a};
}

/// The motion of the point at `r` of the same frame.
template <class T>
Motion<T> moved_to(const Vec3<T>& r, const Motion<T>& m) {
  const Vec3<T> swept = math::cross(m.omega, r);
  const Vec3<T> turning = math::cross(m.alpha, r);
  const Vec3<T> centripetal = math::cross(m.omega, swept);
  return {m.omega, m.alpha, m.v + swept, m.a + turning + centripetal};
}

/// What a vector has across a unit vector. Along a base vector nothing is left of it, not even a
/// dependence.
template <class T>
Vec3<T> across(const Vec3<T>& axis, const Vec3<T>& v) {
  Mat3<T> projection;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) projection(i, j) = T(i == j ? 1.0 : 0.0) - axis(i) * axis(j);
  return projection * v;
}

/// The frame behind a hinge about `axis` with the given relative rate. `inner` is the motion of
/// the hinge point seen in the outer frame's components.
template <class T>
Motion<T> with_relative_rate(const Vec3<T>& axis, const T& rate, const Motion<T>& inner) {
  Motion<T> outer = inner;
  const Vec3<T> carried = math::cross(axis, inner.omega);
  for (int i = 0; i < 3; ++i) {
    outer.omega(i) += axis(i) * rate;
    outer.alpha(i) -= carried(i) * rate;
  }
  return outer;
}

/// The frame behind a free hinge: the outer body's angular velocity about the axis is `speed`.
template <class T>
Motion<T> with_outer_speed(const Vec3<T>& axis, const T& speed, const T& speed_dot,
                           const Motion<T>& inner) {
  const T rate = speed - math::dot(axis, inner.omega);
  Motion<T> outer = inner;
  const Vec3<T> carried = math::cross(axis, inner.omega);
  outer.omega = across<T>(axis, inner.omega) + axis * speed;
  outer.alpha = across<T>(axis, inner.alpha) + axis * speed_dot - carried * rate;
  return outer;
}

template <class T>
struct Wrench {
  Vec3<T> force, moment;
};

/// R - m a and T - I alpha - omega x I omega of a body, about the reference point of `m`.
template <class T>
Wrench<T> active_and_inertia(const RigidBody& body, const Motion<T>& m, const Vec3<T>& gravity) {
  const Vec3<T> center = body.center.cast<T>();
  const Motion<T> at_center = moved_to<T>(center, m);
  const Mat3<T> inertia = body.inertia.cast<T>();
  const Vec3<T> spin = inertia * m.omega;
  const Vec3<T> spin_up = inertia * m.alpha;
  Wrench<T> w;
  w.force = (gravity - at_center.a) * T(body.mass);
  w.moment = math::cross(center, w.force) - spin_up - math::cross(m.omega, spin);
  return w;
}

/// One joint on the way out and back.
template <class T>
class JointWalk {
 public:
  /// `rate`: to which the joint's own is added, as `acceleration` where it is not free. `inner`:
  /// the motion of the joint's point, in the components of the body behind it.
  JointWalk(const Hinge& hinge, const Vector3& axis, const JointState<T>& state,
            const Motion<T>& inner, double rate = 0.0, double acceleration = 0.0)
      : hinge_(hinge), axis_(axis.cast<T>()), state_(state), carried_rate_(rate) {
    own_rate_ = state.speed - math::dot(axis_, inner.omega) - T(rate);
    if (hinge.free) {
      outer_ = with_outer_speed<T>(axis_, state.speed, state.speed_dot, inner);
      return;
    }
    const JointMotion& own = state.prescribed;
    outer_ = with_relative_rate<T>(axis_, T(rate + own.rate), inner);
    for (int i = 0; i < 3; ++i) outer_.alpha(i) += axis_(i) * T(own.acceleration + acceleration);
  }

  const Motion<T>& outer() const { return outer_; }

  /// Of the body behind the joint against the one before it.
  T relative_rate() const { return own_rate_ + T(carried_rate_); }

  /// The joint's rows, from the moment about its point of all that lies behind, which is left
  /// without the component that the joint does not pass on, but for its spring and damper.
  JointRows<T> take(Vec3<T>& moment, bool pass_all = false) const {
    JointRows<T> rows;
    rows.kinematic =
        hinge_.free ? T(state_.angle_dot - own_rate_) : T(own_rate_ - T(state_.prescribed.rate));
    rows.balance = T(0);
    rows.position = state_.angle - T(state_.prescribed.angle);
    if (!hinge_.free) return rows;
    const T spring =
        -(state_.angle * hinge_.stiffness + own_rate_ * hinge_.damping) - stop_torque();
    rows.balance = math::dot(axis_, moment) + spring;
    if (!pass_all) moment = (across<T>(axis_, moment) - axis_ * spring).eval();
    return rows;
  }

 private:
  /// Of the stops on what is behind the hinge, against the turning.
  T stop_torque() const {
    const double angle = math::plain_value(state_.angle);
    if (hinge_.stop_angle == 0.0 || std::abs(angle) <= hinge_.stop_angle) return T(0);
    const double end = angle > 0.0 ? hinge_.stop_angle : -hinge_.stop_angle;
    return (state_.angle - T(end)) * hinge_.stop_stiffness + own_rate_ * hinge_.stop_damping;
  }

  const Hinge& hinge_;
  Vec3<T> axis_;
  const JointState<T>& state_;
  Motion<T> outer_;
  T own_rate_;
  double carried_rate_;
};

}  // namespace detail

/// The rows and the motion that the blades need. A test of Kane's method against Lagrange's
/// equations is in tests/elements/rigid_chain_test.cpp.
template <class T>
ChainRows<T> rigid_chain(const RigidChain& chain, const ChainState<T>& state, HubMotion<T>& hub,
                         ChainReport<T>* report = nullptr) {
  using detail::JointWalk;
  using detail::Motion;
  using detail::Wrench;
  using math::cross;
  const auto from_top = [](const Vec3<T>& b) { return Vec3<T>(b(1), b(2), b(0)); };
  const auto to_top = [](const Vec3<T>& t) { return Vec3<T>(t(2), t(0), t(1)); };
  const auto angle_of = [](const Hinge& hinge, const JointState<T>& joint) {
    return hinge.free ? joint.angle : T(joint.prescribed.angle);
  };

  // Outward: motions. T: derivative of v_T's components in T plus omega x v is the acceleration.
  const Mat3<T> C_top = math::direction_cosines(state.theta);
  Motion<T> top;
  top.v = from_top(state.top_velocity.template head<3>());
  top.omega = from_top(state.top_velocity.template tail<3>());
  top.alpha = from_top(state.top_velocity_dot.template tail<3>());
  top.a = from_top(state.top_velocity_dot.template head<3>()) + cross(top.omega, top.v);
  const Vec3<T> g_T = from_top(C_top * (state.up * T(-chain.gravity)).eval());

  const T q_y = angle_of(chain.yaw, state.yaw);
  const Mat3<T> C_YT = math::turn_about<T>(Vector3::UnitZ(), q_y).transpose();
  const JointWalk<T> yaw(chain.yaw, Vector3::UnitZ(), state.yaw, detail::seen_from<T>(C_YT, top));
  const Motion<T>& nacelle = yaw.outer();
  const Vec3<T> g_Y = C_YT * g_T;

  // D: the bearing's axes, in which the generator looks the same at all its angles.
  const Matrix3 C_YD = math::turn_about<double>(Vector3::UnitX(), chain.tilt);
  const Mat3<T> C_DY = C_YD.transpose().cast<T>();
  const Vec3<T> bearing(T(0), T(0), T(chain.height));
  const Motion<T> stator = detail::seen_from<T>(C_DY, detail::moved_to<T>(bearing, nacelle));
  const JointWalk<T> generator(chain.generator, Vector3::UnitY(), state.generator, stator,
                               state.speed, state.speed_dot);
  const Vec3<T> g_D = C_DY * g_Y;

  const T azimuth = angle_of(chain.generator, state.generator) +
                    angle_of(chain.torsion, state.torsion) + T(state.azimuth);
  const Mat3<T> C_SD = math::turn_about<T>(Vector3::UnitY(), azimuth).transpose();
  const JointWalk<T> torsion(chain.torsion, Vector3::UnitY(), state.torsion,
                             detail::seen_from<T>(C_SD, generator.outer()));
  const Motion<T>& shaft = torsion.outer();
  const Vec3<T> g_S = C_SD * g_D;

  const Vec3<T> pin(T(0), T(chain.overhang), T(0));
  const T q_h = angle_of(chain.teeter, state.teeter);
  const Mat3<T> C_HS = math::turn_about<T>(chain.teeter_axis, q_h).transpose();
  const JointWalk<T> teeter(chain.teeter, chain.teeter_axis, state.teeter,
                            detail::seen_from<T>(C_HS, detail::moved_to<T>(pin, shaft)));
  const Motion<T>& hub_motion = teeter.outer();
  const Vec3<T> g_H = C_HS * g_S;
  const Vec3<T> apex(T(0), T(chain.undersling), T(0));
  hub.velocity = hub_motion.v + cross(hub_motion.omega, apex);
  hub.omega = hub_motion.omega;
  hub.gravity = g_H;

  // Inward: Kane's sums, moments about the point of the joint that is passed.
  ChainRows<T> rows;
  Wrench<T> w = detail::active_and_inertia<T>(chain.hub, hub_motion, g_H);
  const Vec3<T> root_force = state.hub_load.template head<3>();
  const Vec3<T> root_moment = state.hub_load.template tail<3>();
  w.force += root_force;
  w.moment += root_moment + cross(apex, root_force);
  if (!chain.rotor_torque.is_zero()) w.moment(1) += chain.rotor_torque.at(T(hub_motion.omega(1)));
  rows.teeter = teeter.take(w.moment);
  if (report != nullptr) {
    report->azimuth = azimuth;
    report->yaw = q_y;
    report->teeter = q_h;
    report->yaw_rate = yaw.relative_rate();
    report->shaft_rate = generator.relative_rate() + torsion.relative_rate();
    report->teeter_rate = teeter.relative_rate();
    report->rotor_load << C_HS.transpose() * w.force, C_HS.transpose() * w.moment;
    report->top_acceleration = top.a;
  }

  // The sum so far, applied at `arm` of the next body, in whose components C^T brings it.
  const auto pass_to = [&w](const Wrench<T>& own, const Mat3<T>& C, const Vec3<T>& arm) {
    const Vec3<T> force = C.transpose() * w.force;
    const Vec3<T> moment = C.transpose() * w.moment;
    w.force = own.force + force;
    w.moment = own.moment + moment + cross(arm, force);
  };
  const Vec3<T> same_point(T(0), T(0), T(0));
  pass_to(detail::active_and_inertia<T>(chain.shaft, shaft, g_S), C_HS, pin);
  rows.torsion = torsion.take(w.moment);
  pass_to(Wrench<T>{same_point, same_point}, C_SD, same_point);
  rows.generator = generator.take(w.moment, true);
  // The generator's momentum J_g w along s2, w = omega_Y.s2 + n (U_g - omega_Y.s2): its own row
  // knows n times the torque that turns it, what carries it the whole rate.
  const T turning_rate = generator.relative_rate();
  const T along = generator.outer().alpha(1) - stator.alpha(1);
  const T momentum = (stator.omega(1) + turning_rate * chain.gear_ratio) * chain.generator_inertia;
  const T momentum_dot = (stator.alpha(1) + along * chain.gear_ratio) * chain.generator_inertia;
  // Its torques and its speed count in the sense of its turning, whichever way that is.
  const double gear = std::abs(chain.gear_ratio);
  const T held_back = (w.moment(1) - momentum_dot * chain.gear_ratio) / gear;
  w.moment -= cross(stator.omega, Vec3<T>(T(0), momentum, T(0)));
  w.moment(1) -= momentum_dot;
  T braked(0);
  if (chain.generator.free) {
    T torque = state.generator_torque;
    if (!chain.generator_torque.is_zero())
      torque += chain.generator_torque.at(T(turning_rate * gear));
    if (chain.brake_torque != 0.0)
      braked = math::smooth_sign(T(turning_rate / brake_speed)) * chain.brake_torque;
    rows.generator.balance -= momentum_dot * chain.gear_ratio + (torque + braked) * gear;
  }
  pass_to(detail::active_and_inertia<T>(chain.nacelle, nacelle, g_Y), C_DY, bearing);
  rows.yaw = yaw.take(w.moment);
  if (chain.yaw.free) {
    rows.yaw.balance += state.yaw_torque;
    w.moment(2) -= state.yaw_torque;
  }
  pass_to(detail::active_and_inertia<T>(chain.tower_top, top, g_T), C_YT, same_point);
  if (report != nullptr) {
    report->top_load << w.force, w.moment;
    chain.rotor_torque.require(math::plain_value(T(hub_motion.omega(1))));
    report->generator_rate = turning_rate * gear;
    report->generator_torque = held_back - braked;
    report->brake_torque = braked;
    if (chain.generator.free)
      chain.generator_torque.require(math::plain_value(report->generator_rate));
  }
  const Vec3<T> F_hat = C_top * Vec3<T>(state.top_load.template head<3>());
  const Vec3<T> M_hat = C_top * Vec3<T>(state.top_load.template tail<3>());
  rows.top.template head<3>() = to_top(w.force) - F_hat;
  rows.top.template tail<3>() = to_top(w.moment) - M_hat;
  return rows;
}

}  // namespace samara::elements
