// Distance of a point of an undeformed blade from the shaft axis.
#pragma once

#include <cmath>

#include "samara/model/turbine.hpp"

namespace samara::model {

/// `x`: components in the axes a of the blade [m]. No hinge is turned.
inline double undeformed_radius(const BladeRoot& root, const Vector3& x) {
  const Vector3 place = root.position + root.C_Ha * x;
  return std::hypot(place(0), place(2));
}

}  // namespace samara::model
