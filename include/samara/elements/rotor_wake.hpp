// Finite states of the induced velocity of a rotor (Peters, Boyd & He 1989; Peters & He 1991;
// docs/theory.md, section 11.9): the velocity along the rotor's axis is a sum of shapes over the
// disk, and its states follow the loads on the blades.
//
// The disk has fixed axes e1 (azimuth zero) and e2 = n x e1. A place in it is (x, y) = r/R (cos
// psi, sin psi). The velocity against the thrust is w = sum over the shapes of phi(r/R) [alpha
// cos(m psi) + beta sin(m psi)].
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "samara/math/smooth.hpp"
#include "samara/math/types.hpp"

namespace samara::elements {

/// A shape of the induced velocity: harmonic m over the azimuth, order n = m + 1, m + 3, ... over
/// the radius.
struct WakeShape {
  int harmonic = 0;
  int order = 1;
  double norm = 1.0;                 ///< H_n^m
  std::vector<double> coefficients;  ///< phi_n^m(r) = r^m sum of coefficients[i] r^(2 i)

  /// Parts: cosine, and sine from the first harmonic on.
  int parts() const { return harmonic == 0 ? 1 : 2; }
  /// Apparent mass by the radius: (2/pi) H_n^m.
  double mass() const { return 2.0 / std::numbers::pi * norm; }
};

/// The largest order whose coefficients are exact to 1e-9.
inline constexpr int largest_wake_order = 20;

/// `counts`: number of shapes of the harmonics 0, 1, 2, ...
std::vector<WakeShape> make_wake_shapes(const std::vector<int>& counts);

/// Gamma_jn^rm of the shapes `row` (r, j) and `column` (m, n).
double wake_coupling(const WakeShape& row, const WakeShape& column);

/// phi cos(m psi) and phi sin(m psi) at (x, y).
template <class T>
std::array<T, 2> wake_shape_at(const WakeShape& shape, const T& x, const T& y) {
  const T square = x * x + y * y;
  T radial(0.0);
  for (std::size_t i = shape.coefficients.size(); i-- > 0;)
    radial = radial * square + T(shape.coefficients[i]);
  T cosine(1.0);
  T sine(0.0);
  for (int m = 0; m < shape.harmonic; ++m) {
    const T next = cosine * x - sine * y;
    sine = sine * x + cosine * y;
    cosine = next;
  }
  return {radial * cosine, radial * sine};
}

/// The flow through a disk.
template <class T>
struct DiskFlow {
  T z1, z2;    ///< tan(chi/2) along e1 and e2; chi: skew angle of the wake
  T speed;     ///< V_T, of the whole flow [m/s]
  T carrying;  ///< speed that carries the change of the mean load [m/s]
  T through;   ///< lambda, along the axis [m/s]
  T mean;      ///< w_m, mean induced velocity against the thrust [m/s]
  T share;     ///< of the carrying speed in V_T without the floor
  T across;    ///< u_p^2, square of the wind in the plane of the disk [m^2/s^2]
};

/// From this share of the carrying speed on the floor has no effect.
inline constexpr double least_carrying_share = 0.3;

/// `wind`: against the apex, along e1, e2 and n; `mean_load`: L^-1 alpha of the uniform load [m/s];
/// `least`: eps [m/s].
template <class T>
DiskFlow<T> disk_flow(const Vec3<T>& wind, const T& mean_load, double least) {
  using std::sqrt;
  DiskFlow<T> flow;
  flow.mean = mean_load * T(2.0 / std::numbers::sqrt3);
  flow.through = wind(2) - flow.mean;
  flow.across = wind(0) * wind(0) + wind(1) * wind(1);
  flow.speed = sqrt(T(flow.across + flow.through * flow.through + T(least * least)));
  const T along = flow.speed + math::smooth_abs(flow.through);
  flow.z1 = wind(0) / along;
  flow.z2 = wind(1) / along;
  // A floor keeps the states stable where the equations of small disturbances end.
  constexpr double floor = 0.2;
  flow.share =
      (flow.across + flow.through * (flow.through - flow.mean)) / (flow.speed * flow.speed);
  flow.carrying = flow.speed * math::smooth_max(flow.share, T(floor), least_carrying_share - floor);
  return flow;
}

/// Whether the equations of small disturbances hold: the load changes the flow less than by a
/// share, and does not reverse it. Climb, hover and edgewise flow are in the range.
bool is_in_range(const DiskFlow<double>& flow, double least);

/// The mean state t of a steady flow whose momentum balances a load: V_T t = `load` [m^2/s^2].
struct SteadyWake {
  double t = 0.0;  ///< [m/s]; at the end of the range where the load is beyond it
  bool is_in_range = true;
};
SteadyWake find_steady_wake(const Vector3& wind, double load, double least);

/// Terms of a row of alpha = L t, divided by Gamma: L_jn^rm (t_c, t_s)/Gamma_jn^rm, as (cosine,
/// sine) of harmonic r, of a column of harmonic m. In complex form a = alpha_c - i alpha_s,
/// t = t_c - i t_s, z = z1 + i z2:
///   a^0 = Re(z^m t),   a^r = p t + (-1)^min(r, m) conj(z)^(m + r) conj(t),
///   p = z^(m - r) for m >= r, else conj(z)^(r - m).
template <class T>
std::array<T, 2> wake_coupling_terms(int r, int m, const T& z1, const T& z2, const T& t_c,
                                     const T& t_s) {
  const auto power = [&](int exponent) {  // of z, or of its conjugate where it is negative
    T re(1.0);
    T im(0.0);
    const T y = exponent < 0 ? T(-z2) : z2;
    for (int i = 0; i < std::abs(exponent); ++i) {
      const T next = re * z1 - im * y;
      im = im * z1 + re * y;
      re = next;
    }
    return std::array<T, 2>{re, im};
  };
  const auto [p, q] = power(m - r);
  const T re = p * t_c + q * t_s;  // of (p + i q)(t_c - i t_s)
  if (r == 0) return {re, T(0.0)};
  const T im = q * t_c - p * t_s;
  const auto [u, v] = power(-(m + r));  // of (u + i v)(t_c + i t_s)
  const T sign(std::min(r, m) % 2 == 0 ? 1.0 : -1.0);
  return {re + sign * (u * t_c - v * t_s), -(im + sign * (u * t_s + v * t_c))};
}

}  // namespace samara::elements
