#include "samara/analysis/periodic_solution.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace samara::analysis {

PeriodicSolution::PeriodicSolution(Eigen::MatrixXd coefficients, double period)
    : coefficients_(std::move(coefficients)), period_(period) {}

Eigen::VectorXd PeriodicSolution::basis(int harmonics, double period, double t) {
  Eigen::VectorXd values(2 * harmonics + 1);
  values(0) = 1.0;
  for (int j = 1; j <= harmonics; ++j) {
    const double phase = 2.0 * std::numbers::pi * j * t / period;
    values(2 * j - 1) = std::cos(phase);
    values(2 * j) = std::sin(phase);
  }
  return values;
}

Eigen::VectorXd PeriodicSolution::basis_rate(int harmonics, double period, double t) {
  Eigen::VectorXd values(2 * harmonics + 1);
  values(0) = 0.0;
  for (int j = 1; j <= harmonics; ++j) {
    const double rate = 2.0 * std::numbers::pi * j / period;
    values(2 * j - 1) = -rate * std::sin(rate * t);
    values(2 * j) = rate * std::cos(rate * t);
  }
  return values;
}

void PeriodicSolution::evaluate(double t, Vec z, Vec z_dot) const {
  const petsc::WriteView state(z);
  const petsc::WriteView rate(z_dot);
  Eigen::Map<Eigen::VectorXd> values(state.data(), coefficients_.rows());
  Eigen::Map<Eigen::VectorXd> rates(rate.data(), coefficients_.rows());
  if (is_constant()) {
    values = coefficients_.col(0);
    rates.setZero();
    return;
  }
  values = coefficients_ * basis(harmonics(), period_, t);
  rates = coefficients_ * basis_rate(harmonics(), period_, t);
}

}  // namespace samara::analysis
