#include "block_factors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <petscblaslapack.h>

#include "samara/petsc/handle.hpp"

namespace samara::analysis {
namespace {

/// Relative to the largest entry of a block row before elimination: a smaller pivot is round-off.
constexpr double least_pivot = 1e-13;

}  // namespace

BlockFactors::BlockFactors(const BlockMatrix& pattern) : size_(pattern.size), rows_(pattern.rows) {
  begin_.push_back(0);
  // Row i gets the columns of U of each row k that it eliminates.
  for (Index i = 0; i < rows_; ++i) {
    std::set<Index> row;
    row.insert(i);
    for (PetscInt k = pattern.begin[i]; k < pattern.begin[i + 1]; ++k)
      row.insert(pattern.columns[k]);
    for (auto k = row.begin(); *k < i; ++k)
      for (Index entry = diagonal_[static_cast<std::size_t>(*k)] + 1;
           entry < begin_[static_cast<std::size_t>(*k) + 1]; ++entry)
        row.insert(columns_[static_cast<std::size_t>(entry)]);
    const auto first = static_cast<Index>(columns_.size());
    diagonal_.push_back(first + std::distance(row.begin(), row.find(i)));
    columns_.insert(columns_.end(), row.begin(), row.end());
    begin_.push_back(static_cast<Index>(columns_.size()));
  }
  values_.resize(columns_.size() * static_cast<std::size_t>(size_ * size_));
  interchanges_.resize(static_cast<std::size_t>(rows_ * size_));
  filled_rows_.resize(columns_.size());
}

/// Finds the rows of a block that are not zero throughout: elimination adds none to them.
void BlockFactors::find_rows(Index entry) {
  const Eigen::Map<const Eigen::MatrixXd> values(block(entry), size_, size_);
  Index first = 0;
  Index end = size_;
  while (first < end && (values.row(first).array() == 0.0).all()) ++first;
  while (first < end && (values.row(end - 1).array() == 0.0).all()) --end;
  filled_rows_[static_cast<std::size_t>(entry)] = {first, end};
}

/// C = C - A B with the block A of an entry; B and C of size x columns.
void BlockFactors::subtract_product(Index entry, const double* b, double* c, Index columns) const {
  const auto [first, end] = filled_rows_[static_cast<std::size_t>(entry)];
  if (first == end) return;
  const auto rows = static_cast<PetscBLASInt>(end - first);
  const auto size = static_cast<PetscBLASInt>(size_);
  const auto n = static_cast<PetscBLASInt>(columns);
  const PetscScalar minus = -1.0;
  const PetscScalar one = 1.0;
  BLASgemm_("N", "N", &rows, &n, &size, &minus, block(entry) + first, &size, b, &size, &one,
            c + first, &size);
}

bool BlockFactors::factor_diagonal(Index i, double largest) {
  const auto n = static_cast<PetscBLASInt>(size_);
  double* values = block(diagonal_[static_cast<std::size_t>(i)]);
  PetscBLASInt status = 0;
  LAPACKgetrf_(&n, &n, values, &n, interchanges(i), &status);
  if (status != 0) return false;
  double pivot = largest;
  for (Index k = 0; k < size_; ++k) pivot = std::min(pivot, std::abs(values[k * (size_ + 1)]));
  return pivot > least_pivot * largest;
}

/// A becomes A D^-1 with the diagonal block D = P^T L U of row k.
void BlockFactors::divide(double* a, Index k) const {
  const auto n = static_cast<PetscBLASInt>(size_);
  const double* factors = block(diagonal_[static_cast<std::size_t>(k)]);
  const PetscScalar one = 1.0;
  BLAStrsm_("R", "U", "N", "N", &n, &n, &one, factors, &n, a, &n);
  BLAStrsm_("R", "L", "N", "U", &n, &n, &one, factors, &n, a, &n);
  for (Index c = size_ - 1; c >= 0; --c)
    if (const Index other = interchanges(k)[c] - 1; other != c)
      std::swap_ranges(a + c * size_, a + (c + 1) * size_, a + other * size_);
}

bool BlockFactors::factor(const BlockMatrix& matrix) {
  const Index area = size_ * size_;
  std::fill(values_.begin(), values_.end(), 0.0);
  std::vector<Index> place(static_cast<std::size_t>(rows_), -1);
  for (Index i = 0; i < rows_; ++i) {
    const Index first = begin_[static_cast<std::size_t>(i)];
    const Index last = begin_[static_cast<std::size_t>(i) + 1];
    for (Index entry = first; entry < last; ++entry)
      place[static_cast<std::size_t>(columns_[static_cast<std::size_t>(entry)])] = entry;
    double largest = 0.0;
    for (PetscInt k = matrix.begin[i]; k < matrix.begin[i + 1]; ++k) {
      const Eigen::Map<const Eigen::VectorXd> one(matrix.values + k * area, area);
      largest = std::max(largest, one.cwiseAbs().maxCoeff());
      std::copy_n(one.data(), area, block(place[static_cast<std::size_t>(matrix.columns[k])]));
    }
    for (Index entry = first; entry < diagonal_[static_cast<std::size_t>(i)]; ++entry) {
      const auto k = static_cast<std::size_t>(columns_[static_cast<std::size_t>(entry)]);
      divide(block(entry), columns_[static_cast<std::size_t>(entry)]);
      find_rows(entry);
      for (Index other = diagonal_[k] + 1; other < begin_[k + 1]; ++other)
        subtract_product(
            entry, block(other),
            block(place[static_cast<std::size_t>(columns_[static_cast<std::size_t>(other)])]),
            size_);
    }
    for (Index entry = diagonal_[static_cast<std::size_t>(i)] + 1; entry < last; ++entry)
      find_rows(entry);
    if (!factor_diagonal(i, largest)) return false;
  }
  return true;
}

void BlockFactors::solve(const Eigen::Ref<const Eigen::MatrixXd>& right,
                         const Eigen::Ref<const Eigen::VectorXd>& row_factors) {
  right_sides_ = right.cols();
  packed_.resize(static_cast<std::size_t>(rows_ * size_ * right_sides_));
  const auto n = static_cast<PetscBLASInt>(size_);
  const auto m = static_cast<PetscBLASInt>(right_sides_);
  for (Index i = 0; i < rows_; ++i) {
    Eigen::Map<Eigen::MatrixXd>(rows_of(i), size_, right_sides_) =
        right.middleRows(i * size_, size_).array().colwise() *
        row_factors.segment(i * size_, size_).array();
    for (Index entry = begin_[static_cast<std::size_t>(i)];
         entry < diagonal_[static_cast<std::size_t>(i)]; ++entry)
      subtract_product(entry, rows_of(columns_[static_cast<std::size_t>(entry)]), rows_of(i),
                       right_sides_);
  }
  for (Index i = rows_ - 1; i >= 0; --i) {
    const Index diagonal = diagonal_[static_cast<std::size_t>(i)];
    for (Index entry = diagonal + 1; entry < begin_[static_cast<std::size_t>(i) + 1]; ++entry)
      subtract_product(entry, rows_of(columns_[static_cast<std::size_t>(entry)]), rows_of(i),
                       right_sides_);
    PetscBLASInt status = 0;
    LAPACKgetrs_("N", &n, &m, block(diagonal), &n, interchanges(i), rows_of(i), &n, &status);
  }
}

Eigen::VectorXd BlockFactors::column(Index c) const {
  Eigen::VectorXd values(rows_ * size_);
  for (Index i = 0; i < rows_; ++i)
    values.segment(i * size_, size_) =
        Eigen::Map<const Eigen::VectorXd>(rows_of(i) + c * size_, size_);
  return values;
}

void BlockFactors::copy(const Eigen::Ref<const Eigen::VectorXd>& factors,
                        Eigen::MatrixXd& solution) const {
  solution.resize(rows_ * size_, right_sides_);
  for (Index i = 0; i < rows_; ++i)
    solution.middleRows(i * size_, size_) =
        Eigen::Map<const Eigen::MatrixXd>(rows_of(i), size_, right_sides_).array().colwise() *
        factors.segment(i * size_, size_).array();
}

}  // namespace samara::analysis
