#include "samara/math/time_curve.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <muParser.h>

#include "samara/base/error.hpp"
#include "samara/math/quadrature.hpp"

namespace samara::math {
namespace {

using Point = TimeCurve::Point;
using Value = TimeCurve::Value;

/// Step of the differences of a formula [s].
constexpr double difference_step = 1e-3;
constexpr int integration_points = 5;
constexpr double longest_interval = 0.05;
constexpr int least_intervals = 100;

/// The number of the interval of t between points[i] and points[i + 1].
std::size_t interval_of(const std::vector<Point>& points, double t) {
  const auto next =
      std::upper_bound(points.begin(), points.end(), t,
                       [](double at, const Point& point) { return at < point.first; });
  const auto i = static_cast<std::size_t>(next - points.begin());
  return std::min(std::max<std::size_t>(i, 1), points.size() - 1) - 1;
}

/// Slopes at the points: zero at the ends and where the direction changes, otherwise a harmonic
/// mean of the slopes of the neighbouring intervals (Fritsch & Butland 1984).
std::vector<double> monotone_slopes(const std::vector<Point>& points) {
  std::vector<double> slopes(points.size(), 0.0);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double before = points[i].first - points[i - 1].first;
    const double behind = points[i + 1].first - points[i].first;
    const double a = (points[i].second - points[i - 1].second) / before;
    const double b = (points[i + 1].second - points[i].second) / behind;
    const double weight_a = 2.0 * behind + before;
    const double weight_b = behind + 2.0 * before;
    if (a * b > 0.0) slopes[i] = (weight_a + weight_b) / (weight_a / a + weight_b / b);
  }
  return slopes;
}

Value hermite(const Point& a, const Point& b, double slope_a, double slope_b, double t) {
  const double h = b.first - a.first;
  const double x = (t - a.first) / h;
  const double rise = b.second - a.second;
  const double c2 = 3.0 * rise - h * (2.0 * slope_a + slope_b);
  const double c3 = h * (slope_a + slope_b) - 2.0 * rise;
  return {a.second + x * (h * slope_a + x * (c2 + x * c3)),
          slope_a + x * (2.0 * c2 + 3.0 * x * c3) / h, (2.0 * c2 + 6.0 * x * c3) / (h * h)};
}

/// A formula and the variable that it reads.
struct Parsed {
  mu::Parser parser;
  double t = 0.0;

  double at(double time) {
    t = time;
    return parser.Eval();
  }
};

}  // namespace

TimeCurve TimeCurve::through(const std::vector<Point>& points) {
  const std::vector<double> slopes = monotone_slopes(points);
  return TimeCurve([points, slopes](double t) -> Value {
    if (t <= points.front().first) return {points.front().second, 0.0, 0.0};
    if (t >= points.back().first) return {points.back().second, 0.0, 0.0};
    const std::size_t i = interval_of(points, t);
    return hermite(points[i], points[i + 1], slopes[i], slopes[i + 1], t);
  });
}

TimeCurve TimeCurve::along(const std::vector<Point>& points) {
  return TimeCurve([points](double t) -> Value {
    if (t <= points.front().first) return {points.front().second, 0.0, 0.0};
    if (t >= points.back().first) return {points.back().second, 0.0, 0.0};
    const auto& [t0, y0] = points[interval_of(points, t)];
    const auto& [t1, y1] = points[interval_of(points, t) + 1];
    const double slope = (y1 - y0) / (t1 - t0);
    return {y0 + slope * (t - t0), slope, 0.0};
  });
}

TimeCurve TimeCurve::formula(const std::string& text) {
  const auto parsed = std::make_shared<Parsed>();
  try {
    parsed->parser.DefineVar("t", &parsed->t);
    parsed->parser.SetExpr(text);
    const double value = parsed->at(0.0);
    if (!std::isfinite(value)) throw InputError("\"" + text + "\" is no number at t = 0");
  } catch (const mu::Parser::exception_type& error) {
    throw InputError("\"" + text + "\": " + error.GetMsg());
  }
  return TimeCurve([parsed](double t) -> Value {
    constexpr double h = difference_step;
    // A formula is not evaluated before t = 0: differences are one-sided near it.
    const double f = parsed->at(std::max(t, 0.0));
    if (t < 2.0 * h) {
      const double at = std::max(t, 0.0);
      const double f1 = parsed->at(at + h);
      const double f2 = parsed->at(at + 2.0 * h);
      const double f3 = parsed->at(at + 3.0 * h);
      const double f4 = parsed->at(at + 4.0 * h);
      const double rate = (-25.0 * f + 48.0 * f1 - 36.0 * f2 + 16.0 * f3 - 3.0 * f4) / (12.0 * h);
      return {f + std::min(t, 0.0) * rate, rate,
              (35.0 * f - 104.0 * f1 + 114.0 * f2 - 56.0 * f3 + 11.0 * f4) / (12.0 * h * h)};
    }
    const double a1 = parsed->at(t + h);
    const double b1 = parsed->at(t - h);
    const double a2 = parsed->at(t + 2.0 * h);
    const double b2 = parsed->at(t - 2.0 * h);
    return {f, (8.0 * (a1 - b1) - (a2 - b2)) / (12.0 * h),
            (16.0 * (a1 + b1) - (a2 + b2) - 30.0 * f) / (12.0 * h * h)};
  });
}

TimeCurve TimeCurve::ramp(double start, double from, double to, double rate) {
  const double time = 0.5 * std::numbers::pi * std::abs(to - from) / rate;
  return TimeCurve([=](double t) -> Value {
    if (t <= start || time == 0.0) return {t <= start ? from : to, 0.0, 0.0};
    if (t >= start + time) return {to, 0.0, 0.0};
    const double w = std::numbers::pi / time;
    const double half = 0.5 * (to - from);
    const double phase = w * (t - start);
    return {from + half * (1.0 - std::cos(phase)), half * w * std::sin(phase),
            half * w * w * std::cos(phase)};
  });
}

IntegratedCurve::IntegratedCurve(TimeCurve curve, double until) : curve_(std::move(curve)) {
  const double count = std::max<double>(least_intervals, std::ceil(until / longest_interval));
  interval_ = until / count;
  sums_.push_back(0.0);
  for (int i = 0; i < static_cast<int>(count); ++i)
    sums_.push_back(sums_.back() + integrate(i * interval_, (i + 1) * interval_));
}

double IntegratedCurve::integrate(double from, double to) const {
  static const QuadratureRule rule = gauss_rule(integration_points);
  double sum = 0.0;
  for (std::size_t j = 0; j < rule.points.size(); ++j)
    sum += rule.weights[j] * curve_.at(from + (to - from) * rule.points[j]).value;
  return sum * (to - from);
}

TimeCurve::Value IntegratedCurve::at(double t) const {
  const double last = static_cast<double>(sums_.size() - 1);
  const double i = std::clamp(std::floor(t / interval_), 0.0, last);
  const TimeCurve::Value now = curve_.at(t);
  return {sums_[static_cast<std::size_t>(i)] + integrate(i * interval_, t), now.value, now.rate};
}

}  // namespace samara::math
