// LU factors of a dense matrix whose rows and columns are scaled.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "blas.hpp"

namespace samara::analysis {

/// The complement of a border. Its largest entries are scaled to about one, so that small pivots
/// mean that it is singular. `Scalar` is double or std::complex<double>.
template <class Scalar>
class DenseFactors {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  /// @returns false where a pivot is below `least_pivot` times the largest one
  bool factor(Matrix matrix, double least_pivot = 1e-14) {
    const auto inverse = [](double square) { return square > 0.0 ? 1.0 / std::sqrt(square) : 1.0; };
    values_ = std::move(matrix);
    if (values_.rows() == 0) return true;
    rows_ = values_.cwiseAbs2().rowwise().maxCoeff().unaryExpr(inverse);
    values_ = (rows_.asDiagonal() * values_).eval();
    columns_ = values_.cwiseAbs2().colwise().maxCoeff().transpose().unaryExpr(inverse);
    values_ = (values_ * columns_.asDiagonal()).eval();
    interchanges_.resize(static_cast<std::size_t>(values_.rows()));
    if (blas::factor(size(), values_.data(), interchanges_.data()) != 0) return false;
    const auto pivots = values_.diagonal().cwiseAbs();
    return pivots.minCoeff() > least_pivot * pivots.maxCoeff();
  }

  /// For all columns.
  Matrix solve(const Eigen::Ref<const Matrix>& right) const {
    Matrix solution = rows_.asDiagonal() * right;
    blas::solve(size(), static_cast<blas::Integer>(right.cols()), values_.data(),
                interchanges_.data(), solution.data());
    return columns_.asDiagonal() * solution;
  }

  /// Up to multiples of 2 pi i.
  std::complex<double> log_determinant() const {
    std::complex<double> sum = 0.0;
    for (Eigen::Index i = 0; i < values_.rows(); ++i) {
      sum += std::log(std::complex<double>(values_(i, i))) - std::log(rows_(i)) -
             std::log(columns_(i));
      if (interchanges_[static_cast<std::size_t>(i)] != i + 1)
        sum += std::complex<double>(0.0, std::numbers::pi);
    }
    return sum;
  }

 private:
  blas::Integer size() const { return static_cast<blas::Integer>(values_.rows()); }

  Matrix values_;
  Eigen::VectorXd rows_;  ///< factors of scale
  Eigen::VectorXd columns_;
  std::vector<PetscBLASInt> interchanges_;
};

}  // namespace samara::analysis
