// Smooth steps, maxima and absolute values: twice continuously differentiable, and exactly equal to
// the functions that they replace outside a band. For all scalars of the equations.
#pragma once

#include <cmath>

#include "samara/math/linearized.hpp"
#include "samara/math/scalar.hpp"

namespace samara::math {

/// x^3 (10 - 15 x + 6 x^2) and its slope within 0 < x < 1; 0 before it, 1 behind it.
inline ValueAndSlope smoothstep_at(double x) {
  if (x <= 0.0) return {0.0, 0.0};
  if (x >= 1.0) return {1.0, 0.0};
  const double left = 1.0 - x;
  return {x * x * x * (10.0 + x * (6.0 * x - 15.0)), 30.0 * x * x * left * left};
}

/// The positive part of y, smoothed within -1 < y < 1: (y + 1)^3/4 - (y + 1)^4/16 there.
inline ValueAndSlope smooth_positive_part(double y) {
  if (y <= -1.0) return {0.0, 0.0};
  if (y >= 1.0) return {y, 1.0};
  const double s = y + 1.0;
  return {s * s * s * (0.25 - s / 16.0), 0.25 * s * s * (3.0 - s)};
}

// The last branch of the functions below is the one of not-a-number, that is of a Dependence. It
// depends on all arguments.

/// 0 for x <= 0, 1 for x >= 1, a polynomial of fifth degree between them.
template <class T>
T smoothstep(const T& x) {
  const double plain = plain_value(x);
  if (plain <= 0.0) return T(0.0);
  if (plain >= 1.0) return T(1.0);
  return linearized(x, smoothstep_at(plain));
}

/// The larger of a and b > 0: b m(a/b), with m(x) = 1 for x <= 0, x for x >= 2, and
/// 1 + x^3/4 - x^4/16 between them.
template <class T>
T smooth_max(const T& a, const T& b) {
  const double scale = plain_value(b);
  const double ratio = plain_value(a) / scale;
  if (ratio <= 0.0) return b;
  if (ratio >= 2.0) return a;
  const ValueAndSlope part = smooth_positive_part(ratio - 1.0);
  const double m = 1.0 + part.value;
  return linearized(a, b, scale * m, part.slope, m - ratio * part.slope);
}

/// The larger of a and b, smoothed where they differ by less than `width` > 0.
template <class T>
T smooth_max(const T& a, const T& b, double width) {
  const double y = (plain_value(a) - plain_value(b)) / width;
  if (y <= -1.0) return b;
  if (y >= 1.0) return a;
  const ValueAndSlope part = smooth_positive_part(y);
  return linearized(a, b, plain_value(b) + width * part.value, part.slope, 1.0 - part.slope);
}

/// The smaller of a and b, smoothed where they differ by less than `width` > 0.
template <class T>
T smooth_min(const T& a, const T& b, double width) {
  const double y = (plain_value(b) - plain_value(a)) / width;
  if (y <= -1.0) return b;
  if (y >= 1.0) return a;
  const ValueAndSlope part = smooth_positive_part(y);
  return linearized(a, b, plain_value(b) - width * part.value, part.slope, 1.0 - part.slope);
}

/// |x|, an even polynomial of fourth degree where |x| < 0.1. Its least value is 0.0375.
template <class T>
T smooth_abs(const T& x) {
  constexpr double band = 0.1;
  const double plain = plain_value(x);
  if (plain >= band) return x;
  if (plain <= -band) return T(-x);
  const double y = plain / band;
  const double square = y * y;
  return linearized(x,
                    {band * (0.375 + square * (0.75 - 0.125 * square)), y * (1.5 - 0.5 * square)});
}

}  // namespace samara::math
