#include "hill_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include "samara/base/error.hpp"

#include "complex_solver.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;
using Vector = Eigen::VectorXcd;

/// Relative residual at which the subspace counts as found, least factor by which a step must
/// reduce it, and number of steps that may fail to.
constexpr double enough = 1e-11;
constexpr double least_reduction = 0.5;
constexpr double small = 1e-9;
constexpr int most_failures = 3;
constexpr int most_steps = 20;
constexpr double linear_tolerance = 1e-5;
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
  if (shift_ && std::abs(*shift_ - exponent) < largest_distance * speed) return true;
  shift_ = exponent + Complex(beside * speed, exponent.imag() == 0.0 ? beside * speed : 0.0);
  if (pencil_.set_shift(*shift_)) return true;
  shift_.reset();
  return false;
}

double HillRefinement::refine(std::vector<HillPair>& pairs) {
  const auto m = static_cast<Index>(pairs.size());
  const Index n = pencil_.size();
  Eigen::MatrixXcd X(n, m);
  Eigen::MatrixXcd T = Eigen::MatrixXcd::Zero(m, m);
  for (Index j = 0; j < m; ++j) {
    X.col(j) = pencil_.vector_of(pairs[static_cast<std::size_t>(j)].series).normalized();
    T(j, j) = pairs[static_cast<std::size_t>(j)].exponent;
  }
  to_schur_form(X, T);
  Eigen::MatrixXcd stiffness(n, m);
  Eigen::MatrixXcd mass(n, m);
  Eigen::MatrixXcd best_X = X;
  Eigen::MatrixXcd best_T = T;
  double best = std::numeric_limits<double>::infinity();
  Vector product;
  int failures = 0;
  for (int step = 0;; ++step) {
    for (Index j = 0; j < m; ++j) {
      pencil_.multiply(0.0, X.col(j), product);
      stiffness.col(j) = product;
      pencil_.multiply_mass(X.col(j), product);
      mass.col(j) = product;
    }
    const Eigen::MatrixXcd residual = stiffness + mass * T;
    const double scale = std::max((mass * T).norm(), pencil_.speed() * mass.norm());
    const double size = residual.norm() / scale;
    const bool is_better = size < least_reduction * best;
    if (size < best) {
      best = size;
      best_X = X;
      best_T = T;
    }
    if (!is_better) ++failures;
    if (!std::isfinite(size) || size <= enough || failures > most_failures || step == most_steps)
      break;
    if (best <= small && !is_better) break;  // round-off
    if (!take_shift(T.diagonal().mean())) break;
    Eigen::MatrixXcd Y(n, m);
    for (Index j = 0; j < m; ++j) {
      pencil_.precondition(mass.col(j), product);
      Y.col(j) = product;
    }
    const Eigen::PartialPivLU<Eigen::MatrixXcd> border(X.adjoint() * Y);
    Complex exponent;
    Vector inner;
    ComplexSolver solver(
        n + m,
        [&](const Vector& x, Vector& y) {
          pencil_.multiply(exponent, x.head(n), inner);
          y.resize(n + m);
          y.head(n) = inner + mass * x.tail(m);
          y.tail(m) = X.adjoint() * x.head(n);
        },
        [&](const Vector& x, Vector& y) {
          pencil_.precondition(x.head(n), inner);
          y.resize(n + m);
          y.tail(m) = border.solve(X.adjoint() * inner - x.tail(m));
          y.head(n) = inner - Y * y.tail(m);
        },
        linear_tolerance, "hill_refine_");
    Eigen::MatrixXcd corrections(n, m);
    Eigen::MatrixXcd changes(m, m);
    Vector right = Vector::Zero(n + m);
    Vector solution;
    try {
      for (Index j = 0; j < m; ++j) {
        exponent = T(j, j);
        right.head(n) = -residual.col(j);
        if (j > 0) {
          pencil_.multiply_mass(corrections.leftCols(j) * T.col(j).head(j), product);
          right.head(n) -= product;
        }
        solver.solve(right, solution);
        corrections.col(j) = solution.head(n);
        changes.col(j) = solution.tail(m);
      }
    } catch (const ConvergenceError&) {
      break;  // the residual says how far it came
    }
    X += corrections;
    T += changes;
    to_schur_form(X, T);
  }
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(best_T);
  for (Index j = 0; j < m; ++j)
    pairs[static_cast<std::size_t>(j)] = {solver.eigenvalues()(j),
                                          pencil_.series_of(best_X * solver.eigenvectors().col(j))};
  return best;
}

}  // namespace samara::analysis
