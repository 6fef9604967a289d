// The flow around the tower (docs/theory.md, section 11.1).
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
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

  /// The wind at a place, from the undisturbed wind there [m/s]. Inside the tower it is continued
  /// with continuous slopes, for the iterations of a solver.
  template <class T>
  Vec3<T> disturb(const Vec3<T>& wind, const Vec3<T>& place) const;

  /// @throws DomainError if a place is inside the tower; `what`: the part that is there
  void require_outside(const Vector3& place, const std::string& what) const;

  /// Value of a curve over the height.
  template <class T>
  static T over_height(const math::TimeCurve& curve, const T& height) {
    const double plain = math::plain_value(height);
    if (std::isnan(plain)) return math::linearized(height, {plain, plain});
    const math::TimeCurve::Value at = curve.at(plain);
    return math::linearized(height, {at.value, at.rate});
  }

 private:
  /// Shift of the cylinder against the wind, in radii.
  static constexpr double bak_shift = 0.1;

  /// Distances from the axis of the tower along n1 and n2 [m].
  template <class T>
  std::array<T, 2> from_axis(const Vec3<T>& place) const {
    return {T(place(0) - place(2) * T(top(0) / top(2))),
            T(place(1) - place(2) * T(top(1) / top(2)))};
  }

  /// 1/s; where s is inside the tower of both potentials, the tangent at the edge of this range.
  template <class T>
  static T inverse_square(const T& s) {
    constexpr double edge = (1.0 - bak_shift) * (1.0 - bak_shift);
    if (math::plain_value(s) >= edge) return T(1.0) / s;
    return T(2.0 / edge) - s * T(1.0 / (edge * edge));
  }

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
  const auto [x1, x2] = from_axis(place);
  const T x = (x1 * c1 + x2 * c2) * T(2.0) / D;
  const T y = (x2 * c1 - x1 * c2) * T(2.0) / D;  // to the left
  const T C_d = over_height(drag, place(2));
  T along(0.0);
  T across(0.0);
  if (potential != TowerPotential::none) {
    const bool is_bak = potential == TowerPotential::bak;
    const T X = is_bak ? T(x + T(bak_shift)) : x;
    const T inverse = inverse_square(T(X * X + y * y));
    along = (y * y - X * X) * inverse * inverse;
    across = X * y * T(-2.0) * inverse * inverse;
    if (is_bak) {
      const T source = C_d * inverse * T(0.5 / std::numbers::pi);
      along += X * source;
      across += y * source;
    }
  }
  if (wake != TowerWake::none) along -= wake_deficit(x, y, C_d);
  const T factor = speed * (T(1.0) - above);
  return Vec3<T>(wind(0) + factor * (along * c1 - across * c2),
                 wind(1) + factor * (along * c2 + across * c1), wind(2));
}

inline void TowerFlow::require_outside(const Vector3& place, const std::string& what) const {
  if (!disturbs() || place(2) >= top(2) + over_height(diameter, place(2))) return;
  const auto [x1, x2] = from_axis(place);
  if (std::hypot(x1, x2) < 0.5 * over_height(diameter, place(2)))
    throw DomainError(what + " is inside the tower, " + general(place(2), 4) +
                      " m above the foot; hint: overhang, tilt and cone set the distance of the "
                      "blades from the tower");
}

}  // namespace samara::elements
