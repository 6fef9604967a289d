#include "massless_states.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace samara::analysis {
namespace {

using Index = Eigen::Index;
using Matrix = Eigen::MatrixXd;

/// Pivots of factorizations that are round-off, relative to the largest one. (Those of blades of 1
/// to 30 elements are 1e-8 and above, or 1e-14 and below.)
constexpr double round_off = 1e-10;

/// Combinations of the columns that are zero: columns x their number. `sizes`: of each column.
Matrix null_combinations(const Matrix& columns, const Eigen::VectorXd& sizes) {
  const Eigen::VectorXd scale =
      sizes.unaryExpr([](double size) { return size > 0.0 ? 1.0 / size : 1.0; });
  Eigen::ColPivHouseholderQR<Matrix> qr(columns * scale.asDiagonal());
  const Index count = columns.cols();
  Index rank = 0;
  while (rank < std::min(count, columns.rows()) &&
         std::abs(qr.matrixR()(rank, rank)) > round_off * std::max(1.0, qr.maxPivot()))
    ++rank;
  Matrix null = Matrix::Identity(count, count).rightCols(count - rank);
  null.topRows(rank) = -qr.matrixR()
                            .topLeftCorner(rank, rank)
                            .triangularView<Eigen::Upper>()
                            .solve(qr.matrixR().topRightCorner(rank, count - rank));
  return scale.asDiagonal() * (qr.colsPermutation() * null);
}

}  // namespace

MasslessStates::MasslessStates(const Eigen::SparseMatrix<double>& K,
                               const Eigen::SparseMatrix<double>& M, const Matrix& basis,
                               const EnergyCoordinates& coordinates) {
  const Index d = coordinates.without_inertia().rows();
  if (coordinates.without_inertia().cols() == 0) return;
  const Matrix inertia = M * basis.middleCols(d, d);
  const Matrix moving = null_combinations(inertia, inertia.colwise().norm().transpose());
  directions_ = static_cast<int>(moving.cols());
  if (directions_ == 0) return;
  // Without a damper, the rate that replaces a value at once needs no load.
  const Matrix rates = basis.middleCols(d, d) * moving;
  const Matrix values = basis.leftCols(d) * moving;
  const Matrix sizes = K.cwiseAbs() * rates.cwiseAbs() + M.cwiseAbs() * values.cwiseAbs();
  const Matrix at_rest =
      moving * null_combinations(K * rates + M * values, sizes.colwise().norm().transpose());
  count_ = static_cast<int>(at_rest.cols()) + directions_;
  Matrix states = Matrix::Zero(basis.cols(), count_);
  states.topLeftCorner(d, at_rest.cols()) = at_rest;
  states.block(d, at_rest.cols(), d, directions_) = moving;
  const Eigen::HouseholderQR<Matrix> qr(coordinates.of(states));
  others_ = Matrix::Identity(basis.cols(), basis.cols()).rightCols(basis.cols() - count_);
  others_.applyOnTheLeft(qr.householderQ());
}

Matrix MasslessStates::without(const Matrix& map) const {
  return count_ == 0 ? map : Matrix(others_.transpose() * multiply(map, others_));
}

Eigenpairs MasslessStates::eigenpairs_of(const Matrix& map, const std::string& prefix,
                                         Eigen::VectorXd* conditions) const {
  Eigenpairs pairs = dense_eigenpairs(without(map), prefix);
  if (conditions != nullptr) *conditions = condition_numbers(pairs);
  if (count_ > 0) pairs.vectors = (others_ * pairs.vectors).eval();
  return pairs;
}

}  // namespace samara::analysis
