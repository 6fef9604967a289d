// The rigid bodies between tower and blades by Kane's method (docs/theory.md, section 3; Lee,
// Hodges & Patil (2002), eq. (8), (9)): tower top T, yaw q_y about t3, nacelle Y, tilted shaft
// bearing, azimuth psi about s2, shaft S, teeter q_h about the hinge axis e of S and H, hub H.
//
// Generalized speeds: U1 = omega_Y.y3, U2 = omega_H.e, U3..5 = omega_T in t1 t2 t3, U6..8 = v_T in
// t1 t2 t3. "Speed of the outer body in the inertial frame" makes the partial velocities so sparse
// that Kane's sums are one walk inward: a joint passes on the moment without its component about
// its own axis, and that component, with the joint's spring and damper, is the joint's row.
//
// The full nonlinear equations; valid for any angles (theta_T below 180 degrees).
#pragma once

#include "samara/elements/beam_point.hpp"
#include "samara/math/rotation.hpp"

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
};

struct RigidChain {
  double gravity = 0.0;  ///< along -n3 [m/s^2]
  Hinge yaw;
  Hinge teeter;
  RigidBody tower_top;                     ///< reference point: tower top; axes t1 t2 t3
  RigidBody nacelle;                       ///< reference point: tower top; axes y1 y2 y3
  RigidBody shaft;                         ///< reference: yaw axis on the shaft; axes s1 s2 s3
  RigidBody hub;                           ///< reference: teeter pin; axes h1 h2 h3
  double height = 0.0;                     ///< tower top to shaft axis, along y3 [m]
  double tilt = 0.0;                       ///< > 0 raises s2 [rad]
  double overhang = 0.0;                   ///< yaw axis to teeter pin along s2 [m]
  double undersling = 0.0;                 ///< teeter pin to apex along h2 [m]
  Vector3 teeter_axis = Vector3::UnitX();  ///< e, fixed in S and in H
};

/// Coordinates, speeds and their rates. The tower-top quantities are in the order of a beam's tip:
/// components along (t3, t1, t2), as the tower's axes are (n3, n1, n2).
template <class T>
struct ChainState {
  Vec3<T> theta;         ///< Rodrigues parameters of T, components in the tower's a
  Vec6<T> top_velocity;  ///< V, Omega of T: (U8, U6, U7, U5, U3, U4)
  Vec6<T> top_velocity_dot;
  T yaw, yaw_speed, yaw_dot, yaw_speed_dot;              ///< q_y, U1 and rates
  T teeter, teeter_speed, teeter_dot, teeter_speed_dot;  ///< q_h, U2 and rates
  Vec6<T> top_load;      ///< F_hat, M_hat at the tower tip, components in the tower's a
  Vec6<T> hub_load;      ///< sum of the blade-root loads: force, moment about the apex, in H
  double azimuth = 0.0;  ///< psi [rad]
  double speed = 0.0;    ///< psi_dot [rad/s]
};

/// The hub as the blades see it, components in H.
template <class T>
struct HubMotion {
  Vec3<T> velocity;  ///< of the apex [m/s]
  Vec3<T> omega;     ///< [rad/s]
  Vec3<T> gravity;   ///< [m/s^2]
};

/// Residual rows. A locked joint has the row U - (speed it is carried with) instead of Kane's.
template <class T>
struct ChainRows {
  Vec6<T> top;         ///< Kane's rows of (U8, U6, U7, U5, U3, U4) [N, N m]
  T yaw_kinematic;     ///< q_y_dot - (U1 - U5), or of a locked joint U1 - U5
  T yaw_balance;       ///< Kane's row of U1 [N m]; unused where locked
  T teeter_kinematic;  ///< q_h_dot - (U2 - omega_S.e), or of a locked joint U2 - omega_S.e
  T teeter_balance;    ///< Kane's row of U2 [N m]; unused where locked
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
  Motion<T> outer = with_relative_rate<T>(axis, rate, inner);
  const T lacking = speed_dot - math::dot(axis, outer.alpha);
  for (int i = 0; i < 3; ++i) outer.alpha(i) += axis(i) * lacking;
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

}  // namespace detail

/// The rows and the motion that the blades need. A test of Kane's method against Lagrange's
/// equations is in tests/elements/rigid_chain_test.cpp.
template <class T>
ChainRows<T> rigid_chain(const RigidChain& chain, const ChainState<T>& state, HubMotion<T>& hub) {
  using detail::Motion;
  using detail::Wrench;
  using math::cross;
  using math::dot;
  const auto from_top = [](const Vec3<T>& b) { return Vec3<T>(b(1), b(2), b(0)); };
  const auto to_top = [](const Vec3<T>& t) { return Vec3<T>(t(2), t(0), t(1)); };
  const Vec3<T> y3 = Vector3::UnitZ().cast<T>();
  const Vec3<T> s2 = Vector3::UnitY().cast<T>();
  const Vec3<T> e = chain.teeter_axis.cast<T>();

  // Outward: motions. T: derivative of v_T's components in T plus omega x v is the acceleration.
  const Mat3<T> C_top = math::direction_cosines(state.theta);
  Motion<T> top;
  top.v = from_top(state.top_velocity.template head<3>());
  top.omega = from_top(state.top_velocity.template tail<3>());
  top.alpha = from_top(state.top_velocity_dot.template tail<3>());
  top.a = from_top(state.top_velocity_dot.template head<3>()) + cross(top.omega, top.v);
  const Vec3<T> down(T(-chain.gravity), T(0), T(0));  // components in (n3, n1, n2)
  const Vec3<T> g_T = from_top(C_top * down);

  const T yaw = chain.yaw.free ? state.yaw : T(0);
  const Mat3<T> C_YT = math::turn_about<T>(Vector3::UnitZ(), yaw).transpose();
  const Motion<T> carried_Y = detail::seen_from<T>(C_YT, top);
  const Motion<T> nacelle =
      chain.yaw.free
          ? detail::with_outer_speed<T>(y3, state.yaw_speed, state.yaw_speed_dot, carried_Y)
          : carried_Y;
  const Vec3<T> g_Y = C_YT * g_T;

  const Matrix3 C_YS_tilt = math::turn_about<double>(Vector3::UnitX(), chain.tilt);
  const Matrix3 C_SY_turn =
      math::turn_about<double>(Vector3::UnitY(), state.azimuth).transpose() * C_YS_tilt.transpose();
  const Mat3<T> C_SY = C_SY_turn.cast<T>();
  const Vec3<T> bearing(T(0), T(0), T(chain.height));
  const Motion<T> carried_S = detail::seen_from<T>(C_SY, detail::moved_to<T>(bearing, nacelle));
  const Motion<T> shaft = detail::with_relative_rate<T>(s2, T(state.speed), carried_S);
  const Vec3<T> g_S = C_SY * g_Y;

  const Vec3<T> pin(T(0), T(chain.overhang), T(0));
  const T teeter = chain.teeter.free ? state.teeter : T(0);
  const Mat3<T> C_HS = math::turn_about<T>(chain.teeter_axis, teeter).transpose();
  const Motion<T> carried_H = detail::seen_from<T>(C_HS, detail::moved_to<T>(pin, shaft));
  const Motion<T> hub_motion =
      chain.teeter.free
          ? detail::with_outer_speed<T>(e, state.teeter_speed, state.teeter_speed_dot, carried_H)
          : carried_H;
  const Vec3<T> g_H = C_HS * g_S;
  const Vec3<T> apex(T(0), T(chain.undersling), T(0));
  hub.velocity = hub_motion.v + cross(hub_motion.omega, apex);
  hub.omega = hub_motion.omega;
  hub.gravity = g_H;

  ChainRows<T> rows;
  const T yaw_rate = state.yaw_speed - dot(y3, carried_Y.omega);
  const T teeter_rate = state.teeter_speed - dot(e, carried_H.omega);
  rows.yaw_kinematic = chain.yaw.free ? T(state.yaw_dot - yaw_rate) : yaw_rate;
  rows.teeter_kinematic = chain.teeter.free ? T(state.teeter_dot - teeter_rate) : teeter_rate;

  // Inward: Kane's sums, moments about the point of the joint that is passed.
  Wrench<T> w = detail::active_and_inertia<T>(chain.hub, hub_motion, g_H);
  const Vec3<T> root_force = state.hub_load.template head<3>();
  const Vec3<T> root_moment = state.hub_load.template tail<3>();
  w.force += root_force;
  w.moment += root_moment + cross(apex, root_force);
  rows.teeter_balance = T(0);
  if (chain.teeter.free) {
    const T spring = -(state.teeter * chain.teeter.stiffness + teeter_rate * chain.teeter.damping);
    const T about = dot(e, w.moment);
    rows.teeter_balance = about + spring;
    for (int i = 0; i < 3; ++i) w.moment(i) -= e(i) * (about + spring);
  }
  const Vec3<T> hub_force = C_HS.transpose() * w.force;
  const Vec3<T> hub_moment = C_HS.transpose() * w.moment;
  w = detail::active_and_inertia<T>(chain.shaft, shaft, g_S);
  w.force += hub_force;
  w.moment += hub_moment + cross(pin, hub_force);
  const Vec3<T> shaft_force = C_SY.transpose() * w.force;
  const Vec3<T> shaft_moment = C_SY.transpose() * w.moment;
  w = detail::active_and_inertia<T>(chain.nacelle, nacelle, g_Y);
  w.force += shaft_force;
  w.moment += shaft_moment + cross(bearing, shaft_force);
  rows.yaw_balance = T(0);
  if (chain.yaw.free) {
    const T spring = -(state.yaw * chain.yaw.stiffness + yaw_rate * chain.yaw.damping);
    const T about = w.moment(2);
    rows.yaw_balance = about + spring;
    w.moment(2) -= about + spring;
  }
  const Wrench<T> fixed = detail::active_and_inertia<T>(chain.tower_top, top, g_T);
  const Vec3<T> top_force = C_YT.transpose() * w.force + fixed.force;
  const Vec3<T> top_moment = C_YT.transpose() * w.moment + fixed.moment;
  const Vec3<T> F_hat = C_top * Vec3<T>(state.top_load.template head<3>());
  const Vec3<T> M_hat = C_top * Vec3<T>(state.top_load.template tail<3>());
  rows.top.template head<3>() = to_top(top_force) - F_hat;
  rows.top.template tail<3>() = to_top(top_moment) - M_hat;
  return rows;
}

}  // namespace samara::elements
