// A smooth curve near points, within their values.
#pragma once

#include <vector>

#include "samara/math/linearized.hpp"
#include "samara/math/piecewise_cubic.hpp"

namespace samara::math {

/// Cubic spline whose coefficients of B-splines are the values of the broken line through points
/// (Schoenberg's variation diminishing spline): twice continuously differentiable, within the
/// values of four neighbouring points, and rising and falling only where they do. It does not go
/// through the points: at equal distances h it is (1, 4, 1)/6 of three of them, which differs by
/// h^2/6 times the curvature. A straight line stays one, except in the first and last three
/// intervals.
class SmoothedCurve {
 public:
  /// Zero everywhere.
  SmoothedCurve() = default;
  /// At least four knots, which rise.
  /// @throws std::invalid_argument for other knots and values
  SmoothedCurve(const std::vector<double>& knots, const std::vector<double>& values);

  /// Beyond the first and the last knot the curve is constant and has the value there; it begins
  /// and ends without slope and curvature. Not-a-number where x is.
  ValueAndSlope at(double x) const;

  template <class T>
  T operator()(const T& x) const {
    return linearized(x, at(plain_value(x)));
  }

 private:
  PiecewiseCubic curve_;
};

}  // namespace samara::math
