#include "samara/math/periodic_spline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace samara::math {
namespace {

constexpr double period = 2.0 * std::numbers::pi;
/// Absolute, for the period, and relative to the largest value, for the values at the ends.
constexpr double round_off = 1e-12;

/// Solution of the symmetric cyclic system with the diagonal `diagonal` and, in row i, `beside[i]`
/// at column i + 1; the last row has it at column 0. By Gauss elimination of the tridiagonal part
/// and the formula of Sherman and Morrison for the corners.
std::vector<double> solve_cyclic(std::vector<double> diagonal, const std::vector<double>& beside,
                                 std::vector<double> right) {
  const std::size_t n = diagonal.size();
  const double corner = beside.back();
  const double gamma = -diagonal.front();
  diagonal.front() -= gamma;
  diagonal.back() -= corner * corner / gamma;
  std::vector<double> corners(n, 0.0);
  corners.front() = gamma;
  corners.back() = corner;
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = beside[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * beside[i - 1];
    right[i] -= factor * right[i - 1];
    corners[i] -= factor * corners[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) {
    const double next = i + 1 < n ? beside[i] : 0.0;
    right[i] = (right[i] - next * (i + 1 < n ? right[i + 1] : 0.0)) / diagonal[i];
    corners[i] = (corners[i] - next * (i + 1 < n ? corners[i + 1] : 0.0)) / diagonal[i];
  }
  const double part = (right.front() + corner / gamma * right.back()) /
                      (1.0 + corners.front() + corner / gamma * corners.back());
  for (std::size_t i = 0; i < n; ++i) right[i] -= part * corners[i];
  return right;
}

void check_period(const std::vector<double>& knots, const std::vector<double>& values) {
  check_knots(knots, values);
  if (std::abs(knots.back() - knots.front() - period) > round_off)
    throw std::invalid_argument("the knots of a periodic spline do not span 2 pi");
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  if (std::abs(values.back() - values.front()) > round_off * largest)
    throw std::invalid_argument("a periodic spline needs equal values at its ends");
}

/// Slopes at the knots with which the second derivatives of neighbouring polynomials agree:
/// m[i-1]/h[i-1] + 2 (1/h[i-1] + 1/h[i]) m[i] + m[i+1]/h[i] = 3 (c[i-1]/h[i-1] + c[i]/h[i]),
/// with the lengths h and the slopes c of the chords.
std::vector<double> spline_slopes(const std::vector<double>& knots,
                                  const std::vector<double>& values) {
  check_period(knots, values);
  const std::size_t n = knots.size() - 1;
  if (n == 1) return {0.0, 0.0};
  std::vector<double> beside(n);
  std::vector<double> chord(n);
  for (std::size_t i = 0; i < n; ++i) {
    beside[i] = 1.0 / (knots[i + 1] - knots[i]);
    chord[i] = (values[i + 1] - values[i]) * beside[i];
  }
  std::vector<double> diagonal(n);
  std::vector<double> right(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i > 0 ? i - 1 : n - 1;
    diagonal[i] = 2.0 * (beside[before] + beside[i]);
    right[i] = 3.0 * (chord[before] * beside[before] + chord[i] * beside[i]);
  }
  std::vector<double> slopes = solve_cyclic(diagonal, beside, right);
  slopes.push_back(slopes.front());
  return slopes;
}

}  // namespace

PeriodicSpline::PeriodicSpline(const std::vector<double>& knots, const std::vector<double>& values)
    : curve_(knots, values, spline_slopes(knots, values)) {}

ValueAndSlope PeriodicSpline::at(double angle) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (!std::isfinite(angle)) return {unknown, unknown};
  if (curve_.is_empty()) return {};
  if (angle < curve_.first() || angle > curve_.last()) {
    angle -= period * std::floor((angle - curve_.first()) / period);
    angle = std::clamp(angle, curve_.first(), curve_.last());
  }
  return curve_.at(angle);
}

}  // namespace samara::math
