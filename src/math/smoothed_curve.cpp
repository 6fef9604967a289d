#include "samara/math/smoothed_curve.hpp"

#include <cmath>
#include <stdexcept>

namespace samara::math {
namespace {

/// Values and slopes at the knots of the spline with these coefficients.
struct Nodes {
  std::vector<double> values;
  std::vector<double> slopes;
};

/// The knots with two more before and behind, at the distances of their neighbours.
std::vector<double> extended(const std::vector<double>& knots) {
  const std::size_t n = knots.size();
  const double before = knots[1] - knots[0];
  const double behind = knots[n - 1] - knots[n - 2];
  std::vector<double> x{knots[0] - 2.0 * before, knots[0] - before};
  x.insert(x.end(), knots.begin(), knots.end());
  x.insert(x.end(), {knots[n - 1] + behind, knots[n - 1] + 2.0 * behind});
  return x;
}

/// The broken line at the means of three knots, where a B-spline has its centre. The first two and
/// the last two coefficients are equal, like those beyond the ends.
std::vector<double> find_coefficients(const std::vector<double>& knots,
                                      const std::vector<double>& values) {
  const std::size_t n = knots.size();
  std::vector<double> c(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double shift = (knots[i - 1] + knots[i + 1] - 2.0 * knots[i]) / 3.0;
    const std::size_t j = shift < 0.0 ? i - 1 : i + 1;
    c[i] = values[i] + shift * (values[j] - values[i]) / (knots[j] - knots[i]);
  }
  c[0] = c[1] = values[0];
  c[n - 2] = c[n - 1] = values[n - 1];
  return c;
}

/// By the recursion of de Boor.
Nodes find_nodes(const std::vector<double>& knots, const std::vector<double>& values) {
  const std::vector<double> c = find_coefficients(knots, values);
  const std::vector<double> x = extended(knots);
  Nodes nodes;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double* k = &x[i + 2];  // k[0]: the knot
    const double before = i == 0 ? c[0] : c[i - 1];
    const double behind = i + 1 == c.size() ? c[i] : c[i + 1];
    const double left = (k[1] - k[0]) / (k[1] - k[-1]);
    const double right = (k[0] - k[-1]) / (k[1] - k[-1]);
    const double to_before = left * (k[1] - k[0]) / (k[1] - k[-2]);
    const double to_behind = right * (k[0] - k[-1]) / (k[2] - k[-1]);
    nodes.values.push_back(c[i] + to_before * (before - c[i]) + to_behind * (behind - c[i]));
    nodes.slopes.push_back(left * 3.0 * (c[i] - before) / (k[1] - k[-2]) +
                           right * 3.0 * (behind - c[i]) / (k[2] - k[-1]));
  }
  return nodes;
}

}  // namespace

SmoothedCurve::SmoothedCurve(const std::vector<double>& knots, const std::vector<double>& values) {
  check_knots(knots, values);
  if (knots.size() < 4) throw std::invalid_argument("a smoothed curve needs at least four knots");
  const Nodes nodes = find_nodes(knots, values);
  curve_ = PiecewiseCubic(knots, nodes.values, nodes.slopes);
}

ValueAndSlope SmoothedCurve::at(double x) const {
  if (std::isnan(x)) return {x, x};
  if (curve_.is_empty()) return {};
  if (x < curve_.first()) return {curve_.at(curve_.first()).value, 0.0};
  if (x > curve_.last()) return {curve_.at(curve_.last()).value, 0.0};
  return curve_.at(x);
}

}  // namespace samara::math
