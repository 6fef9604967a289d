#include "samara/math/spline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "samara/math/quadrature.hpp"

namespace samara::math {
namespace {

constexpr int quadrature_points = 10;
constexpr int most_iterations = 50;
constexpr double arc_tolerance = 1e-14;  // of an interval

}  // namespace

NaturalSpline::NaturalSpline(std::vector<Vector3> points)
    : points_(std::move(points)), curvatures_(points_.size(), Vector3::Zero()), knots_(1, 0.0) {
  const std::size_t n = points_.size();
  for (std::size_t i = 1; i < n; ++i)
    knots_.push_back(knots_.back() + (points_[i] - points_[i - 1]).norm());
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = span(i - 1);
    const double after = span(i);
    const Vector3 slope_change =
        (points_[i + 1] - points_[i]) / after - (points_[i] - points_[i - 1]) / before;
    const double pivot = 2.0 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    curvatures_[i] = (6.0 * slope_change - before * curvatures_[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) curvatures_[i] -= upper[i] * curvatures_[i + 1];
  arc_.push_back(0.0);
  for (std::size_t i = 0; i + 1 < n; ++i) arc_.push_back(arc_.back() + arc_within(i, 1.0));
}

Vector3 NaturalSpline::position(std::size_t interval, double fraction) const {
  const double h = span(interval);
  const double b = fraction;
  const double a = 1.0 - b;
  return a * points_[interval] + b * points_[interval + 1] +
         h * h / 6.0 *
             ((a * a * a - a) * curvatures_[interval] +
              (b * b * b - b) * curvatures_[interval + 1]);
}

Vector3 NaturalSpline::slope(std::size_t interval, double fraction) const {
  const double h = span(interval);
  const double b = fraction;
  const double a = 1.0 - b;
  return (points_[interval + 1] - points_[interval]) / h +
         h / 6.0 *
             ((3.0 * b * b - 1.0) * curvatures_[interval + 1] -
              (3.0 * a * a - 1.0) * curvatures_[interval]);
}

double NaturalSpline::arc_within(std::size_t interval, double fraction) const {
  static const QuadratureRule rule = gauss_rule(quadrature_points);
  double sum = 0.0;
  for (std::size_t q = 0; q < rule.points.size(); ++q)
    sum += rule.weights[q] * slope(interval, fraction * rule.points[q]).norm();
  return sum * fraction * span(interval);
}

NaturalSpline::Place NaturalSpline::at(double arc) const {
  const auto next = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, arc);
  const auto interval = static_cast<std::size_t>(next - arc_.begin()) - 1;
  const double whole = arc_[interval + 1] - arc_[interval];
  const double wanted = arc - arc_[interval];
  double fraction = wanted / whole;
  for (int i = 0; i < most_iterations; ++i) {
    const double miss = wanted - arc_within(interval, fraction);
    if (std::abs(miss) < arc_tolerance * whole) break;
    fraction += miss / (span(interval) * slope(interval, fraction).norm());
  }
  return {position(interval, fraction), slope(interval, fraction).normalized()};
}

}  // namespace samara::math
