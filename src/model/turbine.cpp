#include "samara/model/turbine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "samara/base/error.hpp"
#include "samara/math/rotation.hpp"
#include "samara/model/air.hpp"
#include "samara/model/reference_line.hpp"

namespace samara::model {
namespace {

elements::Hinge hinge_of(const JointDefinition& joint) {
  elements::Hinge hinge;
  hinge.free = joint.kind == JointKind::free;
  hinge.stiffness = joint.stiffness;
  hinge.damping = joint.damping;
  return hinge;
}

/// The hub and the masses on it as one body.
elements::RigidBody hub_of(const HubDefinition& hub) {
  elements::RigidBody body;
  body.mass = hub.mass;
  body.center = Vector3(0.0, hub.center_of_mass, 0.0);
  body.inertia = hub.inertia.asDiagonal();
  for (const HubMassDefinition& lump : hub.point_masses) {
    // About the common centre: the reduced mass at the distance between the two centres.
    const double mass = body.mass + lump.mass;
    const Matrix3 across = math::skew<double>(Vector3(lump.center - body.center));
    body.inertia += Matrix3(lump.inertia.asDiagonal());
    body.inertia -= body.mass * lump.mass / mass * across * across;
    body.center += lump.mass / mass * (lump.center - body.center);
    body.mass = mass;
  }
  return body;
}

elements::RigidChain chain_of(const TurbineDefinition& definition) {
  elements::RigidChain chain;
  const NacelleDefinition& nacelle = definition.nacelle;
  const ShaftDefinition& shaft = definition.shaft;
  const HubDefinition& hub = definition.hub;
  chain.gravity = definition.gravity;
  if (definition.has_nacelle) {
    chain.yaw = hinge_of(nacelle.yaw);
    chain.nacelle.mass = nacelle.mass;
    chain.nacelle.center = nacelle.center_of_mass;
    chain.nacelle.inertia = nacelle.inertia.asDiagonal();
  }
  chain.shaft.mass = shaft.mass;
  chain.shaft.center = Vector3(0.0, shaft.center_of_mass, 0.0);
  chain.shaft.inertia =
      Vector3(shaft.inertia_transverse, shaft.inertia_axial, shaft.inertia_transverse).asDiagonal();
  chain.hub = hub_of(hub);
  chain.teeter = hinge_of(hub.teeter);
  chain.teeter.stop_angle = hub.teeter_stops.angle;
  chain.teeter.stop_stiffness = hub.teeter_stops.stiffness;
  chain.teeter.stop_damping = hub.teeter_stops.damping;
  chain.torsion = hinge_of(shaft.torsion);
  if (shaft.generator.kind == JointKind::free) {
    chain.generator.free = true;
    chain.generator_torque = shaft.generator.law.line_at(shaft.generator_speed());
  }
  chain.rotor_torque = shaft.rotor.line_at(shaft.speed);
  chain.generator_inertia = shaft.generator.inertia;
  chain.gear_ratio = shaft.gear_ratio;
  chain.height = shaft.height;
  chain.tilt = shaft.tilt;
  chain.overhang = shaft.overhang;
  chain.undersling = hub.undersling;
  chain.teeter_axis = Vector3(std::cos(hub.delta3), 0.0, std::sin(hub.delta3));
  return chain;
}

/// Body on the end of the tower, in t1 t2 t3. The tower's axes are a = (t3, t1, t2).
elements::RigidBody tower_top_of(const Matrix6& mass) {
  Matrix3 C_Ta;
  C_Ta << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  elements::RigidBody body;
  body.mass = mass(0, 0);
  if (body.mass == 0.0) return body;
  const Vector3 center = Vector3(mass(5, 1), mass(3, 2), mass(4, 0)) / body.mass;
  const Matrix3 across = math::skew<double>(center);
  const Matrix3 inertia = mass.bottomRightCorner<3, 3>() + body.mass * across * across;
  body.center = C_Ta * center;
  body.inertia = C_Ta * inertia * C_Ta.transpose();
  return body;
}

BladeDifference difference_of(const BladesDefinition& blades, int k) {
  const auto found = blades.each.find(k + 1);
  return found == blades.each.end() ? BladeDifference{} : found->second;
}

/// Blade axes at zero cone and pitch: b1 from root to tip, b3 = s2, b2 = b3 x b1. Azimuth turns
/// about h2; cone moves b1 toward h2; pitch turns b2 (the leading edge) upwind, about -b1.
BladeRoot root_of(const BladesDefinition& blades, double radius, int k) {
  const double azimuth = 2.0 * std::numbers::pi * k / blades.count;
  const BladeDifference own = difference_of(blades, k);
  BladeRoot root;
  root.pitch = blades.pitch + own.pitch;
  Matrix3 upright;  // columns b1 b2 b3 = h3 h1 h2
  upright << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const Matrix3 turned = math::turn_about<double>(Vector3::UnitY(), azimuth) * upright;
  const Matrix3 cone = math::turn_about<double>(-Vector3::UnitY(), blades.precone);
  const Matrix3 feather = math::turn_about<double>(-Vector3::UnitX(), root.pitch);
  double along = 0.0;
  bool is_pitched = false;
  // The first link has the cone's axes included in its own axes, and its arm in H.
  const auto add_link = [&](double offset, RootLink link) {
    const Matrix3 before = root.links.empty() ? Matrix3(turned * cone) : Matrix3::Identity();
    link.arm = offset * before.col(0);
    link.axes = before * link.axes;
    root.links.push_back(link);
    along += offset;
  };
  for (const HingeDefinition& hinge : blades.hinges) {
    RootLink link;
    if (hinge.axis == HingeAxis::flap)
      link.axis = Vector3(std::sin(hinge.delta3), -std::cos(hinge.delta3), 0.0);
    if (hinge.axis == HingeAxis::lag) link.axis = -Vector3::UnitZ();
    if (hinge.axis == HingeAxis::pitch) {
      link.axes = feather;
      link.is_pitch = is_pitched = true;
    }
    if (hinge.joint.kind == JointKind::prescribed) {
      link.motion = hinge.joint.motion;
      link.motion.phase += link.motion.per_rev * azimuth;  // as the first blade at this azimuth
    }
    if (hinge.joint.kind == JointKind::free) {
      link.hinge = static_cast<int>(root.hinges.size());
      if (hinge.axis == HingeAxis::flap) root.flap_hinge = link.hinge;
      RootHinge free{hinge.axis, hinge.joint.stiffness, hinge.joint.damping};
      if (const auto other = own.hinges.find(hinge.axis); other != own.hinges.end()) {
        free.stiffness = other->second.stiffness.value_or(free.stiffness);
        free.damping = other->second.damping.value_or(free.damping);
      }
      root.hinges.push_back(free);
    }
    add_link(hinge.offset, link);
  }
  RootLink last;
  if (!is_pitched) last.axes = feather;
  last.is_pitch = !is_pitched;
  add_link(radius - along, last);
  if (root.flap_hinge >= 0) root.pitch_by_flap = -std::tan(blades.pitch_link);
  for (const RootLink& link : root.links) {
    root.position += root.C_Ha * link.arm;
    root.C_Ha *= link.axes * math::turn_about<double>(link.axis, link.motion.angle);
  }
  return root;
}

/// Number of degrees of freedom: elastic strains plus the motions of the ends; each held direction
/// of an end removes one.
int elastic_strains(const Beam& beam) {
  int count = 0;
  for (const elements::BeamPoint& point : beam.points)
    for (int i = 0; i < 6; ++i)
      if (point.compliance(i, i) > 0.0) ++count;
  for (int i = 0; i < 6; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (beam.support.is_elastic(i) || beam.support.free[at]) ++count;
    if (beam.end_support.rigid[at]) --count;
  }
  return count;
}

void add_loads(const TurbineDefinition& definition, Turbine& turbine) {
  for (std::size_t i = 0; i < definition.loads.size(); ++i) {
    const LoadDefinition& load = definition.loads[i];
    const auto put = [&](const BeamDefinition& beam_definition, Beam& beam) {
      beam.loads.push_back(build_load(load, beam_definition, beam));
      beam.loads.back().source = static_cast<int>(i);
    };
    if (load.on_tower && !turbine.has_tower)
      throw InputError("loads[" + std::to_string(i) + "]: there is no tower");
    if (load.on_tower) put(definition.tower, turbine.tower);
    for (std::size_t k = 0; !load.on_tower && k < turbine.blades.size(); ++k)
      if (load.blade == 0 || load.blade == static_cast<int>(k) + 1)
        put(definition.blades.beam, turbine.blades[k]);
  }
}

/// Adds a node for each damper at an end of an element, as for a point mass.
void add_damper_nodes(const std::vector<MassDamperDefinition>& dampers, BeamDefinition& tower,
                      BeamDefinition& blade) {
  for (const MassDamperDefinition& damper : dampers) {
    if (damper.carrier == MassDamperDefinition::Carrier::nacelle) continue;
    std::vector<PointMassDefinition>& masses =
        damper.carrier == MassDamperDefinition::Carrier::tower ? tower.point_masses
                                                               : blade.point_masses;
    const auto next = std::ranges::lower_bound(masses, damper.at, {}, &PointMassDefinition::at);
    if (next != masses.end() && next->at == damper.at) continue;
    PointMassDefinition node;
    node.at = damper.at;
    masses.insert(next, node);
  }
}

void place_mass_dampers(const TurbineDefinition& definition, Turbine& turbine) {
  using Carrier = MassDamperDefinition::Carrier;
  const auto place = [&](const MassDamperDefinition& damper, const BeamDefinition* carrier,
                         const Beam& beam, int blade) {
    MassDamper placed;
    placed.definition = damper;
    placed.blade = blade;
    for (const MassDamper& other : turbine.mass_dampers)
      if (other.definition.carrier == damper.carrier && other.blade == blade) ++placed.number;
    if (carrier != nullptr) {
      const ReferenceLine line(beam.name, *carrier);
      placed.axes = line.at(damper.at, interpolate_section(*carrier, damper.at).twist).C_ab;
      const auto end = std::ranges::find(beam.ends, damper.at) - beam.ends.begin();
      for (std::size_t m = 0; m < beam.mass_nodes.size(); ++m)
        if (damper.at < 1.0 && beam.mass_nodes[m].end == end) placed.node = static_cast<int>(m);
    }
    placed.place = placed.axes * damper.position;
    turbine.mass_dampers.push_back(placed);
  };
  for (const MassDamperDefinition& damper : definition.mass_dampers) {
    if (damper.carrier == Carrier::nacelle) place(damper, nullptr, turbine.tower, -1);
    if (damper.carrier == Carrier::tower) place(damper, &definition.tower, turbine.tower, -1);
    if (damper.carrier != Carrier::blade) continue;
    if (damper.blade != 0) turbine.identical_blades = false;
    for (std::size_t k = 0; k < turbine.blades.size(); ++k)
      if (damper.blade == 0 || damper.blade == static_cast<int>(k) + 1)
        place(damper, &definition.blades.beam, turbine.blades[k], static_cast<int>(k));
  }
}

}  // namespace

Turbine build_turbine(const TurbineDefinition& given) {
  TurbineDefinition definition = given;
  require_none(complete(definition), "");
  Turbine turbine;
  turbine.has_tower = definition.has_tower;
  BeamDefinition tower = definition.tower;
  BladesDefinition blades = definition.blades;
  add_damper_nodes(definition.mass_dampers, tower, blades.beam);
  if (definition.has_tower) turbine.tower = build_beam("tower", tower);
  for (int k = 0; k < blades.count; ++k) {
    const BladeDifference d = difference_of(blades, k);
    if (d != difference_of(blades, 0)) turbine.identical_blades = false;
    turbine.blades.push_back(build_beam("blade " + std::to_string(k + 1), blades.beam,
                                        d.mass_factor, d.stiffness_factor));
    turbine.roots.push_back(root_of(blades, definition.hub.radius, k));
  }
  turbine.extensions = definition.extensions;
  turbine.pitch = blades.pitch;
  turbine.pitch_actuator = blades.actuator;
  if (definition.shaft.speed != 0.0) {
    turbine.controller = definition.controller;
    turbine.rotor_pitch_slope = definition.shaft.rotor_pitch_slope;
  }
  add_loads(definition, turbine);
  place_mass_dampers(definition, turbine);
  turbine.chain = chain_of(definition);
  if (definition.has_tower) turbine.chain.tower_top = tower_top_of(turbine.tower.tip_mass);
  const auto motion_of = [](const JointDefinition& joint) {
    return joint.kind == JointKind::prescribed ? joint.motion : PrescribedMotion{};
  };
  if (definition.has_nacelle) turbine.yaw_motion = motion_of(definition.nacelle.yaw);
  turbine.teeter_motion = motion_of(definition.hub.teeter);
  turbine.speed = definition.shaft.speed;
  turbine.azimuth = definition.shaft.azimuth;
  turbine.degrees_of_freedom = definition.has_tower ? elastic_strains(turbine.tower) : 0;
  for (const Beam& blade : turbine.blades) turbine.degrees_of_freedom += elastic_strains(blade);
  const elements::RigidChain& chain = turbine.chain;
  for (const elements::Hinge* hinge : {&chain.yaw, &chain.teeter, &chain.torsion, &chain.generator})
    if (hinge->free) ++turbine.degrees_of_freedom;
  for (const BladeRoot& root : turbine.roots)
    turbine.degrees_of_freedom += static_cast<int>(root.hinges.size());
  if (definition.aero && definition.wind) turbine.air = build_air(definition, turbine);
  for (const MassDamper& damper : turbine.mass_dampers)
    turbine.degrees_of_freedom += static_cast<int>(damper.definition.axes.size());
  return turbine;
}

}  // namespace samara::model
