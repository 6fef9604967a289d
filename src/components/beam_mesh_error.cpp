#include "beam_mesh_error.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "samara/math/quadrature.hpp"
#include "samara/math/rotation.hpp"

namespace samara::components {
namespace {

/// Coefficients c_j of the derivative of order s - 1, which is constant, of the polynomial through
/// the values at the s Gauss points of [0, 1].
Eigen::VectorXd highest_derivative(int s) {
  const std::vector<double> points = math::gauss_rule(s).points;
  Eigen::MatrixXd powers(s, s);
  for (int j = 0; j < s; ++j)
    for (int k = 0; k < s; ++k) powers(j, k) = std::pow(points[static_cast<std::size_t>(j)], k);
  return std::tgamma(s) * powers.inverse().row(s - 1).transpose();
}

/// (s!)^2 / ((2 s)! (2 s + 1)!): coefficient of the first term of an exponential that Gauss
/// collocation of order s omits.
double leading_constant(int s) {
  return std::pow(std::tgamma(s + 1), 2) / (std::tgamma(2 * s + 1) * std::tgamma(2 * s + 2));
}

Matrix6 square_root(const Matrix6& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(matrix);
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace

/// Error of element e of a beam. With y = (u, theta, F, M) along the span and y' = A y, an element
/// of order s has the Pade approximant of exp(A L). Its error is c_s (A L)^(2 s + 1). The
/// first-order change of an eigenvalue is the energy of the derivative of order s. That is the
/// derivative of order s - 1 of y', which follows from the points of the element.
system::MeshError find_mesh_error(const model::Beam& beam, int e, const std::vector<int>& points) {
  const int s = beam.order;
  const double L = beam.element_length(e);
  const Eigen::VectorXd weights = highest_derivative(s) / std::pow(L, s - 1);
  system::MeshError error;
  error.constant.setZero(12, 12 * s);
  error.rate.setZero(12, 12 * s);
  Matrix6 compliance = Matrix6::Zero();
  Matrix6 mass = Matrix6::Zero();
  for (int j = 0; j < s; ++j) {
    const int p = e * s + j;
    const elements::BeamPoint& point = beam.points[static_cast<std::size_t>(p)];
    for (int i = 0; i < 12; ++i)
      error.unknowns.push_back(points[static_cast<std::size_t>(p)] + 6 + i);
    Matrix6 turn = Matrix6::Zero();  // components in the section to components in a
    turn.topLeftCorner<3, 3>() = point.C_ab;
    turn.bottomRightCorner<3, 3>() = point.C_ab;
    const double share = beam.functions.weights[static_cast<std::size_t>(j)];
    compliance += share * turn * point.compliance * turn.transpose();
    mass += share * turn * point.mass * turn.transpose();
    const Matrix3 along = point.C_ab * math::skew<double>(Vector3::UnitX());
    const Eigen::Index velocity = 12 * j;
    const Eigen::Index load = velocity + 6;
    const double weight = weights(j);
    // F' and M': inertia, and the moment of the shear force.
    error.rate.block<6, 6>(0, velocity) = weight * turn * point.mass;
    error.constant.block<3, 3>(3, load) = weight * along;
    // V' and Omega': rotation of the section, and the rates of strain.
    error.constant.block<3, 3>(6, velocity + 3) = weight * along;
    error.rate.block<6, 6>(6, load) = weight * turn * point.compliance;
  }
  error.remainder.setZero(12 * s, 12 * s);
  const model::SectionRemainder& left = beam.remainders[static_cast<std::size_t>(e)];
  for (int j = 0; j < s; ++j)
    for (int k = 0; k < s; ++k) {
      error.remainder.block<6, 6>(12 * j, 12 * k) = left.mass.block<6, 6>(6 * j, 6 * k);
      error.remainder.block<6, 6>(12 * j + 6, 12 * k + 6) =
          left.compliance.block<6, 6>(6 * j, 6 * k);
    }
  const double scale = std::sqrt(leading_constant(s) * std::pow(L, 2 * s + 1));
  for (Eigen::MatrixXd* part : {&error.constant, &error.rate}) {
    part->topRows<6>() = scale * square_root(compliance) * part->topRows<6>();
    part->bottomRows<6>() = scale * square_root(mass) * part->bottomRows<6>();
  }
  return error;
}

}  // namespace samara::components
