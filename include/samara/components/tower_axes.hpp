// The axes of the tower's end: a beam has them in the order (t3, t1, t2), bodies as t1 t2 t3.
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
