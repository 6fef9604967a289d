#include "samara/model/load.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "samara/math/quadrature.hpp"
#include "samara/model/beam.hpp"
#include "samara/model/reference_line.hpp"

namespace samara::model {
namespace {

/// Test functions, and the polynomials that interpolate the rotations of the Gauss points.
class Interpolation {
 public:
  explicit Interpolation(int order)
      : rule_(math::gauss_rule(order)), nodes_(math::lobatto_nodes(order)) {}

  /// Adds weight N_a(xi) l_j(xi).
  void add(double xi, double weight, Eigen::MatrixXd& sum) const {
    for (Eigen::Index a = 0; a < sum.rows(); ++a)
      for (Eigen::Index j = 0; j < sum.cols(); ++j)
        sum(a, j) += weight * math::lagrange(nodes_, static_cast<int>(a), xi) *
                     math::lagrange(rule_.points, static_cast<int>(j), xi);
  }

  /// The quadrature rule of the points integrates N_a l_j, of degree 2 s - 1, exactly.
  const math::QuadratureRule& rule() const { return rule_; }

 private:
  math::QuadratureRule rule_;
  std::vector<double> nodes_;
};

}  // namespace

double LoadVariation::factor(double t, double rotor_speed) const {
  if (table.empty()) {
    if (amplitude == 0.0) return mean;
    const double rate = per_rev > 0 ? per_rev * rotor_speed : frequency;
    return mean + amplitude * std::cos(rate * t + phase);
  }
  const auto next =
      std::find_if(table.begin(), table.end(), [t](const auto& entry) { return entry.first > t; });
  if (next == table.begin()) return table.front().second;
  if (next == table.end()) return table.back().second;
  const auto& [t0, f0] = *(next - 1);
  const auto& [t1, f1] = *next;
  return f0 + (f1 - f0) * (t - t0) / (t1 - t0);
}

BeamLoad build_load(const LoadDefinition& load, const BeamDefinition& definition,
                    const Beam& beam) {
  BeamLoad result;
  result.load << load.force, load.moment;
  result.follower = load.follower;
  result.variation = load.variation;
  result.at_tip = load.from == load.to && load.to == 1.0;
  if (result.at_tip) {
    const double twist = interpolate_section(definition, 1.0).twist;
    result.tip_axes = ReferenceLine(beam.name, definition).at(1.0, twist).C_ab;
    return result;
  }
  const Interpolation interpolation(beam.order);
  for (int e = 0; e < beam.elements; ++e) {
    const double start = beam.ends[static_cast<std::size_t>(e)];
    const double end = beam.ends[static_cast<std::size_t>(e) + 1];
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(beam.order + 1, beam.order);
    if (load.from == load.to) {
      if (!(load.from >= start && load.from < end)) continue;
      interpolation.add((load.from - start) / (end - start), 1.0, weights);
    } else {
      const double low = std::max(load.from, start);
      const double span = std::min(load.to, end) - low;
      if (span <= 0.0) continue;
      const math::QuadratureRule& rule = interpolation.rule();
      for (std::size_t q = 0; q < rule.points.size(); ++q)
        interpolation.add((low + span * rule.points[q] - start) / (end - start),
                          beam.length * span * rule.weights[q], weights);
    }
    if (result.weights.empty()) result.first_element = e;
    result.weights.push_back(weights);
  }
  return result;
}

}  // namespace samara::model
