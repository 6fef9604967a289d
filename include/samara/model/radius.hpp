// Distance of a point of an undeformed blade from the shaft axis.
#pragma once

#include <algorithm>
#include <cmath>

#include "samara/model/turbine.hpp"

namespace samara::model {

/// `x`: components in the axes a of the blade [m]. No hinge is turned.
inline double undeformed_radius(const BladeRoot& root, const Vector3& x) {
  const Vector3 place = root.position + root.C_Ha * x;
  return std::hypot(place(0), place(2));
}

/// The largest one of the tips.
inline double rotor_radius(const Turbine& turbine) {
  double radius = 0.0;
  for (std::size_t k = 0; k < turbine.blades.size(); ++k)
    radius = std::max(radius, undeformed_radius(turbine.roots[k], turbine.blades[k].tip));
  return radius;
}

}  // namespace samara::model
