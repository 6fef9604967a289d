// Changes of an invariant subspace of Hill's eigenproblem (docs/theory.md, section 5.10).
#pragma once

#include <complex>

#include <Eigen/Core>
#include <Eigen/LU>

#include "complex_solver.hpp"
#include "hill_pencil.hpp"

namespace samara::analysis {

/// Solves A C + B (C T + X D) = right, X^H C = 0 for C and D: a subspace X with A X + B X T = 0
/// becomes X + C, its exponents those of T + D. Regular also for equal exponents in the subspace,
/// where the pencil itself is singular.
class HillBorderedSolver {
 public:
  using Matrix = Eigen::MatrixXcd;

  /// `X`: orthonormal columns; `mass`: B X. All are kept by reference. Factors the preconditioner
  /// next to the exponents, if it has no factors there. `accuracy`: relative residual of a solve.
  /// @throws ConvergenceError where there are no factors
  HillBorderedSolver(HillPencil& pencil, const Matrix& X, const Matrix& T, const Matrix& mass,
                     double accuracy);

  struct Solution {
    Matrix C, D;
  };
  /// @throws ConvergenceError
  Solution solve(const Matrix& right);

 private:
  ComplexSolver make_solver(double accuracy);

  HillPencil& pencil_;
  const Matrix& X_;
  const Matrix& T_;
  Matrix Y_;  ///< preconditioned B X
  Eigen::PartialPivLU<Matrix> complement_;
  ComplexSolver solver_;
};

}  // namespace samara::analysis
