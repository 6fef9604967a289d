#include "samara/model/beam.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "samara/base/error.hpp"
#include "samara/math/quadrature.hpp"
#include "samara/math/rotation.hpp"

namespace samara::model {
namespace {

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

}  // namespace

Matrix6 compliance_of(const SectionDefinition& section) {
  std::vector<int> elastic;
  for (int i = 0; i < 6; ++i)
    if (!section.rigid[static_cast<std::size_t>(i)]) elastic.push_back(i);
  const auto n = static_cast<Eigen::Index>(elastic.size());
  Eigen::MatrixXd S(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      S(i, j) = section.stiffness(elastic[static_cast<std::size_t>(i)],
                                  elastic[static_cast<std::size_t>(j)]);
  const Eigen::MatrixXd inverse = S.llt().solve(Eigen::MatrixXd::Identity(n, n));
  Matrix6 compliance = Matrix6::Zero();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      compliance(elastic[static_cast<std::size_t>(i)], elastic[static_cast<std::size_t>(j)]) =
          0.5 * (inverse(i, j) + inverse(j, i));
  return compliance;
}

Beam build_beam(const std::string& name, const BeamDefinition& definition, double mass_factor,
                double stiffness_factor) {
  if (!definition.reference_line.empty())
    throw InputError(name +
                     ": a reference_line is not available yet; hint: give length (straight)");
  const math::QuadratureRule rule = math::gauss_rule(definition.order);
  Beam beam;
  beam.name = name;
  beam.elements = definition.elements;
  beam.order = definition.order;
  beam.element_length = definition.length / definition.elements;
  beam.functions = test_functions(rule);
  beam.tip = Vector3(definition.length, 0.0, 0.0);
  beam.tip_mass = definition.tip_mass;
  for (int e = 0; e < definition.elements; ++e) {
    for (const double xi : rule.points) {
      const double fraction = (e + xi) / definition.elements;
      const SectionDefinition section = interpolate_section(definition, fraction);
      elements::BeamPoint point;
      point.x = Vector3(fraction * definition.length, 0.0, 0.0);
      point.C_ab = math::turn_about<double>(-Vector3::UnitX(), section.twist);
      point.compliance = compliance_of(section) / stiffness_factor;
      point.mass = section.mass * mass_factor;
      for (int i = 0; i < 6; ++i)
        point.damping(i) = section.rigid[static_cast<std::size_t>(i)] ? 0.0 : definition.damping(i);
      beam.points.push_back(point);
      beam.fractions.push_back(fraction);
    }
  }
  return beam;
}

}  // namespace samara::model
