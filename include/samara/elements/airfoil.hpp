// Steady coefficients of an airfoil and its separation point, over the angle of attack
// (docs/theory.md, section 11).
#pragma once

#include <cmath>
#include <numbers>

#include "samara/math/linearized.hpp"
#include "samara/math/periodic_spline.hpp"
#include "samara/math/scalar.hpp"
#include "samara/math/smooth.hpp"
#include "samara/math/smoothed_curve.hpp"

namespace samara::elements {

/// Curves over the angle of attack [rad]. The coefficients of the steady flow and the deficit have
/// the period 2 pi; the separation point is constant beyond -pi and pi.
struct AirfoilCurves {
  math::PeriodicSpline lift;
  math::PeriodicSpline drag;
  math::PeriodicSpline moment;  ///< about the aerodynamic centre, nose up
  /// Change of the lift coefficient with the separation point f: the lift of a flow with f instead
  /// of its steady value f_st is Cl + (f - f_st) dC.
  math::PeriodicSpline deficit;
  math::SmoothedCurve separation;  ///< f_st: 1 attached flow, 0 separated flow
  double zero_lift = 0.0;          ///< angle without lift in attached flow [rad]
  double lift_slope = 0.0;         ///< of attached flow [1/rad]
  /// Zero lift and slope exist. Without them f_st and the deficit are zero: the lift is the steady
  /// one.
  bool has_dynamics = false;

  template <class T>
  T lift_at(const T& angle) const {
    return lift(angle);
  }
  template <class T>
  T drag_at(const T& angle) const {
    return drag(angle);
  }
  template <class T>
  T moment_at(const T& angle) const {
    return moment(angle);
  }
  template <class T>
  T deficit_at(const T& angle) const {
    return deficit(angle);
  }
  /// The angle is not wrapped.
  template <class T>
  T separation_at(const T& angle) const {
    return separation(angle);
  }
};

/// S(y): y where |y| < 1.1 rad, then y (1 - smoothstep((|y| - 1.1)/(pi - 1.1))) down to zero at
/// |y| = pi. Odd, of period 2 pi and twice continuously differentiable.
inline math::ValueAndSlope attached_angle(double y) {
  constexpr double linear = 1.1;  // [rad]
  constexpr double fade = std::numbers::pi - linear;
  y = math::wrapped(y);
  if (std::abs(y) <= linear) return {y, 1.0};
  const math::ValueAndSlope step = math::smoothstep_at((std::abs(y) - linear) / fade);
  return {y * (1.0 - step.value), 1.0 - step.value - std::abs(y) / fade * step.slope};
}

/// Lift coefficient of attached flow at any angle: Cl_alpha S(alpha - alpha_0).
template <class T>
T inviscid_lift(const AirfoilCurves& airfoil, const T& angle) {
  const math::ValueAndSlope S = attached_angle(math::plain_value(angle) - airfoil.zero_lift);
  return math::linearized(angle, {airfoil.lift_slope * S.value, airfoil.lift_slope * S.slope});
}

}  // namespace samara::elements
