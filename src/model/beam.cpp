#include "samara/model/beam.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "samara/base/error.hpp"
#include "samara/math/quadrature.hpp"
#include "samara/math/rotation.hpp"
#include "samara/model/reference_line.hpp"

namespace samara::model {
namespace {

/// Shortest element that point masses may leave, of an even one.
constexpr double least_element = 0.25;

TestFunctions test_functions(const math::QuadratureRule& rule) {
  const int order = static_cast<int>(rule.points.size());
  const std::vector<double> nodes = math::lobatto_nodes(order);
  TestFunctions functions;
  functions.weights = rule.weights;
  for (int a = 0; a <= order; ++a) {
    std::vector<double> value;
    std::vector<double> slope;
    for (const double xi : rule.points) {
      value.push_back(math::lagrange(nodes, a, xi));
      slope.push_back(math::lagrange_derivative(nodes, a, xi));
    }
    functions.value.push_back(value);
    functions.slope.push_back(slope);
  }
  return functions;
}

/// Evenly spaced, but that a point mass draws the nearest end to its place.
std::vector<double> element_ends(const std::string& name, const BeamDefinition& definition) {
  std::vector<double> ends;
  const int n = definition.elements;
  for (int e = 0; e <= n; ++e) ends.push_back(static_cast<double>(e) / n);
  int last = 0;
  for (const PointMassDefinition& lump : definition.point_masses) {
    if (lump.at == 1.0 || lump.at == ends[static_cast<std::size_t>(last)]) continue;
    const int nearest = std::min(static_cast<int>(std::lround(lump.at * n)), n - 1);
    last = std::max(nearest, last + 1);
    if (last >= n) break;
    ends[static_cast<std::size_t>(last)] = lump.at;
  }
  for (std::size_t e = 1; e < ends.size(); ++e)
    if (last >= n || !(ends[e] - ends[e - 1] >= least_element / n))
      throw InputError(name + ".point_masses: the mesh of " + std::to_string(n) +
                       " elements is too coarse for their places; hint: more elements");
  return ends;
}

/// The inverse on the elastic directions, zero elsewhere.
Matrix6 inverse_of(const Matrix6& stiffness, const std::vector<int>& elastic) {
  const auto n = static_cast<Eigen::Index>(elastic.size());
  Eigen::MatrixXd S(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      S(i, j) =
          stiffness(elastic[static_cast<std::size_t>(i)], elastic[static_cast<std::size_t>(j)]);
  const Eigen::MatrixXd inverse = S.llt().solve(Eigen::MatrixXd::Identity(n, n));
  Matrix6 compliance = Matrix6::Zero();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      compliance(elastic[static_cast<std::size_t>(i)], elastic[static_cast<std::size_t>(j)]) =
          0.5 * (inverse(i, j) + inverse(j, i));
  return compliance;
}

void add_supports(const BeamDefinition& definition, Beam& beam) {
  const SupportDefinition& support = definition.support;
  if (!support.is_clamp()) {
    std::vector<int> elastic;
    for (int i = 0; i < 6; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!support.rigid[at] && !support.free[at]) elastic.push_back(i);
    }
    beam.has_support = true;
    beam.support.compliance = inverse_of(support.stiffness, elastic);
    beam.support.free = support.free;
    beam.support.damping = support.damping;
    beam.mass_nodes.push_back(
        {0, Vector3::Zero(),
         rigid_mass(support.mass, support.center, support.inertia.asDiagonal())});
  }
  beam.end_support.stiffness = definition.end_support.stiffness;
  beam.end_support.rigid = definition.end_support.rigid;
}

}  // namespace

Matrix6 compliance_of(const SectionDefinition& section) {
  std::vector<int> elastic;
  for (int i = 0; i < 6; ++i)
    if (!section.rigid[static_cast<std::size_t>(i)]) elastic.push_back(i);
  return inverse_of(section.stiffness, elastic);
}

Matrix6 rigid_mass(double mass, const Vector3& center, const Matrix3& inertia_about_center) {
  const Matrix3 across = mass * math::skew<double>(center);
  Matrix6 matrix;
  matrix << mass * Matrix3::Identity(), -across, across,
      inertia_about_center - across * math::skew<double>(center);
  return matrix;
}

Beam build_beam(const std::string& name, const BeamDefinition& definition, double mass_factor,
                double stiffness_factor) {
  const math::QuadratureRule rule = math::gauss_rule(definition.order);
  const ReferenceLine line(name, definition);
  Beam beam;
  beam.name = name;
  beam.elements = definition.elements;
  beam.order = definition.order;
  beam.length = definition.length;
  beam.ends = element_ends(name, definition);
  beam.functions = test_functions(rule);
  beam.tip = line.at(1.0).x;
  beam.tip_mass = rigid_mass(definition.tip_mass, Vector3::Zero(), Matrix3::Zero());
  for (int e = 0; e < definition.elements; ++e) {
    const double start = beam.ends[static_cast<std::size_t>(e)];
    const double span = beam.ends[static_cast<std::size_t>(e) + 1] - start;
    for (const double xi : rule.points) {
      const double fraction = start + span * xi;
      const SectionDefinition section = interpolate_section(definition, fraction);
      const ReferenceLine::Station station = line.at(fraction, section.twist);
      elements::BeamPoint point;
      point.x = station.x;
      point.C_ab = station.C_ab;
      point.compliance = compliance_of(section) / stiffness_factor;
      point.mass = section.mass * mass_factor;
      for (int i = 0; i < 6; ++i)
        point.damping(i) = section.rigid[static_cast<std::size_t>(i)] ? 0.0 : definition.damping(i);
      beam.points.push_back(point);
      beam.fractions.push_back(fraction);
    }
  }
  add_supports(definition, beam);
  for (const PointMassDefinition& lump : definition.point_masses) {
    const ReferenceLine::Station station =
        line.at(lump.at, interpolate_section(definition, lump.at).twist);
    const Matrix3 C = station.C_ab;
    const Matrix3 inertia = C * lump.inertia.asDiagonal() * C.transpose();
    const Matrix6 mass = rigid_mass(lump.mass, C * lump.center, inertia);
    if (lump.at == 1.0) {
      beam.tip_mass += mass;
      continue;
    }
    const auto end = std::find(beam.ends.begin(), beam.ends.end(), lump.at) - beam.ends.begin();
    if (!beam.mass_nodes.empty() && beam.mass_nodes.back().end == end)
      beam.mass_nodes.back().mass += mass;
    else
      beam.mass_nodes.push_back({static_cast<int>(end), station.x, mass});
  }
  return beam;
}

}  // namespace samara::model
