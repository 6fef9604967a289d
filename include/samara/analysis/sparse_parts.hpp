// Rows and columns of the tangents on a steady state, and solutions with square parts of them.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

using Sparse = Eigen::SparseMatrix<double>;

/// K and M on a steady state.
struct SparseTangents {
  Sparse K, M;
};

SparseTangents tangents_on(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                           double t);

/// The entries in the given rows and columns.
Sparse part(const Sparse& whole, const std::vector<PetscInt>& rows,
            const std::vector<PetscInt>& columns);

/// The same with all columns.
Sparse rows_of(const Sparse& whole, const std::vector<PetscInt>& rows);

/// Factors of a square part, for several right-hand sides.
class SparseSolver {
 public:
  /// @throws InternalError where the matrix is singular: `what` do not determine the state
  SparseSolver(const Sparse& matrix, const char* what);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  Eigen::SparseLU<Sparse> lu_;
  bool empty_;
};

}  // namespace samara::analysis
