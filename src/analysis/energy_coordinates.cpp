#include "energy_coordinates.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "samara/analysis/harmonic_energy.hpp"
#include "samara/analysis/linear_algebra.hpp"

#include "blas.hpp"

namespace samara::analysis {
namespace {

/// Pivot of a factorization, relative to the diagonal, that may be round-off; and eigenvalue of a
/// metric with ones on the diagonal that is.
constexpr double least_pivot = 1e-11;
constexpr double least_eigenvalue = 1e-13;

using Factors = Eigen::LLT<Eigen::MatrixXd>;

/// R with R^T R = metric; `fallback` on the diagonal where the metric is not positive definite.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& metric, const Factors& factors, double fallback) {
  if (factors.info() != Eigen::Success || !metric.allFinite())
    return fallback * Eigen::MatrixXd::Identity(metric.rows(), metric.cols());
  return factors.matrixU();
}

/// Basis of the null space of a metric, d x its dimension.
Eigen::MatrixXd null_space_of(const Eigen::MatrixXd& metric, const Factors& factors) {
  const Eigen::VectorXd diagonal = metric.diagonal();
  const bool has_null_columns = diagonal.size() == 0 || !(diagonal.minCoeff() > 0.0);
  if (has_null_columns || !metric.allFinite() ||
      (factors.info() == Eigen::Success &&
       (factors.matrixLLT().diagonal().array().square() > least_pivot * diagonal.array()).all()))
    return {metric.rows(), 0};
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * metric *
                                                              scale.asDiagonal());
  const Eigen::Index null = (solver.eigenvalues().array() < least_eigenvalue).count();
  return scale.asDiagonal() * solver.eigenvectors().leftCols(null);
}

/// Twice the energy of the groups of a kind as a quadratic form of the columns: d x d.
Eigen::MatrixXd metric_of(const system::PeriodicSystem& system, system::EnergyGroup::Kind kind,
                          const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  Eigen::Index rows = 0;
  for (const system::EnergyGroup& group : system.energy_groups())
    if (group.kind == kind) rows += static_cast<Eigen::Index>(group.unknowns.size());
  Eigen::MatrixXd signals = Eigen::MatrixXd::Zero(rows, columns.cols());
  Eigen::Index first = 0;
  for (const system::EnergyGroup& group : system.energy_groups()) {
    if (group.kind != kind || group.unknowns.empty()) continue;
    const Eigen::MatrixXd root = energy_root(group);
    signals.middleRows(first, root.rows()) = root * columns(group.unknowns, Eigen::all);
    first += root.rows();
  }
  return multiply(signals.transpose(), signals);
}

/// R^-1 B (`side` 'L') or B R^-1 ('R') for an upper triangle R.
void divide_by(char side, const Eigen::MatrixXd& triangle, Eigen::Ref<Eigen::MatrixXd> columns) {
  if (columns.size() == 0) return;
  blas::divide_by_upper(side, static_cast<blas::Integer>(columns.rows()),
                        static_cast<blas::Integer>(columns.cols()), triangle.data(),
                        static_cast<blas::Integer>(triangle.rows()), columns.data(),
                        static_cast<blas::Integer>(columns.outerStride()));
}

}  // namespace

EnergyCoordinates::EnergyCoordinates(const system::PeriodicSystem& system,
                                     const Eigen::MatrixXd& basis, Eigen::Index d, double rate) {
  Eigen::MatrixXd kinetic =
      metric_of(system, system::EnergyGroup::Kind::kinetic, basis.middleCols(d, d));
  Eigen::MatrixXd strain = metric_of(system, system::EnergyGroup::Kind::strain, basis.leftCols(d));
  Factors kinetic_factors(kinetic);
  without_inertia_ = null_space_of(kinetic, kinetic_factors);
  strain += rate * rate * kinetic;
  eta_ = root_of(strain, Factors(strain), 1.0);
  // As large as the strain energy at `rate`.
  if (without_inertia_.cols() > 0) {
    const Eigen::MatrixXd loads = strain * without_inertia_ / rate;
    kinetic.noalias() +=
        loads *
        (without_inertia_.transpose() * strain * without_inertia_).ldlt().solve(loads.transpose());
    kinetic_factors.compute(kinetic);
  }
  rate_ = root_of(kinetic, kinetic_factors, 1.0 / rate);
}

void EnergyCoordinates::divide(Eigen::MatrixXd& columns) const {
  const Eigen::Index d = eta_.rows();
  divide_by('R', eta_, columns.leftCols(d));
  divide_by('R', rate_, columns.middleCols(d, d));
}

Eigen::MatrixXd EnergyCoordinates::of(const Eigen::MatrixXd& states) const {
  const Eigen::Index d = eta_.rows();
  Eigen::MatrixXd result(states.rows(), states.cols());
  result.topRows(d) = multiply(eta_, states.topRows(d));
  result.middleRows(d, d) = multiply(rate_, states.middleRows(d, d));
  result.bottomRows(states.rows() - 2 * d) = states.bottomRows(states.rows() - 2 * d);
  return result;
}

Eigen::MatrixXd EnergyCoordinates::states_of(const Eigen::MatrixXd& coordinates) const {
  const Eigen::Index d = eta_.rows();
  Eigen::MatrixXd states = coordinates;
  divide_by('L', eta_, states.topRows(d));
  divide_by('L', rate_, states.middleRows(d, d));
  return states;
}

}  // namespace samara::analysis
