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

bool is_in_range(const DiskFlow<double>& flow, double least) {
  if (std::abs(flow.mean) <= least) return true;
  const double wind = flow.through + flow.mean;  // along the axis
  const bool is_reversed =
      flow.through * wind < 0.0 && flow.mean * wind > 0.0 && flow.across < flow.mean * flow.mean;
  return flow.share >= least_carrying_share && !is_reversed;
}

SteadyWake find_steady_wake(const Vector3& wind, double load, double least) {
  constexpr int parts = 1000;
  constexpr int halvings = 50;
  const auto excess = [&](double t, bool& is_valid) {
    const DiskFlow<double> flow = disk_flow<double>(wind, t, least);
    is_valid = is_in_range(flow, least);
    return flow.speed * std::abs(t) - std::abs(load);
  };
  // In hover V_T = w_m; a wind along the axis delays the balance by its speed at most.
  const double end = std::sqrt(std::abs(load)) + std::abs(wind(2)) + least;
  const double step = std::copysign(end / parts, load);
  SteadyWake wake;
  bool is_valid = true;
  for (int i = 1; i <= parts; ++i) {
    const double t = i * step;
    const double value = excess(t, is_valid);
    if (!is_valid) return {wake.t, false};
    if (value >= 0.0) {
      double low = wake.t;
      double high = t;
      for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        (excess(middle, is_valid) < 0.0 ? low : high) = middle;
      }
      return {high, true};
    }
    wake.t = t;
  }
  return {wake.t, false};
}

}  // namespace samara::elements
