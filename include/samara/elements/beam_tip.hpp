// The free or loaded end of a beam, which may carry a point mass (docs/theory.md, section 2).
//
// Unknowns, in the order of a Gauss point: u_hat(3), theta_hat(3) in a; V_hat(3), Omega_hat(3) in a
// turned by C(theta_hat); F_hat(3), M_hat(3), the section loads at the end, in a.
#pragma once

#include "samara/elements/beam_point.hpp"

namespace samara::elements {

template <class T>
struct TipTerms {
  Vec3<T> velocity;  ///< f_P at the end
  Vec3<T> spin;      ///< f_H at the end
  Vec3<T> force;     ///< F_hat + m (acceleration - gravity): what the end mass asks for, in a
  Vec3<T> moment;    ///< M_hat
};

template <class T>
TipTerms<T> beam_tip_terms(const Vector3& x, double mass,
                           const Eigen::Matrix<T, point_size, 1>& z,
                           const Eigen::Matrix<T, point_size, 1>& z_dot, const Attachment<T>& a) {
  const Mat3<T> R = math::direction_cosines(Vec3<T>(z.template segment<3>(3))).transpose();
  TipTerms<T> terms;
  kinematic_rows<T>(x, Matrix3::Identity(), z.template head<6>(), z_dot.template head<6>(),
                    z.template segment<6>(6), a, R, terms.velocity, terms.spin);
  terms.force = z.template segment<3>(12);
  terms.moment = z.template segment<3>(15);
  if (mass > 0.0) {
    const Vec3<T> V = z.template segment<3>(6);
    const Vec3<T> Omega = z.template segment<3>(9);
    const Vec3<T> V_dot = z_dot.template segment<3>(6);
    const Vec3<T> acceleration = R * (V_dot + math::cross(Omega, V));
    terms.force += (acceleration - a.gravity) * T(mass);
  }
  return terms;
}

}  // namespace samara::elements
