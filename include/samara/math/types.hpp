// Small fixed-size arrays, templated on the scalar.
#pragma once

#include <Eigen/Core>

namespace samara {

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Mat3 = Eigen::Matrix<T, 3, 3>;
template <class T>
using Vec6 = Eigen::Matrix<T, 6, 1>;
template <class T>
using Mat6 = Eigen::Matrix<T, 6, 6>;

using Vector3 = Vec3<double>;
using Matrix3 = Mat3<double>;
using Vector6 = Vec6<double>;
using Matrix6 = Mat6<double>;

}  // namespace samara
