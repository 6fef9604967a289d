#include "admissible_velocities.hpp"

#include <algorithm>
#include <string>

#include "samara/base/error.hpp"

#include "matrix_entries.hpp"

namespace samara::analysis {
namespace {

/// Step of the central difference quotient for constraints that change with time, relative to a
/// time step.
constexpr double difference_fraction = 0.01;

using system::RowRole;
using system::UnknownRole;

}  // namespace

AdmissibleVelocities::AdmissibleVelocities(const system::PeriodicSystem& system, double dt)
    : system_(system),
      interval_(difference_fraction * dt),
      rates_(system.make_state()),
      r_(system.make_state()),
      jump_(system.make_state()),
      matrix_(system.make_jacobian()),
      mass_(system.make_mass()),
      // Impulses of some hinged blades with rigid strains are not unique (docs/decisions.md).
      solver_("transient_impulse_", equilibrate, DirectSolver::Elimination::petsc) {
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
  MatrixEntries(matrix_.get()).for_each([&](PetscInt i, PetscInt j, PetscScalar& value) {
    if (row(i) == RowRole::constraint) return;
    if (column(j) != kept_by(row(i)).of_K) value = 0.0;
  });
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
  if (!system_.constraints_are_autonomous())
    for (const double side : {-1.0, 1.0}) {
      system_.residual(t + side * interval_, z, rates_.get(), r_.get());
      take(r_.get(), 0, RowRole::constraint, -side / (2.0 * interval_));
    }
  system_.tangents(t, z, rates_.get(), 0.0, matrix_.get(), mass_.get());
  {
    const petsc::WriteView view(jump_.get());
    Eigen::Map<Eigen::VectorXd>(view.data(), n) = jump;
  }
  petsc::check(MatMult(matrix_.get(), jump_.get(), r_.get()));
  take(r_.get(), 1, RowRole::kinematic, -1.0);
  build();
  try {
    solver_.factor(matrix_.get());
  } catch (const SingularError&) {
    throw ConvergenceError(
        "transient: the midpoint rule needs inertia in every motion, and one has none; hint: "
        "transient.method: bdf2");
  }
  solver_.solve(right);
  return right;
}

}  // namespace samara::analysis
