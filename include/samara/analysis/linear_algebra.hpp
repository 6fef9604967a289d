// Linear algebra of the analyses: a scaled direct solver for many right-hand sides, the
// dense product and the dense eigenproblem.
#pragma once

#include <complex>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Row and column factors that bring the largest entry of every row and column near one.
struct Equilibration {
  petsc::Handle<Vec> rows;
  petsc::Handle<Vec> columns;
};

Equilibration equilibrate(Mat matrix);

/// rows matrix columns, in place; faster than MatDiagonalScale for block matrices.
void apply_scaling(const Equilibration& scaling, Mat matrix);

/// The factors rounded to powers of two: scaling with them and back loses no digit.
void round_to_powers_of_two(Equilibration& scaling);

/// Factors from the roles of unknowns: positions 1, velocities `rate` [1/s], internal loads the
/// median inertia load that belongs to them; rows by their largest entry. The matrix of (19) has
/// condition 6e17 as it is, 1e8 equilibrated and 2e3 so (the paper's turbine, 500 steps), and so
/// have the blocks that the elimination divides by.
Equilibration scale_by_role(const system::PeriodicSystem& system, Mat matrix, double rate);

/// A matrix without an inverse.
class SingularError : public ConvergenceError {
  using ConvergenceError::ConvergenceError;
};

/// Why there are no factors.
struct FactorFailure {
  PCFailedReason reason = PC_NOERROR;  ///< that, where there are
  std::string words;                   ///< what the solver says
  std::string hint;                    ///< empty where the matrix is singular
  bool is_singular = false;            ///< the solver has established it
  bool wants_room = false;             ///< a larger work array may do
};

/// Sets up a solver whose operators are new, which factors them. Where MUMPS needs a larger work
/// array than it has estimated it gets one, unless an option sets its size.
/// @throws InternalError where there is not enough memory.
FactorFailure set_up(KSP solver);

/// LU with fixed scaling. The scaling of the first matrix serves all later ones of its pattern.
class DirectSolver {
 public:
  /// `prefix` of the KSP's options, e.g. "floquet_"; `scale` gives the factors of a matrix.
  DirectSolver(std::string prefix, std::function<Equilibration(Mat)> scale);

  /// Factors `matrix`, which is scaled in place.
  /// @throws SingularError where that is established, ConvergenceError where there are no factors
  /// for another reason.
  void factor(Mat matrix);

  /// Solves for all columns of `right`, which is overwritten by the solution.
  /// @throws ConvergenceError where the residual of a probing column is not small, even after some
  /// steps of iterative refinement.
  void solve(Eigen::MatrixXd& right);

 private:
  double compute_residual(const Eigen::MatrixXd& right) const;
  void take_pivoting_solver();

  std::string prefix_;
  std::function<Equilibration(Mat)> scale_;
  petsc::Handle<KSP> solver_;
  Equilibration scaling_;
  Mat matrix_ = nullptr;
  Eigen::MatrixXd solution_;  ///< kept: large arrays cost more to get than to fill
  Eigen::Index probe_ = 0;
};

/// The real part of an eigenvector, whose phase is free, where its largest entry is real.
Eigen::VectorXd real_part(const Eigen::VectorXcd& vector);

/// A B by BLAS; `c` is resized where it must be.
Eigen::MatrixXd multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
void multiply(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::MatrixXd& b,
              Eigen::MatrixXd& c);

/// exp(A) by SLEPc.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix);

/// The rows of a PETSc matrix on one rank as an Eigen sparse matrix.
Eigen::SparseMatrix<double> to_sparse(Mat matrix);

/// Eigenvalues and right eigenvectors (columns, 2-norm 1) of a dense real matrix by SLEPc.
struct Eigenpairs {
  std::vector<std::complex<double>> values;
  Eigen::MatrixXcd vectors;
  std::vector<double> residuals;  ///< |A v - lambda v| / |v|
};

/// @throws InputError naming an option that asks SLEPc for other eigenpairs than all.
void require_whole_spectrum(const std::string& prefix);

/// @throws InputError as above, ConvergenceError where eigenpairs are missing.
Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix, const std::string& prefix);

/// |y| |x| / |y.x| of left and right eigenvectors, by which errors of the matrix are in an
/// eigenvalue at the most: 1 of a normal matrix, infinite where eigenvectors coincide.
Eigen::VectorXd condition_numbers(const Eigenpairs& pairs);

}  // namespace samara::analysis
