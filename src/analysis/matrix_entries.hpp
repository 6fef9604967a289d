// Access in place to the entries of a serial matrix, with or without blocks.
#pragma once

#include <Eigen/Core>

#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/petsc/session.hpp"

#include "block_factors.hpp"

namespace samara::analysis {

class MatrixEntries {
 public:
  explicit MatrixEntries(Mat matrix) : matrix_(matrix) {
    petsc::check(
        PetscObjectTypeCompare(reinterpret_cast<PetscObject>(matrix), MATSEQBAIJ, &is_blocked_));
    if (is_blocked_ != PETSC_FALSE) petsc::check(MatGetBlockSize(matrix, &size_));
    PetscBool done = PETSC_FALSE;
    petsc::check(
        MatGetRowIJ(matrix, 0, PETSC_FALSE, is_blocked_, &rows_, &begin_, &columns_, &done));
    if (done == PETSC_FALSE)
      throw InternalError("PETSc gives no access to the structure of a matrix");
    if (is_blocked_ != PETSC_FALSE)
      petsc::check(MatSeqBAIJGetArray(matrix, &values_));
    else
      petsc::check(MatSeqAIJGetArray(matrix, &values_));
  }
  MatrixEntries(const MatrixEntries&) = delete;
  MatrixEntries& operator=(const MatrixEntries&) = delete;
  ~MatrixEntries() {
    if (is_blocked_ != PETSC_FALSE)
      MatSeqBAIJRestoreArray(matrix_, &values_);
    else
      MatSeqAIJRestoreArray(matrix_, &values_);
    PetscBool done = PETSC_FALSE;
    MatRestoreRowIJ(matrix_, 0, PETSC_FALSE, is_blocked_, &rows_, &begin_, &columns_, &done);
  }

  /// Calls visit(i, j, value) for every entry; value is a reference into values().
  template <class Visit>
  void for_each(Visit visit) {
    for (PetscInt i = 0; i < rows_; ++i)
      for (PetscInt k = begin_[i]; k < begin_[i + 1]; ++k)
        for (PetscInt c = 0; c < size_; ++c)
          for (PetscInt r = 0; r < size_; ++r)
            visit(i * size_ + r, columns_[k] * size_ + c, values_[(k * size_ + c) * size_ + r]);
  }

  bool has_blocks() const { return is_blocked_ != PETSC_FALSE; }
  BlockMatrix<double> blocks() const { return {size_, rows_, begin_, columns_, values_}; }

  /// The order is the same for all matrices of a pattern. Blocks column by column.
  PetscScalar* values() { return values_; }
  const PetscScalar* values() const { return values_; }

 private:
  Mat matrix_;
  PetscBool is_blocked_ = PETSC_FALSE;
  PetscInt size_ = 1;
  PetscInt rows_ = 0;
  const PetscInt* begin_ = nullptr;
  const PetscInt* columns_ = nullptr;
  PetscScalar* values_ = nullptr;
};

}  // namespace samara::analysis
