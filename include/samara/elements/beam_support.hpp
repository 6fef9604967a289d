// Supports of a beam's ends, other than a clamped root and a free tip
// (docs/theory.md, section 2.7).
#pragma once

#include <array>

#include "samara/elements/beam_tip.hpp"

namespace samara::elements {

/// Support of the root. The root stands on a rigid body of its own (a node with the unknowns of a
/// Gauss point), and the body stands on springs. Order of directions: u1 u2 u3 theta1 theta2
/// theta3, root axes a.
struct RootSupport {
  Matrix6 compliance = Matrix6::Zero();  ///< springs; zero rows and columns where rigid
  std::array<bool, 6> free{};            ///< directions without a spring
  Vector6 damping = Vector6::Zero();     ///< mu [s]: load = F_hat + mu F_hat_dot, where elastic
  Matrix6 added_mass = Matrix6::Zero();  ///< inertia without weight, axes of the body [kg, kg m^2]

  bool is_elastic(int i) const { return compliance(i, i) > 0.0; }
};

/// Springs at the free end, in root axes a. A rigid direction does not move.
struct EndSupport {
  Matrix6 stiffness = Matrix6::Zero();
  std::array<bool, 6> rigid{};

  bool is_none() const { return rigid == std::array<bool, 6>{} && stiffness.isZero(0.0); }
};

template <class T>
struct RootSupportTerms {
  Vec6<T> law;   ///< position less compliance times elastic load; in free directions the load
  Vec6<T> load;  ///< load of the node on its springs, in a
  Vec6<T> root;  ///< load on the part that carries the springs; moment about the undeformed root
};

/// z: u, theta; V, Omega; F_hat and m_hat, the elastic loads that are work-conjugate to u and
/// theta. The moment M that is work-conjugate to a rotation follows from M . omega = m . theta_dot:
/// M = Q^-1 m.
template <class T>
RootSupportTerms<T> root_support_terms(const RootSupport& support,
                                       const Eigen::Matrix<T, point_size, 1>& z,
                                       const Eigen::Matrix<T, point_size, 1>& z_dot) {
  RootSupportTerms<T> terms;
  for (int i = 0; i < 6; ++i) {
    terms.load(i) = z(12 + i);
    if (support.is_elastic(i)) terms.load(i) += z_dot(12 + i) * support.damping(i);
    terms.law(i) = support.free[static_cast<std::size_t>(i)] ? z(12 + i) : z(i);
    for (int j = 0; j < 6; ++j)
      if (support.compliance(i, j) != 0.0) terms.law(i) -= z(12 + j) * support.compliance(i, j);
  }
  const Vec3<T> theta = z.template segment<3>(3);
  const Vec3<T> on_parameters = terms.load.template tail<3>();
  terms.load.template tail<3>() = math::inverse_tangent_times(theta, on_parameters);
  const Vec3<T> force = terms.load.template head<3>();
  const Vec3<T> displacement = z.template head<3>();
  terms.root = terms.load;
  terms.root.template tail<3>() += math::cross(displacement, force);
  return terms;
}

/// Force and moment from the change of the momenta of the water around the body, in a (Kirchhoff's
/// equations).
template <class T>
Vec6<T> added_mass_load(const RootSupport& support, const Eigen::Matrix<T, point_size, 1>& z,
                        const Eigen::Matrix<T, point_size, 1>& z_dot) {
  const Mat3<T> R = math::direction_cosines(Vec3<T>(z.template segment<3>(3))).transpose();
  const Vec6<T> load =
      inertial_load<T>(support.added_mass, z.template segment<6>(6), z_dot.template segment<6>(6));
  Vec6<T> in_a;
  in_a << R * Vec3<T>(load.template head<3>()), R * Vec3<T>(load.template tail<3>());
  return in_a;
}

/// Rows of the end from its `balance` of forces and moments in a. Elastic directions: the balance,
/// work-conjugate to the position (Q M for moments), plus the load of the springs. Rigid
/// directions: the position. `reference`: parameters of the rotation from which theta counts.
template <class T>
Vec6<T> end_support_rows(const EndSupport& support, const Vector3& reference, const Vec6<T>& end,
                         const Vec6<T>& balance) {
  Vec6<T> position = end;
  if (!reference.isZero(0.0))
    position.template tail<3>() =
        math::compose<T>(Vec3<T>(end.template tail<3>()), reference.cast<T>());
  const Vec3<T> theta = position.template tail<3>();
  const Vec3<T> moment = balance.template tail<3>();
  Vec6<T> rows = balance;
  rows.template tail<3>() = math::tangent_times(theta, moment);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j)
      if (support.stiffness(i, j) != 0.0) rows(i) += position(j) * support.stiffness(i, j);
    if (support.rigid[static_cast<std::size_t>(i)]) rows(i) = position(i);
  }
  return rows;
}

}  // namespace samara::elements
