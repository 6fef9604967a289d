#include "samara/analysis/linear_algebra.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <exception>
#include <limits>
#include <sstream>

#include <petscblaslapack.h>

#include "samara/analysis/ranks.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/options.hpp"
#include "samara/petsc/session.hpp"

#include "blas.hpp"
#include "block_factors.hpp"
#include "matrix_entries.hpp"

namespace samara::analysis {
namespace {

/// Ratio of |J x - b| to |x| + |b|, where the rows and columns of J have entries of about one.
constexpr double largest_solve_residual = 1e-11;
/// Factors of a badly scaled matrix lose digits; refinement restores them.
constexpr int most_refinements = 3;

void multiply_each(Vec factors, const std::vector<double>& by) {
  const petsc::WriteView view(factors);
  for (std::size_t i = 0; i < by.size(); ++i) view[static_cast<PetscInt>(i)] *= by[i];
}

/// All eigenvalues compare as equal: the caller sorts them. Sorting by SLEPc (swaps in the Schur
/// form) fails for the degenerate pairs of identical blades.
PetscErrorCode keep_order(PetscScalar, PetscScalar, PetscScalar, PetscScalar, PetscInt* result,
                          void*) noexcept {
  *result = 0;
  return 0;
}

constexpr char room_option[] = "mat_mumps_icntl_14";

std::string prefix_of(KSP solver) {
  const char* prefix = nullptr;
  petsc::check(KSPGetOptionsPrefix(solver, &prefix));
  return prefix == nullptr ? "" : prefix;
}

bool is_given(KSP solver, const char* option) {
  PetscBool given = PETSC_FALSE;
  petsc::check(PetscOptionsHasName(nullptr, prefix_of(solver).c_str(),
                                   (std::string("-") + option).c_str(), &given));
  return given != PETSC_FALSE;
}

bool is_solver_chosen(KSP solver) { return is_given(solver, "pc_factor_mat_solver_type"); }

/// Report of MUMPS on its last phase: INFOG(1) and (2) of its user's guide.
FactorFailure explain_mumps(KSP solver, PC factored, PCFailedReason reason) {
  Mat factors = nullptr;
  PetscInt code = 0;
  PetscInt detail = 0;
  petsc::check(PCFactorGetMatrix(factored, &factors));
  petsc::check(MatMumpsGetInfog(factors, 1, &code));
  petsc::check(MatMumpsGetInfog(factors, 2, &detail));
  constexpr std::array<int, 2> singular{-6, -10};
  constexpr std::array<int, 2> no_memory{-7, -13};
  constexpr std::array<int, 8> no_room{-8, -9, -11, -12, -14, -15, -17, -20};
  const auto is_one_of = [code](const auto& codes) {
    return std::find(codes.begin(), codes.end(), code) != codes.end();
  };
  const std::string name =
      "INFOG(1) = " + std::to_string(code) + ", INFOG(2) = " + std::to_string(detail);
  const std::string room = "-" + prefix_of(solver) + room_option;
  FactorFailure failure{reason, "MUMPS ended with " + name, "", false, false};
  if (is_one_of(singular)) {
    failure.words = "the matrix is singular (MUMPS: " + name + ")";
    failure.is_singular = true;
  } else if (is_one_of(no_memory)) {
    throw InternalError("linear solve (" + prefix_of(solver) +
                        "): there is not enough memory for the factors (MUMPS: " + name + ")");
  } else if (is_one_of(no_room)) {
    failure.words += ": its work array is too small";
    failure.hint = "a larger " + room;
    failure.wants_room = !is_given(solver, room_option);
  } else {
    failure.hint = "the user's guide of MUMPS explains these numbers";
  }
  return failure;
}

FactorFailure find_failure(KSP solver) {
  PC factored = nullptr;
  PCFailedReason reason = PC_NOERROR;
  petsc::check(KSPGetPC(solver, &factored));
  petsc::check(PCGetFailedReason(factored, &reason));
  if (reason == PC_NOERROR) return {};
  MatSolverType type = nullptr;
  petsc::check(PCFactorGetMatSolverType(factored, &type));
  const std::string name = type == nullptr ? "" : type;
  if (name == MATSOLVERMUMPS) return explain_mumps(solver, factored, reason);
  FactorFailure failure{reason, "the factorization failed", "", false, false};
  if (reason == PC_FACTOR_NUMERIC_ZEROPIVOT || reason == PC_FACTOR_STRUCT_ZEROPIVOT)
    failure.words = "the factorization met a zero pivot";
  failure.words += " (" + (name.empty() ? "" : name + ": ") + PCFailedReasons[reason] + ")";
  failure.hint = "-" + prefix_of(solver) + "pc_factor_mat_solver_type mumps";
  return failure;
}

}  // namespace

void apply_scaling(const Equilibration& scaling, Mat matrix) {
  PetscBool is_blocked = PETSC_FALSE;
  petsc::check(
      PetscObjectTypeCompare(reinterpret_cast<PetscObject>(matrix), MATSEQBAIJ, &is_blocked));
  if (is_blocked == PETSC_FALSE) {
    petsc::check(MatDiagonalScale(matrix, scaling.rows.get(), scaling.columns.get()));
    return;
  }
  PetscInt size = 0;
  PetscInt block_rows = 0;
  const PetscInt* begin = nullptr;
  const PetscInt* block_columns = nullptr;
  PetscBool done = PETSC_FALSE;
  PetscScalar* values = nullptr;
  petsc::check(MatGetBlockSize(matrix, &size));
  petsc::check(
      MatGetRowIJ(matrix, 0, PETSC_FALSE, PETSC_TRUE, &block_rows, &begin, &block_columns, &done));
  if (done == PETSC_FALSE)
    throw InternalError("PETSc gives no access to the structure of a block matrix");
  petsc::check(MatSeqBAIJGetArray(matrix, &values));
  const petsc::ReadView rows(scaling.rows.get());
  const petsc::ReadView columns(scaling.columns.get());
  for (PetscInt i = 0; i < block_rows; ++i) {
    const Eigen::Map<const Eigen::ArrayXd> row(rows.data() + i * size, size);
    for (PetscInt k = begin[i]; k < begin[i + 1]; ++k)
      for (PetscInt c = 0; c < size; ++c)
        Eigen::Map<Eigen::ArrayXd>(values + (k * size + c) * size, size) *=
            row * columns[block_columns[k] * size + c];
  }
  petsc::check(MatSeqBAIJRestoreArray(matrix, &values));
  petsc::check(MatRestoreRowIJ(matrix, 0, PETSC_FALSE, PETSC_TRUE, &block_rows, &begin,
                               &block_columns, &done));
  petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
}

void round_to_powers_of_two(Equilibration& scaling) {
  for (const petsc::Handle<Vec>* factors : {&scaling.rows, &scaling.columns}) {
    PetscInt size = 0;
    petsc::check(VecGetLocalSize(factors->get(), &size));
    const petsc::WriteView view(factors->get());
    for (PetscInt i = 0; i < size; ++i) view[i] = std::exp2(std::round(std::log2(view[i])));
  }
}

Equilibration equilibrate(Mat matrix) {
  Equilibration scaling;
  petsc::check(MatCreateVecs(matrix, scaling.columns.fill(), scaling.rows.fill()));
  petsc::check(VecSet(scaling.rows.get(), 1.0));
  petsc::check(VecSet(scaling.columns.get(), 1.0));
  Eigen::SparseMatrix<double> work = to_sparse(matrix);
  constexpr int sweeps = 6;  // Ruiz (2001): halves the logarithm of the spread each time
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    std::vector<double> row_largest(static_cast<std::size_t>(work.rows()), 0.0);
    std::vector<double> column_largest(static_cast<std::size_t>(work.cols()), 0.0);
    for (Eigen::Index j = 0; j < work.outerSize(); ++j) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(work, j); it; ++it) {
        double& row = row_largest[static_cast<std::size_t>(it.row())];
        double& column = column_largest[static_cast<std::size_t>(j)];
        row = std::max(row, std::abs(it.value()));
        column = std::max(column, std::abs(it.value()));
      }
    }
    for (std::vector<double>* largest : {&row_largest, &column_largest})
      for (double& value : *largest) value = value > 0.0 ? 1.0 / std::sqrt(value) : 1.0;
    for (Eigen::Index j = 0; j < work.outerSize(); ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator it(work, j); it; ++it)
        it.valueRef() *= row_largest[static_cast<std::size_t>(it.row())] *
                         column_largest[static_cast<std::size_t>(j)];
    multiply_each(scaling.rows.get(), row_largest);
    multiply_each(scaling.columns.get(), column_largest);
  }
  return scaling;
}

Equilibration scale_by_role(const system::PeriodicSystem& system, Mat matrix, double rate) {
  return scaling_by_role(system, to_sparse(matrix), rate);
}

Equilibration scaling_by_role(const system::PeriodicSystem& system,
                              const Eigen::SparseMatrix<double>& entries, double rate,
                              double least_load, const Ranks* ranks) {
  const auto n = static_cast<std::size_t>(entries.rows());
  const auto role = [&system](Eigen::Index i) {
    return system.unknowns()[static_cast<std::size_t>(i)].role;
  };
  const auto size = [&system](Eigen::Index i) {
    return system.unknowns()[static_cast<std::size_t>(i)].scale;
  };
  std::vector<double> inertia(n, 0.0);  // largest term of a balance row except internal loads
  for (Eigen::Index j = 0; j < entries.outerSize(); ++j) {
    if (role(j) == system::UnknownRole::internal) continue;
    const double column = role(j) == system::UnknownRole::velocity ? rate : size(j);
    for (Eigen::SparseMatrix<double>::InnerIterator it(entries, j); it; ++it) {
      double& largest = inertia[static_cast<std::size_t>(it.row())];
      largest = std::max(largest, std::abs(it.value()) * column);
    }
  }
  if (ranks != nullptr) ranks->find_largest(inertia);
  std::vector<double> levels;
  for (std::size_t i = 0; i < n; ++i)
    if (system.rows()[i] == system::RowRole::balance && inertia[i] > 0.0)
      levels.push_back(inertia[i]);
  std::sort(levels.begin(), levels.end());
  const double inertia_load = levels.empty() ? 1.0 : levels[levels.size() / 2];
  const double load = std::max(inertia_load, least_load);

  const auto size_of_all = static_cast<PetscInt>(n);
  Equilibration scaling{petsc::make_vector(PETSC_COMM_SELF, size_of_all, size_of_all),
                        petsc::make_vector(PETSC_COMM_SELF, size_of_all, size_of_all)};
  std::vector<double> row_largest(n, 0.0);
  {
    const petsc::WriteView columns(scaling.columns.get());
    for (Eigen::Index j = 0; j < entries.outerSize(); ++j) {
      const double column = role(j) == system::UnknownRole::internal   ? load
                            : role(j) == system::UnknownRole::velocity ? rate
                                                                       : size(j);
      columns[static_cast<PetscInt>(j)] = column;
      for (Eigen::SparseMatrix<double>::InnerIterator it(entries, j); it; ++it) {
        double& largest = row_largest[static_cast<std::size_t>(it.row())];
        largest = std::max(largest, std::abs(it.value()) * column);
      }
    }
  }
  if (ranks != nullptr) ranks->find_largest(row_largest);
  const petsc::WriteView rows(scaling.rows.get());
  for (std::size_t i = 0; i < n; ++i)
    rows[static_cast<PetscInt>(i)] = row_largest[i] > 0.0 ? 1.0 / row_largest[i] : 1.0;
  return scaling;
}

FactorFailure set_up(KSP solver) {
  petsc::check(KSPSetUp(solver));
  for (const char* room : {"100", "300", "1000", "3000"}) {
    FactorFailure failure = find_failure(solver);
    if (!failure.wants_room) return failure;
    // MUMPS accepts another size of its work array only before it analyses the pattern.
    const std::string option = "-" + prefix_of(solver) + room_option;
    PC factored = nullptr;
    Mat operators = nullptr;
    Mat matrix = nullptr;
    petsc::check(KSPGetPC(solver, &factored));
    petsc::check(KSPGetOperators(solver, &operators, &matrix));
    petsc::check(PetscOptionsSetValue(nullptr, option.c_str(), room));
    petsc::check(PCReset(factored));
    petsc::check(KSPSetOperators(solver, operators, matrix));
    const PetscErrorCode code = KSPSetUp(solver);
    petsc::check(PetscOptionsClearValue(nullptr, option.c_str()));
    petsc::check(code);
  }
  return find_failure(solver);
}

DirectSolver::DirectSolver(std::string prefix, std::function<Equilibration(Mat)> scale)
    : prefix_(std::move(prefix)), scale_(std::move(scale)) {}
DirectSolver::DirectSolver(DirectSolver&&) noexcept = default;
DirectSolver& DirectSolver::operator=(DirectSolver&&) noexcept = default;
DirectSolver::~DirectSolver() = default;

/// Whether an option chooses or shows something of the KSP or of its preconditioner.
bool DirectSolver::is_solver_given() const {
  const std::string options = petsc::Session::options();
  const auto is_there = [&](const char* part) {
    return options.find("-" + prefix_ + part) != std::string::npos;
  };
  return is_there("ksp_") || is_there("pc_") || is_there("mat_");
}

void DirectSolver::factor(Mat matrix) {
  matrix_ = matrix;
  const bool is_first = !scaling_.rows;
  if (is_first) {
    scaling_ = scale_(matrix);
    if (const MatrixEntries entries(matrix); entries.has_blocks() && !is_solver_given())
      blocks_ = std::make_unique<BlockFactors<double>>(entries.blocks());
  }
  apply_scaling(scaling_, matrix);
  if (blocks_) {
    solves_ = 0;
    needs_refinement_ = false;
    if (blocks_->factor(MatrixEntries(matrix).blocks())) return;
    blocks_.reset();
    pivots_ = true;
  }
  factor_by_petsc();
}

void DirectSolver::factor_by_petsc() {
  if (!solver_) {
    petsc::check(KSPCreate(PETSC_COMM_SELF, solver_.fill()));
    petsc::check(KSPSetOptionsPrefix(solver_.get(), prefix_.c_str()));
    petsc::check(KSPSetType(solver_.get(), KSPPREONLY));
    PC preconditioner = nullptr;
    petsc::check(KSPGetPC(solver_.get(), &preconditioner));
    petsc::check(PCSetType(preconditioner, PCLU));
    // Systems number their unknowns so that elimination in this order causes little fill-in.
    petsc::check(PCFactorSetMatOrderingType(preconditioner, MATORDERINGNATURAL));
    if (pivots_) petsc::check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
    petsc::check(KSPSetOperators(solver_.get(), matrix_, matrix_));
    petsc::take_options(KSPSetFromOptions, solver_.get());
  }
  petsc::check(KSPSetOperators(solver_.get(), matrix_, matrix_));
  FactorFailure failure = set_up(solver_.get());
  if (failure.reason != PC_NOERROR && !pivots_ && !is_solver_chosen(solver_.get())) {
    take_pivoting_solver();
    failure = set_up(solver_.get());
  }
  if (failure.reason == PC_NOERROR) return;
  PC factored = nullptr;
  petsc::check(KSPGetPC(solver_.get(), &factored));
  petsc::check(PCReset(factored));  // otherwise the next matrix would count as factored
  const std::string text = "linear solve (" + prefix_ + "): " + failure.words;
  if (failure.is_singular) throw SingularError(text);
  throw ConvergenceError(text + "; hint: " + failure.hint);
}

/// A beam held at its end has a singular diagonal block: rows must be interchanged. The caller
/// keeps a solver that the user has chosen.
void DirectSolver::take_pivoting_solver() {
  PC factored = nullptr;
  petsc::check(KSPGetPC(solver_.get(), &factored));
  petsc::check(PCReset(factored));
  petsc::check(PCFactorSetMatSolverType(factored, MATSOLVERMUMPS));
  petsc::check(KSPSetOperators(solver_.get(), matrix_, matrix_));
  pivots_ = true;
}

double DirectSolver::compute_residual(const Eigen::VectorXd& x,
                                      const Eigen::VectorXd& right) const {
  const auto n = static_cast<PetscInt>(right.size());
  Eigen::VectorXd product(right.size());
  petsc::Handle<Vec> in;
  petsc::Handle<Vec> out;
  petsc::check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, x.data(), in.fill()));
  petsc::check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, product.data(), out.fill()));
  petsc::check(MatMult(matrix_, in.get(), out.get()));
  return (product - right).norm();
}

void DirectSolver::solve(Eigen::MatrixXd& right) {
  if (right.cols() == 0) return;
  probe_ = (probe_ + 1) % right.cols();  // each solve checks another column
  if (blocks_) {
    if (solve_by_blocks(right)) return;
    // The factors have lost too many digits: rows must be interchanged.
    blocks_.reset();
    pivots_ = true;
    factor_by_petsc();
  }
  solve_by_petsc(right);
}

/// @returns false, with `right` as it was, where refinement does not bring the residual down.
bool DirectSolver::solve_by_blocks(Eigen::MatrixXd& right) {
  const petsc::ReadView rows(scaling_.rows.get());
  const petsc::ReadView columns(scaling_.columns.get());
  const Eigen::Map<const Eigen::VectorXd> row_factors(rows.data(), right.rows());
  const Eigen::Map<const Eigen::VectorXd> column_factors(columns.data(), right.rows());
  const Eigen::VectorXd b = right.col(probe_).cwiseProduct(row_factors);
  const auto is_small = [&](const Eigen::VectorXd& x) {
    return compute_residual(x, b) <= largest_solve_residual * (b.norm() + x.norm());
  };
  blocks_->solve(right, row_factors);
  const bool is_checked = std::has_single_bit(++solves_) || needs_refinement_;
  if (!is_checked || is_small(blocks_->column(probe_))) {
    blocks_->copy(column_factors, right);
    return true;
  }
  needs_refinement_ = true;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(right.rows());
  const Eigen::SparseMatrix<double> matrix = to_sparse(matrix_);
  blocks_->copy(ones, solution_);
  Eigen::MatrixXd change;
  for (int refinement = 0; refinement < most_refinements && solution_.allFinite(); ++refinement) {
    blocks_->solve(row_factors.asDiagonal() * right - matrix * solution_, ones);
    blocks_->copy(ones, change);
    solution_ += change;
    if (!is_small(solution_.col(probe_))) continue;
    right = solution_.array().colwise() * column_factors.array();
    return true;
  }
  return false;
}

void DirectSolver::solve_by_petsc(Eigen::MatrixXd& right) {
  const petsc::ReadView rows(scaling_.rows.get());
  const petsc::ReadView columns(scaling_.columns.get());
  const Eigen::Map<const Eigen::VectorXd> row_factors(rows.data(), right.rows());
  const Eigen::Map<const Eigen::VectorXd> column_factors(columns.data(), right.rows());
  right.array().colwise() *= row_factors.array();
  solution_.resize(right.rows(), right.cols());
  petsc::Handle<Mat> B;
  petsc::Handle<Mat> X;
  const auto n = static_cast<PetscInt>(right.rows());
  const auto m = static_cast<PetscInt>(right.cols());
  petsc::check(MatCreateSeqDense(PETSC_COMM_SELF, n, m, right.data(), B.fill()));
  petsc::check(MatCreateSeqDense(PETSC_COMM_SELF, n, m, solution_.data(), X.fill()));
  petsc::check(KSPMatSolve(solver_.get(), B.get(), X.get()));
  for (int refinement = 0;; ++refinement) {
    const double size = right.col(probe_).norm();
    const double result = solution_.col(probe_).norm();
    const double residual = compute_residual(solution_.col(probe_), right.col(probe_));
    if (residual <= largest_solve_residual * (size + result)) break;
    if (refinement == most_refinements || !std::isfinite(residual)) {
      std::ostringstream text;
      text << "linear solve (" << prefix_ << "): residual " << residual
           << " for a right-hand side of " << size << " and a solution of " << result << "; hint: -"
           << prefix_ << "pc_factor_mat_solver_type mumps";
      throw ConvergenceError(text.str());
    }
    Eigen::MatrixXd rest(right.rows(), right.cols());
    Eigen::MatrixXd change(right.rows(), right.cols());
    petsc::Handle<Mat> R;
    petsc::Handle<Mat> D;
    petsc::check(MatCreateSeqDense(PETSC_COMM_SELF, n, m, rest.data(), R.fill()));
    petsc::check(MatCreateSeqDense(PETSC_COMM_SELF, n, m, change.data(), D.fill()));
    rest = right - to_sparse(matrix_) * solution_;
    petsc::check(KSPMatSolve(solver_.get(), R.get(), D.get()));
    solution_ += change;
  }
  right = solution_.array().colwise() * column_factors.array();
}

Eigen::VectorXd real_part(const Eigen::VectorXcd& vector) {
  Eigen::Index largest = 0;
  const double size = vector.cwiseAbs().maxCoeff(&largest);
  if (size == 0.0) return vector.real();
  return (vector * (std::conj(vector(largest)) / size)).real();
}

void multiply(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::MatrixXd& b,
              Eigen::MatrixXd& c) {
  c.resize(a.rows(), b.cols());
  if (a.cols() == 0) c.setZero();
  if (c.size() == 0 || a.cols() == 0) return;
  const auto m = static_cast<PetscBLASInt>(a.rows());
  const auto n = static_cast<PetscBLASInt>(b.cols());
  const auto k = static_cast<PetscBLASInt>(a.cols());
  const auto lda = static_cast<PetscBLASInt>(a.outerStride());
  const PetscScalar one = 1.0;
  const PetscScalar zero = 0.0;
  PetscLogFlops(2.0 * m * n * k);
  BLASgemm_("N", "N", &m, &n, &k, &one, a.data(), &lda, b.data(), &k, &zero, c.data(), &m);
}

Eigen::MatrixXd multiply(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd c;
  multiply(a, b, c);
  return c;
}

namespace {

Eigen::MatrixXcd multiply_turned(char how, const Eigen::Ref<const Eigen::MatrixXcd>& a,
                                 const Eigen::Ref<const Eigen::MatrixXcd>& b) {
  Eigen::MatrixXcd c = Eigen::MatrixXcd::Zero(a.cols(), b.cols());
  if (c.size() == 0 || a.rows() == 0) return c;
  const auto integer = [](Eigen::Index value) { return static_cast<blas::Integer>(value); };
  blas::multiply_turned(how, integer(a.cols()), integer(b.cols()), integer(a.rows()), a.data(),
                        integer(a.outerStride()), b.data(), integer(b.outerStride()), c.data(),
                        integer(c.rows()));
  return c;
}

}  // namespace

Eigen::MatrixXcd multiply_adjoint(const Eigen::Ref<const Eigen::MatrixXcd>& a,
                                  const Eigen::Ref<const Eigen::MatrixXcd>& b) {
  return multiply_turned('C', a, b);
}

Eigen::MatrixXcd multiply_transpose(const Eigen::Ref<const Eigen::MatrixXcd>& a,
                                    const Eigen::Ref<const Eigen::MatrixXcd>& b) {
  return multiply_turned('T', a, b);
}

void multiply(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a, const Eigen::MatrixXd& b,
              Eigen::MatrixXd& c, double c_factor) {
  PetscLogFlops(2.0 * static_cast<double>(a.nonZeros() * b.cols()));
  constexpr int group = 8;  // columns at once
  using Group = Eigen::Array<double, group, 1>;
  std::vector<Group> values(static_cast<std::size_t>(b.rows()), Group::Zero());
  if (c_factor == 0.0) c.resize(a.rows(), b.cols());
  for (Eigen::Index first = 0; first < b.cols(); first += group) {
    const Eigen::Index count = std::min<Eigen::Index>(group, b.cols() - first);
    for (Eigen::Index j = 0; j < count; ++j)
      for (Eigen::Index i = 0; i < b.rows(); ++i)
        values[static_cast<std::size_t>(i)](j) = b(i, first + j);
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      Group sum = Group::Zero();
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(a, i); it; ++it)
        sum += it.value() * values[static_cast<std::size_t>(it.col())];
      for (Eigen::Index j = 0; j < count; ++j) {
        double& value = c(i, first + j);
        value = c_factor == 0.0 ? sum(j) : c_factor * value + sum(j);
      }
    }
  }
}

Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix) {
  const auto n = static_cast<PetscInt>(matrix.rows());
  Eigen::MatrixXd copy = matrix;
  Eigen::MatrixXd result(n, n);
  petsc::Handle<Mat> from;
  petsc::Handle<Mat> to;
  petsc::check(MatCreateSeqDense(PETSC_COMM_SELF, n, n, copy.data(), from.fill()));
  petsc::check(MatCreateSeqDense(PETSC_COMM_SELF, n, n, result.data(), to.fill()));
  petsc::Handle<FN> function;
  petsc::check(FNCreate(PETSC_COMM_SELF, function.fill()));
  petsc::check(FNSetType(function.get(), FNEXP));
  petsc::check(FNEvaluateFunctionMat(function.get(), from.get(), to.get()));
  return result;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> to_sparse_rows(Mat matrix) {
  PetscInt rows = 0;
  PetscInt columns = 0;
  petsc::check(MatGetSize(matrix, &rows, &columns));
  MatInfo info{};
  petsc::check(MatGetInfo(matrix, MAT_LOCAL, &info));
  Eigen::SparseMatrix<double, Eigen::RowMajor> sparse(rows, columns);
  sparse.reserve(static_cast<Eigen::Index>(info.nz_used));
  for (PetscInt i = 0; i < rows; ++i) {
    PetscInt count = 0;
    const PetscInt* at = nullptr;
    const PetscScalar* values = nullptr;
    petsc::check(MatGetRow(matrix, i, &count, &at, &values));
    sparse.startVec(i);
    for (PetscInt c = 0; c < count; ++c)
      if (values[c] != 0.0) sparse.insertBack(i, at[c]) = values[c];
    petsc::check(MatRestoreRow(matrix, i, &count, &at, &values));
  }
  sparse.finalize();
  return sparse;
}

Eigen::SparseMatrix<double> to_sparse(Mat matrix) { return to_sparse_rows(matrix); }

namespace {

/// SLEPc's eigenproblem of a dense real matrix.
struct DenseProblem {
  explicit DenseProblem(const Eigen::MatrixXd& matrix) : copy(matrix) {
    const auto n = static_cast<PetscInt>(copy.rows());
    petsc::check(MatCreateSeqDense(PETSC_COMM_SELF, n, n, copy.data(), operators.fill()));
    petsc::check(EPSCreate(PETSC_COMM_SELF, solver.fill()));
    petsc::check(EPSSetOperators(solver.get(), operators.get(), nullptr));
    petsc::check(EPSSetProblemType(solver.get(), EPS_NHEP));
  }

  Eigen::MatrixXd copy;
  petsc::Handle<Mat> operators;
  petsc::Handle<EPS> solver;
};

/// SLEPc's types that find only a few eigenvalues end with an error if all are requested.
void solve_whole(EPS solver, const std::string& prefix) {
  const PetscErrorCode code = EPSSolve(solver);
  if (code == PETSC_ERR_SUP || code == PETSC_ERR_USER_INPUT) {
    EPSType type = nullptr;
    petsc::check(EPSGetType(solver, &type));
    throw InputError("-" + prefix + "eps_type " + type +
                     ": SLEPc does not find all eigenvalues with it; hint: lapack");
  }
  petsc::check(code);
}

/// @throws InternalError unless a complex eigenvalue is followed by its conjugate.
bool is_first_of_pair(const Eigenpairs& pairs, Eigen::Index i) {
  const auto at = static_cast<std::size_t>(i);
  if (pairs.values[at].imag() == 0.0) return false;
  if (at + 1 == pairs.values.size() || pairs.values[at + 1] != std::conj(pairs.values[at]))
    throw InternalError("a complex eigenvalue is not followed by its conjugate");
  return true;
}

/// The real eigenvectors, and the real and imaginary part of the first one of each complex pair.
Eigen::MatrixXd real_parts(const Eigenpairs& pairs) {
  Eigen::MatrixXd parts(pairs.vectors.rows(), pairs.vectors.cols());
  for (Eigen::Index i = 0; i < parts.cols(); ++i) {
    parts.col(i) = pairs.vectors.col(i).real();
    if (!is_first_of_pair(pairs, i)) continue;
    parts.col(i + 1) = pairs.vectors.col(i).imag();
    ++i;
  }
  return parts;
}

}  // namespace

void require_whole_spectrum(const std::string& prefix) {
  constexpr std::array partial{"nev",
                               "all",
                               "interval",
                               "target",
                               "target_real",
                               "target_imaginary",
                               "target_magnitude",
                               "largest_magnitude",
                               "smallest_magnitude",
                               "largest_real",
                               "smallest_real",
                               "largest_imaginary",
                               "smallest_imaginary",
                               "hermitian",
                               "gen_hermitian",
                               "pos_gen_non_hermitian",
                               "gen_indefinite"};
  for (const char* name : partial) {
    const std::string option = "-" + prefix + "eps_" + name;
    PetscBool given = PETSC_FALSE;
    petsc::check(PetscOptionsHasName(nullptr, nullptr, option.c_str(), &given));
    if (given != PETSC_FALSE)
      throw InputError(option +
                       ": all eigenvalues are computed, and the matrix has no symmetry; "
                       "hint: leave the option out");
  }
}

Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix, const std::string& prefix) {
  const auto n = static_cast<PetscInt>(matrix.rows());
  Eigenpairs pairs;
  pairs.vectors.resize(n, n);
  if (n == 0) return pairs;
  DenseProblem problem(matrix);
  EPS solver = problem.solver.get();
  petsc::check(EPSSetOptionsPrefix(solver, prefix.c_str()));
  petsc::check(EPSSetType(solver, EPSLAPACK));
  petsc::check(EPSSetDimensions(solver, n, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc::check(EPSSetWhichEigenpairs(solver, EPS_WHICH_USER));
  petsc::check(EPSSetEigenvalueComparison(solver, keep_order, nullptr));
  petsc::take_options(EPSSetFromOptions, solver);
  require_whole_spectrum(prefix);
  solve_whole(solver, prefix);
  PetscInt converged = 0;
  petsc::check(EPSGetConverged(solver, &converged));
  if (converged < n) {
    EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
    petsc::check(EPSGetConvergedReason(solver, &reason));
    throw ConvergenceError("eigenproblem (" + prefix + "): " + std::to_string(converged) + " of " +
                           std::to_string(n) + " eigenvalues converged (" +
                           EPSConvergedReasons[reason] + "); hint: -" + prefix + "eps_type lapack");
  }
  const petsc::Handle<Vec> re = petsc::make_vector(PETSC_COMM_SELF, n, n);
  const petsc::Handle<Vec> im = petsc::make_vector(PETSC_COMM_SELF, n, n);
  for (PetscInt i = 0; i < n; ++i) {
    PetscScalar value_re = 0.0;
    PetscScalar value_im = 0.0;
    petsc::check(EPSGetEigenpair(solver, i, &value_re, &value_im, re.get(), im.get()));
    pairs.values.emplace_back(value_re, value_im);
    const petsc::ReadView a(re.get());
    const petsc::ReadView b(im.get());
    for (PetscInt j = 0; j < n; ++j)
      pairs.vectors(j, i) = std::complex<double>(a[j], value_im == 0.0 ? 0.0 : b[j]);
  }
  const Eigen::MatrixXd product = multiply(matrix, real_parts(pairs));
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::complex<double> value = pairs.values[static_cast<std::size_t>(i)];
    Eigen::VectorXcd defect = -value * pairs.vectors.col(i);
    defect.real() += product.col(i);
    if (is_first_of_pair(pairs, i)) defect.imag() += product.col(i + 1);
    const double residual = defect.norm() / pairs.vectors.col(i).norm();
    pairs.residuals.push_back(residual);
    if (!is_first_of_pair(pairs, i)) continue;
    pairs.residuals.push_back(residual);
    ++i;
  }
  return pairs;
}

std::vector<std::complex<double>> dense_eigenvalues(Eigen::MatrixXd matrix) {
  const auto n = static_cast<PetscBLASInt>(matrix.rows());
  std::vector<std::complex<double>> values;
  if (n == 0) return values;
  Eigen::VectorXd re(n);
  Eigen::VectorXd im(n);
  const PetscBLASInt no_vectors = 1;
  PetscBLASInt length = -1;  // asks for the length of the workspace
  PetscBLASInt status = 0;
  std::vector<PetscScalar> work(1);
  for (int call = 0; call < 2; ++call) {
    LAPACKgeev_("N", "N", &n, matrix.data(), &n, re.data(), im.data(), nullptr, &no_vectors,
                nullptr, &no_vectors, work.data(), &length, &status);
    length = static_cast<PetscBLASInt>(work.front());
    if (call == 0) work.resize(static_cast<std::size_t>(length));
  }
  if (status != 0)
    throw ConvergenceError("eigenvalues: LAPACK's QR iteration does not converge (" +
                           std::to_string(status) + ")");
  for (Eigen::Index i = 0; i < n; ++i) values.emplace_back(re(i), im(i));
  return values;
}

namespace {

/// A LinearMap as a PETSc matrix. PETSc's stack does not carry exceptions: the first one is kept.
struct ShellOfMap {
  ShellOfMap(Eigen::Index size, const LinearMap& linear_map) : map(linear_map) {
    const auto n = static_cast<PetscInt>(size);
    petsc::check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, this, matrix.fill()));
    petsc::check(
        MatShellSetOperation(matrix.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
  }

  static PetscErrorCode multiply(Mat shell, Vec x, Vec y) noexcept {
    void* context = nullptr;
    if (const PetscErrorCode code = MatShellGetContext(shell, &context)) return code;
    auto& self = *static_cast<ShellOfMap*>(context);
    try {
      PetscInt size = 0;
      petsc::check(VecGetLocalSize(x, &size));
      const petsc::ReadView in(x);
      const petsc::WriteView out(y);
      Eigen::Map<Eigen::VectorXd>(out.data(), size) =
          self.map(Eigen::Map<const Eigen::VectorXd>(in.data(), size));
    } catch (...) {
      if (!self.error) self.error = std::current_exception();
      return PETSC_ERR_LIB;
    }
    return 0;
  }

  const LinearMap& map;
  petsc::Handle<Mat> matrix;
  std::exception_ptr error;
};

}  // namespace

std::vector<std::complex<double>> largest_eigenvalues(Eigen::Index size, const LinearMap& map,
                                                      int count, double tolerance) {
  ShellOfMap shell(size, map);
  petsc::Handle<EPS> solver;
  petsc::check(EPSCreate(PETSC_COMM_SELF, solver.fill()));
  petsc::check(EPSSetOperators(solver.get(), shell.matrix.get(), nullptr));
  petsc::check(EPSSetProblemType(solver.get(), EPS_NHEP));
  petsc::check(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_MAGNITUDE));
  petsc::check(EPSSetDimensions(solver.get(), count, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc::check(EPSSetTolerances(solver.get(), tolerance, PETSC_DEFAULT));
  const PetscErrorCode code = EPSSolve(solver.get());
  if (shell.error) std::rethrow_exception(shell.error);
  petsc::check(code);
  PetscInt converged = 0;
  petsc::check(EPSGetConverged(solver.get(), &converged));
  std::vector<std::complex<double>> values;
  for (PetscInt i = 0; i < converged; ++i) {
    PetscScalar re = 0.0;
    PetscScalar im = 0.0;
    petsc::check(EPSGetEigenvalue(solver.get(), i, &re, &im));
    values.emplace_back(re, im);
  }
  return values;
}

Eigen::VectorXd condition_numbers(const Eigenpairs& pairs) {
  // The rows of the inverse of the real parts are 2 Re y and -2 Im y of a left eigenvector y.
  Eigen::MatrixXd inverse = real_parts(pairs);
  const auto n = static_cast<blas::Integer>(inverse.rows());
  std::vector<blas::Integer> interchanges(static_cast<std::size_t>(n));
  if (blas::factor(n, inverse.data(), interchanges.data()) != 0)
    return Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  blas::invert(n, inverse.data(), interchanges.data());
  Eigen::VectorXd sizes = inverse.rowwise().norm();
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!is_first_of_pair(pairs, i)) continue;
    sizes.segment<2>(i).setConstant(sizes.segment<2>(i).norm() / 2.0);
    ++i;
  }
  sizes = sizes.cwiseProduct(pairs.vectors.colwise().norm().transpose()).eval();
  return sizes.unaryExpr([](double size) {
    return std::isfinite(size) ? size : std::numeric_limits<double>::infinity();
  });
}

}  // namespace samara::analysis
