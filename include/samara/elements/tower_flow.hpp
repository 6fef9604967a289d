// The flow around the tower (docs/theory.md, section 11.1).
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "samara/base/error.hpp"
#include "samara/elements/air_models.hpp"
#include "samara/math/linearized.hpp"
#include "samara/math/smooth.hpp"
#include "samara/math/time_curve.hpp"
#include "samara/math/types.hpp"

namespace samara::elements {

/// A tower of round sections in the wind. Its axis is the line from the origin to its undeformed
/// top.
struct TowerFlow {
  TowerPotential potential = TowerPotential::none;
  TowerWake wake = TowerWake::none;
  Vector3 top = Vector3::Zero();  ///< components n1 n2 n3 [m]
  math::TimeCurve diameter;       ///< over the height above the foot [m]
  math::TimeCurve drag;           ///< drag coefficient over the height
  double turbulence = 0.1;        ///< intensity, of the wake of Eames et al.

  bool disturbs() const { return potential != TowerPotential::none || wake != TowerWake::none; }

  /// The wind at a place, from the undisturbed wind there [m/s].
  /// @throws DomainError inside the tower
  template <class T>
  Vec3<T> disturb(const Vec3<T>& wind, const Vec3<T>& place) const;

  /// Value of a curve over the height.
  template <class T>
  static T over_height(const math::TimeCurve& curve, const T& height) {
    const double plain = math::plain_value(height);
    if (std::isnan(plain)) return math::linearized(height, {plain, plain});
    const math::TimeCurve::Value at = curve.at(plain);
    return math::linearized(height, {at.value, at.rate});
  }

 private:
  template <class T>
  T wake_deficit(const T& x, const T& y, const T& drag_coefficient) const;
};

/// Change of the speed in the wake, relative to the wind. x downwind, y across, in radii.
template <class T>
T TowerFlow::wake_deficit(const T& x, const T& y, const T& drag_coefficient) const {
  using std::cos;
  using std::sqrt;
  constexpr double largest = 0.5;
  const double plain_x = math::plain_value(x);
  const double plain_y = math::plain_value(y);
  if (plain_x <= 0.0) return T(0.0);
  T deficit(0.0);
  if (wake == TowerWake::powles) {
    const double plain_width = std::sqrt(std::hypot(plain_x, plain_y));
    if (std::abs(plain_y) >= plain_width) return T(0.0);
    const T width = sqrt(T(sqrt(T(x * x + y * y))));
    const T shape = cos(T(y / width * T(0.5 * std::numbers::pi)));
    deficit = drag_coefficient / width * shape * shape;
  } else {
    const T spread = math::smooth_max(x, T(0.1)) * T(turbulence);
    const T relative = y / spread;
    deficit = drag_coefficient / (spread * T(std::sqrt(2.0 * std::numbers::pi))) *
              math::exponential(T(relative * relative * T(-0.5)));
  }
  return math::smooth_min(deficit, T(largest), 0.05) * math::smoothstep(x);
}

template <class T>
Vec3<T> TowerFlow::disturb(const Vec3<T>& wind, const Vec3<T>& place) const {
  using std::sqrt;
  constexpr double least = 1e-6;  // square of a speed [m^2/s^2]
  const T D = over_height(diameter, place(2));
  const T above = math::smoothstep(T((place(2) - T(top(2))) / D));
  if (math::plain_value(above) >= 1.0) return wind;
  const T speed = sqrt(T(wind(0) * wind(0) + wind(1) * wind(1) + T(least)));
  const T c1 = wind(0) / speed;  // direction of the wind
  const T c2 = wind(1) / speed;
  const T x1 = place(0) - place(2) * T(top(0) / top(2));
  const T x2 = place(1) - place(2) * T(top(1) / top(2));
  const T x = (x1 * c1 + x2 * c2) * T(2.0) / D;
  const T y = (x2 * c1 - x1 * c2) * T(2.0) / D;  // to the left
  const T C_d = over_height(drag, place(2));
  if (math::plain_value(x) * math::plain_value(x) + math::plain_value(y) * math::plain_value(y) <
      1.0)
    throw DomainError("a blade is inside the tower " + std::to_string(math::plain_value(place(2))) +
                      " m above the foot");
  T along(0.0);
  T across(0.0);
  if (potential != TowerPotential::none) {
    const bool is_bak = potential == TowerPotential::bak;
    const T X = is_bak ? T(x + T(0.1)) : x;
    const T square = X * X + y * y;
    along = (y * y - X * X) / (square * square);
    across = X * y * T(-2.0) / (square * square);
    if (is_bak) {
      const T source = C_d / (square * T(2.0 * std::numbers::pi));
      along += X * source;
      across += y * source;
    }
  }
  if (wake != TowerWake::none) along -= wake_deficit(x, y, C_d);
  const T factor = speed * (T(1.0) - above);
  return Vec3<T>(wind(0) + factor * (along * c1 - across * c2),
                 wind(1) + factor * (along * c2 + across * c1), wind(2));
}

}  // namespace samara::elements
