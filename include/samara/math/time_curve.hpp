// A number that is given as a function of time, with its two rates.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace samara::math {

class TimeCurve {
 public:
  struct Value {
    double value = 0.0;
    double rate = 0.0;
    double acceleration = 0.0;
  };
  using Point = std::pair<double, double>;  ///< t [s], value

  /// Zero at all times.
  TimeCurve() = default;

  /// The monotone cubic through points of rising t (Fritsch & Butland 1984: no overshoot, the rate
  /// is continuous); constant outside, without a jump of the rate.
  static TimeCurve through(const std::vector<Point>& points);

  /// Straight lines between points of rising t, constant outside: the rate jumps.
  static TimeCurve along(const std::vector<Point>& points);

  /// A formula of t, e.g. "0.1*sin(2*_pi*t)" in the language of muParser. Rates by differences of
  /// fourth order; near t = 0 one-sided, the second of third order. Before t = 0 a straight line.
  /// @throws InputError with the place in the formula
  static TimeCurve formula(const std::string& text);

  /// From one value to another, beginning at the time `start`, by half a cosine whose largest rate
  /// is `rate` > 0.
  static TimeCurve ramp(double start, double from, double to, double rate);

  /// Any function of time with its rates.
  static TimeCurve of(std::function<Value(double)> function) {
    return TimeCurve(std::move(function));
  }

  Value at(double t) const { return function_ ? function_(t) : Value{}; }

 private:
  explicit TimeCurve(std::function<Value(double)> function) : function_(std::move(function)) {}

  std::function<Value(double)> function_;
};

/// The integral of a curve from 0, e.g. an azimuth from a speed. Its value is the integral, its
/// rate the curve's value, its acceleration the curve's rate.
class IntegratedCurve {
 public:
  /// Exact to round-off for t from 0 to `until` [s] where the curve is a polynomial of degree 9
  /// over each hundredth of that time.
  IntegratedCurve(TimeCurve curve, double until);

  TimeCurve::Value at(double t) const;

 private:
  double integrate(double from, double to) const;

  TimeCurve curve_;
  double interval_;
  std::vector<double> sums_;  ///< from 0 to the start of each interval
};

}  // namespace samara::math
