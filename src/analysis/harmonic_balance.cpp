#include "samara/analysis/harmonic_balance.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <random>
#include <sstream>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"

namespace samara::analysis {
namespace {

int sample_count(int harmonics) { return 4 * harmonics + 2; }

/// The equations of harmonic balance. Unknown (i, c) is coefficient c of unknown i and has number
/// i (2 H + 1) + c; the mean of a neutral coordinate gives its place to the load that holds it.
class Balance {
 public:
  Balance(const system::PeriodicSystem& system, int harmonics)
      : system_(system),
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
    Eigen::MatrixXd coefficients =
        Eigen::Map<const Eigen::MatrixXd>(h, width_, size_).transpose();
    for (const system::NeutralCoordinate& neutral : system_.neutral_coordinates())
      coefficients(neutral.unknown, 0) = 0.0;
    return coefficients;
  }

  std::vector<double> loads(const PetscScalar* h) const {
    std::vector<double> loads;
    for (const system::NeutralCoordinate& neutral : system_.neutral_coordinates())
      loads.push_back(h[neutral.unknown * width_]);
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
    const auto& neutral = system_.neutral_coordinates();
    for (std::size_t n = 0; n < neutral.size(); ++n) result(0, neutral[n].row) += held[n];
  }

  void tangent(const PetscScalar* h, Mat matrix) {
    const PeriodicSolution solution(unpack(h), system_.period());
    const int samples = sample_count(harmonics_);
    petsc::check(MatZeroEntries(matrix));
    for (int k = 0; k < samples; ++k) {
      const double t = time_of(k);
      solution.evaluate(t, z_.get(), z_dot_.get());
      system_.tangents(t, z_.get(), z_dot_.get(), 0.0, jacobian_.get(), mass_.get());
      const Eigen::VectorXd weights = projection(t);
      add_sample(jacobian_.get(),
                 weights * PeriodicSolution::basis(harmonics_, period(), t).transpose(), matrix);
      if (harmonics_ > 0)
        add_sample(mass_.get(),
                   weights * PeriodicSolution::basis_rate(harmonics_, period(), t).transpose(),
                   matrix);
    }
    for (const system::NeutralCoordinate& neutral : system_.neutral_coordinates())
      petsc::check(MatSetValue(matrix, neutral.row * width_, neutral.unknown * width_, 1.0,
                               ADD_VALUES));
    petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  }

  /// An AIJ matrix with the pattern of the tangent: every entry of K and M that is not always zero,
  /// found at a state where everything moves, becomes a block of harmonics.
  petsc::Handle<Mat> make_matrix() {
    std::minstd_rand random(1);
    std::uniform_real_distribution<double> uniform(-0.1, 0.1);
    system_.reference_state(0.0, z_.get());
    {
      const petsc::WriteView z(z_.get());
      const petsc::WriteView z_dot(z_dot_.get());
      for (PetscInt i = 0; i < system_.size(); ++i) {
        z[i] += uniform(random);
        z_dot[i] = uniform(random);
      }
    }
    system_.tangents(0.37 * system_.period(), z_.get(), z_dot_.get(), 1.0 + uniform(random),
                     jacobian_.get(), mass_.get());
    const Eigen::SparseMatrix<double, Eigen::RowMajor> pattern = to_sparse(jacobian_.get());
    std::vector<PetscInt> counts;
    for (Eigen::Index i = 0; i < size_; ++i)
      for (int c = 0; c < width_; ++c)
        counts.push_back((static_cast<PetscInt>(pattern.row(i).nonZeros()) + 1) * width_);
    petsc::Handle<Mat> matrix;
    petsc::check(
        MatCreateSeqAIJ(PETSC_COMM_SELF, unknowns(), unknowns(), 0, counts.data(), matrix.fill()));
    add_sample(jacobian_.get(), Eigen::MatrixXd::Zero(width_, width_), matrix.get());
    for (const system::NeutralCoordinate& neutral : system_.neutral_coordinates())
      petsc::check(MatSetValue(matrix.get(), neutral.row * width_, neutral.unknown * width_, 0.0,
                               ADD_VALUES));
    petsc::check(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
    return matrix;
  }

 private:
  double period() const { return system_.period() > 0.0 ? system_.period() : 1.0; }
  double time_of(int k) const { return system_.period() * k / sample_count(harmonics_); }

  /// Fourier weights of a sample: mean, then 2/N cos, 2/N sin.
  Eigen::VectorXd projection(double t) const {
    Eigen::VectorXd weights = PeriodicSolution::basis(harmonics_, period(), t);
    weights *= 2.0 / sample_count(harmonics_);
    weights(0) *= 0.5;
    return weights;
  }

  bool is_neutral(PetscInt unknown) const {
    return std::any_of(
        system_.neutral_coordinates().begin(), system_.neutral_coordinates().end(),
        [unknown](const system::NeutralCoordinate& n) { return n.unknown == unknown; });
  }

  void add_sample(Mat sample, const Eigen::MatrixXd& harmonics, Mat matrix) const {
    std::vector<PetscInt> row_numbers(static_cast<std::size_t>(width_));
    std::vector<PetscInt> column_numbers;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values;
    for (PetscInt i = 0; i < static_cast<PetscInt>(size_); ++i) {
      PetscInt count = 0;
      const PetscInt* columns = nullptr;
      const PetscScalar* entries = nullptr;
      petsc::check(MatGetRow(sample, i, &count, &columns, &entries));
      PetscInt used = 0;
      column_numbers.clear();
      values.resize(width_, count * width_);
      for (PetscInt c = 0; c < count; ++c) {
        if (entries[c] == 0.0) continue;
        values.middleCols(used * width_, width_) = entries[c] * harmonics;
        if (is_neutral(columns[c])) values.col(used * width_).setZero();
        for (int h = 0; h < width_; ++h) column_numbers.push_back(columns[c] * width_ + h);
        ++used;
      }
      petsc::check(MatRestoreRow(sample, i, &count, &columns, &entries));
      if (used == 0) continue;
      const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> block =
          values.leftCols(used * width_);
      for (int h = 0; h < width_; ++h) row_numbers[static_cast<std::size_t>(h)] = i * width_ + h;
      petsc::check(MatSetValues(matrix, width_, row_numbers.data(), used * width_,
                                column_numbers.data(), block.data(), ADD_VALUES));
    }
  }

  const system::PeriodicSystem& system_;
  int harmonics_;
  int width_;
  Eigen::Index size_;
  petsc::Handle<Vec> z_;
  petsc::Handle<Vec> z_dot_;
  petsc::Handle<Vec> r_;
  petsc::Handle<Mat> jacobian_;
  petsc::Handle<Mat> mass_;
};

/// What SNES's callbacks see: the unknowns and rows are scaled by `scaling`.
struct SolverContext {
  Balance* balance = nullptr;
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
  } catch (const DomainError&) {
    context.error = std::current_exception();
    return SNESSetFunctionDomainError(snes);
  } catch (...) {
    context.error = std::current_exception();
    return PETSC_ERR_USER;
  }
  return 0;
}

PetscErrorCode form_jacobian(SNES snes, Vec x, Mat, Mat matrix, void* pointer) noexcept {
  auto& context = *static_cast<SolverContext*>(pointer);
  try {
    context.balance->tangent(context.unscale(x), matrix);
    petsc::check(MatDiagonalScale(matrix, context.scaling->rows.get(),
                                  context.scaling->columns.get()));
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
          "softer load or a stiffer blade shows whether a steady state exists";
  throw ConvergenceError(text.str());
}

Eigen::VectorXd start_vector(const system::PeriodicSystem& system, int harmonics,
                             const PeriodicSolution* start) {
  const auto n = static_cast<Eigen::Index>(system.size());
  Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(2 * harmonics + 1, n);
  if (start != nullptr) {
    const Eigen::Index columns =
        std::min(coefficients.rows(), start->coefficients().cols());
    coefficients.topRows(columns) = start->coefficients().leftCols(columns).transpose();
  } else {
    const petsc::Handle<Vec> z = system.make_state();
    system.reference_state(0.0, z.get());
    const petsc::ReadView view(z.get());
    coefficients.row(0) = Eigen::Map<const Eigen::RowVectorXd>(view.data(), n);
  }
  return Eigen::Map<const Eigen::VectorXd>(coefficients.data(), coefficients.size());
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
    const petsc::WriteView view(r.get());
    const auto& neutral = system.neutral_coordinates();
    for (std::size_t n = 0; n < loads.size(); ++n) view[neutral[n].row] += loads[n].load;
    for (std::size_t i = 0; i < system.rows().size(); ++i)
      if (system.rows()[i] == system::RowRole::balance)
        largest = std::max(largest, std::abs(view[static_cast<PetscInt>(i)]));
  }
  return largest;
}

void finish_trim(const system::PeriodicSystem& system, Trim& trim) {
  for (std::size_t i = 0; i < system.unknowns().size(); ++i)
    if (system.unknowns()[i].role == system::UnknownRole::internal)
      trim.load_level = std::max(trim.load_level, trim.solution.coefficients()
                                                      .row(static_cast<Eigen::Index>(i))
                                                      .cwiseAbs()
                                                      .maxCoeff());
  trim.residual = balance_residual(system, trim.solution, trim.held, 0.0);
  trim.residual_between = balance_residual(system, trim.solution, trim.held, 0.5);
}

Trim solve_harmonic_balance(const system::PeriodicSystem& system, int harmonics, double tolerance,
                            const PeriodicSolution* start) {
  if (harmonics > 0 && system.period() == 0.0)
    throw InternalError("harmonics of a system without a period");
  Balance balance(system, harmonics);
  const petsc::Handle<Mat> matrix = balance.make_matrix();
  const petsc::Handle<Vec> x = petsc::make_vector(PETSC_COMM_SELF, balance.unknowns(),
                                                  balance.unknowns());
  const petsc::Handle<Vec> f = petsc::make_vector(PETSC_COMM_SELF, balance.unknowns(),
                                                  balance.unknowns());
  Eigen::VectorXd h = start_vector(system, harmonics, start);
  balance.tangent(h.data(), matrix.get());
  const Equilibration scaling = equilibrate(matrix.get());
  SolverContext context;
  context.balance = &balance;
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
  petsc::check(SNESSetTolerances(solver.get(), 1e-13, tolerance, 0.0, 50, 10000));
  KSP linear = nullptr;
  PC preconditioner = nullptr;
  petsc::check(SNESGetKSP(solver.get(), &linear));
  petsc::check(KSPSetType(linear, KSPPREONLY));
  petsc::check(KSPGetPC(linear, &preconditioner));
  petsc::check(PCSetType(preconditioner, PCLU));
  petsc::check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
  petsc::check(SNESSetFromOptions(solver.get()));
  const PetscErrorCode code = SNESSolve(solver.get(), nullptr, x.get());
  if (code != 0 && context.error) std::rethrow_exception(context.error);
  petsc::check(code);
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  petsc::check(SNESGetConvergedReason(solver.get(), &reason));
  if (reason < 0) fail(solver.get(), context);

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
  for (std::size_t n = 0; n < loads.size(); ++n) {
    const system::NeutralCoordinate& neutral = system.neutral_coordinates()[n];
    trim.held.push_back({neutral.name, neutral.unit, loads[n]});
  }
  finish_trim(system, trim);
  trim.history = {{harmonics, trim.residual_between}};
  return trim;
}

}  // namespace samara::analysis
