#include "samara/components/block_matrix.hpp"

#include <algorithm>
#include <string>

#include <Eigen/Core>

#include "samara/base/error.hpp"

namespace samara::components {

BlockMatrix::BlockMatrix(std::vector<std::vector<int>> columns) : columns_(std::move(columns)) {
  std::size_t count = 0;
  for (const std::vector<int>& row : columns_) {
    start_.push_back(count);
    count += row.size();
  }
  values_.assign(count * block * block, 0.0);
}

std::size_t BlockMatrix::place(int row, int column) const {
  const std::vector<int>& blocks = columns_[static_cast<std::size_t>(row / block)];
  const auto found = std::lower_bound(blocks.begin(), blocks.end(), column / block);
  if (found == blocks.end() || *found != column / block)
    throw InternalError("no block has row " + std::to_string(row) + ", column " +
                        std::to_string(column));
  return offset(row / block, static_cast<int>(found - blocks.begin())) +
         static_cast<std::size_t>(column % block * block + row % block);
}

void BlockMatrix::copy_to(Mat matrix) const {
  PetscBool serial = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(matrix), MATSEQBAIJ, &serial));
  if (serial) {
    PetscScalar* target = nullptr;
    petsc::check(MatSeqBAIJGetArray(matrix, &target));
    std::copy(values_.begin(), values_.end(), target);
    petsc::check(MatSeqBAIJRestoreArray(matrix, &target));
    petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    return;
  }
  PetscInt first = 0;
  PetscInt last = 0;
  petsc::check(MatGetOwnershipRange(matrix, &first, &last));
  for (PetscInt i = first / block; i < last / block; ++i) {
    const auto row = static_cast<int>(i);
    const std::vector<int>& columns = columns_[static_cast<std::size_t>(row)];
    for (std::size_t n = 0; n < columns.size(); ++n) {
      const PetscInt j = columns[n];
      // MatSetValuesBlocked reads row by row; the blocks are stored column by column.
      const Eigen::Matrix<double, block, block, Eigen::RowMajor> values =
          Eigen::Map<const Eigen::Matrix<double, block, block>>(values_.data() +
                                                                offset(row, static_cast<int>(n)));
      petsc::check(MatSetValuesBlocked(matrix, 1, &i, 1, &j, values.data(), INSERT_VALUES));
    }
  }
  petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
}

}  // namespace samara::components
