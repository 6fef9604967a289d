// LU factors of a matrix of which each rank has a part.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <petscmat.h>

#include "block_factors.hpp"
#include "dense_factors.hpp"
#include "mesh_partition.hpp"

namespace samara::analysis {

/// Factors the sum of the matrices of all ranks: each rank eliminates its piece of the mesh, and
/// all of them solve for the border. All functions are collective.
class PartitionFactors {
 public:
  /// `pattern`: a tangent of the part of this rank, of blocks. The partition must outlive the
  /// object.
  PartitionFactors(const MeshPartition& partition, Mat pattern);

  /// @returns false where it is singular to working precision
  bool factor(Mat tangent);

  /// From a right-hand side to the solution, in the places of all unknowns of the system: those on
  /// this rank are read and written. The ranks' parts of the border add up.
  void solve(double* values);

 private:
  BlockMatrix<double> matrix() const {
    return {size_, static_cast<Eigen::Index>(blocks_.size()), begin_.data(), columns_.data(),
            values_.data()};
  }

  const MeshPartition& partition_;
  Eigen::Index size_;             ///< rows of a block
  std::vector<PetscInt> blocks_;  ///< of the part on this rank, the border at the end
  Eigen::Index inner_ = 0;        ///< number of those before the border
  std::vector<PetscInt> begin_;   ///< pattern of these
  std::vector<PetscInt> columns_;
  std::vector<PetscInt> entries_;  ///< of each, the block in the tangent
  std::vector<double> values_;
  std::optional<BlockFactors<double>> factors_;
  DenseFactors<double> complement_;  ///< of the border
  Eigen::MatrixXd right_;
};

}  // namespace samara::analysis
