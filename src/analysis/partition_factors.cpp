#include "partition_factors.hpp"

#include <algorithm>

#include "samara/base/error.hpp"

#include "matrix_entries.hpp"

namespace samara::analysis {
namespace {

/// Smaller pivots of a piece are round-off. (Newton's method shows whether the factors serve.)
constexpr double least_pivot = 1e-16;

}  // namespace

PartitionFactors::PartitionFactors(const MeshPartition& partition, Mat pattern)
    : partition_(partition), size_(partition.block_size()) {
  const std::vector<char>& border = partition.border();
  for (const char wanted : {char{0}, char{1}})
    for (std::size_t i = 0; i < border.size(); ++i)
      if (border[i] == wanted &&
          partition.number_of(static_cast<PetscInt>(static_cast<Eigen::Index>(i) * size_)) >= 0)
        blocks_.push_back(static_cast<PetscInt>(i));
  inner_ = std::ranges::count_if(
      blocks_, [&](PetscInt i) { return border[static_cast<std::size_t>(i)] == 0; });
  std::vector<PetscInt> number(border.size(), -1);
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    number[static_cast<std::size_t>(blocks_[i])] = static_cast<PetscInt>(i);

  const MatrixEntries of_pattern(pattern);
  const BlockMatrix<double> all = of_pattern.blocks();
  begin_.push_back(0);
  for (const PetscInt block : blocks_) {
    for (PetscInt entry = all.begin[block]; entry < all.begin[block + 1]; ++entry) {
      const PetscInt column = number[static_cast<std::size_t>(all.columns[entry])];
      if (column < 0) throw InternalError("a part of a mesh is coupled to another one");
      columns_.push_back(column);
      entries_.push_back(entry);
    }
    begin_.push_back(static_cast<PetscInt>(columns_.size()));
  }
  values_.resize(entries_.size() * static_cast<std::size_t>(size_ * size_));
  factors_.emplace(matrix(), inner_);
  right_.resize(static_cast<Eigen::Index>(blocks_.size()) * size_, 1);
}

bool PartitionFactors::factor(Mat tangent) {
  const Eigen::Index area = size_ * size_;
  {
    const MatrixEntries all(tangent);
    for (std::size_t i = 0; i < entries_.size(); ++i)
      std::copy_n(all.values() + entries_[i] * area, area,
                  values_.data() + static_cast<Eigen::Index>(i) * area);
  }
  const bool is_regular = factors_->factor(matrix(), least_pivot);
  if (!partition_.ranks().all(is_regular)) return false;
  factors_->invert_diagonals();
  Eigen::MatrixXd complement = factors_->complement();
  partition_.ranks().sum(complement);
  return partition_.ranks().all(complement_.factor(std::move(complement)));
}

void PartitionFactors::solve(double* values) {
  const auto rows = [&](std::size_t block) {
    return Eigen::Map<Eigen::VectorXd>(values + blocks_[block] * size_, size_);
  };
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    right_.middleRows(static_cast<Eigen::Index>(i) * size_, size_) = rows(i);
  factors_->solve_lower(right_);
  const Eigen::Index left = (static_cast<Eigen::Index>(blocks_.size()) - inner_) * size_;
  Eigen::MatrixXd border = right_.bottomRows(left);
  partition_.ranks().sum(border);
  right_.bottomRows(left) = complement_.solve(border);
  factors_->solve_upper(right_);
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    rows(i) = right_.middleRows(static_cast<Eigen::Index>(i) * size_, size_);
}

}  // namespace samara::analysis
