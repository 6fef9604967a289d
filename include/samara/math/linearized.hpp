// Functions of the scalars of the equations by value and slopes, which suffice for the first
// derivatives that these scalars have (automatic differentiation, complex step, dependences).
#pragma once

#include <cmath>
#include <numbers>

#include "samara/math/scalar.hpp"

namespace samara::math {

/// A value and its slope.
struct ValueAndSlope {
  double value = 0.0;
  double slope = 0.0;
};

/// f(x) from f and df/dx at the plain value of x.
template <class T>
T linearized(const T& x, const ValueAndSlope& f) {
  return T(f.value) + (x - T(plain_value(x))) * T(f.slope);
}

/// f(x, y) from f, df/dx and df/dy at the plain values of x and y.
template <class T>
T linearized(const T& x, const T& y, double value, double by_x, double by_y) {
  return T(value) + (x - T(plain_value(x))) * T(by_x) + (y - T(plain_value(y))) * T(by_y);
}

template <class T>
T arctangent(const T& y, const T& x) {
  const double py = plain_value(y);
  const double px = plain_value(x);
  const double square = px * px + py * py;
  return linearized(y, x, std::atan2(py, px), px / square, -py / square);
}

template <class T>
T exponential(const T& x) {
  const double value = std::exp(plain_value(x));
  return linearized(x, {value, value});
}

template <class T>
T logarithm(const T& x) {
  const double plain = plain_value(x);
  return linearized(x, {std::log(plain), 1.0 / plain});
}

/// x^exponent for x > 0.
template <class T>
T power(const T& x, double exponent) {
  const double plain = plain_value(x);
  const double value = std::pow(plain, exponent);
  return linearized(x, {value, exponent * value / plain});
}

/// The angle less whole revolutions, from -pi to pi.
template <class T>
T wrapped(const T& angle) {
  return angle - T(plain_value(angle) - std::remainder(plain_value(angle), 2.0 * std::numbers::pi));
}

}  // namespace samara::math
