#include "samara/analysis/harmonic_balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"

namespace samara::analysis {
namespace {

/// Relative to Unknown::scale: least size of a state in the measure of its residual.
constexpr double least_state = 1e-3;

/// Scaled residual that counts as round-off.
constexpr double vanished = 1e-13;
/// Relative change of a vector by scaling and scaling back.
constexpr double same = 1e-14;

/// Newton's method: line search and number of steps.
struct NewtonLimits {
  const char* line_search = SNESLINESEARCHBT;
  int most_steps = 50;
};

/// For `release`. A change of a controller's pitch needs full Newton steps: each of them first
/// raises the residual of the rotations, and a line search would shorten the step.
constexpr NewtonLimits full_steps{SNESLINESEARCHBASIC, 15};
/// Smallest part of the loads on free coordinates that one step removes.
constexpr double least_release = 1.0 / 64.0;

int sample_count(int harmonics) { return 4 * harmonics + 2; }

/// Fourier weights of a sample at t: mean, then 2/N cos, 2/N sin.
Eigen::VectorXd fourier_weights(int harmonics, double period, double t) {
  Eigen::VectorXd weights = PeriodicSolution::basis(harmonics, period, t);
  weights *= 2.0 / sample_count(harmonics);
  weights(0) *= 0.5;
  return weights;
}

using Coordinates = std::vector<system::UnconstrainedCoordinate>;

/// A constant load in a row.
struct RowLoad {
  PetscInt row = 0;
  double load = 0.0;
};

/// The equations of harmonic balance. Unknown (i, c) is coefficient c of unknown i and has number
/// i (2 H + 1) + c; the load that holds a coordinate takes the place of the coordinate's mean.
class Balance {
 public:
  /// `given`: additional constant loads.
  Balance(const system::PeriodicSystem& system, const Coordinates& held,
          const std::vector<RowLoad>& given, int harmonics)
      : system_(system),
        held_(held),
        given_(given),
        harmonics_(harmonics),
        width_(2 * harmonics + 1),
        size_(static_cast<Eigen::Index>(system.size())),
        z_(system.make_state()),
        z_dot_(system.make_state()),
        r_(system.make_state()),
        jacobian_(system.make_jacobian()),
        mass_(system.make_mass()) {}

  PetscInt unknowns() const { return static_cast<PetscInt>(size_ * width_); }

  Eigen::MatrixXd unpack(const PetscScalar* h) const {
    Eigen::MatrixXd coefficients = Eigen::Map<const Eigen::MatrixXd>(h, width_, size_).transpose();
    for (const system::UnconstrainedCoordinate& coordinate : held_)
      coefficients(coordinate.unknown, 0) = 0.0;
    return coefficients;
  }

  std::vector<double> loads(const PetscScalar* h) const {
    std::vector<double> loads;
    for (const system::UnconstrainedCoordinate& coordinate : held_)
      loads.push_back(h[coordinate.unknown * width_]);
    return loads;
  }

  void residual(const PetscScalar* h, PetscScalar* out) {
    const PeriodicSolution solution(unpack(h), system_.period());
    const std::vector<double> held = loads(h);
    Eigen::Map<Eigen::MatrixXd> result(out, width_, size_);
    result.setZero();
    const int samples = sample_count(harmonics_);
    for (int k = 0; k < samples; ++k) {
      const double t = time_of(k);
      solution.evaluate(t, z_.get(), z_dot_.get());
      system_.residual(t, z_.get(), z_dot_.get(), r_.get());
      const petsc::ReadView view(r_.get());
      const Eigen::Map<const Eigen::VectorXd> r(view.data(), size_);
      result += projection(t) * r.transpose();
    }
    for (std::size_t n = 0; n < held_.size(); ++n) result(0, held_[n].row) += held[n];
    for (const RowLoad& given : given_) result(0, given.row) += given.load;
  }

  /// Entry (i, j) becomes the block sum_k w(t_k) [K_ij(t_k) b(t_k) + M_ij(t_k) b_dot(t_k)]^T. The
  /// blocks of all entries are the product of a matrix of the harmonics with the sampled tangents.
  void tangent(const PetscScalar* h, Mat matrix) {
    const PeriodicSolution solution(unpack(h), system_.period());
    const int samples = sample_count(harmonics_);
    const Eigen::Index entries = pattern_.nonZeros();
    Eigen::MatrixXd sampled = Eigen::MatrixXd::Zero(entries, 2 * samples);
    Eigen::MatrixXd harmonics(width_ * width_, 2 * samples);
    for (int k = 0; k < samples; ++k) {
      const double t = time_of(k);
      solution.evaluate(t, z_.get(), z_dot_.get());
      system_.tangents(t, z_.get(), z_dot_.get(), 0.0, jacobian_.get(), mass_.get());
      sample_entries(jacobian_.get(), sampled.col(k));
      sample_entries(mass_.get(), sampled.col(samples + k));
      const Eigen::VectorXd w = projection(t);
      const Eigen::MatrixXd by_value =
          PeriodicSolution::basis(harmonics_, period(), t) * w.transpose();
      const Eigen::MatrixXd by_rate =
          PeriodicSolution::basis_rate(harmonics_, period(), t) * w.transpose();
      harmonics.col(k) = Eigen::Map<const Eigen::VectorXd>(by_value.data(), by_value.size());
      harmonics.col(samples + k) =
          Eigen::Map<const Eigen::VectorXd>(by_rate.data(), by_rate.size());
    }
    insert_blocks(multiply(harmonics, sampled.transpose()), matrix);
  }

  /// An AIJ matrix with the pattern of the tangent: every place of K and M becomes a block of
  /// harmonics.
  petsc::Handle<Mat> make_matrix() {
    std::vector<Eigen::Triplet<double>> places;
    std::vector<std::vector<PetscInt>> rows = system_.pattern();
    if (rows.empty()) {  // the system does not declare a pattern
      std::vector<PetscInt> all(static_cast<std::size_t>(system_.size()));
      std::iota(all.begin(), all.end(), PetscInt{0});
      rows.assign(all.size(), all);
    }
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (const PetscInt j : rows[i]) places.emplace_back(static_cast<PetscInt>(i), j, 1.0);
    // The load that holds a coordinate stands in the place of its mean.
    for (const system::UnconstrainedCoordinate& coordinate : held_)
      places.emplace_back(coordinate.row, coordinate.unknown, 1.0);
    pattern_.resize(size_, size_);
    pattern_.setFromTriplets(places.begin(), places.end());
    return make_block_matrix();
  }

 private:
  double period() const { return system_.period() > 0.0 ? system_.period() : 1.0; }
  double time_of(int k) const { return system_.period() * k / sample_count(harmonics_); }

  Eigen::VectorXd projection(double t) const { return fourier_weights(harmonics_, period(), t); }

  bool is_held(PetscInt unknown) const {
    return std::any_of(
        held_.begin(), held_.end(),
        [unknown](const system::UnconstrainedCoordinate& n) { return n.unknown == unknown; });
  }

  petsc::Handle<Mat> make_block_matrix() const {
    std::vector<PetscInt> begin{0};
    std::vector<PetscInt> columns;
    for (Eigen::Index i = 0; i < size_; ++i)
      for (int row = 0; row < width_; ++row) {
        for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(pattern_, i); it; ++it)
          for (int c = 0; c < width_; ++c)
            columns.push_back(static_cast<PetscInt>(it.col()) * width_ + c);
        begin.push_back(static_cast<PetscInt>(columns.size()));
      }
    petsc::Handle<Mat> matrix;
    petsc::check(MatCreate(PETSC_COMM_SELF, matrix.fill()));
    petsc::check(MatSetSizes(matrix.get(), unknowns(), unknowns(), unknowns(), unknowns()));
    petsc::check(MatSetType(matrix.get(), MATSEQAIJ));
    petsc::check(MatSeqAIJSetPreallocationCSR(matrix.get(), begin.data(), columns.data(), nullptr));
    return matrix;
  }

  /// Whether the load that holds `unknown` acts in `row`.
  bool holds(Eigen::Index row, PetscInt unknown) const {
    return std::any_of(held_.begin(), held_.end(),
                       [row, unknown](const system::UnconstrainedCoordinate& n) {
                         return n.unknown == unknown && n.row == row;
                       });
  }

  /// The entries of a tangent in the order of the pattern.
  void sample_entries(Mat sample, Eigen::Ref<Eigen::VectorXd> out) const {
    std::vector<Eigen::Index> place(static_cast<std::size_t>(size_), -1);
    for (PetscInt i = 0; i < static_cast<PetscInt>(size_); ++i) {
      const Eigen::Index first = pattern_.outerIndexPtr()[i];
      const Eigen::Index last = pattern_.outerIndexPtr()[i + 1];
      for (Eigen::Index e = first; e < last; ++e)
        place[static_cast<std::size_t>(pattern_.innerIndexPtr()[e])] = e;
      PetscInt count = 0;
      const PetscInt* columns = nullptr;
      const PetscScalar* values = nullptr;
      petsc::check(MatGetRow(sample, i, &count, &columns, &values));
      for (PetscInt c = 0; c < count; ++c) {
        const Eigen::Index e = place[static_cast<std::size_t>(columns[c])];
        if (e >= 0)
          out(e) = values[c];
        else if (values[c] != 0.0)
          throw InternalError("row " + std::to_string(i) +
                              " of the tangents has an entry in column " +
                              std::to_string(columns[c]) + ", outside their pattern");
      }
      petsc::check(MatRestoreRow(sample, i, &count, &columns, &values));
      for (Eigen::Index e = first; e < last; ++e)
        place[static_cast<std::size_t>(pattern_.innerIndexPtr()[e])] = -1;
    }
  }

  /// `blocks`: a column per entry of the pattern, its block of harmonics row by row.
  void insert_blocks(const Eigen::MatrixXd& blocks, Mat matrix) const {
    PetscScalar* values = nullptr;
    petsc::check(MatSeqAIJGetArrayWrite(matrix, &values));
    PetscScalar* next = values;  // in the order of make_block_matrix
    for (Eigen::Index i = 0; i < size_; ++i) {
      const Eigen::Index first = pattern_.outerIndexPtr()[i];
      const Eigen::Index last = pattern_.outerIndexPtr()[i + 1];
      for (int row = 0; row < width_; ++row)
        for (Eigen::Index e = first; e < last; ++e) {
          const auto unknown = static_cast<PetscInt>(pattern_.innerIndexPtr()[e]);
          next = std::copy_n(&blocks(row * width_, e), width_, next);
          if (is_held(unknown)) *(next - width_) = holds(i, unknown) && row == 0 ? 1.0 : 0.0;
        }
    }
    petsc::check(MatSeqAIJRestoreArrayWrite(matrix, &values));
    petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  }

  const system::PeriodicSystem& system_;
  const Coordinates& held_;
  const std::vector<RowLoad>& given_;
  int harmonics_;
  int width_;
  Eigen::Index size_;
  petsc::Handle<Vec> z_;
  petsc::Handle<Vec> z_dot_;
  petsc::Handle<Vec> r_;
  petsc::Handle<Mat> jacobian_;
  petsc::Handle<Mat> mass_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> pattern_;  ///< of K and M together
};

/// Context of SNES's callbacks: the unknowns and rows are scaled by `scaling`.
struct SolverContext {
  Balance* balance = nullptr;
  const Eigen::VectorXd* start = nullptr;  ///< the matrix has its tangent; null after the first use
  const Equilibration* scaling = nullptr;
  Eigen::VectorXd unscaled;
  std::exception_ptr error;

  const PetscScalar* unscale(Vec x) {
    const petsc::ReadView view(x);
    const petsc::ReadView columns(scaling->columns.get());
    const Eigen::Map<const Eigen::VectorXd> scaled(view.data(), unscaled.size());
    const Eigen::Map<const Eigen::VectorXd> factors(columns.data(), unscaled.size());
    unscaled = scaled.cwiseProduct(factors);
    return unscaled.data();
  }
};

PetscErrorCode form_function(SNES snes, Vec x, Vec f, void* pointer) noexcept {
  auto& context = *static_cast<SolverContext*>(pointer);
  try {
    {
      const petsc::WriteView view(f);
      context.balance->residual(context.unscale(x), view.data());
    }
    petsc::check(VecPointwiseMult(f, f, context.scaling->rows.get()));
    context.error = nullptr;  // an error in a line search is no cause of a later failure
  } catch (const DomainError&) {
    context.error = std::current_exception();
    return SNESSetFunctionDomainError(snes);
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

PetscErrorCode form_jacobian(SNES snes, Vec x, Mat operators, Mat matrix, void* pointer) noexcept {
  auto& context = *static_cast<SolverContext*>(pointer);
  try {
    const PetscScalar* h = context.unscale(x);
    const bool is_start = context.start != nullptr && (context.unscaled - *context.start).norm() <=
                                                          same * context.start->norm();
    if (!is_start) context.balance->tangent(h, matrix);
    context.start = nullptr;
    petsc::check(
        MatDiagonalScale(matrix, context.scaling->rows.get(), context.scaling->columns.get()));
    factor(snes, operators, matrix);
  } catch (const DomainError&) {
    context.error = std::current_exception();
    return SNESSetJacobianDomainError(snes);
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
  text << "; hint: -trim_snes_monitor shows the steps, -trim_snes_max_it raises their number; a "
          "smaller load or a stiffer blade shows whether a steady state exists";
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

Eigen::VectorXd start_vector(const system::PeriodicSystem& system, int harmonics,
                             const PeriodicSolution* start) {
  const auto n = static_cast<Eigen::Index>(system.size());
  Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(2 * harmonics + 1, n);
  if (start != nullptr) {
    const Eigen::Index columns = std::min(coefficients.rows(), start->coefficients().cols());
    coefficients.topRows(columns) = start->coefficients().leftCols(columns).transpose();
  } else {
    const petsc::Handle<Vec> z = system.make_state();
    const int samples = system.constraints_are_autonomous() ? 1 : sample_count(harmonics);
    for (int k = 0; k < samples; ++k) {
      const double t = system.period() * k / samples;
      system.reference_state(t, z.get());
      const petsc::ReadView view(z.get());
      const Eigen::Map<const Eigen::RowVectorXd> values(view.data(), n);
      if (samples == 1)
        coefficients.row(0) = values;
      else
        coefficients += fourier_weights(harmonics, system.period(), t) * values;
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(coefficients.data(), coefficients.size());
}

/// Norm of the scaled residual.
double residual_at(const Eigen::VectorXd& h, SolverContext& context) {
  Eigen::VectorXd f(h.size());
  context.balance->residual(h.data(), f.data());
  const petsc::ReadView rows(context.scaling->rows.get());
  return (f.array() * Eigen::Map<const Eigen::ArrayXd>(rows.data(), f.size())).matrix().norm();
}

/// Solves from `start`, or from the undeformed system, to whose residual `tolerance` is relative.
/// Does not set the residuals and the load level.
Trim solve(const system::PeriodicSystem& system, const Coordinates& held,
           const std::vector<RowLoad>& given, int harmonics, double tolerance,
           const PeriodicSolution* start, const NewtonLimits& limits = {}) {
  Balance balance(system, held, given, harmonics);
  const petsc::Handle<Mat> matrix = balance.make_matrix();
  const petsc::Handle<Vec> x =
      petsc::make_vector(PETSC_COMM_SELF, balance.unknowns(), balance.unknowns());
  const petsc::Handle<Vec> f =
      petsc::make_vector(PETSC_COMM_SELF, balance.unknowns(), balance.unknowns());
  Eigen::VectorXd h = start_vector(system, harmonics, start);
  balance.tangent(h.data(), matrix.get());
  const Equilibration scaling = equilibrate(matrix.get());
  SolverContext context;
  context.balance = &balance;
  context.start = &h;
  context.scaling = &scaling;
  context.unscaled.resize(h.size());
  {
    const petsc::WriteView view(x.get());
    Eigen::Map<Eigen::VectorXd>(view.data(), h.size()) = h;
  }
  petsc::check(VecPointwiseDivide(x.get(), x.get(), scaling.columns.get()));

  petsc::Handle<SNES> solver;
  petsc::check(SNESCreate(PETSC_COMM_SELF, solver.fill()));
  petsc::check(SNESSetOptionsPrefix(solver.get(), "trim_"));
  petsc::check(SNESSetFunction(solver.get(), f.get(), form_function, &context));
  petsc::check(SNESSetJacobian(solver.get(), matrix.get(), matrix.get(), form_jacobian, &context));
  double enough = vanished;
  if (start != nullptr) {
    // The residual of a good start is too small to fall by the factor of the tolerance. But such a
    // start has no values for new harmonics; one step finds them.
    const Eigen::VectorXd undeformed = start_vector(system, harmonics, nullptr);
    enough = std::max(enough, tolerance * residual_at(undeformed, context));
    if (residual_at(h, context) > vanished)
      petsc::check(SNESSetForceIteration(solver.get(), PETSC_TRUE));
  }
  petsc::check(SNESSetTolerances(solver.get(), enough, tolerance, 0.0, limits.most_steps, 10000));
  SNESLineSearch search = nullptr;
  petsc::check(SNESGetLineSearch(solver.get(), &search));
  petsc::check(SNESLineSearchSetType(search, limits.line_search));
  KSP linear = nullptr;
  PC preconditioner = nullptr;
  petsc::check(SNESGetKSP(solver.get(), &linear));
  petsc::check(KSPSetType(linear, KSPPREONLY));
  petsc::check(KSPGetPC(linear, &preconditioner));
  petsc::check(PCSetType(preconditioner, PCLU));
  petsc::check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
  petsc::check(SNESSetFromOptions(solver.get()));
  const PreferredFactorization factorization;
  const PetscErrorCode code = SNESSolve(solver.get(), nullptr, x.get());
  if (code != 0 && context.error) std::rethrow_exception(context.error);
  petsc::check(code);
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  petsc::check(SNESGetConvergedReason(solver.get(), &reason));
  if (reason < 0) fail(solver.get(), context);
  PetscReal left = 0.0;
  petsc::check(SNESGetFunctionNorm(solver.get(), &left));
  if (reason == SNES_CONVERGED_FNORM_ABS && left > vanished) reason = SNES_CONVERGED_FNORM_RELATIVE;

  const PetscScalar* solution = context.unscale(x.get());
  Trim trim{PeriodicSolution(balance.unpack(solution), system.period()),
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
  const std::vector<double> loads = balance.loads(solution);
  for (std::size_t n = 0; n < loads.size(); ++n)
    trim.held.push_back({held[n].name, held[n].unit, loads[n], held[n].unknown});
  return trim;
}

/// The start of a trim with free coordinates, whose means are held at zero.
struct HeldStart {
  PeriodicSolution solution;
  std::vector<RowLoad> loads;  ///< that hold the free coordinates
};

/// The forces that restore a hinge (centrifugal force, weight) act through internal loads that the
/// undeformed system does not have, and the integral of a controller gets its value through motions
/// that it does not have: Newton's method diverges from there. Empty without free coordinates, or
/// where this start is not found.
std::optional<HeldStart> hold_free(const system::PeriodicSystem& system, int harmonics,
                                   double tolerance) {
  const Coordinates free = system.free_coordinates();
  if (free.empty()) return std::nullopt;
  Coordinates held = system.unconstrained_coordinates();
  const std::size_t first = held.size();
  held.insert(held.end(), free.begin(), free.end());
  try {
    const Trim trim = solve(system, held, {}, harmonics, tolerance, nullptr);
    HeldStart start{trim.solution, {}};
    for (std::size_t n = first; n < held.size(); ++n)
      start.loads.push_back({held[n].row, trim.held[n].load});
    return start;
  } catch (const ConvergenceError&) {
    return std::nullopt;
  }
}

/// Homotopy: removes the loads that hold the free coordinates in parts, or at once if that
/// converges.
Trim release(const system::PeriodicSystem& system, int harmonics, double tolerance,
             const HeldStart& start) {
  const Coordinates& held = system.unconstrained_coordinates();
  PeriodicSolution last = start.solution;
  double left = 1.0;  // part of the loads
  double step = 1.0;
  while (step >= least_release) {
    const double next = std::max(left - step, 0.0);
    std::vector<RowLoad> loads = start.loads;
    for (RowLoad& load : loads) load.load *= next;
    try {
      Trim trim = solve(system, held, loads, harmonics, tolerance, &last, full_steps);
      if (next == 0.0) return trim;
      last = trim.solution;
      left = next;
      step *= 2.0;
    } catch (const ConvergenceError&) {
      step *= 0.5;
    }
  }
  return solve(system, held, {}, harmonics, tolerance, &start.solution);
}

}  // namespace

double balance_residual(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                        const std::vector<HeldCoordinate>& loads, double shift) {
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Vec> r = system.make_state();
  const int samples = std::max(sample_count(solution.harmonics()), 16);
  double largest = 0.0;
  for (int k = 0; k < samples; ++k) {
    const double t = system.period() * (k + shift) / samples;
    solution.evaluate(t, z.get(), z_dot.get());
    system.residual(t, z.get(), z_dot.get(), r.get());
    add_held_loads(system, loads, r.get());
    const petsc::ReadView view(r.get());
    for (std::size_t i = 0; i < system.rows().size(); ++i)
      if (system.rows()[i] == system::RowRole::balance)
        largest = std::max(largest, std::abs(view[static_cast<PetscInt>(i)]));
  }
  return largest;
}

/// Largest mean, cosine or sine of a balance row, up to the solution's harmonics.
double harmonic_residual(const system::PeriodicSystem& system, const Trim& trim) {
  const PeriodicSolution& solution = trim.solution;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Vec> r = system.make_state();
  const int samples = sample_count(solution.harmonics());
  Eigen::MatrixXd harmonics = Eigen::MatrixXd::Zero(system.size(), solution.coefficients().cols());
  for (int k = 0; k < samples; ++k) {
    const double t = system.period() * k / samples;
    solution.evaluate(t, z.get(), z_dot.get());
    system.residual(t, z.get(), z_dot.get(), r.get());
    add_held_loads(system, trim.held, r.get());
    const petsc::ReadView view(r.get());
    harmonics += 2.0 / samples * Eigen::Map<const Eigen::VectorXd>(view.data(), system.size()) *
                 PeriodicSolution::basis(solution.harmonics(), solution.period(), t).transpose();
  }
  harmonics.col(0) *= 0.5;
  double largest = 0.0;
  for (std::size_t i = 0; i < system.rows().size(); ++i)
    if (system.rows()[i] == system::RowRole::balance)
      largest =
          std::max(largest, harmonics.row(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff());
  return largest;
}

double state_residual(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                      const std::vector<HeldCoordinate>& loads) {
  std::vector<PetscInt> rows;
  for (std::size_t i = 0; i < system.rows().size(); ++i)
    if (system.rows()[i] == system::RowRole::evolution ||
        system.rows()[i] == system::RowRole::definition)
      rows.push_back(static_cast<PetscInt>(i));
  if (rows.empty()) return 0.0;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Vec> r = system.make_state();
  const petsc::Handle<Mat> jacobian = system.make_jacobian();
  const petsc::Handle<Mat> mass = system.make_mass();
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(system.size());
  Eigen::VectorXd residuals = sizes;
  const auto values_of = [&system](Vec vector) -> Eigen::VectorXd {
    const petsc::ReadView view(vector);
    return Eigen::Map<const Eigen::VectorXd>(view.data(), system.size());
  };
  Eigen::VectorXd least = Eigen::VectorXd::Zero(system.size());
  for (Eigen::Index i = 0; i < least.size(); ++i) {
    const system::Unknown& unknown = system.unknowns()[static_cast<std::size_t>(i)];
    if (unknown.role == system::UnknownRole::state ||
        unknown.role == system::UnknownRole::auxiliary)
      least(i) = least_state * unknown.scale;
  }
  const double rate = system.period() > 0.0 ? 2.0 * std::numbers::pi / system.period() : 0.0;
  const int samples = 2 * std::max(sample_count(solution.harmonics()), 16);
  for (int k = 0; k < samples; ++k) {
    const double t = system.period() * k / samples;
    solution.evaluate(t, z.get(), z_dot.get());
    system.residual(t, z.get(), z_dot.get(), r.get());
    add_held_loads(system, loads, r.get());
    system.tangents(t, z.get(), z_dot.get(), 0.0, jacobian.get(), mass.get());
    const Eigen::VectorXd terms =
        to_sparse(jacobian.get()).cwiseAbs() * values_of(z.get()).cwiseAbs().cwiseMax(least) +
        to_sparse(mass.get()).cwiseAbs() * values_of(z_dot.get()).cwiseAbs().cwiseMax(rate * least);
    sizes = sizes.cwiseMax(terms);
    residuals = residuals.cwiseMax(values_of(r.get()).cwiseAbs());
  }
  double largest = 0.0;
  for (const PetscInt i : rows)
    if (residuals(i) > 0.0) largest = std::max(largest, residuals(i) / sizes(i));
  return largest;
}

void finish_trim(const system::PeriodicSystem& system, Trim& trim) {
  for (std::size_t i = 0; i < system.unknowns().size(); ++i)
    if (system.unknowns()[i].role == system::UnknownRole::internal)
      trim.load_level = std::max(
          trim.load_level,
          trim.solution.coefficients().row(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff());
  trim.residual = balance_residual(system, trim.solution, trim.held, 0.0);
  trim.residual_between = balance_residual(system, trim.solution, trim.held, 0.5);
  trim.state_residual = state_residual(system, trim.solution, trim.held);
}

Trim solve_harmonic_balance(const system::PeriodicSystem& system, int harmonics, double tolerance,
                            const PeriodicSolution* start) {
  if (harmonics > 0 && system.period() == 0.0)
    throw InternalError("harmonics of a system without a period");
  const Coordinates& unconstrained = system.unconstrained_coordinates();
  const std::optional<HeldStart> held =
      start == nullptr ? hold_free(system, harmonics, tolerance) : std::nullopt;
  Trim trim = held ? release(system, harmonics, tolerance, *held)
                   : solve(system, unconstrained, {}, harmonics, tolerance, start);
  finish_trim(system, trim);
  trim.harmonic_residual = harmonic_residual(system, trim);
  trim.attempts = {{harmonics, trim.residual_between}};
  return trim;
}

}  // namespace samara::analysis
