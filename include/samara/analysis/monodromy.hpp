// Integrates the linearized periodic system over a period (docs/theory.md, section 5; Lee, Hodges &
// Patil (2002), eq. (18), (19)).
//
// One factorization a step serves all columns. Rows with rates hold at the middle of a step with
// central differences, as (19); rows without (strains) hold at the step's end. Where those rows are
// constant in time the two are the same; where they change with the steady state, only the second
// keeps rigid strains exactly unstrained.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// One step of the linearized system, factored.
class LinearizedStep {
 public:
  /// `carried`: see ConsistentSubspace. `fixed_constraints`: the rows without rates never change,
  /// and need no tangents of their own. `prefix`: of the solver's options.
  LinearizedStep(const system::PeriodicSystem& system, const std::vector<bool>& carried,
                 double step, bool fixed_constraints, const std::string& prefix);

  /// Tangents at the middle, and of the rows without rates at the end (t_end, z_end).
  void factor(double t_middle, Vec z_middle, Vec z_dot_middle, double t_end, Vec z_end,
              Vec z_dot_end);

  /// Columns of states from the step's start to its end; returns their values at the middle, which
  /// stand until the next call. `load` (size x columns or empty) is added to the rows.
  const Eigen::MatrixXd& advance(Eigen::MatrixXd& z, const Eigen::MatrixXd& load = {});

  /// Solves J x = right for the values x at the middle, J = 2 M / dt + K.
  void solve(Eigen::MatrixXd& right) { solver_.solve(right); }

  /// From the values z at the step's start and those at its middle to the values at its end.
  void to_end(Eigen::Ref<Eigen::MatrixXd> z,
              const Eigen::Ref<const Eigen::MatrixXd>& middle) const {
    z = (2.0 * middle - z).array().colwise() * carried_.array();
  }

 private:
  void replace_constraints(double t_end, Vec z_end, Vec z_dot_end);

  const system::PeriodicSystem& system_;
  Eigen::VectorXd carried_;  ///< 1 where the end of a step follows from its middle, else 0
  double step_;
  bool fixed_constraints_;
  petsc::Handle<Mat> jacobian_;
  petsc::Handle<Mat> mass_;
  petsc::Handle<Mat> end_jacobian_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> constraint_rows_;
  Eigen::MatrixXd middle_;
  DirectSolver solver_;
};

/// Advances columns of states along a periodic solution; a negative step goes back in time.
class StepPropagator {
 public:
  StepPropagator(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                 const std::vector<bool>& carried, double step);

  /// From z at the start of step k (t = k step) to its end; returns the values at the middle, which
  /// stand until the next call.
  const Eigen::MatrixXd& advance(long k, Eigen::MatrixXd& z);

  /// The same step with other columns.
  const Eigen::MatrixXd& repeat(Eigen::MatrixXd& z) { return linearized_.advance(z); }

 private:
  const PeriodicSolution& solution_;
  double step_;
  petsc::Handle<Vec> z_, z_dot_, z_end_, z_dot_end_;
  LinearizedStep linearized_;
};

}  // namespace samara::analysis
