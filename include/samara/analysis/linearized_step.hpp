// One step of the midpoint rule for the linearized system (Lee, Hodges & Patil (2002), eq. (19)),
// as the nonlinear steps of the shooting method need it.
//
// One factorization serves all columns. Rows with rates are satisfied at the middle of the step;
// rows without rates (strains) are satisfied at its end, where rigid strains remain exactly zero.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// One step of the linearized system, factored.
class LinearizedStep {
 public:
  /// `carried`: see ConsistentSubspace. `fixed_constraints`: the rows without rates never change,
  /// and need no tangents at the end of the step. `prefix`: of the solver's options.
  LinearizedStep(const system::PeriodicSystem& system, const std::vector<bool>& carried,
                 double step, bool fixed_constraints, const std::string& prefix);

  /// Factors the tangents at the middle, with those of the rows without rates at the end (t_end,
  /// z_end).
  void factor(double t_middle, Vec z_middle, Vec z_dot_middle, double t_end, Vec z_end,
              Vec z_dot_end);

  /// Advances columns of states from the start of the step to its end; returns their values at the
  /// middle, which are valid until the next call. `load` (size x columns or empty) is added to the
  /// rows.
  const Eigen::MatrixXd& advance(Eigen::MatrixXd& z, const Eigen::MatrixXd& load = {});

  /// Solves J x = right for the values x at the middle, J = 2 M / dt + K.
  void solve(Eigen::MatrixXd& right) { solver_.solve(right); }

  /// Replaces the values z at the start of the step by those at its end, from those at its middle.
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

}  // namespace samara::analysis
