#include "samara/math/quadrature.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace samara::math {

QuadratureRule gauss_rule(int n) {
  QuadratureRule rule;
  const auto count = static_cast<std::size_t>(n);
  rule.points.resize(count);
  rule.weights.resize(count);
  for (int i = 0; i < n; ++i) {
    double x = -std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double p = 1.0;
      double previous = 0.0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * previous) / k;
        previous = p;
        p = next;
      }
      slope = n * (x * p - previous) / (x * x - 1.0);
      const double step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    const auto at = static_cast<std::size_t>(i);
    rule.points[at] = 0.5 * (1.0 + x);
    rule.weights[at] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
  return rule;
}

std::vector<double> lobatto_nodes(int n) {
  std::vector<double> nodes(static_cast<std::size_t>(n) + 1);
  for (int i = 0; i <= n; ++i)
    nodes[static_cast<std::size_t>(i)] = 0.5 * (1.0 - std::cos(std::numbers::pi * i / n));
  return nodes;
}

double lagrange(const std::vector<double>& nodes, int a, double x) {
  const auto self = static_cast<std::size_t>(a);
  double value = 1.0;
  for (std::size_t b = 0; b < nodes.size(); ++b)
    if (b != self) value *= (x - nodes[b]) / (nodes[self] - nodes[b]);
  return value;
}

double lagrange_derivative(const std::vector<double>& nodes, int a, double x) {
  const auto self = static_cast<std::size_t>(a);
  double sum = 0.0;
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    if (c == self) continue;
    double product = 1.0 / (nodes[self] - nodes[c]);
    for (std::size_t b = 0; b < nodes.size(); ++b)
      if (b != self && b != c) product *= (x - nodes[b]) / (nodes[self] - nodes[b]);
    sum += product;
  }
  return sum;
}

}  // namespace samara::math
