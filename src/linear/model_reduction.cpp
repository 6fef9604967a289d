#include "samara/linear/model_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "samara/base/error.hpp"

#include "ordered_schur.hpp"

namespace samara::linear {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

/// Relative to the modulus of an exponent, or to 1 rad/s: a smaller decay counts as none.
constexpr double neutral_decay = 1e-6;

bool is_stable(Complex exponent) {
  return exponent.real() < -neutral_decay * std::max(1.0, std::abs(exponent));
}

/// X of A X + X A^T + F F^T = 0 for a stable A (Bartels and Stewart 1972).
MatrixXd gramian(const MatrixXd& A, const MatrixXd& F) {
  const Schur schur = schur_of(A);
  const MatrixXcd& T = schur.T;
  const MatrixXcd G = schur.U.adjoint() * F.cast<Complex>();
  const MatrixXcd right = G * G.adjoint();
  MatrixXcd X = MatrixXcd::Zero(A.rows(), A.rows());
  for (Index j = A.rows() - 1; j >= 0; --j) {
    Eigen::VectorXcd column = -right.col(j);
    for (Index k = j + 1; k < A.rows(); ++k) column -= X.col(k) * std::conj(T(j, k));
    MatrixXcd shifted = T;
    shifted.diagonal().array() += std::conj(T(j, j));
    X.col(j) = shifted.triangularView<Eigen::Upper>().solve(column);
  }
  const MatrixXd found = (schur.U * X * schur.U.adjoint()).real();
  return 0.5 * (found + found.transpose());
}

/// L with L L^T = the matrix, without the eigenvalues that round-off made negative.
MatrixXd root_of(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// The form in coordinates in which the first `first` states and the others are decoupled.
struct Parted {
  StateSpace form;
  Index first = 0;
};

template <class Stays>
Parted part(const StateSpace& form, Stays stays) {
  Schur schur = schur_of(form.A);
  Parted parted;
  parted.first = bring_forward(schur, stays);
  const Index rest = schur.T.rows() - parted.first;
  const MatrixXcd others =
      schur.U.leftCols(parted.first) * parting(schur.T, parted.first) + schur.U.rightCols(rest);
  MatrixXd T(form.A.rows(), form.A.rows());
  T << real_basis(schur.U.leftCols(parted.first)), real_basis(others);
  const Eigen::PartialPivLU<MatrixXd> lu(T);
  parted.form = {lu.solve(form.A * T), lu.solve(form.B), form.C * T, form.D};
  parted.form.A.topRightCorner(parted.first, rest).setZero();
  parted.form.A.bottomLeftCorner(rest, parted.first).setZero();
  return parted;
}

ReducedForm reduce_modal(const StateSpace& form, int order, int kept,
                         const std::vector<Complex>& exponents) {
  std::vector<double> moduli;
  for (const Complex& exponent : exponents)
    if (is_stable(exponent)) moduli.push_back(std::abs(exponent));
  std::sort(moduli.begin(), moduli.end());
  auto count = static_cast<std::size_t>(order - kept);
  // Moduli of a pair are equal.
  constexpr double same = 1e-9;
  if (count > 0 && count < moduli.size() && moduli[count] < moduli[count - 1] * (1.0 + same))
    --count;
  const double limit = count < moduli.size() && count > 0
                           ? std::sqrt(moduli[count - 1] * moduli[count])
                       : count == 0 ? 0.0
                                    : 2.0 * moduli.back();
  const Parted parted = part(form, [limit](Complex exponent) {
    return !is_stable(exponent) || std::abs(exponent) < limit;
  });
  const StateSpace& whole = parted.form;
  const Index n = parted.first;
  const Index rest = whole.A.rows() - n;
  ReducedForm reduced;
  reduced.kept = kept;
  reduced.form = {whole.A.topLeftCorner(n, n), whole.B.topRows(n), whole.C.leftCols(n), whole.D};
  if (rest > 0)
    reduced.form.D -= whole.C.rightCols(rest) * whole.A.bottomRightCorner(rest, rest)
                                                    .partialPivLu()
                                                    .solve(MatrixXd(whole.B.bottomRows(rest)));
  return reduced;
}

ReducedForm reduce_balanced(const StateSpace& form, int order) {
  const Parted parted = part(form, [](Complex exponent) { return !is_stable(exponent); });
  const StateSpace& whole = parted.form;
  const Index n = parted.first;
  const Index rest = whole.A.rows() - n;
  const MatrixXd A = whole.A.bottomRightCorner(rest, rest);
  const MatrixXd B = whole.B.bottomRows(rest);
  const MatrixXd C = whole.C.rightCols(rest);
  const MatrixXd reach = root_of(gramian(A, B));
  const MatrixXd seen = root_of(gramian(A.transpose(), C.transpose()));
  const Eigen::BDCSVD<MatrixXd> svd(seen.transpose() * reach,
                                    Eigen::ComputeThinU | Eigen::ComputeThinV);
  ReducedForm reduced;
  reduced.kept = static_cast<int>(n);
  reduced.hankel = svd.singularValues();
  Index count = std::min<Index>(order - n, rest);
  while (count > 0 && reduced.hankel(count - 1) <= 0.0) --count;
  reduced.error_bound = 2.0 * reduced.hankel.tail(rest - count).sum();
  const Eigen::VectorXd scale = reduced.hankel.head(count).cwiseSqrt().cwiseInverse();
  const MatrixXd right = reach * svd.matrixV().leftCols(count) * scale.asDiagonal();
  const MatrixXd left =
      scale.asDiagonal() * svd.matrixU().leftCols(count).transpose() * seen.transpose();
  StateSpace& small = reduced.form;
  small.A = MatrixXd::Zero(n + count, n + count);
  small.A.topLeftCorner(n, n) = whole.A.topLeftCorner(n, n);
  small.A.bottomRightCorner(count, count) = left * A * right;
  small.B.resize(n + count, whole.B.cols());
  small.B << whole.B.topRows(n), left * B;
  small.C.resize(whole.C.rows(), n + count);
  small.C << whole.C.leftCols(n), C * right;
  small.D = whole.D;
  return reduced;
}

}  // namespace

ReducedForm reduce(const StateSpace& form, int order, ReductionMethod method) {
  const Eigen::ComplexEigenSolver<MatrixXcd> solver(form.A.cast<Complex>(), false);
  std::vector<Complex> exponents(static_cast<std::size_t>(form.A.rows()));
  int kept = 0;
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    exponents[i] = solver.eigenvalues()(static_cast<Index>(i));
    if (!is_stable(exponents[i])) ++kept;
  }
  if (kept > order)
    throw InputError("linearize.reduce.order: " + std::to_string(kept) +
                     " states are neutral or unstable, and are kept; hint: a higher order, or "
                     "damping where there is none");
  if (order >= static_cast<int>(form.A.rows())) return {form, kept, {}, 0.0};
  return method == ReductionMethod::modal ? reduce_modal(form, order, kept, exponents)
                                          : reduce_balanced(form, order);
}

}  // namespace samara::linear
