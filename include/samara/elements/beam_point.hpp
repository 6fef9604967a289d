// One Gauss point of the mixed, geometrically exact beam element of order s
// (docs/theory.md, section 2; Lee, Hodges & Patil (2002), eq. (1)-(7)).
//
// Unknowns of a point, in order: u(3), theta(3) in the attachment basis a; V(3), Omega(3), F(3),
// M(3) in the deformed section basis B. The residual of an element is a sum over its points. This
// function of one point contains all mechanics of the element; the nodes only add.
//
// theta counts from a reference rotation of the element. A beam can therefore turn by any angle.
// Valid for |theta| below 180 degrees and any strain that the linear law (4) allows.
#pragma once

#include "samara/math/rotation.hpp"
#include "samara/math/types.hpp"

namespace samara::elements {

inline constexpr int point_size = 18;

/// Constants of a Gauss point.
struct BeamPoint {
  Vector3 x = Vector3::Zero();              ///< undeformed position, components in a [m]
  Matrix3 C_ab = Matrix3::Identity();       ///< undeformed section basis
  Matrix3 reference = Matrix3::Identity();  ///< rotation from which theta counts, in a
  Matrix6 compliance = Matrix6::Zero();     ///< S^-1 of (4); zero rows and columns where rigid
  Matrix6 mass = Matrix6::Zero();           ///< I6 of (3)
  Vector6 damping = Vector6::Zero();        ///< mu [s]; zero where rigid
  Matrix3 drag = Matrix3::Zero();           ///< C_ab diag(alpha m) C_ba [kg/(m s)]
};

/// The motion of the attachment frame, and gravity (components in a).
template <class T>
struct Attachment {
  Vec3<T> v = Vec3<T>::Zero();        ///< velocity of the beam's origin [m/s]
  Vec3<T> omega = Vec3<T>::Zero();    ///< angular velocity of a [rad/s]
  Vec3<T> gravity = Vec3<T>::Zero();  ///< [m/s^2]
};

/// Contribution of a point to the balances of its element, components in a except the kinematic
/// rows. For a node with test function N_a the point adds w_j { N_a' flux + L N_a load } to force
/// and moment, and w_j { -N_a' u - L N_a stretch }, w_j { -N_a' theta - L N_a turn } to strain and
/// curvature.
template <class T>
struct PointTerms {
  Vec3<T> force_flux;   ///< R F
  Vec3<T> force_load;   ///< R (P_dot + Omega x P) - f
  Vec3<T> moment_flux;  ///< R M
  Vec3<T> moment_load;  ///< R (H_dot + Omega x H + V x P - (e1 + gamma) x F) - m
  Vec3<T> stretch;      ///< R (e1 + gamma) - C_ab e1
  Vec3<T> turn;         ///< Q^-1 C_ab kappa, C_ab turned by the reference
  Vec3<T> velocity;     ///< f_P = V - R^T (v_a + omega_a x (x + u) + u_dot), components in B
  Vec3<T> spin;         ///< f_H = Omega - R^T omega_a - C_ba Q theta_dot, components in B
};

/// The two kinematic rows of a point or of a beam's tip (the last two lines of the element).
/// `turned`: undeformed section basis, turned by the reference.
template <class T>
void kinematic_rows(const Vector3& x, const Matrix3& turned, const Vec6<T>& position,
                    const Vec6<T>& position_dot, const Vec6<T>& velocity, const Attachment<T>& a,
                    const Mat3<T>& R, Vec3<T>& f_P, Vec3<T>& f_H) {
  const Vec3<T> u = position.template head<3>();
  const Vec3<T> theta = position.template tail<3>();
  const Vec3<T> u_dot = position_dot.template head<3>();
  const Vec3<T> theta_dot = position_dot.template tail<3>();
  const Vec3<T> place = u + x.cast<T>();
  const Vec3<T> carried = math::cross(a.omega, place);
  const Vec3<T> motion = a.v + carried + u_dot;
  const Vec3<T> relative = math::tangent_times(theta, theta_dot);
  f_P = velocity.template head<3>() - R.transpose() * motion;
  f_H = velocity.template tail<3>() - R.transpose() * a.omega -
        turned.transpose().cast<T>() * relative;
}

/// {gamma; kappa} = S^-1 {F; M} of (4).
template <class T>
Vec6<T> section_strain(const BeamPoint& point, const Vec6<T>& FM) {
  Vec6<T> strain;
  for (int i = 0; i < 6; ++i) {
    strain(i) = T(0);
    for (int j = 0; j < 6; ++j)
      if (point.compliance(i, j) != 0.0) strain(i) += FM(j) * point.compliance(i, j);
  }
  return strain;
}

/// PointTerms::turn only.
template <class T>
Vec3<T> beam_point_turn(const BeamPoint& point, const Vec3<T>& theta, const Vec6<T>& FM) {
  const Matrix3 turned = point.reference * point.C_ab;
  const Vec3<T> kappa = section_strain(point, FM).template tail<3>();
  const Vec3<T> kappa_a = turned.cast<T>() * kappa;
  return math::inverse_tangent_times(theta, kappa_a);
}

/// All terms of one Gauss point at the state z, z_dot (18 each).
template <class T>
PointTerms<T> beam_point_terms(const BeamPoint& point, const Eigen::Matrix<T, point_size, 1>& z,
                               const Eigen::Matrix<T, point_size, 1>& z_dot,
                               const Attachment<T>& a) {
  using math::cross;
  const Vec3<T> theta = z.template segment<3>(3);
  const Vec3<T> V = z.template segment<3>(6);
  const Vec3<T> Omega = z.template segment<3>(9);
  const Vec6<T> FM = z.template segment<6>(12);
  const Mat3<T> C = math::direction_cosines(theta);
  const Matrix3 turned = point.reference * point.C_ab;
  const Mat3<T> R = C.transpose() * turned.cast<T>();  // B components to a components

  const Vec6<T> strain = section_strain(point, FM);
  Vec6<T> momentum;
  Vec6<T> momentum_dot;
  Vec6<T> weight;  // I6 {g_B; 0}
  const Vec3<T> g_B = R.transpose() * a.gravity;
  for (int i = 0; i < 6; ++i) {
    momentum(i) = T(0);
    momentum_dot(i) = T(0);
    weight(i) = T(0);
    for (int j = 0; j < 6; ++j) {
      if (point.mass(i, j) == 0.0) continue;
      momentum(i) += z(6 + j) * point.mass(i, j);  // (3)
      momentum_dot(i) += z_dot(6 + j) * point.mass(i, j);
      if (j < 3) weight(i) += g_B(j) * point.mass(i, j);
    }
  }
  Vec6<T> load = FM;  // section force with structural damping
  for (int i = 0; i < 6; ++i)
    if (point.damping(i) != 0.0) load(i) += z_dot(12 + i) * point.damping(i);
  const Vec3<T> F = load.template head<3>();
  const Vec3<T> M = load.template tail<3>();
  const Vec3<T> P = momentum.template head<3>();
  const Vec3<T> H = momentum.template tail<3>();
  Vec3<T> along = strain.template head<3>();  // e1 + gamma
  along(0) += 1.0;
  const Vec3<T> kappa = strain.template tail<3>();

  PointTerms<T> terms;
  const Vec3<T> force_B = Vec3<T>(momentum_dot.template head<3>()) + cross(Omega, P) -
                          Vec3<T>(weight.template head<3>());
  const Vec3<T> moment_B = Vec3<T>(momentum_dot.template tail<3>()) + cross(Omega, H) +
                           cross(V, P) - cross(along, F) - Vec3<T>(weight.template tail<3>());
  terms.force_flux = R * F;
  terms.force_load = R * force_B;
  terms.moment_flux = R * M;
  terms.moment_load = R * moment_B;
  terms.stretch = R * along - point.C_ab.col(0).template cast<T>();
  const Vec3<T> kappa_a = turned.cast<T>() * kappa;
  terms.turn = math::inverse_tangent_times(theta, kappa_a);
  kinematic_rows<T>(point.x, turned, z.template head<6>(), z_dot.template head<6>(),
                    z.template segment<6>(6), a, R, terms.velocity, terms.spin);
  return terms;
}

}  // namespace samara::elements
