// The end of a beam or of a part of it, which may carry a rigid mass (docs/theory.md, section 2).
//
// Unknowns, in the order of a Gauss point: u_hat(3), theta_hat(3) in a; V_hat(3), Omega_hat(3) in a
// turned with the section; F_hat(3), M_hat(3), the section loads at the end, in a.
#pragma once

#include "samara/elements/beam_point.hpp"

namespace samara::elements {

template <class T>
struct TipTerms {
  Vec3<T> velocity;  ///< f_P at the end
  Vec3<T> spin;      ///< f_H at the end
  Vec3<T> force;     ///< F_hat + R (P_dot + Omega x P) - f: the load behind the mass, in a
  Vec3<T> moment;    ///< M_hat + R (H_dot + Omega x H + V x P) - m
};

/// Force and moment that change the momenta of `inertia` at V, Omega: P_dot + Omega x P and H_dot +
/// Omega x H + V x P, in their basis.
template <class T>
Vec6<T> inertial_load(const Matrix6& inertia, const Vec6<T>& velocity,
                      const Vec6<T>& velocity_dot) {
  const Mat6<T> mass = inertia.cast<T>();  // NOLINT: no copy where T is no double
  const Vec6<T> momentum = mass * velocity;
  const Vec6<T> momentum_dot = mass * velocity_dot;
  const Vec3<T> V = velocity.template head<3>();
  const Vec3<T> Omega = velocity.template tail<3>();
  const Vec3<T> P = momentum.template head<3>();
  const Vec3<T> H = momentum.template tail<3>();
  const Vec3<T> force = Vec3<T>(momentum_dot.template head<3>()) + math::cross(Omega, P);
  const Vec3<T> moment =
      Vec3<T>(momentum_dot.template tail<3>()) + math::cross(Omega, H) + math::cross(V, P);
  Vec6<T> load;
  load << force, moment;
  return load;
}

/// `mass`: I6 of (3) about x, momenta from velocities, in the basis of V_hat and Omega_hat.
/// `reference`: the rotation from which theta_hat counts.
template <class T>
TipTerms<T> beam_tip_terms(const Vector3& x, const Matrix3& reference, const Matrix6& mass,
                           const Eigen::Matrix<T, point_size, 1>& z,
                           const Eigen::Matrix<T, point_size, 1>& z_dot, const Attachment<T>& a) {
  const Mat3<T> R =
      math::direction_cosines(Vec3<T>(z.template segment<3>(3))).transpose() * reference.cast<T>();
  TipTerms<T> terms;
  kinematic_rows<T>(x, reference, z.template head<6>(), z_dot.template head<6>(),
                    z.template segment<6>(6), a, R, terms.velocity, terms.spin);
  terms.force = z.template segment<3>(12);
  terms.moment = z.template segment<3>(15);
  if (mass(0, 0) > 0.0) {
    Vec6<T> fall = Vec6<T>::Zero();
    fall.template head<3>() = R.transpose() * a.gravity;
    const Mat6<T> inertia = mass.cast<T>();  // NOLINT: no copy where T is no double
    const Vec6<T> load =
        inertial_load<T>(mass, z.template segment<6>(6), z_dot.template segment<6>(6)) -
        Vec6<T>(inertia * fall);
    const Vec3<T> force = load.template head<3>();
    const Vec3<T> moment = load.template tail<3>();
    terms.force += R * force;
    terms.moment += R * moment;
  }
  return terms;
}

}  // namespace samara::elements
