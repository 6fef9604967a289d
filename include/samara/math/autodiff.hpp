// The forward-mode automatic-differentiation scalar of the element tangents.
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

namespace samara::math {

/// A value with its derivatives by N independent quantities.
template <int N>
using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, N, 1>>;

/// `value` as the independent quantity number `index` of N.
template <int N>
Dual<N> independent(double value, int index) {
  return Dual<N>(value, N, index);
}

/// `value` as a constant.
template <int N>
Dual<N> constant(double value) {
  return Dual<N>(value, Eigen::Matrix<double, N, 1>::Zero());
}

}  // namespace samara::math
