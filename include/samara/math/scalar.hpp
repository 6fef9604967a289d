// The plain value of the scalars that the equations are evaluated with, for branches.
#pragma once

#include <cmath>
#include <complex>
#include <limits>

#include "samara/math/autodiff.hpp"
#include "samara/math/dependence.hpp"

namespace samara::math {

inline double plain_value(double value) { return value; }
inline double plain_value(const std::complex<double>& value) { return value.real(); }
template <class Derivatives>
double plain_value(const Eigen::AutoDiffScalar<Derivatives>& value) {
  return value.value();
}
/// None: every comparison with it is false.
inline double plain_value(const Dependence&) { return std::numeric_limits<double>::quiet_NaN(); }

/// x / sqrt(1 + x^2): the sign of x but near zero.
template <class T>
T smooth_sign(const T& x) {
  using std::sqrt;
  const T length = sqrt(T(x * x + T(1.0)));
  return x / length;
}

}  // namespace samara::math
