#include "hill_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "samara/base/error.hpp"

#include "complex_solver.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;
using Vector = Eigen::VectorXcd;

/// Least factor by which a step must reduce the relative residual, the residual below which a step
/// that fails to means round-off, and number of steps that may fail above it.
constexpr double least_reduction = 0.5;
constexpr double small = 1e-9;
constexpr int most_failures = 3;
constexpr int most_steps = 20;
/// Relative residual of the linear solves: what Newton's step can use, between these.
constexpr double finest_solve = 1e-6;
constexpr double coarsest_solve = 3e-2;
/// Distance of the shift from the exponents, and largest one at which factors are used again,
/// relative to the rotor speed.
constexpr double beside = 0.02;
constexpr double largest_distance = 0.5;
/// X with orthonormal columns and T with an upper triangle, of the same subspace.
void to_schur_form(Eigen::MatrixXcd& X, Eigen::MatrixXcd& T) {
  const Index m = X.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXcd> qr(X);
  const Eigen::MatrixXcd R =
      qr.matrixQR().topRows(m).triangularView<Eigen::Upper>().toDenseMatrix();
  const Eigen::MatrixXcd Q = qr.householderQ() * Eigen::MatrixXcd::Identity(X.rows(), m);
  T = R * T * R.triangularView<Eigen::Upper>().solve(Eigen::MatrixXcd::Identity(m, m));
  const Eigen::ComplexSchur<Eigen::MatrixXcd> schur(T);
  T = schur.matrixT().triangularView<Eigen::Upper>();
  X = Q * schur.matrixU();
}

}  // namespace

/// @returns false where the preconditioner has no factors
bool HillRefinement::take_shift(Complex exponent) {
  const double speed = pencil_.speed();
  const std::optional<Complex> shift = pencil_.shift();
  if (shift && std::abs(*shift - exponent) < largest_distance * speed) return true;
  return pencil_.set_shift(exponent +
                           Complex(beside * speed, exponent.imag() == 0.0 ? beside * speed : 0.0));
}

void HillRefinement::find_residual(Subspace& subspace) {
  subspace.residual.resize(subspace.X.rows(), subspace.X.cols());
  subspace.mass.resize(subspace.X.rows(), subspace.X.cols());
  pencil_.multiply(subspace.X, subspace.X * subspace.T, subspace.residual);
  pencil_.multiply_mass(subspace.X, subspace.mass);
  const double scale =
      std::max((subspace.mass * subspace.T).norm(), pencil_.speed() * subspace.mass.norm());
  subspace.size = subspace.residual.norm() / scale;
}

/// Adds C to X and D to T, A C + B (C T + X D) = -residual, X^H C = 0.
/// @returns false where the linear solves fail
bool HillRefinement::correct(Subspace& subspace, double tolerance) {
  Matrix& X = subspace.X;
  Matrix& T = subspace.T;
  if (!take_shift(T.diagonal().mean())) return false;
  const Index n = X.rows();
  const Index m = X.cols();
  Matrix Y(n, m);
  pencil_.precondition(subspace.mass, Y);
  const Eigen::PartialPivLU<Matrix> complement(X.adjoint() * Y);
  // A vector has C by column, then D.
  const auto main_part = [&](auto& vector) { return Eigen::Map<Matrix>(vector.data(), n, m); };
  const auto border = [&](auto& vector) { return Eigen::Map<Matrix>(vector.data() + n * m, m, m); };
  const auto in_main_part = [&](const Vector& vector) {
    return Eigen::Map<const Matrix>(vector.data(), n, m);
  };
  const auto in_border = [&](const Vector& vector) {
    return Eigen::Map<const Matrix>(vector.data() + n * m, m, m);
  };
  // A step leaves about the square of the residual.
  const double accuracy = std::clamp(std::max(0.1 * subspace.size, 0.3 * tolerance / subspace.size),
                                     finest_solve, coarsest_solve);
  ComplexSolver solver(
      n * m + m * m,
      [&](const Vector& x, Vector& y) {
        y.resize(x.size());
        const auto C = in_main_part(x);
        pencil_.multiply(C, C * T + X * in_border(x), main_part(y));
        border(y) = X.adjoint() * C;
      },
      [&](const Vector& x, Vector& y) {
        y.resize(x.size());
        auto C = main_part(y);
        auto D = border(y);
        pencil_.precondition(in_main_part(x), C);
        D = complement.solve(X.adjoint() * C - in_border(x));
        C -= Y * D;
      },
      accuracy, "hill_refine_");
  Vector right = Vector::Zero(n * m + m * m);
  main_part(right) = -subspace.residual;
  Vector solution;
  try {
    solver.solve(right, solution);
  } catch (const ConvergenceError&) {
    return false;
  }
  X += main_part(solution);
  T += border(solution);
  to_schur_form(X, T);
  return true;
}

HillRefinement::Result HillRefinement::refine(std::vector<HillPair>& pairs, double tolerance) {
  const auto m = static_cast<Index>(pairs.size());
  Subspace subspace{Matrix(pencil_.size(), m), Matrix::Zero(m, m), {}, {}, 0.0};
  for (Index j = 0; j < m; ++j) {
    const HillPair& pair = pairs[static_cast<std::size_t>(j)];
    subspace.X.col(j) = pencil_.vector_of(pair.series).normalized();
    subspace.T(j, j) = pair.exponent;
  }
  to_schur_form(subspace.X, subspace.T);
  const Matrix before = subspace.X;
  Matrix best_X = subspace.X;
  Matrix best_T = subspace.T;
  double best = std::numeric_limits<double>::infinity();
  int failures = 0;
  for (int step = 0;; ++step) {
    find_residual(subspace);
    const double size = subspace.size;
    const bool is_better = size < least_reduction * best;
    if (size < best) {
      best = size;
      best_X = subspace.X;
      best_T = subspace.T;
    }
    if (!is_better) ++failures;
    if (!std::isfinite(size) || size <= tolerance || failures > most_failures || step == most_steps)
      break;
    if (best <= small && !is_better) break;    // round-off
    if (!correct(subspace, tolerance)) break;  // the residual says how far it came
  }
  const Eigen::ComplexEigenSolver<Matrix> solver(best_T);
  for (Index j = 0; j < m; ++j)
    pairs[static_cast<std::size_t>(j)] = {solver.eigenvalues()(j),
                                          pencil_.series_of(best_X * solver.eigenvectors().col(j))};
  return {best, Eigen::JacobiSVD<Matrix>(before.adjoint() * best_X).singularValues().minCoeff()};
}

}  // namespace samara::analysis
