// One step of (19), and many.
#include "samara/analysis/monodromy.hpp"

#include <boost/test/unit_test.hpp>

#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using analysis::PeriodicSolution;
using analysis::StepPropagator;

BOOST_AUTO_TEST_CASE(a_step_is_the_midpoint_rule) {
  // (I - dt/2 A_m) z_f = (I + dt/2 A_m) z_i with A at the middle of the step.
  const Mathieu system(2.5, 1.0);
  const PeriodicSolution solution = rest(system);
  constexpr double dt = 0.1;
  StepPropagator propagator(system, solution, system.differential(), dt);
  for (const long k : {0L, 7L, 31L}) {
    Eigen::MatrixXd z = Eigen::MatrixXd::Random(2, 3);
    const Eigen::MatrixXd start = z;
    const Eigen::MatrixXd middle = propagator.advance(k, z);
    const Eigen::MatrixXd A = system.explicit_form((static_cast<double>(k) + 0.5) * dt);
    const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
    const Eigen::MatrixXd wanted = (I - 0.5 * dt * A).lu().solve((I + 0.5 * dt * A) * start);
    BOOST_TEST((z - wanted).norm() < 1e-14 * wanted.norm());
    BOOST_TEST((middle - 0.5 * (start + z)).norm() < 1e-14 * wanted.norm());
  }
}

BOOST_AUTO_TEST_CASE(columns_do_not_see_each_other) {
  const GroundResonance system(3);
  const PeriodicSolution solution = rest(system);
  StepPropagator together(system, solution, system.differential(), 0.01);
  StepPropagator alone(system, solution, system.differential(), 0.01);
  Eigen::MatrixXd z = Eigen::MatrixXd::Random(10, 4);
  Eigen::MatrixXd one = z.col(2);
  for (long k = 0; k < 5; ++k) {
    together.advance(k, z);
    alone.advance(k, one);
  }
  BOOST_TEST((z.col(2) - one).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(changing_rigid_constraint_holds_at_the_end_of_every_step) {
  const ChangingGear system;
  const PeriodicSolution solution = rest(system);
  const analysis::ConsistentSubspace subspace(system, solution);
  constexpr double dt = 0.02;
  StepPropagator propagator(system, solution, subspace.carried(), dt);
  Eigen::MatrixXd z = subspace.basis(0.0, 0.5 * dt);
  for (long k = 0; k < 40; ++k) {
    propagator.advance(k, z);
    const double c = ChangingGear::c(static_cast<double>(k + 1) * dt);
    for (Eigen::Index j = 0; j < z.cols(); ++j) {
      BOOST_TEST(std::abs(z(1, j) - c * z(0, j)) < 1e-12);
      BOOST_TEST(std::abs(z(0, j) - ChangingGear::f * z(4, j)) < 1e-12);
    }
  }
}

BOOST_AUTO_TEST_CASE(trajectory_converges_with_slope_two) {
  const GroundResonance system(4);
  const PeriodicSolution solution = rest(system);
  const Eigen::VectorXd start = Eigen::VectorXd::LinSpaced(system.size(), -1.0, 1.0);
  const auto rate = [&system](double t, const Eigen::VectorXd& z) {
    return Eigen::VectorXd(system.explicit_form(t) * z);
  };
  constexpr double span = 2.0;
  const Eigen::VectorXd exact = runge_kutta<Eigen::VectorXd>(rate, start, 0.0, span, 2000);
  std::vector<double> errors;
  for (const int steps : {100, 200, 400}) {
    StepPropagator propagator(system, solution, system.differential(), span / steps);
    Eigen::MatrixXd z = start;
    for (long k = 0; k < steps; ++k) propagator.advance(k, z);
    errors.push_back((z.col(0) - exact).norm());
  }
  BOOST_TEST(std::log2(errors[0] / errors[1]) == 2.0, boost::test_tools::tolerance(0.01));
  BOOST_TEST(std::log2(errors[1] / errors[2]) == 2.0, boost::test_tools::tolerance(0.01));
}
