// A periodic steady state as a Fourier series, eq. (15).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "samara/petsc/handle.hpp"

namespace samara::analysis {

/// z(t) = h0 + sum_j hc_j cos(j Omega t) + hs_j sin(j Omega t).
class PeriodicSolution {
 public:
  /// `coefficients`: size x (2 H + 1), columns h0, hc_1, hs_1, hc_2, ...; `period` 0: constant.
  PeriodicSolution(Eigen::MatrixXd coefficients, double period);

  int harmonics() const { return static_cast<int>((coefficients_.cols() - 1) / 2); }
  bool is_constant() const { return harmonics() == 0; }
  double period() const { return period_; }
  const Eigen::MatrixXd& coefficients() const { return coefficients_; }

  /// Writes z(t) and z_dot(t).
  void evaluate(double t, Vec z, Vec z_dot) const;

  /// The 2 H + 1 functions of the series at t, and their rates.
  static Eigen::VectorXd basis(int harmonics, double period, double t);
  static Eigen::VectorXd basis_rate(int harmonics, double period, double t);

 private:
  Eigen::MatrixXd coefficients_;
  double period_;
};

}  // namespace samara::analysis
