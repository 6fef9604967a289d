// Angles among the unknowns.
#pragma once

#include "samara/system/metadata.hpp"

namespace samara::system {

/// True for a coordinate of rotation: the angle of a joint, or a rotation parameter 2 tan(angle/2).
inline bool is_angle(const Unknown& unknown) {
  return unknown.role == UnknownRole::position && unknown.unit == "rad";
}

/// Derivative of the unknown with respect to its angle: 1 for the angle of a joint.
inline double angle_stretch(const Unknown& unknown, double value) {
  return unknown.owner.kind == PartKind::joint ? 1.0 : 1.0 + 0.25 * value * value;
}

}  // namespace samara::system
