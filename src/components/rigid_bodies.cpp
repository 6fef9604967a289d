#include "samara/components/rigid_bodies.hpp"

#include <limits>
#include <type_traits>

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
constexpr int chain_arguments = at_hub_load + 6;
// Its values: rows of the tower top, two of each joint, the motion of the hub.
constexpr int top_rows = 0;
constexpr int joint_rows = 6;
constexpr int hub_motion = joint_rows + joint_unknowns;
constexpr int chain_values = hub_motion + 9;

template <class T>
using ChainArguments = Eigen::Matrix<T, chain_arguments, 1>;
template <class T>
using RootMotion = Eigen::Matrix<T, 9, 1>;

/// v_a, omega_a, gravity of a blade root from the hub's motion, at the pitch of C_Ha.
Eigen::Matrix<double, 9, 9> root_from_hub(const model::BladeRoot& root) {
  const Matrix3 C_aH = root.C_Ha.transpose();
  Eigen::Matrix<double, 9, 9> map = Eigen::Matrix<double, 9, 9>::Zero();
  map.block<3, 3>(0, 0) = C_aH;
  map.block<3, 3>(0, 3) = -C_aH * math::skew<double>(root.position);
  map.block<3, 3>(3, 3) = C_aH;
  map.block<3, 3>(6, 6) = C_aH;
  return map;
}

/// Force and moment about the apex in H of a blade's root load, at that pitch.
Matrix6 hub_from_root(const model::BladeRoot& root) {
  Matrix6 map = Matrix6::Zero();
  map.topLeftCorner<3, 3>() = root.C_Ha;
  map.bottomLeftCorner<3, 3>() = math::skew<double>(root.position) * root.C_Ha;
  map.bottomRightCorner<3, 3>() = root.C_Ha;
  return map;
}

}  // namespace

RigidBodies::RigidBodies(const model::Turbine& turbine, const BodiesSetting& setting)
    : turbine_(turbine), setting_(setting), chain_at_any_speed_(turbine.chain) {
  constexpr double any = std::numeric_limits<double>::quiet_NaN();
  for (elements::TorqueLine* line :
       {&chain_at_any_speed_.generator_torque, &chain_at_any_speed_.rotor_torque})
    if (!line->table.empty()) *line = {any, any, any, {}};
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
  for (const Beam* blade : setting_.blades) {
    loads_.push_back({{unknowns(blade->placed().root, 6)}, {}, {{load_port_, 0}}});
    roots_.push_back({{port_values(hub_port_, 9)}, {}, {{blade->placed().root_port, 0}}});
  }
}

/// The chain that a system is stated with: for a pattern, tables of torque may have any slope.
template <class System>
const elements::RigidChain& RigidBodies::chain_in(const System&) const {
  if constexpr (std::is_same_v<System, Pattern>)
    return chain_at_any_speed_;
  else
    return turbine_.chain;
}

template <class T, class System, class Arguments>
elements::ChainState<T> RigidBodies::chain_state(const System& system, const Arguments& x) const {
  elements::ChainState<T> state;
  state.theta = x.template segment<3>(at_theta);
  state.top_velocity = x.template segment<6>(at_top_velocity);
  state.top_velocity_dot = x.template segment<6>(at_top_velocity_dot);
  state.top_load = x.template segment<6>(at_top_load);
  state.hub_load = x.template segment<6>(at_hub_load);
  int local = 0;
  for (elements::JointState<T>* joint :
       {&state.yaw, &state.teeter, &state.torsion, &state.generator}) {
    joint->angle = x(at_joints + local);
    joint->speed = x(at_joints + local + 1);
    joint->angle_dot = x(at_joint_rates + local);
    joint->speed_dot = x(at_joint_rates + local + 1);
    local += 2;
  }
  const double t = system.time();
  const model::Operation& operation = turbine_.operation;
  const auto motion = [&](const elements::JointMotion& now, bool varies) {
    if (!varies) return now;
    return elements::JointMotion{system.varying(now.angle), system.varying(now.rate),
                                 system.varying(now.acceleration)};
  };
  state.yaw.prescribed =
      motion(turbine_.yaw_at(t), operation.yaw || !turbine_.yaw_motion.is_constant());
  state.teeter.prescribed =
      motion(turbine_.teeter_at(t), operation.teeter || !turbine_.teeter_motion.is_constant());
  const math::TimeCurve::Value turning = turbine_.turning_at(t);
  const bool turns = operation.turning.has_value();
  state.azimuth = turns || turbine_.speed != 0.0 ? system.varying(turning.value) : turning.value;
  state.speed = turns ? system.varying(turning.rate) : turning.rate;
  state.speed_dot = turns ? system.varying(turning.acceleration) : turning.acceleration;
  if constexpr (System::has_inputs) {
    const TurbineInputs<T>& inputs = system.inputs();
    state.generator_torque = inputs.generator_torque;
    state.yaw_torque = inputs.yaw_torque;
    state.up = inputs.up();
  }
  return state;
}

/// By the turbine's operation and by inputs together.
template <class T, class System>
BladePitch<T> RigidBodies::pitch_of(const System& system, std::size_t k) const {
  BladePitch<T> pitch;
  if (!turbine_.operation.pitch.empty()) {
    const math::TimeCurve::Value now = turbine_.pitch_at(k, system.time());
    pitch.moves = true;
    pitch.angle = T(system.varying(now.value - turbine_.roots[k].pitch));
    pitch.rate = T(system.varying(now.rate));
  }
  if constexpr (System::has_inputs) {
    const TurbineInputs<T>& inputs = system.inputs();
    if (inputs.pitch.empty()) return pitch;
    pitch.moves = true;
    pitch.angle += inputs.pitch[k];
    pitch.rate += inputs.pitch_rate[k];
  }
  return pitch;
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
  state_loads(system);
  const elements::RigidChain& chain = chain_in(system);
  const auto rows_of = [&]<class T>(const ChainArguments<T>& x) {
    elements::HubMotion<T> hub;
    const elements::ChainRows<T> rows =
        elements::rigid_chain<T>(chain, chain_state<T>(system, x), hub);
    Eigen::Matrix<T, chain_values, 1> y;
    y.template segment<6>(top_rows) = rows.top;
    int row = joint_rows;
    const auto put = [&](const elements::Hinge& hinge, const elements::JointRows<T>& joint) {
      y(row++) = hinge.free ? joint.kinematic : joint.position;
      y(row++) = hinge.free ? joint.balance : joint.kinematic;
    };
    put(chain.yaw, rows.yaw);
    put(chain.teeter, rows.teeter);
    put(chain.torsion, rows.torsion);
    put(chain.generator, rows.generator);
    y.template segment<9>(hub_motion) << hub.velocity, hub.omega, hub.gravity;
    return y;
  };
  system.template add<chain_arguments, chain_values>(chain_, rows_of);
  state_roots(system);
}

template <class System>
void RigidBodies::state_loads(System& system) const {
  for (std::size_t k = 0; k < loads_.size(); ++k) {
    const Matrix6 map = hub_from_root(turbine_.roots[k]);
    const auto load_of = [&]<class T>(const Vec6<T>& root) {
      Vec6<T> load = root;
      if (const BladePitch<T> pitch = pitch_of<T>(system, k); pitch.moves) {
        const Mat3<T> feather = pitch.feather();
        load << feather * root.template head<3>(), feather * root.template tail<3>();
      }
      return Vec6<T>(map.cast<T>() * load);
    };
    system.template add<6, 6>(loads_[k], load_of);
  }
}

template <class System>
void RigidBodies::state_roots(System& system) const {
  for (std::size_t k = 0; k < roots_.size(); ++k) {
    const Eigen::Matrix<double, 9, 9> map = root_from_hub(turbine_.roots[k]);
    const auto motion_of = [&]<class T>(const RootMotion<T>& hub) {
      RootMotion<T> root = map.cast<T>() * hub;
      if (const BladePitch<T> pitch = pitch_of<T>(system, k); pitch.moves) {
        const Mat3<T> back = pitch.feather().transpose();
        for (int vector = 0; vector < 9; vector += 3)
          root.template segment<3>(vector) = (back * root.template segment<3>(vector)).eval();
        root(3) -= pitch.rate;
      }
      return root;
    };
    system.template add<9, 9>(roots_[k], motion_of);
  }
}

template <class T>
elements::ChainReport<T> RigidBodies::report(Residual<T>& residual) const {
  state_loads(residual);
  elements::HubMotion<T> hub;
  elements::ChainReport<T> report;
  elements::rigid_chain<T>(
      turbine_.chain, chain_state<T>(residual, residual.template gather<chain_arguments>(chain_)),
      hub, &report);
  return report;
}

template elements::ChainReport<double> RigidBodies::report(Residual<double>&) const;
template elements::ChainReport<std::complex<double>> RigidBodies::report(
    Residual<std::complex<double>>&) const;

template class Stated<RigidBodies>;

}  // namespace samara::components
