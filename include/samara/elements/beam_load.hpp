// A load that turns with its section (docs/theory.md, section 2.6).
#pragma once

#include "samara/math/rotation.hpp"
#include "samara/math/types.hpp"

namespace samara::elements {

/// Components in a of a force and a moment that are given in B, the basis of a section turned by
/// theta: R = C^T C_ab.
template <class T>
Vec6<T> follower_load(const Vec3<T>& theta, const Matrix3& C_ab, const Vector6& load) {
  const Mat3<T> C = math::direction_cosines(theta);
  const Vector3 force = C_ab * load.head<3>();
  const Vector3 moment = C_ab * load.tail<3>();
  Vec6<T> turned;
  for (int i = 0; i < 3; ++i) {
    turned(i) = C(0, i) * force(0) + C(1, i) * force(1) + C(2, i) * force(2);
    turned(3 + i) = C(0, i) * moment(0) + C(1, i) * moment(1) + C(2, i) * moment(2);
  }
  return turned;
}

}  // namespace samara::elements
