#include "rotor_symmetry.hpp"

#include <algorithm>
#include <cmath>

#include "samara/turbine/extension.hpp"

namespace samara::turbine {
namespace {

/// Tolerance relative to the larger of the terms that should cancel (lengths and inertias of the
/// hub's masses). Places given with ten digits leave such errors (three masses 120 degrees apart).
/// They change frequencies by no more than this relative amount, which no analysis resolves.
constexpr double symmetry_round_off = 1e-9;

/// Asymmetry of the hub. Its axis must be a principal axis through its centre. With more than two
/// blades all axes normal to it must be equivalent.
std::string hub_fault(const model::Turbine& turbine, bool round) {
  const elements::RigidBody& hub = turbine.chain.hub;
  const Matrix3& I = hub.inertia;
  const double largest = I.cwiseAbs().maxCoeff();
  const double inertia = symmetry_round_off * largest;
  const double length = hub.mass > 0.0 ? hub.center.norm() + std::sqrt(largest / hub.mass) : 0.0;
  if (std::hypot(hub.center(0), hub.center(2)) > symmetry_round_off * length)
    return "the hub's centre of mass is off the shaft";
  if (std::hypot(I(0, 1), I(1, 2)) > inertia)
    return "the shaft is not a principal axis of the hub's inertia";
  if (round && (std::abs(I(0, 0) - I(2, 2)) > inertia || std::abs(I(0, 2)) > inertia))
    return "hub.inertia differs about h1 and h3";
  return "";
}

/// Asymmetry of the prescribed motions. The yaw must repeat from blade to blade; half a revolution
/// must reverse the teeter angle of two blades.
std::string motion_fault(const model::Turbine& turbine) {
  const int blades = static_cast<int>(turbine.blades.size());
  const model::PrescribedMotion& yaw = turbine.yaw_motion;
  const model::PrescribedMotion& teeter = turbine.teeter_motion;
  if (!yaw.is_constant() && (yaw.per_rev == 0 || yaw.per_rev % blades != 0))
    return "the yaw does not repeat from blade to blade";
  const bool reverses = teeter.angle == 0.0 && (teeter.is_constant() || teeter.per_rev % 2 == 1);
  if (!reverses || (blades > 2 && !teeter.is_constant()))
    return "the teeter angle does not repeat from blade to blade";
  for (const model::BladeRoot& root : turbine.roots)
    for (const model::RootLink& link : root.links)
      if (!link.motion.is_constant() && link.motion.per_rev == 0)
        return "a hinge's angle does not repeat with the rotor";
  return "";
}

/// Asymmetry of the prescribed loads.
std::string load_fault(const model::Turbine& turbine) {
  const int blades = static_cast<int>(turbine.blades.size());
  const auto repeats = [&](const model::BeamLoad& load) {
    return load.variation.is_constant() ||
           (load.variation.table.empty() && load.variation.per_rev > 0 &&
            load.variation.per_rev % blades == 0);
  };
  const auto alike = [](const model::BeamLoad& a, const model::BeamLoad& b) {
    return a.source == b.source;
  };
  if (turbine.blades.empty()) return "there are no blades";
  const std::vector<model::BeamLoad>& first = turbine.blades.front().loads;
  for (const model::Beam& blade : turbine.blades)
    if (!std::equal(first.begin(), first.end(), blade.loads.begin(), blade.loads.end(), alike))
      return "the loads on the blades differ";
  for (const std::vector<model::BeamLoad>* loads : {&first, &turbine.tower.loads})
    if (!std::all_of(loads->begin(), loads->end(), repeats))
      return "a load does not repeat from blade to blade";
  return "";
}

}  // namespace

std::string find_symmetry_fault(const model::Turbine& turbine) {
  const elements::RigidChain& chain = turbine.chain;
  const auto blades = turbine.blades.size();
  if (!turbine.identical_blades) return "the blades differ";
  if (blades > 2 && chain.teeter.free) return "the hub teeters";
  for (const auto& extension : turbine.extensions)
    if (!extension->keeps_rotor_symmetry())
      return "a component of the program differs from blade to blade";
  for (const std::string& fault :
       {hub_fault(turbine, blades > 2), motion_fault(turbine), load_fault(turbine)})
    if (!fault.empty()) return fault;
  return "";
}

}  // namespace samara::turbine
