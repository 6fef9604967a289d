// Finite rotations by Rodrigues parameters theta = 2 tan(phi/2) n (docs/theory.md, section 2).
// C(theta) maps components in the unturned basis to components in the turned one. Every function
// is a template on the scalar: double, std::complex<double> or an automatic-differentiation scalar;
// none uses a conjugate, a modulus or a branch on the value.
#pragma once

#include "samara/math/types.hpp"

namespace samara::math {

/// skew(a) b = a x b.
template <class T>
Mat3<T> skew(const Vec3<T>& a) {
  Mat3<T> s;
  s << T(0), -a(2), a(1), a(2), T(0), -a(0), -a(1), a(0), T(0);
  return s;
}

template <class T>
Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  Vec3<T> c;
  c(0) = a(1) * b(2) - a(2) * b(1);
  c(1) = a(2) * b(0) - a(0) * b(2);
  c(2) = a(0) * b(1) - a(1) * b(0);
  return c;
}

/// a . b without a conjugate.
template <class T>
T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return T(a(0) * b(0)) + T(a(1) * b(1)) + T(a(2) * b(2));
}

/// Direction cosines C(theta), eq. (2). Regular for every finite theta; |theta| grows without
/// bound toward a rotation of 180 degrees.
template <class T>
Mat3<T> direction_cosines(const Vec3<T>& theta) {
  const T quarter = dot(theta, theta) * 0.25;
  const T factor = T(1.0) / T(quarter + 1.0);
  const T diagonal = (T(1.0) - quarter) * factor;
  const Vec3<T> scaled = theta * factor;
  Mat3<T> c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      c(i, j) = theta(i) * scaled(j) * 0.5;
      c(j, i) = c(i, j);
    }
    c(i, i) += diagonal;
  }
  c(0, 1) += scaled(2);
  c(0, 2) -= scaled(1);
  c(1, 0) -= scaled(2);
  c(1, 2) += scaled(0);
  c(2, 0) += scaled(1);
  c(2, 1) -= scaled(0);
  return c;
}

/// Q(theta) r: the angular velocity (r = theta_dot) of the turned basis relative to the unturned
/// one, in the turned basis.
template <class T>
Vec3<T> tangent_times(const Vec3<T>& theta, const Vec3<T>& r) {
  const T factor = T(1.0) / T(dot(theta, theta) * 0.25 + 1.0);
  const Vec3<T> turn = cross(theta, r);
  Vec3<T> w;
  for (int i = 0; i < 3; ++i) w(i) = (r(i) - turn(i) * 0.5) * factor;
  return w;
}

/// Q(theta)^-1 w = w + theta x w / 2 + theta (theta.w) / 4.
template <class T>
Vec3<T> inverse_tangent_times(const Vec3<T>& theta, const Vec3<T>& w) {
  const T along = dot(theta, w) * 0.25;
  const Vec3<T> turn = cross(theta, w);
  Vec3<T> r;
  for (int i = 0; i < 3; ++i) r(i) = w(i) + turn(i) * 0.5 + theta(i) * along;
  return r;
}

/// Parameters of the turn by b, then by a: C(compose(a, b))^T = C(a)^T C(b)^T, components in the
/// unturned basis. Grows without bound where that is a turn by 180 degrees.
template <class T>
Vec3<T> compose(const Vec3<T>& a, const Vec3<T>& b) {
  const T factor = T(1.0) / T(T(1.0) - dot(a, b) * 0.25);
  const Vec3<T> turn = cross(a, b);
  Vec3<T> c;
  for (int i = 0; i < 3; ++i) c(i) = (a(i) + b(i) + turn(i) * 0.5) * factor;
  return c;
}

/// theta with C(theta)^T = rotation.
Vector3 parameters_of(const Matrix3& rotation);

/// Matrix that turns vectors by `angle` about the unit vector `axis` (components in = components
/// out of the same basis): v -> v cos + axis x v sin + axis (axis.v)(1 - cos).
template <class T>
Mat3<T> turn_about(const Vector3& axis, const T& angle) {
  using std::cos;
  using std::sin;
  const T c = cos(angle);
  const T s = sin(angle);
  const T rest = T(1.0) - c;
  Mat3<T> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = rest * (axis(i) * axis(j));
  for (int i = 0; i < 3; ++i) m(i, i) += c;
  m(0, 1) -= s * axis(2);
  m(1, 0) += s * axis(2);
  m(0, 2) += s * axis(1);
  m(2, 0) -= s * axis(1);
  m(1, 2) -= s * axis(0);
  m(2, 1) += s * axis(0);
  return m;
}

/// |theta| beyond which a rotation counts as out of range: 170 degrees.
inline constexpr double largest_rodrigues_length = 22.860104605;

}  // namespace samara::math
