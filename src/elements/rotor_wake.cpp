#include "samara/elements/rotor_wake.hpp"

namespace samara::elements {
namespace {

/// n (n - 2) (n - 4) ..., 1 for n <= 0.
double double_factorial(int n) {
  double product = 1.0;
  for (; n > 1; n -= 2) product *= n;
  return product;
}

double norm_of(int m, int n) {
  return double_factorial(n + m - 1) * double_factorial(n - m - 1) /
         (double_factorial(n + m) * double_factorial(n - m));
}

}  // namespace

std::vector<WakeShape> make_wake_shapes(const std::vector<int>& counts) {
  std::vector<WakeShape> shapes;
  for (int m = 0; m < static_cast<int>(counts.size()); ++m)
    for (int k = 0; k < counts[static_cast<std::size_t>(m)]; ++k) {
      const int n = m + 1 + 2 * k;
      WakeShape shape{m, n, norm_of(m, n), {}};
      const double factor = std::sqrt((2.0 * n + 1.0) * shape.norm);
      for (int q = m; q <= n - 1; q += 2) {
        const double sign = (q - m) / 2 % 2 == 0 ? 1.0 : -1.0;
        shape.coefficients.push_back(
            factor * sign * double_factorial(n + q) /
            (double_factorial(q - m) * double_factorial(q + m) * double_factorial(n - q - 1)));
      }
      shapes.push_back(shape);
    }
  return shapes;
}

double wake_coupling(const WakeShape& row, const WakeShape& column) {
  const int r = row.harmonic;
  const int m = column.harmonic;
  const int j = row.order;
  const int n = column.order;
  const double norms = std::sqrt(column.norm * row.norm);
  const double roots = std::sqrt((2.0 * n + 1.0) * (2.0 * j + 1.0));
  if ((r + m) % 2 == 0) {
    const double sign = std::abs((n + j - 2 * r) / 2) % 2 == 0 ? 1.0 : -1.0;
    const double difference = j - n;
    return sign / norms * 2.0 * roots / ((j + n) * (j + n + 2.0) * (difference * difference - 1.0));
  }
  if (std::abs(j - n) != 1) return 0.0;
  return 0.5 * std::numbers::pi * (r > m ? 1.0 : -1.0) / (norms * roots);
}

}  // namespace samara::elements
