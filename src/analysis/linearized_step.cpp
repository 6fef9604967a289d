#include "samara/analysis/linearized_step.hpp"

#include <cmath>

namespace samara::analysis {

LinearizedStep::LinearizedStep(const system::PeriodicSystem& system,
                               const std::vector<bool>& carried, double step,
                               bool fixed_constraints, const std::string& prefix)
    : system_(system),
      carried_(static_cast<Eigen::Index>(carried.size())),
      step_(step),
      fixed_constraints_(fixed_constraints),
      jacobian_(system.make_jacobian()),
      mass_(system.make_mass()),
      solver_(prefix, [&system, step](Mat matrix) {
        return scale_by_role(system, matrix, 2.0 / std::abs(step));
      }) {
  for (std::size_t i = 0; i < carried.size(); ++i)
    carried_(static_cast<Eigen::Index>(i)) = carried[i] ? 1.0 : 0.0;
  if (!fixed_constraints_) end_jacobian_ = system.make_jacobian();
}

void LinearizedStep::factor(double t_middle, Vec z_middle, Vec z_dot_middle, double t_end,
                            Vec z_end, Vec z_dot_end) {
  system_.tangents(t_middle, z_middle, z_dot_middle, 2.0 / step_, jacobian_.get(), mass_.get());
  if (!fixed_constraints_) replace_constraints(t_end, z_end, z_dot_end);
  solver_.factor(jacobian_.get());
}

void LinearizedStep::replace_constraints(double t_end, Vec z_end, Vec z_dot_end) {
  system_.tangents(t_end, z_end, z_dot_end, 0.0, end_jacobian_.get(), nullptr);
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<PetscInt> row_columns;
  std::vector<PetscScalar> row_values;
  for (PetscInt i = 0; i < system_.size(); ++i) {
    if (system_.rows()[static_cast<std::size_t>(i)] != system::RowRole::constraint) continue;
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    petsc::check(MatGetRow(end_jacobian_.get(), i, &count, &columns, &values));
    row_columns.assign(columns, columns + count);
    row_values.assign(values, values + count);
    petsc::check(MatRestoreRow(end_jacobian_.get(), i, &count, &columns, &values));
    for (std::size_t c = 0; c < row_columns.size(); ++c)
      if (row_values[c] != 0.0) entries.emplace_back(i, row_columns[c], row_values[c]);
    petsc::check(MatSetValues(jacobian_.get(), 1, &i, static_cast<PetscInt>(row_columns.size()),
                              row_columns.data(), row_values.data(), INSERT_VALUES));
  }
  petsc::check(MatAssemblyBegin(jacobian_.get(), MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(jacobian_.get(), MAT_FINAL_ASSEMBLY));
  constraint_rows_.resize(system_.size(), system_.size());
  constraint_rows_.setFromTriplets(entries.begin(), entries.end());
}

const Eigen::MatrixXd& LinearizedStep::advance(Eigen::MatrixXd& z, const Eigen::MatrixXd& load) {
  // With z_f = 2 z_m - z_i: (2/dt M + K) z_m = 2/dt M z_i, and D_f z_m = D_f z_i / 2.
  const Eigen::SparseMatrix<double, Eigen::RowMajor> mass = to_sparse_rows(mass_.get());
  Eigen::SparseMatrix<double, Eigen::RowMajor> start = (2.0 / step_) * mass;
  if (!fixed_constraints_) start += 0.5 * constraint_rows_;
  middle_.noalias() = start * z;
  if (load.size() > 0) middle_ += load;
  solver_.solve(middle_);
  to_end(z, middle_);
  return middle_;
}

}  // namespace samara::analysis
