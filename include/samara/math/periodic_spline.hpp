// The periodic cubic spline over an angle.
#pragma once

#include <vector>

#include "samara/math/linearized.hpp"
#include "samara/math/piecewise_cubic.hpp"

namespace samara::math {

/// Twice continuously differentiable, with the period 2 pi.
class PeriodicSpline {
 public:
  /// Zero everywhere.
  PeriodicSpline() = default;
  /// `knots` [rad]: rising, the last one is the first plus 2 pi. The values at both are equal.
  /// @throws std::invalid_argument for other knots and values
  PeriodicSpline(const std::vector<double>& knots, const std::vector<double>& values);

  /// At any angle [rad]; slope per radian. Not-a-number where the angle is not finite.
  ValueAndSlope at(double angle) const;

  template <class T>
  T operator()(const T& angle) const {
    return linearized(angle, at(plain_value(angle)));
  }

 private:
  PiecewiseCubic curve_;
};

}  // namespace samara::math
