// Mass-proportional damping of a beam: it acts on the motion relative to the rigid frame of the
// beam's own root (docs/theory.md, section 2.9).
#pragma once

#include "samara/elements/beam_point.hpp"

namespace samara::elements {

/// Motion of a root on springs, in a; zero for a clamped root.
template <class T>
struct RootMotion {
  Vec3<T> u = Vec3<T>::Zero();
  Vec3<T> theta = Vec3<T>::Zero();
  Vec3<T> u_dot = Vec3<T>::Zero();
  Vec3<T> theta_dot = Vec3<T>::Zero();
};

/// Force on a section per unit length, components in a, and its moment about the root. The opposite
/// force and moment act on the root.
template <class T>
struct DragTerms {
  Vec3<T> force;
  Vec3<T> moment;
};

/// `drag`: C_ab diag(alpha m) C_ba [kg/(m s)], in the axes of the root; `root`: null for a clamped
/// root.
template <class T>
DragTerms<T> beam_drag_terms(const Vector3& x, const Matrix3& drag, const Vec3<T>& u,
                             const Vec3<T>& u_dot, const RootMotion<T>* root) {
  DragTerms<T> terms;
  const Vec3<T> place = u + x.cast<T>();
  if (root == nullptr) {
    terms.force = -(drag.cast<T>() * u_dot);
    terms.moment = math::cross(place, terms.force);
    return terms;
  }
  const Mat3<T> C = math::direction_cosines(root->theta);  // its transpose turns the root's axes
  const Vec3<T> turning = math::tangent_times(root->theta, root->theta_dot);
  const Vec3<T> spin = C.transpose() * turning;
  const Vec3<T> arm = place - root->u;
  const Vec3<T> carried = math::cross(spin, arm);
  const Vec3<T> motion = C * Vec3<T>(u_dot - root->u_dot - carried);
  terms.force = -(C.transpose() * Vec3<T>(drag.cast<T>() * motion));
  terms.moment = math::cross(arm, terms.force);
  return terms;
}

}  // namespace samara::elements
