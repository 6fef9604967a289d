#include "samara/analysis/impulse_equations.hpp"

#include "matrix_entries.hpp"

namespace samara::analysis {

using system::RowRole;
using system::UnknownRole;

ImpulseEquations::ImpulseEquations(const system::PeriodicSystem& system, const std::string& prefix)
    : system_(system),
      matrix_(system.make_jacobian()),
      mass_(system.make_mass()),
      solver_(prefix, equilibrate) {
  classify();
}

/// Constraint rows contain the loads of elastic strains, but no reactions. The number of degrees of
/// freedom is that of the positions and the loads of elastic strains, less that of the constraints.
void ImpulseEquations::classify() {
  const std::size_t n = system_.unknowns().size();
  const petsc::Handle<Vec> z = system_.make_state();
  const petsc::Handle<Vec> rates = system_.make_state();
  petsc::check(VecSet(rates.get(), 0.0));
  system_.reference_state(0.0, z.get());
  system_.tangents(0.0, z.get(), rates.get(), 0.0, matrix_.get(), nullptr);
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

void ImpulseEquations::evaluate(double t, Vec z, Vec z_dot) {
  system_.tangents(t, z, z_dot, 0.0, matrix_.get(), mass_.get());
}

ImpulseEquations::Kept ImpulseEquations::kept_by(RowRole row) {
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

void ImpulseEquations::factor(double tau) {
  const auto row = [this](PetscInt i) { return system_.rows()[static_cast<std::size_t>(i)]; };
  const auto column = [this](PetscInt j) { return columns_[static_cast<std::size_t>(j)]; };
  std::vector<Eigen::Triplet<double>> loads;
  MatrixEntries(matrix_.get()).for_each([&](PetscInt i, PetscInt j, PetscScalar& value) {
    if (row(i) == RowRole::constraint || column(j) == kept_by(row(i)).of_K) return;
    const bool is_load = row(i) == RowRole::balance && column(j) == Column::elastic;
    value *= is_load ? tau * tau : 0.0;
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
  solver_.factor(matrix_.get());
}

}  // namespace samara::analysis
