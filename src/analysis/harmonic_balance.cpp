#include "samara/analysis/harmonic_balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/options.hpp"
#include "samara/petsc/session.hpp"

#include "harmonic_preconditioner.hpp"
#include "harmonic_tangents.hpp"
#include "mesh_partition.hpp"

namespace samara::analysis {
namespace {

/// Relative to Unknown::scale: least size of a state in the measure of its residual.
constexpr double least_state = 1e-3;
/// The same for a medium: stations without load have no weight.
constexpr double least_medium = 0.1;
/// Least number of instants at which the sizes of terms are taken.
constexpr int instants_of_sizes = 16;

/// Residual of a state outside the domain of the equations, by the last one inside.
constexpr double beyond_domain = 10.0;

/// Scaled residual that counts as round-off.
constexpr double vanished = 1e-13;
/// Relative change of a vector by scaling and scaling back.
constexpr double same = 1e-14;

/// GMRES: reduction of the residual of a linear system, iterations of one solve, and those up to
/// which the factors of an earlier tangent are kept.
constexpr double linear_tolerance = 1e-10;
constexpr PetscInt most_iterations = 60;
constexpr PetscInt few_iterations = 15;
/// Residual of a linear system that is enough, relative to the residual that Newton's method aims
/// at. With long chains round-off is above the reduction by linear_tolerance.
constexpr double enough_for_newton = 1e-3;
/// Reduction with which the most iterations of a solve still give a step.
constexpr double least_reduction = 1e-3;
/// Largest number of entries of a matrix that is factored because GMRES does not converge.
constexpr double most_entries = 2e8;

/// A start whose residual is this small against that of the undeformed system, and the steps for
/// which a tangent serves from there.
constexpr double near_solution = 0.05;
constexpr PetscInt steps_near_solution = 3;

/// Newton's method: line search, number of steps, and steps for which a tangent serves near the
/// solution.
struct NewtonLimits {
  const char* line_search = SNESLINESEARCHBT;
  int most_steps = 50;
  PetscInt steps_of_tangent = steps_near_solution;
};

/// For `release`. A change of a controller's pitch needs full Newton steps: each of them first
/// raises the residual of the rotations, and a line search would shorten the step.
constexpr NewtonLimits full_steps{SNESLINESEARCHBASIC, 15, 1};
/// Smallest part of the loads on free coordinates that one step removes.
constexpr double least_release = 1.0 / 64.0;
/// Largest change of an angle in a step of this homotopy [rad].
constexpr double largest_turn = 0.5;

/// A constant load in a row.
struct RowLoad {
  PetscInt row = 0;
  double load = 0.0;
};

/// The equations of harmonic balance. Unknown (i, c) is coefficient c of unknown i on this rank and
/// has number i (2 H + 1) + c; the load that holds a coordinate takes the place of the coordinate's
/// mean.
class Balance {
 public:
  /// `given`: additional constant loads.
  Balance(const MeshPartition& partition, const HarmonicTangents& tangents, const Coordinates& held,
          const std::vector<RowLoad>& given, int harmonics)
      : partition_(partition),
        tangents_(tangents),
        system_(partition.system()),
        held_(held),
        given_(given),
        harmonics_(harmonics),
        samples_(sample_count(system_, harmonics)),
        width_(2 * harmonics + 1),
        size_(partition.size()),
        z_(system_.make_state()),
        z_dot_(system_.make_state()),
        r_(system_.make_state()) {}

  Eigen::Index width() const { return width_; }
  /// On all ranks.
  Eigen::Index unknowns() const { return partition_.size_of_all(); }
  const MeshPartition& partition() const { return partition_; }

  /// Zero where another rank has the unknown.
  PeriodicSolution own_solution(const PetscScalar* h) const {
    return without_held(
        partition_.own(Eigen::Map<const Eigen::MatrixXd>(h, width_, size_)).transpose());
  }

  /// The same on all ranks.
  PeriodicSolution whole_solution(const PetscScalar* h) const {
    return without_held(
        partition_.whole(Eigen::Map<const Eigen::MatrixXd>(h, width_, size_)).transpose());
  }

  std::vector<double> loads(const PetscScalar* h) const {
    std::vector<double> loads;
    for (const system::UnconstrainedCoordinate& coordinate : held_)
      loads.push_back(h[partition_.number_of(coordinate.unknown) * width_]);
    return loads;
  }

  /// The rows of the border are complete on each rank. Those that the tangents defer have their own
  /// unknown only.
  void residual(const PetscScalar* h, PetscScalar* out) {
    complete_residual(h, out);
    const Eigen::Map<const Eigen::MatrixXd> unknowns(h, width_, size_);
    Eigen::Map<Eigen::MatrixXd> result(out, width_, size_);
    for (const HarmonicTangents::Deferred& deferred : tangents_.deferred())
      result.col(deferred.number) = unknowns.col(deferred.number);
  }

  /// Sets the unknowns of these rows to zero.
  void drop_deferred(PetscScalar* h) const {
    Eigen::Map<Eigen::MatrixXd> unknowns(h, width_, size_);
    for (const HarmonicTangents::Deferred& deferred : tangents_.deferred())
      unknowns.col(deferred.number).setZero();
  }

  /// Sets them to the solutions of the rows.
  void solve_deferred(PetscScalar* h) {
    if (partition_.ranks().all(tangents_.deferred().empty())) return;
    drop_deferred(h);
    Eigen::MatrixXd rows(width_, size_);
    complete_residual(h, rows.data());
    Eigen::Map<Eigen::MatrixXd> unknowns(h, width_, size_);
    for (const HarmonicTangents::Deferred& deferred : tangents_.deferred())
      unknowns.col(deferred.number) = -rows.col(deferred.number) / deferred.factor;
  }

  /// Largest coefficient of a balance row.
  double largest_load(const PetscScalar* h) {
    Eigen::MatrixXd rows(width_, size_);
    residual(h, rows.data());
    double largest = 0.0;
    for (Eigen::Index i = 0; i < size_; ++i)
      if (system_
              .rows()[static_cast<std::size_t>(partition_.kept()[static_cast<std::size_t>(i)])] ==
          system::RowRole::balance)
        largest = std::max(largest, rows.col(i).lpNorm<Eigen::Infinity>());
    return partition_.ranks().largest(largest);
  }

 private:
  void complete_residual(const PetscScalar* h, PetscScalar* out) {
    Eigen::Map<Eigen::MatrixXd> result(out, width_, size_);
    result.setZero();
    partition_.ranks().attempt([&] { add_samples(own_solution(h), result); });
    partition_.sum_border(result);
    tangents_.sector().drop_absent(result);
    const std::vector<double> held = loads(h);
    for (std::size_t n = 0; n < held_.size(); ++n)
      result(0, partition_.number_of(held_[n].row)) += held[n];
    for (const RowLoad& given : given_) result(0, partition_.number_of(given.row)) += given.load;
  }

  PeriodicSolution without_held(Eigen::MatrixXd coefficients) const {
    for (const system::UnconstrainedCoordinate& coordinate : held_)
      coefficients(coordinate.unknown, 0) = coordinate.mean;
    return {std::move(coefficients), system_.period()};
  }

  void add_samples(const PeriodicSolution& solution, Eigen::Map<Eigen::MatrixXd>& result) {
    for (int k = 0; k < samples_; ++k) {
      const double t = time_of(k);
      solution.evaluate(t, z_.get(), z_dot_.get());
      system_.residual(t, z_.get(), z_dot_.get(), r_.get());
      const petsc::ReadView view(r_.get());
      const Eigen::Map<const Eigen::VectorXd> r(view.data(), system_.size());
      result += projection(t) * r(partition_.kept()).transpose();
    }
  }

  double period() const { return system_.period() > 0.0 ? system_.period() : 1.0; }
  double time_of(int k) const { return system_.period() * k / samples_; }

  Eigen::VectorXd projection(double t) const {
    return fourier_weights(harmonics_, period(), t, samples_);
  }

  const MeshPartition& partition_;
  const HarmonicTangents& tangents_;      ///< know the harmonics of the unknowns, once sampled
  const system::PeriodicSystem& system_;  ///< part of this rank
  const Coordinates& held_;
  const std::vector<RowLoad>& given_;
  int harmonics_;
  int samples_;
  int width_;
  Eigen::Index size_;
  petsc::Handle<Vec> z_;
  petsc::Handle<Vec> z_dot_;
  petsc::Handle<Vec> r_;
};

/// A linear system that the preconditioner of the harmonics does not solve.
class LinearFailure : public ConvergenceError {
  using ConvergenceError::ConvergenceError;
};

/// Context of the callbacks of SNES and its linear solver: unknowns and rows are scaled. Vectors of
/// PETSc have the unknowns that the ranks count; all others have the unknowns on this rank.
struct SolverContext {
  Balance* balance = nullptr;
  HarmonicTangents* tangents = nullptr;
  HarmonicPreconditioner* preconditioner = nullptr;  ///< null: the matrix is assembled and factored
  const Eigen::VectorXd* start = nullptr;  ///< that `tangents` belong to; null after the first use
  Eigen::VectorXd rows;                    ///< factors
  Eigen::VectorXd columns;
  Eigen::VectorXd unscaled;
  bool is_factored = false;
  double size = -1.0;  ///< norm of the last residual; negative: none yet
  std::exception_ptr error;

  Eigen::VectorXd spread(Vec x) const {
    const petsc::ReadView view(x);
    Eigen::MatrixXd values(balance->width(), balance->partition().size());
    balance->partition().spread(view.data(), values);
    return values.reshaped();
  }
  void collect(const Eigen::VectorXd& values, Vec x) const {
    const petsc::WriteView view(x);
    balance->partition().collect(values.reshaped(balance->width(), balance->partition().size()),
                                 view.data());
  }

  const PetscScalar* unscale(Vec x) {
    unscaled = spread(x).cwiseProduct(columns);
    return unscaled.data();
  }

  /// x = values / columns.
  void scale(const Eigen::VectorXd& values, Vec x) const {
    collect(values.cwiseQuotient(columns), x);
  }
};

PetscErrorCode form_function(SNES snes, Vec x, Vec f, void* pointer) noexcept {
  auto& context = *static_cast<SolverContext*>(pointer);
  try {
    Eigen::VectorXd residual(context.rows.size());
    context.balance->residual(context.unscale(x), residual.data());
    context.collect(residual.cwiseProduct(context.rows), f);
    if (const PetscErrorCode code = VecNorm(f, NORM_2, &context.size)) return code;
    context.error = nullptr;  // an error in a line search is no cause of a later failure
  } catch (const DomainError&) {
    context.error = std::current_exception();
    if (context.size < 0.0) return SNESSetFunctionDomainError(snes);
    // A larger residual makes the line search shorten the step.
    PetscInt size = 0;
    if (const PetscErrorCode code = VecGetSize(f, &size)) return code;
    return VecSet(f, beyond_domain * context.size / std::sqrt(static_cast<double>(size)));
  } catch (...) {
    context.error = std::current_exception();
    return PETSC_ERR_USER;
  }
  return 0;
}

/// y = J x of the shell matrix, without an assembled J.
PetscErrorCode multiply_tangents(Mat matrix, Vec x, Vec y) noexcept {
  void* pointer = nullptr;
  if (const PetscErrorCode code = MatShellGetContext(matrix, &pointer)) return code;
  auto& context = *static_cast<SolverContext*>(pointer);
  try {
    const Eigen::VectorXd in = context.spread(x).cwiseProduct(context.columns);
    Eigen::VectorXd out(in.size());
    context.tangents->multiply(in.data(), out.data());
    context.collect(out.cwiseProduct(context.rows), y);
  } catch (...) {
    context.error = std::current_exception();
    return PETSC_ERR_USER;
  }
  return 0;
}

/// @throws LinearFailure
void factor_harmonics(SolverContext& context) {
  if (!context.preconditioner->factor(context.rows, context.columns))
    throw LinearFailure("trim: the preconditioner of the harmonics is singular");
  context.is_factored = true;
}

PetscErrorCode apply_preconditioner(PC preconditioner, Vec x, Vec y) noexcept {
  void* pointer = nullptr;
  if (const PetscErrorCode code = PCShellGetContext(preconditioner, &pointer)) return code;
  auto& context = *static_cast<SolverContext*>(pointer);
  try {
    if (!context.is_factored) factor_harmonics(context);  // -trim_snes_mf: tangents of the start
    const Eigen::VectorXd in = context.spread(x);
    Eigen::VectorXd out(in.size());
    context.preconditioner->solve(in.data(), out.data());
    context.collect(out, y);
  } catch (...) {
    context.error = std::current_exception();
    return PETSC_ERR_USER;
  }
  return 0;
}

/// Factors the matrix here and not in SNES, which would only report that the linear solve failed.
void factor(SNES snes, Mat operators, Mat matrix) {
  KSP linear = nullptr;
  PetscInt iterations = 0;
  petsc::check(SNESGetKSP(snes, &linear));
  petsc::check(SNESGetIterationNumber(snes, &iterations));
  petsc::check(KSPSetOperators(linear, operators, matrix));
  const FactorFailure failure = set_up(linear);
  if (failure.reason == PC_NOERROR) return;
  const std::string text =
      "trim: " + failure.words + " after " + std::to_string(iterations) + " Newton steps; hint: ";
  if (!failure.is_singular) throw ConvergenceError(text + failure.hint);
  throw SingularError(
      text + (iterations == 0 ? "a coordinate may move that nothing holds, or a part is held twice"
                              : "-trim_snes_monitor shows the steps; a smaller load or a "
                                "stiffer blade shows whether a steady state exists"));
}

/// Whether the factors of an earlier tangent served well in the last linear solve.
bool factors_serve(SNES snes, const SolverContext& context) {
  KSP linear = nullptr;
  PetscInt iterations = 0;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  petsc::check(SNESGetKSP(snes, &linear));
  petsc::check(KSPGetConvergedReason(linear, &reason));
  petsc::check(KSPGetIterationNumber(linear, &iterations));
  return context.is_factored && reason > 0 && iterations <= few_iterations;
}

/// Scales the rows and columns of an assembled matrix.
void scale(SolverContext& context, Mat matrix) {
  const auto n = static_cast<PetscInt>(context.rows.size());
  petsc::Handle<Vec> rows;
  petsc::Handle<Vec> columns;
  petsc::check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, context.rows.data(), rows.fill()));
  petsc::check(
      VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, context.columns.data(), columns.fill()));
  petsc::check(MatDiagonalScale(matrix, rows.get(), columns.get()));
}

PetscErrorCode form_jacobian(SNES snes, Vec x, Mat operators, Mat matrix, void* pointer) noexcept {
  auto& context = *static_cast<SolverContext*>(pointer);
  try {
    const PetscScalar* h = context.unscale(x);
    const Ranks& ranks = context.balance->partition().ranks();
    const bool is_start =
        context.start != nullptr &&
        ranks.all((context.unscaled - *context.start).norm() <= same * context.start->norm());
    if (!is_start) {
      try {
        context.tangents->sample(context.balance->own_solution(h));
      } catch (const DomainError&) {  // those before serve: the residual tells of the next state
        context.error = std::current_exception();
      }
    }
    context.start = nullptr;
    if (context.preconditioner != nullptr) {
      if (!factors_serve(snes, context)) factor_harmonics(context);
      petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
      petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    } else {
      context.tangents->fill(matrix);
      scale(context, matrix);
    }
    if (operators != matrix) {  // -trim_snes_mf_operator
      petsc::check(MatAssemblyBegin(operators, MAT_FINAL_ASSEMBLY));
      petsc::check(MatAssemblyEnd(operators, MAT_FINAL_ASSEMBLY));
    }
    if (context.preconditioner == nullptr) factor(snes, operators, matrix);
  } catch (...) {
    context.error = std::current_exception();
    return PETSC_ERR_USER;
  }
  return 0;
}

void fail(SNES solver, const SolverContext& context) {
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  PetscReal norm = 0.0;
  petsc::check(SNESGetConvergedReason(solver, &reason));
  petsc::check(SNESGetIterationNumber(solver, &iterations));
  petsc::check(SNESGetFunctionNorm(solver, &norm));
  std::ostringstream text;
  if (reason == SNES_DIVERGED_LINEAR_SOLVE) {
    KSP linear = nullptr;
    KSPConvergedReason linear_reason = KSP_CONVERGED_ITERATING;
    petsc::check(SNESGetKSP(solver, &linear));
    petsc::check(KSPGetConvergedReason(linear, &linear_reason));
    text << "trim: the linear solve failed after " << iterations << " Newton steps ("
         << KSPConvergedReasons[linear_reason]
         << "); hint: leave -trim_ksp and -trim_pc options out";
    throw ConvergenceError(text.str());
  }
  text << "trim: " << SNESConvergedReasons[reason] << " after " << iterations
       << " Newton steps, scaled residual " << norm;
  if (context.error) {
    try {
      std::rethrow_exception(context.error);
    } catch (const std::exception& error) {
      text << " (" << error.what() << ")";
    }
  }
  text << "; hint: more or fewer trim.harmonics; -trim_snes_monitor shows the steps, "
          "-trim_snes_max_it raises their number; a smaller load or a stiffer blade shows whether "
          "a steady state exists";
  throw ConvergenceError(text.str());
}

/// Settings that MUMPS chooses badly here; an option of the user has priority. (MatMumpsSetIcntl
/// before the first factorization has no effect in PETSc 3.18.)
/// - 7: the ordering by METIS suits larger meshes; for a chain of blocks approximate minimum fill
///   causes half as much fill-in.
/// - 6: the permutation to a large diagonal comes with a scaling. Both use the values of the first
///   matrix and are kept for later ones, whose factors they can make useless. Rows and columns are
///   already equilibrated.
class PreferredFactorization {
 public:
  PreferredFactorization() {
    for (std::size_t i = 0; i < choices.size(); ++i) {
      PetscBool given = PETSC_FALSE;
      petsc::check(PetscOptionsHasName(nullptr, nullptr, choices[i].option, &given));
      set_[i] = given == PETSC_FALSE;
      if (set_[i]) petsc::check(PetscOptionsSetValue(nullptr, choices[i].option, choices[i].value));
    }
  }
  ~PreferredFactorization() {
    for (std::size_t i = 0; i < choices.size(); ++i)
      if (set_[i]) PetscOptionsClearValue(nullptr, choices[i].option);
  }
  PreferredFactorization(const PreferredFactorization&) = delete;
  PreferredFactorization& operator=(const PreferredFactorization&) = delete;

 private:
  struct Choice {
    const char* option;
    const char* value;
  };
  static constexpr std::array<Choice, 2> choices{
      {{"-trim_mat_mumps_icntl_7", "2"}, {"-trim_mat_mumps_icntl_6", "0"}}};
  std::array<bool, choices.size()> set_{};
};

/// (2 H + 1) x unknowns of the system.
Eigen::MatrixXd start_coefficients(const system::PeriodicSystem& system, int harmonics,
                                   const PeriodicSolution* start) {
  const auto n = static_cast<Eigen::Index>(system.size());
  Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(2 * harmonics + 1, n);
  if (start != nullptr) {
    const Eigen::Index columns = std::min(coefficients.rows(), start->coefficients().cols());
    coefficients.topRows(columns) = start->coefficients().leftCols(columns).transpose();
  } else {
    const petsc::Handle<Vec> z = system.make_state();
    const int samples = system.constraints_are_autonomous() ? 1 : sample_count(system, harmonics);
    for (int k = 0; k < samples; ++k) {
      const double t = system.period() * k / samples;
      system.reference_state(t, z.get());
      const petsc::ReadView view(z.get());
      const Eigen::Map<const Eigen::RowVectorXd> values(view.data(), n);
      if (samples == 1)
        coefficients.row(0) = values;
      else
        coefficients += fourier_weights(harmonics, system.period(), t, samples) * values;
    }
  }
  return coefficients;
}

/// Norm of the scaled residual.
double residual_at(const Eigen::VectorXd& h, SolverContext& context) {
  const MeshPartition& partition = context.balance->partition();
  Eigen::VectorXd f(h.size());
  context.balance->residual(h.data(), f.data());
  f.array() *= context.rows.array();
  Eigen::VectorXd counted(context.balance->width() *
                          static_cast<Eigen::Index>(partition.counted().size()));
  partition.collect(f.reshaped(context.balance->width(), partition.size()), counted.data());
  Eigen::VectorXd square = Eigen::VectorXd::Constant(1, counted.squaredNorm());
  partition.ranks().sum(square);
  return std::sqrt(square(0));
}

/// Whether an option chooses a preconditioner or a matrix that the harmonics' own does not serve.
bool is_direct_solver_given() {
  const std::string options = petsc::Session::options();
  const auto is_there = [&](const char* text) { return options.find(text) != std::string::npos; };
  return is_there("-trim_pc_") || is_there("-trim_mat_") || is_there("-trim_ksp_type preonly");
}

/// Convergence of GMRES: PETSc's default, or a residual that is enough for Newton's method.
struct LinearTest {
  void* of_petsc = nullptr;
  SNES newton = nullptr;
  double of_newton = -1.0;  ///< residual at the start of Newton's method; negative: not known
  double first = 0.0;       ///< residual at the start of the present solve
};

PetscErrorCode test_linear(KSP solver, PetscInt iteration, PetscReal norm,
                           KSPConvergedReason* reason, void* pointer) noexcept {
  auto& test = *static_cast<LinearTest*>(pointer);
  if (iteration == 0) test.first = norm;
  if (test.of_newton < 0.0) test.of_newton = norm;
  PetscReal least = 0.0;
  PetscReal relative = 0.0;
  PetscInt most = 0;
  PetscErrorCode code = KSPConvergedDefault(solver, iteration, norm, reason, test.of_petsc);
  if (code == 0)
    code = SNESGetTolerances(test.newton, &least, &relative, nullptr, nullptr, nullptr);
  if (code == 0) code = KSPGetTolerances(solver, nullptr, nullptr, nullptr, &most);
  if (code != 0 || *reason != KSP_CONVERGED_ITERATING) return code;
  if (norm <= enough_for_newton * std::max(least, relative * test.of_newton))
    *reason = KSP_CONVERGED_ATOL;
  else if (iteration >= most && norm <= least_reduction * test.first)
    *reason = KSP_CONVERGED_ITS;
  return 0;
}

PetscErrorCode destroy_linear_test(void* pointer) noexcept {
  const auto* test = static_cast<LinearTest*>(pointer);
  const PetscErrorCode code = KSPConvergedDefaultDestroy(test->of_petsc);
  delete test;
  return code;
}

/// KSP and PC of a SNES, before its options.
void choose_linear_solver(SNES solver, SolverContext& context) {
  KSP linear = nullptr;
  PC preconditioner = nullptr;
  petsc::check(SNESGetKSP(solver, &linear));
  petsc::check(KSPGetPC(linear, &preconditioner));
  if (context.preconditioner == nullptr) {
    petsc::check(KSPSetType(linear, KSPPREONLY));
    petsc::check(PCSetType(preconditioner, PCLU));
    petsc::check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
    return;
  }
  petsc::check(KSPSetType(linear, KSPGMRES));
  petsc::check(KSPGMRESSetRestart(linear, most_iterations));
  petsc::check(KSPSetPCSide(linear, PC_RIGHT));
  petsc::check(
      KSPSetTolerances(linear, linear_tolerance, PETSC_DEFAULT, PETSC_DEFAULT, most_iterations));
  auto test = std::make_unique<LinearTest>();
  petsc::check(KSPConvergedDefaultCreate(&test->of_petsc));
  test->newton = solver;
  petsc::check(KSPSetConvergenceTest(linear, test_linear, test.release(), destroy_linear_test));
  petsc::check(PCSetType(preconditioner, PCSHELL));
  petsc::check(PCShellSetName(preconditioner, "harmonics with a border"));
  petsc::check(PCShellSetContext(preconditioner, &context));
  petsc::check(PCShellSetApply(preconditioner, apply_preconditioner));
}

/// What a rank has of the mesh.
std::string words_of(const MeshPartition& partition) {
  const int sectors = partition.sector().sectors;
  std::string words;
  if (sectors > 1) words = ", one of " + std::to_string(sectors) + " blades in the place of all";
  if (partition.is_distributed())
    words += ", mesh on " + std::to_string(partition.ranks().size) + " ranks";
  return words;
}

/// The linear solver that was used, for the report.
std::string words_of_solver(SNES solver, const SolverContext& context) {
  KSP linear = nullptr;
  PC preconditioner = nullptr;
  KSPType type = nullptr;
  PCType kind = nullptr;
  MatSolverType package = nullptr;
  PetscInt iterations = 0;
  petsc::check(SNESGetKSP(solver, &linear));
  petsc::check(KSPGetPC(linear, &preconditioner));
  petsc::check(KSPGetType(linear, &type));
  petsc::check(PCGetType(preconditioner, &kind));
  petsc::check(SNESGetLinearSolveIterations(solver, &iterations));
  const std::string words =
      std::string(type) + ", " + std::to_string(iterations) + " iterations, preconditioned by ";
  if (context.preconditioner != nullptr)
    return words + "harmonics with a border of " +
           std::to_string(context.preconditioner->border_size()) + " of " +
           std::to_string(context.balance->unknowns()) + " unknowns" +
           words_of(context.balance->partition());
  petsc::check(PCFactorGetMatSolverType(preconditioner, &package));
  const std::string name =
      std::string(kind) + (package == nullptr ? "" : std::string(" (") + package + ")");
  return std::string(type) == KSPPREONLY ? name : words + name;
}

petsc::Handle<Mat> make_shell(MPI_Comm comm, PetscInt own, SolverContext& context) {
  petsc::Handle<Mat> matrix;
  petsc::check(
      MatCreateShell(comm, own, own, PETSC_DETERMINE, PETSC_DETERMINE, &context, matrix.fill()));
  petsc::check(MatShellSetOperation(matrix.get(), MATOP_MULT,
                                    reinterpret_cast<void (*)()>(multiply_tangents)));
  return matrix;
}

/// Solves from `start`, or from the undeformed system, to whose residual `tolerance` is relative.
/// Does not set the residuals and the load level.
/// @throws LinearFailure if `tries_harmonics` and the preconditioner of the harmonics fails
Trim solve_by(bool tries_harmonics, const system::PeriodicSystem& system, const Coordinates& held,
              const std::vector<RowLoad>& given, int harmonics, double tolerance,
              const PeriodicSolution* start, const NewtonLimits& limits, MPI_Comm comm) {
  const MeshPartition partition(system, held, tries_harmonics && given.empty(),
                                tries_harmonics ? comm : PETSC_COMM_SELF);
  const Ranks& ranks = partition.ranks();
  HarmonicTangents tangents(partition, held, harmonics, true);
  Balance balance(partition, tangents, held, given, harmonics);
  HarmonicPreconditioner preconditioner(tangents);
  const auto local_start = [&](const PeriodicSolution* from) -> Eigen::VectorXd {
    return partition.local(start_coefficients(system, harmonics, from)).reshaped();
  };
  Eigen::VectorXd h = local_start(start);
  tangents.sample(balance.own_solution(h.data()));
  tangents.sector().drop_absent(h.reshaped(balance.width(), partition.size()));
  balance.drop_deferred(h.data());
  SolverContext context;
  context.balance = &balance;
  context.tangents = &tangents;
  if (tries_harmonics && preconditioner.is_useful()) context.preconditioner = &preconditioner;
  if (context.preconditioner == nullptr && partition.sector().sectors > 1)
    throw LinearFailure("trim: the preconditioner of the harmonics does not serve");
  context.start = &h;
  const Eigen::VectorXd undeformed = local_start(nullptr);
  tangents.scale(balance.largest_load(undeformed.data()), tangents.highest_rate(), context.rows,
                 context.columns);
  const auto width = static_cast<PetscInt>(balance.width());
  const PetscInt own = width * static_cast<PetscInt>(partition.counted().size());
  const petsc::Handle<Mat> matrix = context.preconditioner != nullptr
                                        ? make_shell(ranks.comm, own, context)
                                        : tangents.make_matrix();
  const petsc::Handle<Vec> x = petsc::make_vector(ranks.comm, own, PETSC_DETERMINE);
  const petsc::Handle<Vec> f = petsc::make_vector(ranks.comm, own, PETSC_DETERMINE);
  context.scale(h, x.get());

  petsc::Handle<SNES> solver;
  petsc::check(SNESCreate(ranks.comm, solver.fill()));
  petsc::check(SNESSetOptionsPrefix(solver.get(), "trim_"));
  petsc::check(SNESSetFunction(solver.get(), f.get(), form_function, &context));
  petsc::check(SNESSetJacobian(solver.get(), matrix.get(), matrix.get(), form_jacobian, &context));
  double enough = vanished;
  if (start != nullptr) {
    // The residual of a good start is too small to fall by the factor of the tolerance. But such a
    // start has no values for new harmonics; one step finds them.
    const double whole = residual_at(undeformed, context);
    const double at_start = residual_at(h, context);
    enough = std::max(enough, tolerance * whole);
    if (at_start > vanished) petsc::check(SNESSetForceIteration(solver.get(), PETSC_TRUE));
    if (at_start < near_solution * whole)
      petsc::check(SNESSetLagJacobian(solver.get(), limits.steps_of_tangent));
  }
  petsc::check(SNESSetTolerances(solver.get(), enough, tolerance, 0.0, limits.most_steps, 10000));
  SNESLineSearch search = nullptr;
  petsc::check(SNESGetLineSearch(solver.get(), &search));
  petsc::check(SNESLineSearchSetType(search, limits.line_search));
  choose_linear_solver(solver.get(), context);
  petsc::take_options(SNESSetFromOptions, solver.get());
  const PreferredFactorization factorization;
  const PetscErrorCode code = SNESSolve(solver.get(), nullptr, x.get());
  if (code != 0 && context.error) std::rethrow_exception(context.error);
  if (code == PETSC_ERR_SUP)
    throw InputError("trim: PETSc does not support these options of -trim_ together");
  petsc::check(code);
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  petsc::check(SNESGetConvergedReason(solver.get(), &reason));
  if (reason == SNES_DIVERGED_LINEAR_SOLVE && context.preconditioner != nullptr)
    throw LinearFailure("trim: GMRES with the preconditioner of the harmonics does not converge");
  if (reason < 0) fail(solver.get(), context);
  PetscReal left = 0.0;
  petsc::check(SNESGetFunctionNorm(solver.get(), &left));
  if (reason == SNES_CONVERGED_FNORM_ABS && left > vanished) reason = SNES_CONVERGED_FNORM_RELATIVE;

  context.unscale(x.get());
  balance.solve_deferred(context.unscaled.data());
  const PetscScalar* solution = context.unscaled.data();
  Trim trim{balance.whole_solution(solution),
            TrimMethod::harmonic_balance,
            0,
            SNESConvergedReasons[reason],
            0.0,
            0.0,
            0.0,
            {},
            {}};
  PetscInt steps = 0;
  petsc::check(SNESGetIterationNumber(solver.get(), &steps));
  trim.newton_steps = static_cast<int>(steps);
  trim.linear_solver = words_of_solver(solver.get(), context);
  const std::vector<double> loads = balance.loads(solution);
  for (std::size_t n = 0; n < loads.size(); ++n)
    trim.held.push_back({held[n].name, held[n].unit, loads[n], held[n].unknown});
  return trim;
}

/// As solve_by, with an assembled matrix and its factors where the preconditioner of the harmonics
/// does not serve.
Trim solve(const system::PeriodicSystem& system, const Coordinates& held,
           const std::vector<RowLoad>& given, int harmonics, double tolerance,
           const PeriodicSolution* start, MPI_Comm comm, const NewtonLimits& limits = {}) {
  if (!is_direct_solver_given()) {
    try {
      return solve_by(true, system, held, given, harmonics, tolerance, start, limits, comm);
    } catch (const LinearFailure& failure) {
      const auto pattern = static_cast<double>(find_pattern(system, held).nonZeros());
      const double entries = pattern * std::pow(2.0 * harmonics + 1.0, 2);
      if (entries > most_entries) {
        std::ostringstream text;
        text << failure.what() << ", and a matrix of " << entries
             << " entries is too large to be factored instead; hint: fewer elements or harmonics; "
                "-trim_ksp_type preonly factors it nevertheless";
        throw ConvergenceError(text.str());
      }
    }
  }
  return solve_by(false, system, held, given, harmonics, tolerance, start, limits, comm);
}

/// The start of a trim with free coordinates, whose means are held.
struct HeldStart {
  PeriodicSolution solution;
  std::vector<RowLoad> loads;  ///< that hold the free coordinates
};

/// The forces that restore a hinge (centrifugal force, weight) act through internal loads that the
/// undeformed system does not have, and the integral of a controller gets its value through motions
/// that it does not have: Newton's method diverges from there. Empty without free coordinates, or
/// where this start is not found.
std::optional<HeldStart> hold_free(const system::PeriodicSystem& system, int harmonics,
                                   double tolerance, MPI_Comm comm) {
  const Coordinates free = system.free_coordinates();
  if (free.empty()) return std::nullopt;
  Coordinates held = system.unconstrained_coordinates();
  const std::size_t first = held.size();
  held.insert(held.end(), free.begin(), free.end());
  try {
    const Trim trim = solve(system, held, {}, harmonics, tolerance, nullptr, comm);
    HeldStart start{trim.solution, {}};
    for (std::size_t n = first; n < held.size(); ++n)
      start.loads.push_back({held[n].row, trim.held[n].load});
    return start;
  } catch (const ConvergenceError&) {
    return std::nullopt;
  }
}

/// Whether an angle that was held has turned too far for one step of the homotopy: to another
/// branch.
bool has_turned(const system::PeriodicSystem& system, const PeriodicSolution& from,
                const PeriodicSolution& to) {
  const auto is_far = [&](const system::UnconstrainedCoordinate& free) {
    const Eigen::Index row = free.unknown;
    return system.unknowns()[static_cast<std::size_t>(row)].role == system::UnknownRole::position &&
           std::abs(to.coefficients()(row, 0) - from.coefficients()(row, 0)) > largest_turn;
  };
  const Coordinates free = system.free_coordinates();
  return std::any_of(free.begin(), free.end(), is_far);
}

/// Homotopy: removes the loads that hold the free coordinates in parts, or at once if that
/// converges.
Trim release(const system::PeriodicSystem& system, int harmonics, double tolerance,
             const HeldStart& start, MPI_Comm comm) {
  const Coordinates& held = system.unconstrained_coordinates();
  PeriodicSolution last = start.solution;
  double left = 1.0;  // part of the loads
  double step = 1.0;
  while (step >= least_release) {
    const double next = std::max(left - step, 0.0);
    std::vector<RowLoad> loads = start.loads;
    for (RowLoad& load : loads) load.load *= next;
    try {
      Trim trim = solve(system, held, loads, harmonics, tolerance, &last, comm, full_steps);
      if (has_turned(system, last, trim.solution)) {
        step *= 0.5;
        continue;
      }
      if (next == 0.0) return trim;
      last = trim.solution;
      left = next;
      step *= 2.0;
    } catch (const ConvergenceError&) {
      step *= 0.5;
    }
  }
  Trim trim = solve(system, held, {}, harmonics, tolerance, &start.solution, comm);
  if (has_turned(system, start.solution, trim.solution)) {
    std::string names;
    for (const system::UnconstrainedCoordinate& free : system.free_coordinates())
      names += (names.empty() ? "" : ", ") + free.name;
    throw ConvergenceError(
        "trim: no steady state near the one in which constant loads hold the free joints (" +
        names + "); hint: a stiffness of the joint, or joint: locked or prescribed");
  }
  return trim;
}

}  // namespace

double balance_residual(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                        const std::vector<HeldCoordinate>& loads, double shift, MPI_Comm comm) {
  const Ranks ranks(comm);
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Vec> r = system.make_state();
  const int samples = std::max(sample_count(system, solution.harmonics()), 16);
  double largest = 0.0;
  ranks.attempt([&] {
    for (int k = ranks.rank; k < samples; k += ranks.size) {
      const double t = system.period() * (k + shift) / samples;
      solution.evaluate(t, z.get(), z_dot.get());
      system.residual(t, z.get(), z_dot.get(), r.get());
      add_held_loads(system, loads, r.get());
      const petsc::ReadView view(r.get());
      for (std::size_t i = 0; i < system.rows().size(); ++i)
        if (system.rows()[i] == system::RowRole::balance)
          largest = std::max(largest, std::abs(view[static_cast<PetscInt>(i)]));
    }
  });
  return ranks.largest(largest);
}

/// Largest mean, cosine or sine of a balance row, up to the solution's harmonics.
double harmonic_residual(const system::PeriodicSystem& system, const Trim& trim,
                         const Ranks& ranks) {
  const PeriodicSolution& solution = trim.solution;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Vec> r = system.make_state();
  const int samples = sample_count(system, solution.harmonics());
  Eigen::MatrixXd harmonics = Eigen::MatrixXd::Zero(system.size(), solution.coefficients().cols());
  ranks.attempt([&] {
    for (int k = ranks.rank; k < samples; k += ranks.size) {
      const double t = system.period() * k / samples;
      solution.evaluate(t, z.get(), z_dot.get());
      system.residual(t, z.get(), z_dot.get(), r.get());
      add_held_loads(system, trim.held, r.get());
      const petsc::ReadView view(r.get());
      harmonics += 2.0 / samples * Eigen::Map<const Eigen::VectorXd>(view.data(), system.size()) *
                   PeriodicSolution::basis(solution.harmonics(), solution.period(), t).transpose();
    }
  });
  ranks.sum(harmonics);
  harmonics.col(0) *= 0.5;
  double largest = 0.0;
  for (std::size_t i = 0; i < system.rows().size(); ++i)
    if (system.rows()[i] == system::RowRole::balance)
      largest =
          std::max(largest, harmonics.row(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff());
  return largest;
}

StateResidual state_residual(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                             const std::vector<HeldCoordinate>& loads, MPI_Comm comm) {
  const Ranks ranks(comm);
  std::vector<PetscInt> rows;
  for (std::size_t i = 0; i < system.rows().size(); ++i)
    if (system.rows()[i] == system::RowRole::evolution ||
        system.rows()[i] == system::RowRole::definition)
      rows.push_back(static_cast<PetscInt>(i));
  if (rows.empty()) return {};
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Vec> r = system.make_state();
  const petsc::Handle<Mat> jacobian = system.make_jacobian();
  const petsc::Handle<Mat> mass = system.make_mass();
  std::vector<double> sizes(static_cast<std::size_t>(system.size()), 0.0);
  std::vector<double> residuals = sizes;
  const auto values_of = [&system](Vec vector) -> Eigen::VectorXd {
    const petsc::ReadView view(vector);
    return Eigen::Map<const Eigen::VectorXd>(view.data(), system.size());
  };
  Eigen::VectorXd least = Eigen::VectorXd::Zero(system.size());
  for (Eigen::Index i = 0; i < least.size(); ++i) {
    const system::Unknown& unknown = system.unknowns()[static_cast<std::size_t>(i)];
    if (unknown.role == system::UnknownRole::state ||
        unknown.role == system::UnknownRole::auxiliary)
      least(i) = (unknown.is_of_medium() ? least_medium : least_state) * unknown.scale;
  }
  const double rate = system.period() > 0.0 ? 2.0 * std::numbers::pi / system.period() : 0.0;
  const int samples = 2 * std::max(sample_count(system, solution.harmonics()), 16);
  const int stride = samples / instants_of_sizes;
  const auto raise = [](std::vector<double>& values, const Eigen::VectorXd& by) {
    Eigen::Map<Eigen::VectorXd> all(values.data(), by.size());
    all = all.cwiseMax(by);
  };
  ranks.attempt([&] {
    for (int k = ranks.rank; k < samples; k += ranks.size) {
      const double t = system.period() * k / samples;
      solution.evaluate(t, z.get(), z_dot.get());
      system.residual(t, z.get(), z_dot.get(), r.get());
      add_held_loads(system, loads, r.get());
      raise(residuals, values_of(r.get()).cwiseAbs());
      if (k % stride != 0) continue;
      system.tangents(t, z.get(), z_dot.get(), 0.0, jacobian.get(), mass.get());
      raise(sizes,
            to_sparse(jacobian.get()).cwiseAbs() * values_of(z.get()).cwiseAbs().cwiseMax(least) +
                to_sparse(mass.get()).cwiseAbs() *
                    values_of(z_dot.get()).cwiseAbs().cwiseMax(rate * least));
    }
  });
  ranks.find_largest(sizes);
  ranks.find_largest(residuals);
  StateResidual largest;
  for (const PetscInt row : rows) {
    const auto i = static_cast<std::size_t>(row);
    const bool is_of_medium = system.unknowns()[i].is_of_medium();
    double& found = is_of_medium ? largest.of_medium : largest.of_others;
    if (residuals[i] > 0.0) found = std::max(found, residuals[i] / sizes[i]);
  }
  return largest;
}

namespace {

/// At instants over a period. @throws DomainError
void require_admissible(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                        const Ranks& ranks) {
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const int samples = 2 * sample_count(system, solution.harmonics());
  ranks.attempt([&] {
    for (int k = ranks.rank; k < samples; k += ranks.size) {
      const double t = system.period() * k / samples;
      solution.evaluate(t, z.get(), z_dot.get());
      try {
        system.require_admissible(t, z.get());
      } catch (const DomainError& error) {
        throw DomainError(std::string("trim: ") + error.what());
      }
    }
  });
}

}  // namespace

void finish_trim(const system::PeriodicSystem& system, Trim& trim, MPI_Comm comm) {
  require_admissible(system, trim.solution, Ranks(comm));
  for (std::size_t i = 0; i < system.unknowns().size(); ++i)
    if (system.unknowns()[i].role == system::UnknownRole::internal)
      trim.load_level = std::max(
          trim.load_level,
          trim.solution.coefficients().row(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff());
  trim.residual = balance_residual(system, trim.solution, trim.held, 0.0, comm);
  trim.residual_between = balance_residual(system, trim.solution, trim.held, 0.5, comm);
  const StateResidual states = state_residual(system, trim.solution, trim.held, comm);
  trim.state_residual = states.of_others;
  trim.medium_residual = states.of_medium;
}

Trim solve_harmonic_balance(const system::PeriodicSystem& system, int harmonics, double tolerance,
                            const PeriodicSolution* start, MPI_Comm comm, Residuals residuals) {
  if (harmonics > 0 && system.period() == 0.0)
    throw InternalError("harmonics of a system without a period");
  const Coordinates& unconstrained = system.unconstrained_coordinates();
  const std::optional<HeldStart> held =
      start == nullptr ? hold_free(system, harmonics, tolerance, comm) : std::nullopt;
  Trim trim = held ? release(system, harmonics, tolerance, *held, comm)
                   : solve(system, unconstrained, {}, harmonics, tolerance, start, comm);
  if (residuals == Residuals::none) return trim;
  finish_trim(system, trim, comm);
  trim.harmonic_residual = harmonic_residual(system, trim, Ranks(comm));
  trim.attempts = {{harmonics, trim.residual_between}};
  return trim;
}

}  // namespace samara::analysis
