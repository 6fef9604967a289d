// Iterative solution of complex linear systems by PETSc, whose scalars are real here.
#pragma once

#include <complex>
#include <exception>
#include <functional>
#include <string>

#include <Eigen/Core>
#include <mpi.h>

#include "samara/petsc/handle.hpp"

namespace samara::analysis {

/// Flexible GMRES with a right preconditioner, on vectors of all real parts and all imaginary
/// parts. Options of PETSc's KSP with a prefix.
class ComplexSolver {
 public:
  using Vector = Eigen::VectorXcd;
  /// Writes the product with the first vector into the second one.
  using Map = std::function<void(const Vector&, Vector&)>;

  /// `matrix` and `preconditioner` (an approximate inverse) of size x size. Each rank of `comm` has
  /// a part of the vectors, of its own size.
  ComplexSolver(Eigen::Index size, Map matrix, Map preconditioner, double tolerance,
                const std::string& prefix, MPI_Comm comm);
  ComplexSolver(const ComplexSolver&) = delete;
  ComplexSolver& operator=(const ComplexSolver&) = delete;
  ~ComplexSolver() = default;

  /// @throws ConvergenceError
  void solve(const Vector& right, Vector& x);

 private:
  template <class Call>
  PetscErrorCode apply(const Call& call, Vec x, Vec y);
  static PetscErrorCode multiply(Mat matrix, Vec x, Vec y);
  static PetscErrorCode precondition(PC preconditioner, Vec x, Vec y);

  Map matrix_map_;
  Map preconditioner_map_;
  Vector in_, out_;
  petsc::Handle<Mat> matrix_;
  petsc::Handle<KSP> solver_;
  petsc::Handle<Vec> right_, solution_;
  std::exception_ptr error_;
};

}  // namespace samara::analysis
