// Which unknowns are angles.
#pragma once

#include "samara/system/metadata.hpp"

namespace samara::system {

/// A coordinate that turns: the angle of a joint, or a component of a rotation, 2 tan(angle/2).
inline bool is_angle(const Unknown& unknown) {
  return unknown.role == UnknownRole::position && unknown.unit == "rad";
}

/// How much the unknown changes by where its angle does: 1 for that of a joint.
inline double angle_stretch(const Unknown& unknown, double value) {
  return unknown.owner.kind == PartKind::joint ? 1.0 : 1.0 + 0.25 * value * value;
}

}  // namespace samara::system
