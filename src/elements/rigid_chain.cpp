#include "samara/elements/rigid_chain.hpp"

#include <cmath>

#include "samara/elements/torque_laws.hpp"

namespace samara::elements {
namespace {

TreeNode node_of(const Hinge& hinge, const Vector3& axis) {
  TreeNode node;
  node.axis = axis;
  node.free = hinge.free;
  node.stiffness = hinge.stiffness;
  node.damping = hinge.damping;
  if (hinge.stop_angle != 0.0)
    node.laws.push_back(
        std::make_shared<StopTorque>(hinge.stop_angle, hinge.stop_stiffness, hinge.stop_damping));
  return node;
}

}  // namespace

double RigidChain::gear() const { return std::abs(gear_ratio); }

RigidTree tree_of(const RigidChain& chain) {
  RigidTree tree;
  tree.set_base_body(chain.tower_top);
  TreeNode yaw = node_of(chain.yaw, Vector3::UnitZ());
  yaw.body = chain.nacelle;
  tree.add(yaw);

  TreeNode generator = node_of(chain.generator, Vector3::UnitY());
  generator.parent = yaw_node;
  generator.place = Vector3(0.0, 0.0, chain.height);
  generator.axes = math::turn_about<double>(Vector3::UnitX(), chain.tilt);
  generator.is_round = true;
  generator.is_geared = true;
  generator.gear_ratio = chain.gear_ratio;
  generator.rotor_inertia = chain.generator_inertia;
  if (!chain.generator_torque.is_zero())
    generator.laws.push_back(std::make_shared<GearedTorque>(chain.generator_torque, chain.gear()));
  if (chain.brake_torque != 0.0)
    generator.laws.push_back(std::make_shared<BrakeTorque>(chain.brake_torque * chain.gear()));
  tree.add(generator);

  TreeNode torsion = node_of(chain.torsion, Vector3::UnitY());
  torsion.parent = generator_node;
  torsion.body = chain.shaft;
  tree.add(torsion);

  TreeNode teeter = node_of(chain.teeter, chain.teeter_axis);
  teeter.parent = torsion_node;
  teeter.place = Vector3(0.0, chain.overhang, 0.0);
  teeter.body = chain.hub;
  if (!chain.rotor_torque.is_zero())
    teeter.spin_law = std::make_shared<SpinTorque>(chain.rotor_torque);
  tree.add(teeter);
  return tree;
}

}  // namespace samara::elements
