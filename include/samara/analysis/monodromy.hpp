// Integrates the linearized periodic system over a period (docs/theory.md, section 5; Lee, Hodges &
// Patil (2002), eq. (18), (19)).
//
// One factorization a step serves all columns. Rows with rates hold at the middle of a step with
// central differences, as (19); rows without (strains) hold at the step's end. Where those rows are
// constant in time the two are the same; where they change with the steady state, only the second
// keeps rigid strains exactly unstrained.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Advances columns of states step by step.
class StepPropagator {
 public:
  /// `step` [s], `carried`: see ConsistentSubspace.
  StepPropagator(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                 std::vector<bool> carried, double step);

  /// From z at the start of step k (t = k step) to its end; returns the values at the middle.
  Eigen::MatrixXd advance(long k, Eigen::MatrixXd& z);

 private:
  void replace_constraints(long k);

  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  std::vector<bool> carried_;
  double step_;
  bool fixed_constraints_;
  petsc::Handle<Vec> z_;
  petsc::Handle<Vec> z_dot_;
  petsc::Handle<Mat> jacobian_;
  petsc::Handle<Mat> mass_;
  petsc::Handle<Mat> end_jacobian_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> constraint_rows_;
  DirectSolver solver_;
};

}  // namespace samara::analysis
