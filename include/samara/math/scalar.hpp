// The plain value of the scalars that the equations are evaluated with, for branches.
#pragma once

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
/// Not-a-number: every comparison with it is false.
inline double plain_value(const Dependence&) { return std::numeric_limits<double>::quiet_NaN(); }

}  // namespace samara::math
