// Linear algebra of the analyses: a scaled direct solver for many right-hand sides, the
// dense product and the dense eigenproblem.
#pragma once

#include <complex>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

struct Ranks;

/// Row and column factors that bring the largest entry of every row and column near one.
struct Equilibration {
  petsc::Handle<Vec> rows;
  petsc::Handle<Vec> columns;
};

Equilibration equilibrate(Mat matrix);

/// Scales `matrix` in place by both factors; faster than MatDiagonalScale for block matrices.
void apply_scaling(const Equilibration& scaling, Mat matrix);

/// The factors rounded to powers of two: scaling with them and back loses no digit.
void round_to_powers_of_two(Equilibration& scaling);

/// Factors from the roles of unknowns: positions 1, velocities `rate` [1/s], internal loads the
/// median inertia load that belongs to them; rows by their largest entry. The condition number of
/// the matrix of (19) is 6e17 unscaled, 1e8 equilibrated and 2e3 with these factors (the paper's
/// turbine, 500 steps). The same holds for the pivot blocks of the elimination.
/// `ranks`: each has a part of the entries; null: this rank has all of them.
Equilibration scale_by_role(const system::PeriodicSystem& system, Mat matrix, double rate);
Equilibration scaling_by_role(const system::PeriodicSystem& system,
                              const Eigen::SparseMatrix<double>& matrix, double rate,
                              double least_load = 0.0, const Ranks* ranks = nullptr);

/// A matrix without an inverse.
class SingularError : public ConvergenceError {
  using ConvergenceError::ConvergenceError;
};

/// Reason why a factorization failed.
struct FactorFailure {
  PCFailedReason reason = PC_NOERROR;  ///< PC_NOERROR: it succeeded
  std::string words;                   ///< message of the solver
  std::string hint;                    ///< empty where the matrix is singular
  bool is_singular = false;            ///< as reported by the solver
  bool wants_room = false;             ///< a larger work array may help
};

/// Sets up a solver with new operators, and so factors them. If MUMPS needs a larger work array
/// than it has estimated, it gets one, unless an option sets the size.
/// @throws InternalError where there is not enough memory.
FactorFailure set_up(KSP solver);

template <class Scalar>
class BlockFactors;

/// LU factorization with fixed scaling: all later matrices of a pattern use that of the first one.
/// Matrices of blocks are factored by BlockFactors, others by PETSc's LU, and those that need rows
/// interchanged by MUMPS. Options of the KSP or its preconditioner choose PETSc's solver.
class DirectSolver {
 public:
  /// `prefix` of the KSP's options, e.g. "floquet_"; `scale` returns the factors for a matrix.
  DirectSolver(std::string prefix, std::function<Equilibration(Mat)> scale);
  DirectSolver(DirectSolver&&) noexcept;
  DirectSolver& operator=(DirectSolver&&) noexcept;
  ~DirectSolver();

  /// Factors `matrix`, which is scaled in place.
  /// @throws SingularError where the matrix is singular, ConvergenceError where the factorization
  /// fails for another reason.
  void factor(Mat matrix);

  /// Solves for all columns of `right`, which is overwritten by the solution.
  /// @throws ConvergenceError where the residual of a probing column is not small, even after some
  /// steps of iterative refinement. Of the solves by blocks with the same factors, number 1, 2, 4,
  /// 8, ... are probed, and all that follow one that needed refinement.
  void solve(Eigen::MatrixXd& right);

  /// Of the factored matrices.
  const Equilibration& scaling() const { return scaling_; }

 private:
  double compute_residual(const Eigen::VectorXd& x, const Eigen::VectorXd& right) const;
  bool is_solver_given() const;
  void factor_by_petsc();
  void take_pivoting_solver();
  bool solve_by_blocks(Eigen::MatrixXd& right);
  void solve_by_petsc(Eigen::MatrixXd& right);

  std::string prefix_;
  std::function<Equilibration(Mat)> scale_;
  std::unique_ptr<BlockFactors<double>> blocks_;  ///< null: PETSc solves
  petsc::Handle<KSP> solver_;
  bool pivots_ = false;  ///< MUMPS interchanges rows, unless an option chooses another solver
  Equilibration scaling_;
  Mat matrix_ = nullptr;
  Eigen::MatrixXd solution_;  ///< kept: allocation of large arrays takes longer than filling
  Eigen::Index probe_ = 0;
  unsigned solves_ = 0;            ///< by blocks, with the present factors
  bool needs_refinement_ = false;  ///< a solve with these factors has needed it
};

/// Real part of an eigenvector after a phase shift that makes its largest entry real.
Eigen::VectorXd real_part(const Eigen::VectorXcd& vector);

/// A B by BLAS; `c` is resized if necessary.
Eigen::MatrixXd multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
void multiply(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::MatrixXd& b,
              Eigen::MatrixXd& c);

/// A^H B and A^T B of complex matrices by BLAS.
Eigen::MatrixXcd multiply_adjoint(const Eigen::Ref<const Eigen::MatrixXcd>& a,
                                  const Eigen::Ref<const Eigen::MatrixXcd>& b);
Eigen::MatrixXcd multiply_transpose(const Eigen::Ref<const Eigen::MatrixXcd>& a,
                                    const Eigen::Ref<const Eigen::MatrixXcd>& b);

/// C = A B + `c_factor` C for a sparse matrix by rows and many columns; faster than Eigen's
/// product, which goes through A once for each column. `c` is resized where the factor is zero.
void multiply(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a, const Eigen::MatrixXd& b,
              Eigen::MatrixXd& c, double c_factor = 0.0);

/// exp(A) by SLEPc.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix);

/// The rows of a PETSc matrix on one rank as an Eigen sparse matrix, without entries of zero.
Eigen::SparseMatrix<double, Eigen::RowMajor> to_sparse_rows(Mat matrix);
Eigen::SparseMatrix<double> to_sparse(Mat matrix);

/// Eigenvalues and right eigenvectors (columns, 2-norm 1) of a dense real matrix by SLEPc.
struct Eigenpairs {
  std::vector<std::complex<double>> values;
  Eigen::MatrixXcd vectors;
  std::vector<double> residuals;  ///< |A v - lambda v| / |v|
};

/// @throws InputError that names an option by which SLEPc would not find all eigenpairs.
void require_whole_spectrum(const std::string& prefix);

/// @throws InputError as above, ConvergenceError where eigenpairs are missing.
Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix, const std::string& prefix);

/// Eigenvalues of a dense real matrix, without eigenvectors, by LAPACK.
/// @throws ConvergenceError
std::vector<std::complex<double>> dense_eigenvalues(Eigen::MatrixXd matrix);

/// A real matrix given by its product with a vector.
using LinearMap = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// At least `count` eigenvalues of a real matrix of `size` rows, those of largest modulus, by
/// Krylov-Schur (SLEPc) with a residual below `tolerance` relative to each. Fewer where they do not
/// converge, and few of many that are equal.
std::vector<std::complex<double>> largest_eigenvalues(Eigen::Index size, const LinearMap& map,
                                                      int count, double tolerance);

/// |y| |x| / |y.x| of left and right eigenvectors: the largest factor from an error of the matrix
/// to the error of an eigenvalue. It is 1 for a normal matrix, and infinite where eigenvectors
/// coincide.
Eigen::VectorXd condition_numbers(const Eigenpairs& pairs);

}  // namespace samara::analysis
