// Growth of a disturbance in a transient, against the exponent of a mode.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/mode.hpp"
#include "samara/analysis/trim.hpp"

#include "time_series.hpp"

namespace samara::test {

/// A resolved mode and its shape at t = 0, the largest position 1.
struct FoundMode {
  analysis::Mode mode;
  Eigen::VectorXcd shape;
};

/// The time of a transient: `count` periods, each of `steps` steps. A turbine at rest has a period
/// of any length.
struct Window {
  double period = 0.0;  ///< [s]
  int steps = 0;
  int count = 0;
};

/// Disturbs the steady state along a mode, and compares growth and frequency of the transient with
/// its exponent. Returns the disturbance at each step: half the difference of a disturbance and its
/// opposite, in which what is even drops out.
inline std::vector<Eigen::VectorXd> require_exponent(const system::PeriodicSystem& system,
                                                     const analysis::Trim& trim,
                                                     const FoundMode& found, const Window& window,
                                                     double relative) {
  const auto& [period, steps, revolutions] = window;
  constexpr double amplitude = 1e-3;
  std::array<std::vector<Eigen::VectorXd>, 2> runs;
  for (const int side : {0, 1}) {
    analysis::TransientStart start = analysis::start_on(system, trim, 0.0);
    start.z += (side == 0 ? amplitude : -amplitude) * analysis::real_part(found.shape);
    start.z_dot.resize(0);
    Keeper<Eigen::VectorXd> keeper(
        [](const analysis::TransientSample& sample) { return values_of(sample.z); });
    analysis::run_transient(
        system, start,
        steps_of(period / steps, revolutions * period, analysis::TransientMethod::midpoint),
        keeper);
    runs[static_cast<std::size_t>(side)] = keeper.values;
  }
  // Once a period: s(n+1) = 2 Re mu s(n) - |mu|^2 s(n-1) in every position.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  const auto difference = [&](int row) -> Eigen::VectorXd {
    const auto at = static_cast<std::size_t>(row);
    return 0.5 * (runs[0][at] - runs[1][at]);
  };
  for (int n = 1; n + 1 < revolutions; ++n) {
    const Eigen::VectorXd before = difference(1 + (n - 1) * steps);
    const Eigen::VectorXd now = difference(1 + n * steps);
    const Eigen::VectorXd after = difference(1 + (n + 1) * steps);
    for (std::size_t i = 0; i < system.unknowns().size(); ++i) {
      if (system.unknowns()[i].role != system::UnknownRole::position) continue;
      const auto k = static_cast<Eigen::Index>(i);
      const Eigen::Vector2d terms(now(k), -before(k));
      normal += terms * terms.transpose();
      right += terms * after(k);
    }
  }
  const Eigen::Vector2d fit = normal.inverse() * right;
  const double growth = 0.5 * std::log(fit(1)) / period;
  BOOST_TEST_MESSAGE(found.mode.label << ": " << growth << " against "
                                      << found.mode.exponent.real());
  BOOST_TEST_CONTEXT(found.mode.label)
  BOOST_TEST(growth == found.mode.exponent.real(), boost::test_tools::tolerance(relative));
  // The angle of the multiplier, up to its sign and whole turns.
  const double angle = std::acos(0.5 * fit(0) / std::sqrt(fit(1)));
  const double expected =
      std::abs(std::remainder(found.mode.exponent.imag() * period, 2.0 * std::numbers::pi));
  BOOST_TEST_CONTEXT(found.mode.label)
  BOOST_TEST(std::abs(angle - expected) < relative * std::abs(found.mode.exponent) * period);
  std::vector<Eigen::VectorXd> differences;
  for (int row = 0; row <= steps * revolutions; ++row) differences.push_back(difference(row));
  return differences;
}

}  // namespace samara::test
