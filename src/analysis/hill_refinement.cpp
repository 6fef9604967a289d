#include "hill_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "samara/base/error.hpp"

#include "hill_bordered_solver.hpp"

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

/// X = Q R with orthonormal columns of Q and an upper triangle R.
struct OrthonormalColumns {
  explicit OrthonormalColumns(const Eigen::MatrixXcd& X) {
    const Index m = X.cols();
    Eigen::MatrixXcd rows = Eigen::MatrixXcd::Zero(std::max(X.rows(), m), m);
    rows.topRows(X.rows()) = X;
    const Eigen::HouseholderQR<Eigen::MatrixXcd> qr(rows);
    R = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>().toDenseMatrix();
    Q = (qr.householderQ() * Eigen::MatrixXcd::Identity(rows.rows(), m)).topRows(X.rows());
  }
  Eigen::MatrixXcd Q, R;
};

/// X with orthonormal columns and T with an upper triangle, of the same subspace. Each rank has
/// some rows of X.
void to_schur_form(const Ranks& ranks, Eigen::MatrixXcd& X, Eigen::MatrixXcd& T) {
  const Index m = X.cols();
  OrthonormalColumns columns(X);
  if (ranks.size > 1) {  // the triangles of all ranks, one below the other
    Eigen::MatrixXcd triangles = Eigen::MatrixXcd::Zero(ranks.size * m, m);
    triangles.middleRows(ranks.rank * m, m) = columns.R;
    ranks.sum(triangles);
    const OrthonormalColumns of_all(triangles);
    columns.R = of_all.R;
    columns.Q *= of_all.Q.middleRows(ranks.rank * m, m);
  }
  T = columns.R * T *
      columns.R.triangularView<Eigen::Upper>().solve(Eigen::MatrixXcd::Identity(m, m));
  const Eigen::ComplexSchur<Eigen::MatrixXcd> schur(T);
  T = schur.matrixT().triangularView<Eigen::Upper>();
  X = columns.Q * schur.matrixU();
}

}  // namespace

void HillRefinement::find_residual(Subspace& subspace) {
  subspace.residual.resize(subspace.X.rows(), subspace.X.cols());
  subspace.mass.resize(subspace.X.rows(), subspace.X.cols());
  pencil_.multiply(subspace.X, subspace.X * subspace.T, subspace.residual);
  pencil_.multiply_mass(subspace.X, subspace.mass);
  const Ranks& ranks = pencil_.ranks();
  const double scale =
      std::max(ranks.norm(subspace.mass * subspace.T), pencil_.speed() * ranks.norm(subspace.mass));
  subspace.size = ranks.norm(subspace.residual) / scale;
}

/// Adds C to X and D to T, A C + B (C T + X D) = -residual, X^H C = 0.
/// @returns false where the linear solves fail
bool HillRefinement::correct(Subspace& subspace, double tolerance) {
  // A step leaves about the square of the residual.
  const double accuracy = std::clamp(std::max(0.1 * subspace.size, 0.3 * tolerance / subspace.size),
                                     finest_solve, coarsest_solve);
  try {
    HillBorderedSolver solver(pencil_, subspace.X, subspace.T, subspace.mass, accuracy);
    const HillBorderedSolver::Solution change = solver.solve(-subspace.residual);
    subspace.X += change.C;
    subspace.T += change.D;
  } catch (const ConvergenceError&) {
    return false;
  }
  to_schur_form(pencil_.ranks(), subspace.X, subspace.T);
  return true;
}

HillRefinement::Result HillRefinement::refine(std::vector<HillPair>& pairs, double tolerance) {
  const auto m = static_cast<Index>(pairs.size());
  Subspace subspace{Matrix(pencil_.size(), m), Matrix::Zero(m, m), {}, {}, 0.0};
  for (Index j = 0; j < m; ++j) {
    const HillPair& pair = pairs[static_cast<std::size_t>(j)];
    subspace.X.col(j) = pencil_.normalized(pencil_.vector_of(pair.series));
    subspace.T(j, j) = pair.exponent;
  }
  to_schur_form(pencil_.ranks(), subspace.X, subspace.T);
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
  return {best,
          Eigen::JacobiSVD<Matrix>(pencil_.product(before, best_X)).singularValues().minCoeff()};
}

}  // namespace samara::analysis
