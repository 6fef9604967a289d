// A curve through points that rises and falls only where they do.
#pragma once

#include <vector>

#include "samara/math/linearized.hpp"
#include "samara/math/piecewise_cubic.hpp"

namespace samara::math {

/// Piecewise cubic Hermite interpolation with the slopes of Fritsch and Butland (1984):
/// continuously differentiable, and between two points never outside their values.
class MonotoneCurve {
 public:
  /// Zero everywhere.
  MonotoneCurve() = default;
  /// At least two knots, which rise.
  /// @throws std::invalid_argument for other knots and values
  MonotoneCurve(const std::vector<double>& knots, const std::vector<double>& values);

  /// Beyond the first and the last knot the curve is constant. Not-a-number where x is.
  ValueAndSlope at(double x) const;

  template <class T>
  T operator()(const T& x) const {
    return linearized(x, at(plain_value(x)));
  }

 private:
  PiecewiseCubic curve_;
};

}  // namespace samara::math
