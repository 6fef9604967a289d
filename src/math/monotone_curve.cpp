#include "samara/math/monotone_curve.hpp"

#include <cmath>

namespace samara::math {
namespace {

/// Slope at an end, by three points, from the lengths and the slopes of the chords of the first and
/// the second interval; limited so that the first interval stays monotone.
double end_slope(double h0, double h1, double chord0, double chord1) {
  const double slope = ((2.0 * h0 + h1) * chord0 - h0 * chord1) / (h0 + h1);
  if (slope * chord0 <= 0.0) return 0.0;
  if (chord0 * chord1 <= 0.0 && std::abs(slope) > 3.0 * std::abs(chord0)) return 3.0 * chord0;
  return slope;
}

/// Weighted harmonic means of the slopes of neighbouring chords, zero where they differ in sign.
std::vector<double> monotone_slopes(const std::vector<double>& knots,
                                    const std::vector<double>& values) {
  check_knots(knots, values);
  const std::size_t n = knots.size() - 1;
  std::vector<double> h(n);
  std::vector<double> chord(n);
  for (std::size_t i = 0; i < n; ++i) {
    h[i] = knots[i + 1] - knots[i];
    chord[i] = (values[i + 1] - values[i]) / h[i];
  }
  if (n == 1) return {chord[0], chord[0]};
  std::vector<double> slopes(n + 1, 0.0);
  slopes.front() = end_slope(h[0], h[1], chord[0], chord[1]);
  slopes.back() = end_slope(h[n - 1], h[n - 2], chord[n - 1], chord[n - 2]);
  for (std::size_t i = 1; i < n; ++i) {
    if (!(chord[i - 1] * chord[i] > 0.0)) continue;
    const double before = 2.0 * h[i] + h[i - 1];
    const double behind = h[i] + 2.0 * h[i - 1];
    slopes[i] = (before + behind) / (before / chord[i - 1] + behind / chord[i]);
  }
  return slopes;
}

}  // namespace

MonotoneCurve::MonotoneCurve(const std::vector<double>& knots, const std::vector<double>& values)
    : curve_(knots, values, monotone_slopes(knots, values)) {}

ValueAndSlope MonotoneCurve::at(double x) const {
  if (std::isnan(x)) return {x, x};
  if (curve_.is_empty()) return {};
  if (x < curve_.first()) return {curve_.at(curve_.first()).value, 0.0};
  if (x > curve_.last()) return {curve_.at(curve_.last()).value, 0.0};
  return curve_.at(x);
}

}  // namespace samara::math
