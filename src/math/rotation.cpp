#include "samara/math/rotation.hpp"

#include <Eigen/Geometry>

namespace samara::math {

Vector3 parameters_of(const Matrix3& rotation) {
  const Eigen::Quaterniond q(rotation);
  return 2.0 * q.vec() / q.w();
}

}  // namespace samara::math
