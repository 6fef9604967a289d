// Shooting against harmonic balance, which has no error of the step.
#include "samara/analysis/shooting.hpp"

#include <boost/test/unit_test.hpp>

#include "samara/analysis/harmonic_balance.hpp"
#include "samara/base/error.hpp"

#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using analysis::solve_harmonic_balance;
using analysis::solve_shooting;

namespace {

/// Largest difference of two series, over the harmonics of the shorter.
double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::Index columns = std::min(a.cols(), b.cols());
  return (a.leftCols(columns) - b.leftCols(columns)).cwiseAbs().maxCoeff();
}

}  // namespace

BOOST_AUTO_TEST_CASE(duffing_differs_from_harmonic_balance_by_the_square_of_the_step) {
  const Duffing system(0.4);
  const Eigen::MatrixXd exact =
      solve_harmonic_balance(system, 20, 1e-12, nullptr).solution.coefficients();
  analysis::Observer observer;
  std::vector<Eigen::MatrixXd> found;
  std::vector<double> errors;
  for (const int steps : {100, 200, 400}) {
    const analysis::Trim trim = solve_shooting(system, steps, 1e-12, observer);
    BOOST_TEST((trim.method == analysis::TrimMethod::shooting));
    found.push_back(trim.solution.coefficients());
    errors.push_back(difference(found.back(), exact));
  }
  BOOST_TEST(std::log2(errors[0] / errors[1]) == 2.0, boost::test_tools::tolerance(0.01));
  BOOST_TEST(std::log2(errors[1] / errors[2]) == 2.0, boost::test_tools::tolerance(0.01));
  const Eigen::MatrixXd limit = (4.0 * found[2] - found[1]) / 3.0;
  BOOST_TEST(difference(limit, exact) < 1e-6 * exact.cwiseAbs().maxCoeff());
}

BOOST_AUTO_TEST_CASE(unconstrained_coordinate_is_held_by_shooting_too) {
  // The load is exact: the mean of the rule is that of the equation.
  analysis::Observer observer;
  const analysis::Trim trim = solve_shooting(FreeSlide(), 200, 1e-12, observer);
  BOOST_REQUIRE(trim.held.size() == 1U);
  BOOST_TEST(trim.held[0].load == FreeSlide::f0, boost::test_tools::tolerance(1e-9));
  const Eigen::MatrixXd exact =
      solve_harmonic_balance(FreeSlide(), 2, 1e-12, nullptr).solution.coefficients();
  BOOST_TEST(std::abs(trim.solution.coefficients()(0, 0)) < 1e-4 * exact.cwiseAbs().maxCoeff());
  // (w dt)^2 / 12 = 8e-5 of the amplitude.
  BOOST_TEST(difference(trim.solution.coefficients(), exact) < 2e-4 * exact.cwiseAbs().maxCoeff());
}

BOOST_AUTO_TEST_CASE(a_system_that_never_repeats_is_refused) {
  struct Still final : SmallSystem {
    Still() {
      add_position("x");
      add_velocity("v");
    }
    void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                     Eigen::MatrixXd& M) const override {
      K << 0.0, 1.0, 1.0, 0.0;
      M << -1.0, 0.0, 0.0, 1.0;
    }
  };
  analysis::Observer observer;
  BOOST_CHECK_THROW(solve_shooting(Still(), 100, 1e-10, observer), InputError);
}
