#include "complex_solver.hpp"

#include <utility>

#include "samara/base/error.hpp"
#include "samara/petsc/options.hpp"

namespace samara::analysis {
namespace {

constexpr PetscInt most_iterations = 300;
constexpr PetscInt restart = 60;

void read(Vec vector, Eigen::VectorXcd& x) {
  const petsc::ReadView view(vector);
  const Eigen::Index n = x.size();
  x.real() = Eigen::Map<const Eigen::VectorXd>(view.data(), n);
  x.imag() = Eigen::Map<const Eigen::VectorXd>(view.data() + n, n);
}

void write(const Eigen::VectorXcd& x, Vec vector) {
  const petsc::WriteView view(vector);
  const Eigen::Index n = x.size();
  Eigen::Map<Eigen::VectorXd>(view.data(), n) = x.real();
  Eigen::Map<Eigen::VectorXd>(view.data() + n, n) = x.imag();
}

}  // namespace

template <class Call>
PetscErrorCode ComplexSolver::apply(const Call& call, Vec x, Vec y) {
  try {
    read(x, in_);
    call(in_, out_);
    write(out_, y);
  } catch (...) {
    error_ = std::current_exception();
    return PETSC_ERR_USER;
  }
  return 0;
}

PetscErrorCode ComplexSolver::multiply(Mat matrix, Vec x, Vec y) {
  ComplexSolver* self = nullptr;
  PetscCall(MatShellGetContext(matrix, &self));
  return self->apply(self->matrix_map_, x, y);
}

PetscErrorCode ComplexSolver::precondition(PC preconditioner, Vec x, Vec y) {
  ComplexSolver* self = nullptr;
  PetscCall(PCShellGetContext(preconditioner, &self));
  return self->apply(self->preconditioner_map_, x, y);
}

ComplexSolver::ComplexSolver(Eigen::Index size, Map matrix, Map preconditioner, double tolerance,
                             const std::string& prefix, MPI_Comm comm)
    : matrix_map_(std::move(matrix)),
      preconditioner_map_(std::move(preconditioner)),
      in_(size),
      out_(size) {
  const auto n = static_cast<PetscInt>(2 * size);
  petsc::check(MatCreateShell(comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, this, matrix_.fill()));
  petsc::check(
      MatShellSetOperation(matrix_.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
  right_ = petsc::make_vector(comm, n, PETSC_DETERMINE);
  solution_ = petsc::make_vector(comm, n, PETSC_DETERMINE);
  petsc::check(KSPCreate(comm, solver_.fill()));
  KSP solver = solver_.get();
  petsc::check(KSPSetOptionsPrefix(solver, prefix.c_str()));
  petsc::check(KSPSetOperators(solver, matrix_.get(), matrix_.get()));
  petsc::check(KSPSetType(solver, KSPFGMRES));
  petsc::check(KSPGMRESSetRestart(solver, restart));
  petsc::check(KSPSetPCSide(solver, PC_RIGHT));
  petsc::check(KSPSetTolerances(solver, tolerance, 0.0, PETSC_DEFAULT, most_iterations));
  PC shell = nullptr;
  petsc::check(KSPGetPC(solver, &shell));
  petsc::check(PCSetType(shell, PCSHELL));
  petsc::check(PCShellSetContext(shell, this));
  petsc::check(PCShellSetApply(shell, precondition));
  petsc::take_options(KSPSetFromOptions, solver);
}

void ComplexSolver::solve(const Vector& right, Vector& x) {
  write(right, right_.get());
  const PetscErrorCode code = KSPSolve(solver_.get(), right_.get(), solution_.get());
  if (code != 0 && error_) std::rethrow_exception(error_);
  if (code == PETSC_ERR_SUP) {
    const char* prefix = nullptr;
    petsc::check(KSPGetOptionsPrefix(solver_.get(), &prefix));
    throw InputError("floquet: PETSc does not support these options of -" + std::string(prefix) +
                     " together; hint: the solver is flexible GMRES, with a right preconditioner");
  }
  petsc::check(code);
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  petsc::check(KSPGetConvergedReason(solver_.get(), &reason));
  if (reason < 0)
    throw ConvergenceError(
        std::string("floquet: a linear solve of Hill's method does not converge (") +
        KSPConvergedReasons[reason] + ")");
  x.resize(in_.size());
  read(solution_.get(), x);
}

}  // namespace samara::analysis
