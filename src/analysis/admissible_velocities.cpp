#include "admissible_velocities.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "samara/base/error.hpp"

#include "matrix_entries.hpp"

namespace samara::analysis {
namespace {

/// Step of the central difference quotient for constraints that change with time, relative to a
/// time step.
constexpr double difference_fraction = 0.01;

/// First value of tau relative to a time step, and its least value.
constexpr double first_tau = 1e-3;
constexpr double least_tau = 1e-7;
constexpr double tau_reduction = 0.1;
/// A fixed-point iteration that contracts less than this has too large a tau.
constexpr double slowest_contraction = 0.5;
constexpr int most_iterations = 20;
/// Residual of the scaled equations, relative to their right-hand sides and solution.
constexpr double iteration_tolerance = 1e-12;
/// The same where round-off of the right-hand side ends the contraction.
constexpr double largest_noise = 1e-10;

using system::RowRole;
using system::UnknownRole;

}  // namespace

AdmissibleVelocities::AdmissibleVelocities(const system::PeriodicSystem& system, double dt)
    : system_(system),
      dt_(dt),
      rates_(system.make_state()),
      r_(system.make_state()),
      jump_(system.make_state()),
      matrix_(system.make_jacobian()),
      mass_(system.make_mass()),
      solver_("transient_impulse_", equilibrate) {
  petsc::check(VecSet(rates_.get(), 0.0));
  const petsc::Handle<Vec> z = system.make_state();
  system.reference_state(0.0, z.get());
  classify(0.0, z.get());
}

/// Constraint rows contain the loads of elastic strains, but no reactions. The number of degrees of
/// freedom is that of the positions and the loads of elastic strains, less that of the constraints.
void AdmissibleVelocities::classify(double t, Vec z) {
  const std::size_t n = system_.unknowns().size();
  system_.tangents(t, z, rates_.get(), 0.0, matrix_.get(), nullptr);
  const Eigen::SparseMatrix<double> K = to_sparse(matrix_.get());
  long freedom = 0;
  long velocities = 0;
  for (std::size_t j = 0; j < n; ++j) {
    const UnknownRole role = system_.unknowns()[j].role;
    bool is_constrained = false;
    for (Eigen::SparseMatrix<double>::InnerIterator it(K, static_cast<Eigen::Index>(j)); it; ++it)
      is_constrained = is_constrained ||
                       system_.rows()[static_cast<std::size_t>(it.row())] == RowRole::constraint;
    columns_.push_back(role == UnknownRole::position    ? Column::position
                       : role == UnknownRole::velocity  ? Column::velocity
                       : role == UnknownRole::state     ? Column::state
                       : role == UnknownRole::auxiliary ? Column::auxiliary
                       : is_constrained                 ? Column::elastic
                                                        : Column::reaction);
    if (columns_.back() == Column::position || columns_.back() == Column::elastic) ++freedom;
    if (columns_.back() == Column::velocity) ++velocities;
    if (system_.rows()[j] == RowRole::constraint) --freedom;
  }
  is_restricted_ = velocities > freedom;
}

/// The matrix from K and M. Columns: rates of positions, rates of elastic loads, velocities,
/// impulses, rates of states, auxiliaries (not used):
///     constraint   K_p   K_e    0     0   K_x    0
///     kinematic    M_p    0    K_v    0    0     0
///     balance       0     0    M_v   K_r   0     0
///     evolution     0     0     0     0   M_x    0
///     definition    0     0     0     0    0    K_a
/// In the balance rows tau^2 K_e is added.
AdmissibleVelocities::Kept AdmissibleVelocities::kept_by(RowRole row) {
  switch (row) {
    case RowRole::constraint:
      break;  // all of K
    case RowRole::kinematic:
      return {Column::velocity, Column::position};
    case RowRole::balance:
      return {Column::reaction, Column::velocity};
    case RowRole::evolution:
      return {Column::none, Column::state};
    case RowRole::definition:
      return {Column::auxiliary, Column::none};
  }
  return {};
}

void AdmissibleVelocities::build() {
  const auto row = [this](PetscInt i) { return system_.rows()[static_cast<std::size_t>(i)]; };
  const auto column = [this](PetscInt j) { return columns_[static_cast<std::size_t>(j)]; };
  std::vector<Eigen::Triplet<double>> loads;
  MatrixEntries(matrix_.get()).for_each([&](PetscInt i, PetscInt j, PetscScalar& value) {
    if (row(i) == RowRole::constraint || column(j) == kept_by(row(i)).of_K) return;
    const bool is_load = row(i) == RowRole::balance && column(j) == Column::elastic;
    value *= is_load ? tau_ * tau_ : 0.0;
    if (value != 0.0) loads.emplace_back(i, j, value);
  });
  added_.resize(system_.size(), system_.size());
  added_.setFromTriplets(loads.begin(), loads.end());
  std::vector<PetscScalar> kept;
  for (PetscInt i = 0; i < system_.size(); ++i) {
    const Column wanted = kept_by(row(i)).of_M;
    if (wanted == Column::none) continue;
    PetscInt count = 0;
    const PetscInt* at = nullptr;
    const PetscScalar* values = nullptr;
    petsc::check(MatGetRow(mass_.get(), i, &count, &at, &values));
    kept.assign(values, values + count);
    for (PetscInt k = 0; k < count; ++k)
      if (column(at[k]) != wanted) kept[static_cast<std::size_t>(k)] = 0.0;
    petsc::check(MatSetValues(matrix_.get(), 1, &i, count, at, kept.data(), ADD_VALUES));
    petsc::check(MatRestoreRow(mass_.get(), i, &count, &at, &values));
  }
  petsc::check(MatAssemblyBegin(matrix_.get(), MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(matrix_.get(), MAT_FINAL_ASSEMBLY));
}

Jumps AdmissibleVelocities::correct(double t, Vec z, const Eigen::VectorXd& jump) {
  const auto n = static_cast<Eigen::Index>(system_.size());
  Jumps right = Jumps::Zero(n, 2);
  const auto take = [&](Vec from, Eigen::Index into, RowRole role, double factor) {
    const petsc::ReadView view(from);
    for (Eigen::Index i = 0; i < n; ++i)
      if (system_.rows()[static_cast<std::size_t>(i)] == role)
        right(i, into) += factor * view[static_cast<PetscInt>(i)];
  };
  system_.residual(t, z, rates_.get(), r_.get());
  take(r_.get(), 0, RowRole::kinematic, -1.0);
  take(r_.get(), 0, RowRole::evolution, -1.0);
  const double interval = difference_fraction * dt_;
  if (!system_.constraints_are_autonomous())
    for (const double side : {-1.0, 1.0}) {
      system_.residual(t + side * interval, z, rates_.get(), r_.get());
      take(r_.get(), 0, RowRole::constraint, -side / (2.0 * interval));
    }
  {
    const petsc::WriteView view(jump_.get());
    Eigen::Map<Eigen::VectorXd>(view.data(), n) = jump;
  }
  system_.tangents(t, z, rates_.get(), 0.0, matrix_.get(), mass_.get());
  petsc::check(MatMult(matrix_.get(), jump_.get(), r_.get()));
  take(r_.get(), 1, RowRole::kinematic, -1.0);
  // A value that depended on the steps before would make a restarted run another one.
  for (tau_ = first_tau * dt_; tau_ >= least_tau * dt_; tau_ *= tau_reduction) {
    build();
    try {
      solver_.factor(matrix_.get());
    } catch (const SingularError&) {
      throw ConvergenceError(
          "transient: the midpoint rule needs inertia or stiffness in every motion, and one has "
          "neither; hint: transient.method: bdf2");
    }
    Jumps jumps = right;
    if (solve(jumps)) return jumps;
    system_.tangents(t, z, rates_.get(), 0.0, matrix_.get(), mass_.get());
  }
  throw ConvergenceError(
      "transient: the velocities after a step of the midpoint rule are not found; hint: "
      "transient.method: bdf2");
}

/// A + B is factored, B the added terms. Fixed-point iteration for A x = b, from the solution with
/// B: x_k+1 = (A + B)^-1 (b + B x_k), whose residual is B (x_k - x_k+1). It contracts motions of
/// frequency w by (tau w)^2, and leaves motions without inertia as they are in the first solution.
/// (Round-off moves these by the same amount each time: the residual shows the end, the velocities
/// do not.)
/// @returns false where it does not contract
bool AdmissibleVelocities::solve(Jumps& jumps) {
  const Jumps right = jumps;
  solver_.solve(jumps);
  const petsc::ReadView rows(solver_.scaling().rows.get());
  const petsc::ReadView columns(solver_.scaling().columns.get());
  const Eigen::Map<const Eigen::ArrayXd> row_factors(rows.data(), right.rows());
  const Eigen::Map<const Eigen::ArrayXd> column_factors(columns.data(), right.rows());
  const auto largest = [](const auto& array) { return array.abs().maxCoeff(); };
  const double size = largest(right.array().colwise() * row_factors) +
                      largest(jumps.array().colwise() / column_factors);
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Jumps next = right + added_ * jumps;
    solver_.solve(next);
    const double residual =
        largest((added_ * (next - jumps)).eval().array().colwise() * row_factors);
    jumps.swap(next);
    if (residual <= iteration_tolerance * size) return true;
    if (!(residual <= slowest_contraction * last))
      return iteration > 0 && residual <= largest_noise * size;
    last = residual;
  }
  return false;
}

}  // namespace samara::analysis
