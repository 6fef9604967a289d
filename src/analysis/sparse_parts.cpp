#include "samara/analysis/sparse_parts.hpp"

#include <numeric>
#include <string>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"

namespace samara::analysis {

SparseTangents tangents_on(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                           double t) {
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Mat> jacobian = system.make_jacobian();
  const petsc::Handle<Mat> mass = system.make_mass();
  solution.evaluate(t, z.get(), z_dot.get());
  system.tangents(t, z.get(), z_dot.get(), 0.0, jacobian.get(), mass.get());
  return {to_sparse(jacobian.get()), to_sparse(mass.get())};
}

Sparse part(const Sparse& whole, const std::vector<PetscInt>& rows,
            const std::vector<PetscInt>& columns) {
  std::vector<int> place(static_cast<std::size_t>(whole.rows()), -1);
  for (std::size_t i = 0; i < rows.size(); ++i)
    place[static_cast<std::size_t>(rows[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (Sparse::InnerIterator it(whole, columns[j]); it; ++it)
      if (place[static_cast<std::size_t>(it.row())] >= 0)
        entries.emplace_back(place[static_cast<std::size_t>(it.row())], static_cast<int>(j),
                             it.value());
  Sparse picked(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  picked.setFromTriplets(entries.begin(), entries.end());
  return picked;
}

Sparse rows_of(const Sparse& whole, const std::vector<PetscInt>& rows) {
  std::vector<PetscInt> all(static_cast<std::size_t>(whole.cols()));
  std::iota(all.begin(), all.end(), PetscInt{0});
  return part(whole, rows, all);
}

SparseSolver::SparseSolver(const Sparse& matrix, const char* what) : empty_(matrix.rows() == 0) {
  if (empty_) return;
  lu_.compute(matrix);
  if (lu_.info() != Eigen::Success)
    throw InternalError(std::string("the ") + what + " do not determine the state");
}

Eigen::MatrixXd SparseSolver::solve(const Eigen::MatrixXd& right) const {
  return empty_ ? right : Eigen::MatrixXd(lu_.solve(right));
}

}  // namespace samara::analysis
