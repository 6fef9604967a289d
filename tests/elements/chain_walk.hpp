// The rows of the rigid bodies between tower and blades, and the hub's motion, from a walk through
// their tree.
#pragma once

#include "samara/elements/rigid_chain.hpp"

namespace samara::test {

/// Coordinates, speeds and their rates. The tower-top quantities are in the order of a beam's tip:
/// components along (t3, t1, t2), as the tower's axes are (n3, n1, n2).
template <class T>
struct ChainState {
  Vec3<T> theta;
  Vec6<T> top_velocity;  ///< (U8, U6, U7, U5, U3, U4)
  Vec6<T> top_velocity_dot;
  elements::JointState<T> yaw, teeter, torsion, generator;
  Vec6<T> top_load;  ///< F_hat, M_hat at the tower top
  Vec6<T> hub_load;  ///< sum of the blade-root loads: force, moment about the apex, in H
  double azimuth = 0.0;
  double speed = 0.0;
  double speed_dot = 0.0;  ///< of a generator that is not free
};

/// Motion of the apex, components in H.
template <class T>
struct HubMotion {
  Vec3<T> velocity, omega, gravity;
};

template <class T>
struct ChainRows {
  Vec6<T> top;  ///< Kane's rows of (U8, U6, U7, U5, U3, U4)
  elements::JointRows<T> yaw, teeter, torsion, generator;
};

template <class T>
ChainRows<T> rigid_chain(const elements::RigidChain& chain, const ChainState<T>& state,
                         HubMotion<T>& hub) {
  const auto from_top = [](const Vec3<T>& b) { return Vec3<T>(b(1), b(2), b(0)); };
  const elements::RigidTree tree = elements::tree_of(chain);
  const Mat3<T> C_top = math::direction_cosines(state.theta);
  elements::FrameMotion<T> top;
  top.v = from_top(state.top_velocity.template head<3>());
  top.omega = from_top(state.top_velocity.template tail<3>());
  top.alpha = from_top(state.top_velocity_dot.template tail<3>());
  top.a = from_top(state.top_velocity_dot.template head<3>()) + math::cross(top.omega, top.v);
  top.gravity = from_top(C_top * Vec3<T>(Vec3<T>::UnitX() * T(-chain.gravity)));
  elements::RigidTree::States<T> states;
  states[elements::yaw_node] = state.yaw;
  states[elements::generator_node] = state.generator;
  states[elements::generator_node].carried = {state.azimuth, state.speed, state.speed_dot};
  states[elements::torsion_node] = state.torsion;
  states[elements::teeter_node] = state.teeter;
  elements::RigidTree::Results<T> nodes;
  tree.walk_outward<T>(top, states, nodes);
  const elements::FrameMotion<T>& motion = nodes[elements::teeter_node].motion;
  const Vec3<T> apex(T(0), T(chain.undersling), T(0));
  hub = {motion.v + math::cross(motion.omega, apex), motion.omega, motion.gravity};

  elements::RigidTree::Loads<T> loads;
  for (elements::Wrench<T>& load : loads) load = {Vec3<T>::Zero(), Vec3<T>::Zero()};
  const Vec3<T> force = state.hub_load.template head<3>();
  const Vec3<T> moment = state.hub_load.template tail<3>();
  loads[elements::teeter_node] = {force, moment + math::cross(apex, force)};
  const elements::Wrench<T> carried = tree.walk_inward<T>(top, states, loads, nodes);
  ChainRows<T> rows;
  rows.top << carried.force(2), carried.force(0), carried.force(1), carried.moment(2),
      carried.moment(0), carried.moment(1);
  rows.top.template head<3>() -= C_top * Vec3<T>(state.top_load.template head<3>());
  rows.top.template tail<3>() -= C_top * Vec3<T>(state.top_load.template tail<3>());
  rows.yaw = nodes[elements::yaw_node].rows;
  rows.generator = nodes[elements::generator_node].rows;
  rows.torsion = nodes[elements::torsion_node].rows;
  rows.teeter = nodes[elements::teeter_node].rows;
  return rows;
}

}  // namespace samara::test
