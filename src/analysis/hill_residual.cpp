#include "hill_residual.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/petsc/handle.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;

/// `rate`: of the motion [rad/s].
Eigen::VectorXd row_factors(const system::PeriodicSystem& system, double rate,
                            const Eigen::SparseMatrix<double>& K,
                            const Eigen::SparseMatrix<double>& M) {
  const Eigen::SparseMatrix<double> sizes = K.cwiseAbs() + rate * M.cwiseAbs();
  const Equilibration scaling = scaling_by_role(system, sizes, rate);
  const petsc::ReadView view(scaling.rows.get());
  return Eigen::Map<const Eigen::VectorXd>(view.data(), system.size());
}

}  // namespace

std::vector<double> find_hill_residuals(const system::PeriodicSystem& system,
                                        const PeriodicSolution& solution,
                                        const std::vector<const HillPair*>& pairs,
                                        const Ranks& ranks) {
  if (pairs.empty()) return {};
  const double speed = system::base_rate(system);
  const auto count = static_cast<Index>(pairs.size());
  const int harmonics = static_cast<int>((pairs.front()->series.rows() - 1) / 2);
  const int instants = system.period() > 0.0 ? 4 * harmonics + 5 : 1;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Mat> jacobian = system.make_jacobian();
  const petsc::Handle<Mat> mass = system.make_mass();
  std::vector<double> largest(pairs.size(), 0.0);
  std::vector<double> scale(pairs.size(), 0.0);
  // By the tangents at the first instant, on all ranks, for each rate. Loads of constant tangents,
  // which have one instant, are as large as the exponent says.
  std::map<double, Eigen::VectorXd> rows_of_rates;
  const auto rate_of = [&](Complex exponent) {
    if (instants > 1) return speed;
    return speed * std::exp2(std::ceil(std::log2(std::max(1.0, std::abs(exponent) / speed))));
  };
  Eigen::MatrixXcd values(system.size(), count);
  Eigen::MatrixXcd rates(system.size(), count);
  const auto add_instant = [&](int j) {
    const double t = system.period() * (j + 0.37) / instants;
    solution.evaluate(t, z.get(), z_dot.get());
    system.tangents(t, z.get(), z_dot.get(), 0.0, jacobian.get(), mass.get());
    const Eigen::SparseMatrix<double> K = to_sparse(jacobian.get());
    const Eigen::SparseMatrix<double> M = to_sparse(mass.get());
    if (rows_of_rates.empty())
      for (const HillPair* pair : pairs)
        if (const double rate = rate_of(pair->exponent); !rows_of_rates.contains(rate))
          rows_of_rates.emplace(rate, row_factors(system, rate, K, M));
    if (j % ranks.size != ranks.rank) return;
    for (Index m = 0; m < count; ++m) {
      const HillPair& pair = *pairs[static_cast<std::size_t>(m)];
      Eigen::VectorXcd waves(2 * harmonics + 1);
      Eigen::VectorXcd wave_rates(2 * harmonics + 1);
      for (int k = -harmonics; k <= harmonics; ++k) {
        waves(k + harmonics) = std::polar(1.0, k * speed * t);
        wave_rates(k + harmonics) =
            waves(k + harmonics) * (pair.exponent + Complex(0.0, k * speed));
      }
      values.col(m) = pair.series.transpose() * waves;
      rates.col(m) = pair.series.transpose() * wave_rates;
    }
    const Eigen::MatrixXcd inertia = M * rates;
    const Eigen::MatrixXcd residual = inertia + K * values;
    const Eigen::MatrixXcd at_speed = speed * (M * values);
    for (Index m = 0; m < count; ++m) {
      const auto pair = static_cast<std::size_t>(m);
      const auto rows = rows_of_rates.at(rate_of(pairs[pair]->exponent)).array();
      const auto size_of = [&](const Eigen::MatrixXcd& columns) {
        return (columns.col(m).array() * rows).matrix().norm();
      };
      largest[pair] = std::max(largest[pair], size_of(residual));
      scale[pair] = std::max({scale[pair], size_of(inertia), size_of(at_speed)});
    }
  };
  ranks.attempt([&] {
    for (int j = 0; j < instants; ++j)
      if (j == 0 || j % ranks.size == ranks.rank) add_instant(j);
  });
  ranks.find_largest(largest);
  ranks.find_largest(scale);
  std::vector<double> residuals;
  for (std::size_t m = 0; m < pairs.size(); ++m) residuals.push_back(largest[m] / scale[m]);
  return residuals;
}

}  // namespace samara::analysis
