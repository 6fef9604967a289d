// Places and descriptions of the unknowns of the rigid bodies.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/base/index.hpp"
#include "samara/components/rigid_bodies.hpp"

namespace samara::components {
namespace {

using system::EnergyGroup;
using system::Frame;
using system::Owner;
using system::PartKind;
using system::RowRole;
using system::UnknownRole;

constexpr int joint_unknowns = 2;

/// The joints in the order of their unknowns.
enum Joint { yaw, teeter, torsion, generator, joint_count };

Owner body_owner(const char* name) { return {PartKind::body, name}; }
Owner joint_owner(const std::string& name) { return {PartKind::joint, name}; }

bool turns_freely(const elements::RigidChain& chain) {
  return chain.torsion.free || chain.generator.free;
}

}  // namespace

void RigidBodies::place(Registry& registry) {
  joints_ = registry.add_shared(setting_.shared_rank, joint_count * joint_unknowns);
  hub_port_ = registry.add_port(9);
  load_port_ = registry.add_port(6);
  for (BladeRoot& root : roots_) root.place(registry, setting_.hinge_rank);
  if (!turbine_.air) return;
  pose_port_ = registry.add_port(hub_pose_values);
  for (BladeRoot& root : roots_) root.place_pose(registry);
}

int RigidBodies::joint(int number) const { return joints_ + joint_unknowns * number; }

int RigidBodies::tower_top() const {
  return setting_.tower == nullptr ? -1 : setting_.tower->placed().tip;
}

void RigidBodies::require_admissible(const std::vector<double>& z) const {
  constexpr double degrees = 180.0 / std::numbers::pi;
  constexpr double largest = 170.0;
  const double angle = turbine_.chain.teeter.free ? degrees * z[at(joint(teeter))] : 0.0;
  if (!(std::abs(angle) <= largest))
    throw DomainError("the teeter angle is " + general(angle, 3) +
                      " degrees (at most 170 in either direction): nothing stops the rotor; hint: "
                      "hub.teeter.stops, or hub.teeter.joint: locked");
}

void RigidBodies::describe(Registry& registry) {
  const elements::RigidChain& chain = turbine_.chain;
  describe_joint(registry, yaw, "yaw", Frame::fixed, chain.yaw.free);
  describe_joint(registry, teeter, "teeter", Frame::rotating, chain.teeter.free);
  describe_joint(registry, torsion, "shaft torsion", Frame::rotating, chain.torsion.free);
  describe_joint(registry, generator, "generator", Frame::rotating, chain.generator.free);
  const auto add_unconstrained = [&](const char* name, int number) {
    registry.add(system::UnconstrainedCoordinate{name, joint(number), joint(number) + 1, "N m"});
  };
  if (chain.yaw.free && chain.yaw.stiffness == 0.0) {
    // Wind on a rotor that turns restores it, or turns it away. The shaft starts along the wind.
    if (turbine_.air && turbine_.air->hub_wind > 0.0 && turbine_.speed != 0.0)
      registry.add_free(
          {"yaw", joint(yaw), joint(yaw) + 1, "N m", turbine_.air->rotor.wind.mean.direction});
    else
      add_unconstrained("yaw", yaw);
  }
  if (chain.teeter.free && chain.teeter.stiffness == 0.0 && turbine_.speed == 0.0)
    add_unconstrained("teeter", teeter);
  if (integral_ >= 0) {
    registry.add(
        system::UnconstrainedCoordinate{"generator", joint(generator), integral_, "rad/s"});
    registry.add_free({"controller integral", integral_, joint(generator) + 1, "N m"});
  } else if (chain.generator.free)
    add_unconstrained("generator", generator);
  // The hinge axis turns with the shaft: half a revolution reverses it.
  if (setting_.blades.size() == 2)
    for (int i = 0; i < joint_unknowns; ++i) registry.reverse(joint(teeter) + i);
  describe_energies(registry);
  for (std::size_t k = 0; k < roots_.size(); ++k)
    roots_[k].describe(registry, setting_.blades[k]->placed().root, hub_port_, load_port_,
                       setting_.blades[k]->placed().root_port);
  connect();
}

void RigidBodies::describe_joint(Registry& registry, int number, const std::string& name,
                                 Frame frame, bool free) const {
  const Owner owner = joint_owner(name);
  registry.describe(joint(number), {owner, "", "angle", "rad", UnknownRole::position, frame},
                    free ? RowRole::kinematic : RowRole::constraint);
  registry.describe(joint(number) + 1, {owner, "", "speed", "rad/s", UnknownRole::velocity, frame},
                    free ? RowRole::balance : RowRole::kinematic);
}

/// Axes of the bearing in t1 t2 t3 at the mean of a prescribed yaw.
Matrix3 RigidBodies::bearing_axes() const {
  return math::turn_about<double>(Vector3::UnitZ(), turbine_.yaw_motion.angle) *
         math::turn_about<double>(Vector3::UnitX(), turbine_.chain.tilt);
}

/// Mass of the bodies on the tower top, at zero azimuth and the mean of a prescribed yaw: nacelle,
/// shaft and hub. With a free teeter the hub counts only as a mass at the pin; its rotation about
/// the hinge has an energy of its own. A generator that is not free rolls with the nacelle, with or
/// without a gear.
Matrix6 RigidBodies::carried_mass() const {
  const elements::RigidChain& chain = turbine_.chain;
  const Matrix3 yawed = math::turn_about<double>(Vector3::UnitZ(), turbine_.yaw_motion.angle);
  const Matrix3 tilted = bearing_axes();
  const Vector3 bearing(0.0, 0.0, chain.height);
  const Vector3 pin = bearing + tilted * Vector3(0.0, chain.overhang, 0.0);
  Matrix6 weight = Matrix6::Zero();
  const auto add = [&weight](double mass, const Vector3& center, const Matrix3& inertia) {
    const Matrix3 across = math::skew<double>(center);
    weight.topLeftCorner<3, 3>() += mass * Matrix3::Identity();
    weight.topRightCorner<3, 3>() -= mass * across;  // m V.(omega x c)
    weight.bottomLeftCorner<3, 3>() += mass * across;
    weight.bottomRightCorner<3, 3>() += inertia - mass * across * across;
  };
  const auto add_body = [&](const elements::RigidBody& body, const Matrix3& C,
                            const Vector3& reference) {
    add(body.mass, reference + C * body.center, C * body.inertia * C.transpose());
  };
  add_body(chain.nacelle, yawed, Vector3::Zero());
  elements::RigidBody shaft = chain.shaft;
  elements::RigidBody hub = chain.hub;
  if (turns_freely(chain))
    shaft.inertia(1, 1) = hub.inertia(1, 1) = 0.0;  // counted with the speed of the shaft
  add_body(shaft, tilted, bearing);
  if (!chain.generator.free)
    add(0.0, Vector3::Zero(), chain.generator_inertia * tilted.col(1) * tilted.col(1).transpose());
  if (chain.teeter.free)
    add(chain.hub.mass, pin, Matrix3::Zero());
  else
    add_body(hub, tilted, pin);
  return weight;
}

void RigidBodies::describe_energies(Registry& registry) const {
  const elements::RigidChain& chain = turbine_.chain;
  const Matrix6 carried = carried_mass();
  EnergyGroup group{EnergyGroup::Kind::kinetic, body_owner("nacelle"), "", Frame::fixed, {}, {}};
  if (setting_.tower != nullptr) {
    const int top = tower_top();  // V = (U6 U7 U8), omega = (U3 U4 U1)
    group.unknowns = {top + 7, top + 8, top + 6, top + 10, top + 11, joint(yaw) + 1};
    group.weight.assign(carried.data(), carried.data() + carried.size());
    registry.add(group);
  } else if (chain.yaw.free && carried(5, 5) > 0.0) {
    group.unknowns = {joint(yaw) + 1};
    group.weight = {carried(5, 5)};
    registry.add(group);
  }
  if (chain.teeter.free) {
    const Vector3 e = chain.teeter_axis;
    const Matrix3 across = math::skew<double>(chain.hub.center);
    const double inertia = e.dot((chain.hub.inertia - chain.hub.mass * across * across) * e);
    if (inertia > 0.0)
      registry.add(EnergyGroup{EnergyGroup::Kind::kinetic,
                               body_owner("hub"),
                               "",
                               Frame::rotating,
                               {joint(teeter) + 1},
                               {inertia}});
  }
  const auto add_shaft = [&registry](int speed, double shaft_inertia) {
    if (shaft_inertia > 0.0)
      registry.add(EnergyGroup{EnergyGroup::Kind::kinetic,
                               body_owner("drivetrain"),
                               "",
                               Frame::rotating,
                               {speed},
                               {shaft_inertia}});
  };
  const Vector3 off_axis(chain.hub.center(0), 0.0, chain.hub.center(2));
  const double hub_turning = chain.hub.inertia(1, 1) + chain.hub.mass * off_axis.squaredNorm();
  const double turning = chain.shaft.inertia(1, 1) + (chain.teeter.free ? 0.0 : hub_turning);
  if (turns_freely(chain)) add_shaft(joint(torsion) + 1, turning);
  if (chain.generator.free) describe_generator(registry);
  describe_spring(registry, chain.yaw, "yaw", Frame::fixed, joint(yaw));
  describe_spring(registry, chain.teeter, "teeter", Frame::rotating, joint(teeter));
  describe_spring(registry, chain.torsion, "shaft torsion", Frame::rotating, joint(torsion));
}

/// J_g w^2/2 of a free generator with w = (1 - n) omega_Y.s2 + n U_g.
void RigidBodies::describe_generator(Registry& registry) const {
  const elements::RigidChain& chain = turbine_.chain;
  if (chain.generator_inertia == 0.0) return;
  EnergyGroup group{EnergyGroup::Kind::kinetic,
                    body_owner("drivetrain"),
                    "",
                    Frame::rotating,
                    {joint(generator) + 1},
                    {}};
  std::vector<double> shares{chain.gear_ratio};
  const Vector3 along = (1.0 - chain.gear_ratio) * bearing_axes().col(1);
  const auto add_share = [&](int unknown, double share) {
    if (share == 0.0) return;
    group.unknowns.push_back(unknown);
    shares.push_back(share);
  };
  if (setting_.tower != nullptr) {
    add_share(tower_top() + 10, along(0));
    add_share(tower_top() + 11, along(1));
  }
  if (setting_.tower != nullptr || chain.yaw.free) add_share(joint(yaw) + 1, along(2));
  for (const double a : shares)
    for (const double b : shares) group.weight.push_back(chain.generator_inertia * a * b);
  registry.add(group);
}

void RigidBodies::describe_spring(Registry& registry, const elements::Hinge& hinge,
                                  const std::string& name, Frame frame, int angle) const {
  if (!hinge.free || hinge.stiffness == 0.0) return;
  registry.add(EnergyGroup{EnergyGroup::Kind::strain,
                           joint_owner(name),
                           "",
                           frame,
                           {angle},
                           {hinge.stiffness},
                           hinge.damping / hinge.stiffness});
}

/// A constant torque has a potential where its axis moves as prescribed.
bool RigidBodies::is_conservative() const {
  const elements::RigidChain& chain = turbine_.chain;
  if (chain.teeter.free && chain.teeter.stop_angle > 0.0 && chain.teeter.stop_damping > 0.0)
    return false;
  for (const elements::Hinge* hinge : {&chain.yaw, &chain.teeter, &chain.torsion, &chain.generator})
    if (hinge->free && hinge->damping != 0.0) return false;
  if (axis_moves() && !chain.rotor_torque.is_zero()) return false;
  const bool torque_varies = chain.rotor_torque.slope != 0.0 || !chain.rotor_torque.table.empty();
  if (hub_moves() && torque_varies) return false;
  const elements::TorqueLine& torque = chain.generator_torque;
  if (chain.generator.free && (torque.slope != 0.0 || !torque.table.empty())) return false;
  return chain.brake_torque == 0.0 &&
         std::all_of(roots_.begin(), roots_.end(),
                     [](const BladeRoot& root) { return root.is_conservative(); });
}

bool RigidBodies::has_autonomous_constraints() const {
  return turbine_.yaw_motion.is_constant() && turbine_.teeter_motion.is_constant() &&
         !turbine_.operation.yaw && !turbine_.operation.teeter;
}

bool RigidBodies::axis_moves() const {
  return setting_.tower != nullptr || turbine_.chain.yaw.free || turbine_.chain.teeter.free;
}

bool RigidBodies::hub_moves() const { return axis_moves() || turns_freely(turbine_.chain); }

}  // namespace samara::components
