#include "samara/model/masses.hpp"

#include <algorithm>

#include "samara/math/quadrature.hpp"
#include "samara/math/rotation.hpp"
#include "samara/model/reference_line.hpp"

namespace samara::model {
namespace {

/// Exact for the second moment of a linear mass distribution; accurate for sections that twist.
constexpr int quadrature_points = 6;

Matrix3 moment_matrix(const Vector3& a, const Vector3& b) {
  return a.dot(b) * Matrix3::Identity() - 0.5 * (a * b.transpose() + b * a.transpose());
}

MassProperties point_mass(double mass, const Vector3& x) {
  return {mass, mass * x, mass * moment_matrix(x, x)};
}

MassProperties body_mass(const elements::RigidBody& body) {
  MassProperties properties = point_mass(body.mass, body.center);
  properties.inertia += body.inertia;
  return properties;
}

/// Mass of a piece of a beam: section mass matrix I6 of (3) in axes b, over `length` at x.
MassProperties section_mass(const Matrix6& mass, double length, const Matrix3& C_ab,
                            const Vector3& x) {
  MassProperties properties;
  properties.mass = length * mass(0, 0);
  properties.moment = length * Vector3(mass(5, 1), mass(3, 2), mass(4, 0));  // H = m c x V
  properties.inertia = length * mass.bottomRightCorner<3, 3>();
  return properties.placed(C_ab, x);
}

MassProperties beam_mass(const BeamDefinition& beam, double mass_factor) {
  std::vector<double> ends{0.0, 1.0};
  for (const SectionDefinition& section : beam.sections) ends.push_back(section.at);
  std::sort(ends.begin(), ends.end());
  const math::QuadratureRule rule = math::gauss_rule(quadrature_points);
  const ReferenceLine line("beam", beam);
  MassProperties sum = point_mass(beam.tip_mass, line.at(1.0).x);
  const SupportDefinition& support = beam.support;
  if (!support.is_clamp())
    sum += section_mass(rigid_mass(support.mass, support.center, support.inertia.asDiagonal()), 1.0,
                        Matrix3::Identity(), Vector3::Zero());
  for (const PointMassDefinition& lump : beam.point_masses) {
    const ReferenceLine::Station station =
        line.at(lump.at, interpolate_section(beam, lump.at).twist);
    sum += section_mass(rigid_mass(lump.mass, lump.center, lump.inertia.asDiagonal()), 1.0,
                        station.C_ab, station.x);
  }
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double span = ends[i + 1] - ends[i];
    if (span <= 0.0) continue;
    for (std::size_t q = 0; q < rule.points.size(); ++q) {
      const double fraction = ends[i] + span * rule.points[q];
      const SectionDefinition section = interpolate_section(beam, fraction);
      const ReferenceLine::Station station = line.at(fraction, section.twist);
      sum += section_mass(section.mass, mass_factor * beam.length * span * rule.weights[q],
                          station.C_ab, station.x);
    }
  }
  return sum;
}

MassProperties beam_mass(const Beam& beam) {
  MassProperties sum = section_mass(beam.tip_mass, 1.0, Matrix3::Identity(), beam.tip);
  for (const MassNode& node : beam.mass_nodes)
    sum += section_mass(node.mass, 1.0, Matrix3::Identity(), node.x);
  for (int p = 0; p < beam.point_count(); ++p) {
    const elements::BeamPoint& point = beam.points[static_cast<std::size_t>(p)];
    sum += section_mass(point.mass, beam.point_length(p), point.C_ab, point.x);
  }
  return sum;
}

/// Converts the tower's axes b1 = n3, b2 = n1, b3 = n2 to n1 n2 n3.
Matrix3 tower_axes() {
  Matrix3 C;
  C << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return C;
}

MassProperties whole_mass(const Turbine& turbine, const Masses& masses) {
  const elements::RigidChain& chain = turbine.chain;
  const Vector3 top = tower_axes() * turbine.tower.tip;
  const Matrix3 C_YS = math::turn_about<double>(Vector3::UnitX(), chain.tilt) *
                       math::turn_about<double>(Vector3::UnitY(), turbine.azimuth);
  const Vector3 bearing(0.0, 0.0, chain.height);
  const Vector3 pin = bearing + C_YS * Vector3(0.0, chain.overhang, 0.0);
  MassProperties sum = masses.tower;
  sum += masses.nacelle.placed(Matrix3::Identity(), top);
  sum += masses.shaft.placed(C_YS, top + bearing);
  sum += masses.rotor.placed(C_YS, top + pin);
  return sum;
}

/// The mass dampers of a carrier at rest, in the axes of its node; about the tower's foot, the
/// blade's root or the tower top.
MassProperties damper_masses(const Turbine& turbine, MassDamperDefinition::Carrier carrier,
                             int blade) {
  MassProperties sum;
  for (const MassDamper& damper : turbine.mass_dampers) {
    if (damper.definition.carrier != carrier || damper.blade != blade) continue;
    Vector3 node = Vector3::Zero();
    if (!damper.is_on_nacelle()) {
      const Beam& beam =
          blade < 0 ? turbine.tower : turbine.blades[static_cast<std::size_t>(blade)];
      node = damper.node < 0 ? beam.tip : beam.mass_nodes[static_cast<std::size_t>(damper.node)].x;
    }
    sum += point_mass(damper.definition.mass, node + damper.place);
  }
  return sum;
}

}  // namespace

MassProperties MassProperties::placed(const Matrix3& C, const Vector3& r) const {
  MassProperties result;
  const Vector3 turned = C * moment;
  result.mass = mass;
  result.moment = turned + mass * r;
  result.inertia =
      C * inertia * C.transpose() + 2.0 * moment_matrix(r, turned) + mass * moment_matrix(r, r);
  return result;
}

MassProperties& MassProperties::operator+=(const MassProperties& other) {
  mass += other.mass;
  moment += other.moment;
  inertia += other.inertia;
  return *this;
}

Masses compute_masses(const TurbineDefinition& definition, const Turbine& turbine) {
  const elements::RigidChain& chain = turbine.chain;
  const Vector3 apex(0.0, chain.undersling, 0.0);
  Masses masses;
  using Carrier = MassDamperDefinition::Carrier;
  if (turbine.has_tower) {
    masses.tower = beam_mass(definition.tower, 1.0);
    masses.tower += damper_masses(turbine, Carrier::tower, -1);
    masses.tower = masses.tower.placed(tower_axes(), Vector3::Zero());
  }
  masses.nacelle = body_mass(chain.nacelle);
  masses.nacelle += damper_masses(turbine, Carrier::nacelle, -1);
  masses.shaft = body_mass(chain.shaft);
  masses.hub = body_mass(chain.hub);
  masses.rotor = masses.hub;
  masses.meshed_rotor = masses.hub;
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
    const auto found = definition.blades.each.find(static_cast<int>(k) + 1);
    const double factor = found == definition.blades.each.end() ? 1.0 : found->second.mass_factor;
    const BladeRoot& root = turbine.roots[k];
    const MassProperties on_blade = damper_masses(turbine, Carrier::blade, static_cast<int>(k));
    masses.blades.push_back(beam_mass(definition.blades.beam, factor));
    masses.blades.back() += on_blade;
    masses.rotor += masses.blades.back().placed(root.C_Ha, root.position + apex);
    MassProperties meshed = beam_mass(turbine.blades[k]);
    meshed += on_blade;
    masses.meshed_rotor += meshed.placed(root.C_Ha, root.position + apex);
  }
  masses.whole = whole_mass(turbine, masses);
  return masses;
}

}  // namespace samara::model
