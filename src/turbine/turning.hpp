// Rotation vectors of the sections of a beam.
#pragma once

#include <cmath>
#include <type_traits>

#include "samara/math/rotation.hpp"
#include "samara/model/beam.hpp"

namespace samara::turbine {

template <class T>
double real_of(const T& value) {
  if constexpr (std::is_same_v<T, double>)
    return value;
  else
    return value.real();
}

/// The rotation vector of Rodrigues parameters.
template <class T>
Vec3<T> rotation_vector(const Vec3<T>& theta) {
  using std::atan;
  using std::sqrt;
  const T square = math::dot(theta, theta);
  // 2 atan(x / 2) / x; its series for small x.
  constexpr double small = 1e-4;
  if (std::abs(real_of(square)) < small * small) return theta * T(T(1.0) - square / 12.0);
  const T length = sqrt(square);
  return theta * T(2.0 * atan(length * 0.5) / length);
}

/// The rotation vector from the undeformed state, of parameters theta that count from `reference`.
template <class T>
Vec3<T> turned_from(const Matrix3& reference, const Vec3<T>& theta) {
  if (reference.isIdentity(0.0)) return rotation_vector<T>(theta);
  const Vector3 from = math::parameters_of(reference);
  return rotation_vector<T>(math::compose<T>(theta, from.cast<T>()));
}

}  // namespace samara::turbine
