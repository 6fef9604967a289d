#include "samara/components/rigid_bodies.hpp"

#include <array>

#include "samara/base/index.hpp"
#include "samara/components/prescribed_motion.hpp"
#include "samara/components/tower_axes.hpp"
#include "samara/elements/torque_laws.hpp"

namespace samara::components {
namespace {

// Arguments of the chain of bodies, in this order.
constexpr int at_theta = 0;
constexpr int at_top_velocity = 3;
constexpr int at_joints = 9;
constexpr int joint_unknowns = 8;
constexpr int at_top_velocity_dot = at_joints + joint_unknowns;
constexpr int at_joint_rates = at_top_velocity_dot + 6;
constexpr int at_top_load = at_joint_rates + joint_unknowns;
constexpr int at_hub_load = at_top_load + 6;
// Values of the chain: rows of the tower top, two of each joint, the motion of the hub.
constexpr int top_rows = 0;
constexpr int joint_rows = 6;
constexpr int hub_motion = joint_rows + joint_unknowns;
constexpr int chain_values = hub_motion + 9;

/// Position of each node's unknowns among those of the joints: yaw, generator, torsion, teeter.
constexpr std::array<int, elements::chain_nodes> slot_of{0, 3, 2, 1};

using elements::FrameMotion;
using elements::JointState;
using elements::NodeResult;
using elements::RigidTree;
using elements::Wrench;

template <class T>
using RootMotion = Eigen::Matrix<T, 9, 1>;

}  // namespace

RigidBodies::RigidBodies(const model::Turbine& turbine, const BodiesSetting& setting)
    : turbine_(turbine), setting_(setting), tree_(elements::tree_of(turbine.chain)) {
  for (std::size_t k = 0; k < setting_.blades.size(); ++k) roots_.emplace_back(turbine_, k);
}

void RigidBodies::connect() {
  const int top = tower_top();
  const bool has_top = top >= 0;
  const auto of_top = [&](const Argument& argument) {
    return has_top ? argument : zeros(argument.count);
  };
  chain_.arguments = {of_top(unknowns(top + 3, 3)),      of_top(unknowns(top + 6, 6)),
                      unknowns(joints_, joint_unknowns), of_top(rates(top + 6, 6)),
                      rates(joints_, joint_unknowns),    of_top(unknowns(top + 12, 6)),
                      port_values(load_port_, 6)};
  if (has_top) chain_.shares = {{top + 12, 3, top_rows}, {top + 15, 3, top_rows + 3}};
  for (int i = 0; i < joint_unknowns; i += 2)
    chain_.shares.push_back({joints_ + i, 2, joint_rows + i});
  chain_.provisions = {{hub_port_, hub_motion}};
  foot_.arguments = {zeros(1)};
  if (has_top) foot_.provisions = {{setting_.tower->placed().root_port, 0}};
  if (pose_port_ < 0) return;
  pose_.arguments = {of_top(unknowns(top, 6)), unknowns(joints_, joint_unknowns),
                     port_values(hub_port_, 9)};
  pose_.provisions = {{pose_port_, 0}};
  for (BladeRoot& root : roots_) root.connect_pose(pose_port_);
}

/// Sets the prescribed motions and the torques on the joints.
template <class T, class System>
void RigidBodies::set_joints(const System& system, const ChainArguments<T>& x,
                             RigidTree::States<T>& states) const {
  static_assert(chain_arguments == at_hub_load + 6);
  for (int node = 0; node < tree_.size(); ++node) {
    const int local = 2 * slot_of[at(node)];
    JointState<T>& joint = states[at(node)];
    joint.angle = x(at_joints + local);
    joint.speed = x(at_joints + local + 1);
    joint.angle_dot = x(at_joint_rates + local);
    joint.speed_dot = x(at_joint_rates + local + 1);
  }
  const double t = system.time();
  const model::Operation& operation = turbine_.operation;
  states[elements::yaw_node].prescribed = prescribed_yaw(system, turbine_);
  states[elements::teeter_node].prescribed = prescribed_motion(
      system, turbine_.teeter_at(t), operation.teeter || !turbine_.teeter_motion.is_constant());
  const math::TimeCurve::Value turning = turbine_.turning_at(t);
  elements::JointMotion& carried = states[elements::generator_node].carried;
  carried = prescribed_motion(system, {turning.value, turning.rate, turning.acceleration},
                              operation.turning.has_value());
  if (turbine_.speed != 0.0) carried.angle = system.varying(turning.value);
  if constexpr (System::has_inputs) {
    const TurbineInputs<T>& inputs = system.inputs();
    states[elements::generator_node].torque = inputs.generator_torque * -turbine_.chain.gear();
    states[elements::yaw_node].torque = inputs.yaw_torque;
  }
}

/// Motion of the tower top, in t1 t2 t3.
template <class T, class System>
FrameMotion<T> RigidBodies::base_motion(const System& system, const ChainArguments<T>& x,
                                        const Mat3<T>& C_top) const {
  Vec3<T> up = Vec3<T>::UnitX();
  if constexpr (System::has_inputs) up = system.inputs().up();
  FrameMotion<T> top;
  top.v = from_beam_order<T>(x.template segment<3>(at_top_velocity));
  top.omega = from_beam_order<T>(x.template segment<3>(at_top_velocity + 3));
  top.alpha = from_beam_order<T>(x.template segment<3>(at_top_velocity_dot + 3));
  top.a = from_beam_order<T>(x.template segment<3>(at_top_velocity_dot)) +
          math::cross(top.omega, top.v);
  top.gravity = from_beam_order<T>(C_top * Vec3<T>(up * T(-turbine_.chain.gravity)));
  return top;
}

template <class T, class System>
RigidBodies::Walk<T> RigidBodies::walk(const System& system, const ChainArguments<T>& x) const {
  Walk<T> walk;
  walk.C_top = math::direction_cosines<T>(x.template segment<3>(at_theta));
  walk.top = base_motion<T>(system, x, walk.C_top);
  RigidTree::States<T> states;
  set_joints<T>(system, x, states);
  tree_.walk_outward<T>(walk.top, states, walk.nodes);
  RigidTree::Loads<T> loads;
  for (int node = 0; node < tree_.size(); ++node)
    loads[at(node)] = {Vec3<T>::Zero(), Vec3<T>::Zero()};
  const Vec3<T> apex(T(0), T(turbine_.chain.undersling), T(0));
  Wrench<T>& hub = loads[elements::teeter_node];
  hub.force = x.template segment<3>(at_hub_load);
  hub.moment = x.template segment<3>(at_hub_load + 3) + math::cross(apex, hub.force);
  walk.on_top = tree_.walk_inward<T>(walk.top, states, loads, walk.nodes);
  return walk;
}

template <class System>
void RigidBodies::state(System& system) const {
  if (setting_.tower != nullptr) {
    // The tower's axes are (n3, n1, n2).
    const auto foot = [&]<class T>(const Eigen::Matrix<T, 1, 1>&) {
      RootMotion<T> motion = RootMotion<T>::Zero();
      motion(6) = T(-turbine_.chain.gravity);
      if constexpr (System::has_inputs) {
        const TurbineInputs<T>& inputs = system.inputs();
        const Vec3<T>& v = inputs.base_velocity;
        const Vec3<T>& rate = inputs.base_rate;
        motion << inputs.at_foot(Vec3<T>(v(2), v(0), v(1))), Vec3<T>(rate(2), rate(0), rate(1)),
            inputs.up() * T(-turbine_.chain.gravity);
      }
      return motion;
    };
    system.template add<1, 9>(foot_, foot);
    system.require_rotation(tower_top() + 3, [] { return std::string("tower top"); });
  }
  for (const BladeRoot& root : roots_) root.state_load(system);
  const auto rows_of = [&]<class T>(const ChainArguments<T>& x) {
    const Walk<T> walk = this->walk<T>(system, x);
    Eigen::Matrix<T, chain_values, 1> y;
    y.template segment<3>(top_rows) = to_beam_order<T>(walk.on_top.force) -
                                      walk.C_top * Vec3<T>(x.template segment<3>(at_top_load));
    y.template segment<3>(top_rows + 3) =
        to_beam_order<T>(walk.on_top.moment) -
        walk.C_top * Vec3<T>(x.template segment<3>(at_top_load + 3));
    for (int node = 0; node < tree_.size(); ++node) {
      const elements::JointRows<T>& rows = walk.nodes[at(node)].rows;
      const bool free = tree_.node(node).free;
      const int row = joint_rows + 2 * slot_of[at(node)];
      y(row) = free ? rows.kinematic : rows.position;
      y(row + 1) = free ? rows.balance : rows.kinematic;
    }
    const FrameMotion<T>& hub = walk.nodes[elements::teeter_node].motion;
    const Vec3<T> apex(T(0), T(turbine_.chain.undersling), T(0));
    y.template segment<9>(hub_motion) << hub.v + math::cross(hub.omega, apex), hub.omega,
        hub.gravity;
    return y;
  };
  system.template add<chain_arguments, chain_values>(chain_, rows_of);
  for (const BladeRoot& root : roots_) root.state_motion(system);
  if (pose_port_ >= 0) state_poses(system);
}

/// The poses of hub and blade roots, which the wind needs.
template <class System>
void RigidBodies::state_poses(System& system) const {
  const auto pose_of = [&]<class T>(const Eigen::Matrix<T, pose_arguments, 1>& x) {
    ChainArguments<T> joints = ChainArguments<T>::Zero();
    joints.template segment<joint_unknowns>(at_joints) = x.template segment<joint_unknowns>(6);
    RigidTree::States<T> states;
    set_joints<T>(system, joints, states);
    elements::Pose<T> base;
    if (setting_.tower != nullptr) {
      const Vec3<T> top = x.template head<3>() + setting_.tower->placed().beam->tip.cast<T>();
      const Mat3<T> C = math::direction_cosines<T>(x.template segment<3>(3));
      base.place = in_ground<T>(system, top);
      for (int i = 0; i < 3; ++i)  // t1 t2 t3 are the second, third and first axis of the beam
        base.axes.col(i) = in_ground<T>(system, Vec3<T>(C.row((i + 1) % 3).transpose()));
    }
    const elements::Pose<T> hub = tree_.pose_of<T>(elements::teeter_node, base, states);
    const Vec3<T> velocity = hub.axes * Vec3<T>(x.template segment<3>(14));
    const Vec3<T> apex(T(0), T(turbine_.chain.undersling), T(0));
    Eigen::Matrix<T, hub_pose_values, 1> y;
    y << hub.place + hub.axes * apex, hub.axes.col(0), hub.axes.col(1), velocity, x(18);
    return y;
  };
  system.template add<pose_arguments, hub_pose_values>(pose_, pose_of);
  for (const BladeRoot& root : roots_) root.state_pose(system);
}

template <class T>
BodiesReport<T> RigidBodies::report(Residual<T>& residual) const {
  if (setting_.tower != nullptr)
    residual.require_rotation(tower_top() + 3, [] { return std::string("tower top"); });
  for (const BladeRoot& root : roots_) root.state_load(residual);
  const Walk<T> walk = this->walk<T>(residual, residual.template gather<chain_arguments>(chain_));
  const NodeResult<T>& yaw = walk.nodes[elements::yaw_node];
  const NodeResult<T>& generator = walk.nodes[elements::generator_node];
  const NodeResult<T>& torsion = walk.nodes[elements::torsion_node];
  const NodeResult<T>& teeter = walk.nodes[elements::teeter_node];
  const elements::RigidChain& chain = turbine_.chain;
  BodiesReport<T> report;
  report.azimuth = torsion.angle;
  report.yaw = yaw.angle;
  report.yaw_rate = yaw.rate;
  report.teeter = teeter.angle;
  report.teeter_rate = teeter.rate;
  report.shaft_rate = generator.rate + torsion.rate;
  report.rotor_load << teeter.passed.force, teeter.passed.moment;
  report.top_load << walk.on_top.force, walk.on_top.moment;
  report.top_acceleration = walk.top.a;
  for (const BladeRoot& root : roots_) report.pitch.push_back(root.pitch(residual));
  report.generator_rate = generator.rate * chain.gear();
  report.brake_torque = T(0);
  if (chain.generator.free && chain.brake_torque != 0.0)
    report.brake_torque =
        -elements::torque_of<T>(elements::BrakeTorque(chain.brake_torque), T(0), generator.rate);
  report.generator_torque = generator.held - report.brake_torque;
  chain.rotor_torque.require(math::plain_value(teeter.motion.omega(1)));
  if (chain.generator.free)
    chain.generator_torque.require(math::plain_value(report.generator_rate));
  return report;
}

template BodiesReport<double> RigidBodies::report(Residual<double>&) const;
template BodiesReport<std::complex<double>> RigidBodies::report(
    Residual<std::complex<double>>&) const;

template class Stated<RigidBodies>;

}  // namespace samara::components
