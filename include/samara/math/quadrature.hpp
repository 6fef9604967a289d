// Gauss-Legendre rules and Lagrange polynomials on [0, 1].
#pragma once

#include <vector>

namespace samara::math {

struct QuadratureRule {
  std::vector<double> points;   ///< in (0, 1), ascending
  std::vector<double> weights;  ///< sum 1
};

/// The Gauss-Legendre rule with n >= 1 points, exact for polynomials of degree 2n - 1.
QuadratureRule gauss_rule(int n);

/// The n + 1 Chebyshev-Lobatto points of [0, 1] in ascending order: both ends are among them.
std::vector<double> lobatto_nodes(int n);

/// Value of the Lagrange polynomial that is one at nodes[a] and zero at the others.
double lagrange(const std::vector<double>& nodes, int a, double x);

/// Its derivative.
double lagrange_derivative(const std::vector<double>& nodes, int a, double x);

}  // namespace samara::math
