// The axes of the tower's end: t3, t1, t2 in the order of a beam, t1 t2 t3 for bodies.
#pragma once

#include "samara/math/types.hpp"

namespace samara::components {

template <class T>
Vec3<T> from_beam_order(const Vec3<T>& b) {
  return Vec3<T>(b(1), b(2), b(0));
}

template <class T>
Vec3<T> to_beam_order(const Vec3<T>& t) {
  return Vec3<T>(t(2), t(0), t(1));
}

}  // namespace samara::components
