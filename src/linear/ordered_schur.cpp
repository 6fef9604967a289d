#include "ordered_schur.hpp"

#include <complex>

#include <Eigen/Eigenvalues>
#include <Eigen/Jacobi>
#include <Eigen/SVD>

#include "samara/base/error.hpp"

namespace samara::linear {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

Schur schur_of(const MatrixXd& matrix) {
  const Eigen::ComplexSchur<MatrixXcd> solver(matrix.cast<Complex>());
  if (solver.info() != Eigen::Success)
    throw ConvergenceError("linearize: the eigenvalues of a matrix do not converge");
  return {solver.matrixT(), solver.matrixU()};
}

void exchange(Schur& schur, Index k) {
  const Complex first = schur.T(k, k);
  const Complex second = schur.T(k + 1, k + 1);
  Eigen::JacobiRotation<Complex> turn;
  turn.makeGivens(schur.T(k, k + 1), second - first);
  schur.T.applyOnTheLeft(k, k + 1, turn.adjoint());
  schur.T.applyOnTheRight(k, k + 1, turn);
  schur.U.applyOnTheRight(k, k + 1, turn);
  schur.T(k + 1, k) = 0.0;
}

MatrixXcd parting(const MatrixXcd& T, Index first) {
  const Index rest = T.rows() - first;
  const MatrixXcd T11 = T.topLeftCorner(first, first);
  MatrixXcd X(first, rest);
  for (Index j = 0; j < rest; ++j) {
    Eigen::VectorXcd right = -T.col(first + j).head(first);
    for (Index k = 0; k < j; ++k) right += X.col(k) * T(first + k, first + j);
    MatrixXcd shifted = T11;
    shifted.diagonal().array() -= T(first + j, first + j);
    X.col(j) = shifted.triangularView<Eigen::Upper>().solve(right);
  }
  return X;
}

MatrixXd real_basis(const MatrixXcd& columns) {
  MatrixXd both(columns.rows(), 2 * columns.cols());
  both << columns.real(), columns.imag();
  if (columns.cols() == 0) return MatrixXd(columns.rows(), 0);
  const Eigen::BDCSVD<MatrixXd> svd(both, Eigen::ComputeThinU);
  return svd.matrixU().leftCols(columns.cols());
}

}  // namespace samara::linear
