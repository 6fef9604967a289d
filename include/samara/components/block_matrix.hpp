// A sparse matrix of dense 18 x 18 blocks that elements add to, and its copy into PETSc.
#pragma once

#include <vector>

#include "samara/petsc/handle.hpp"

namespace samara::components {

class BlockMatrix {
 public:
  static constexpr int block = 18;

  /// `columns[i]`: block columns of block row i, ascending.
  explicit BlockMatrix(std::vector<std::vector<int>> columns);

  int rows() const { return static_cast<int>(columns_.size()); }
  const std::vector<std::vector<int>>& columns() const { return columns_; }

  /// Position in values() of the entry of a row and column of the whole matrix.
  /// @throws InternalError if no block contains the entry
  std::size_t place(int row, int column) const;

  /// Writes the rows that `matrix` owns (BAIJ or MPIBAIJ, with this pattern).
  void copy_to(Mat matrix) const;

  /// All values, block after block, each column by column (the order of BAIJ).
  const std::vector<double>& values() const { return values_; }
  std::vector<double>& values() { return values_; }
  /// Position in values() of the first entry of block (i, columns()[i][n]).
  std::size_t offset(int i, int n) const {
    return (start_[static_cast<std::size_t>(i)] + static_cast<std::size_t>(n)) * block * block;
  }

 private:
  std::vector<std::vector<int>> columns_;
  std::vector<std::size_t> start_;
  std::vector<double> values_;
};

}  // namespace samara::components
