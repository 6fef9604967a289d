// Harmonic balance against an independent integration in time.
#include "samara/analysis/harmonic_balance.hpp"

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using analysis::find_trim;
using analysis::solve_harmonic_balance;

namespace {

Eigen::Vector2d duffing_rate(const Duffing& system, double t, const Eigen::Vector2d& z) {
  return {z(1), system.load(t) - Duffing::c * z(1) - z(0) - Duffing::b * z(0) * z(0) * z(0)};
}

/// The state at t = 0 of the oscillation that is left after 60 periods: the transient has decayed
/// by exp(-c T 60 / 2) = 1e-19.
Eigen::Vector2d settled(const Duffing& system) {
  constexpr int periods = 60;
  constexpr int steps = 1000;  // error of Runge-Kutta some (w_max dt)^4 / 120 = 1e-10
  const auto rate = [&system](double t, const Eigen::Vector2d& z) {
    return duffing_rate(system, t, z);
  };
  return runge_kutta<Eigen::Vector2d>(rate, Eigen::Vector2d::Zero(), 0.0, periods * system.period(),
                                      periods * steps);
}

Eigen::Vector2d state_of(const analysis::PeriodicSolution& solution, double t) {
  return solution.coefficients() *
         analysis::PeriodicSolution::basis(solution.harmonics(), solution.period(), t);
}

}  // namespace

BOOST_AUTO_TEST_CASE(duffing_agrees_with_runge_kutta_over_the_period) {
  for (const double constant : {0.0, 0.7}) {
    const Duffing system(constant);
    const analysis::Trim trim = solve_harmonic_balance(system, 20, 1e-12, nullptr);
    Eigen::Vector2d reference = settled(system);
    constexpr int parts = 8;
    const auto rate = [&system](double t, const Eigen::Vector2d& z) {
      return duffing_rate(system, t, z);
    };
    for (int k = 0; k < parts; ++k) {
      const double t = system.period() * k / parts;
      BOOST_TEST((state_of(trim.solution, t) - reference).norm() < 1e-8, "at " << t);
      reference = runge_kutta<Eigen::Vector2d>(rate, reference, t, system.period() / parts, 500);
    }
    BOOST_TEST(trim.newton_steps > 1);
    BOOST_TEST(trim.residual < 1e-7);  // of a load of one; 20 harmonics leave 1e-8 of the series
    BOOST_TEST(trim.held.empty());
  }
}

BOOST_AUTO_TEST_CASE(odd_forces_have_odd_harmonics_only) {
  const analysis::Trim trim = solve_harmonic_balance(Duffing(), 10, 1e-12, nullptr);
  const Eigen::MatrixXd& h = trim.solution.coefficients();
  BOOST_TEST(std::abs(h(0, 0)) < 1e-10);
  for (int j = 2; j <= 10; j += 2) {
    BOOST_TEST(std::abs(h(0, 2 * j - 1)) < 1e-10);
    BOOST_TEST(std::abs(h(0, 2 * j)) < 1e-10);
  }
  BOOST_TEST(std::hypot(h(0, 5), h(0, 6)) > 1e-3);  // the third is there
}

BOOST_AUTO_TEST_CASE(residual_between_the_samples_falls_with_the_harmonics) {
  // Every odd harmonic adds a factor; the even ones change nothing here.
  double last = 1e300;
  for (const int harmonics : {1, 3, 5, 7, 9}) {
    const analysis::Trim trim = solve_harmonic_balance(Duffing(), harmonics, 1e-12, nullptr);
    BOOST_TEST(trim.residual_between < 0.3 * last, harmonics << " harmonics");
    last = trim.residual_between;
  }
}

BOOST_AUTO_TEST_CASE(samples_do_not_alias_what_the_harmonics_can_balance) {
  // A cubic of H harmonics has 3 H of them; 4 H + 2 samples fold harmonics above 3 H + 1 onto
  // those balanced: none. So the Galerkin equations hold with many more samples as well.
  const Duffing system(0.7);
  constexpr int harmonics = 3;
  const analysis::Trim trim = solve_harmonic_balance(system, harmonics, 1e-12, nullptr);
  constexpr int samples = 64;
  Eigen::MatrixXd projection = Eigen::MatrixXd::Zero(2 * harmonics + 1, 2);
  for (int k = 0; k < samples; ++k) {
    const double t = system.period() * k / samples;
    const Eigen::VectorXd rate =
        trim.solution.coefficients() *
        analysis::PeriodicSolution::basis_rate(harmonics, system.period(), t);
    projection += analysis::PeriodicSolution::basis(harmonics, system.period(), t) *
                  system.residual_at(t, state_of(trim.solution, t), rate).transpose() / samples;
  }
  BOOST_TEST(projection.cwiseAbs().maxCoeff() < 1e-11);
}

BOOST_AUTO_TEST_CASE(start_from_fewer_harmonics_leads_to_the_same_solution) {
  const Duffing system(0.7);
  const analysis::Trim few = solve_harmonic_balance(system, 3, 1e-12, nullptr);
  const analysis::Trim cold = solve_harmonic_balance(system, 8, 1e-12, nullptr);
  const analysis::Trim warm = solve_harmonic_balance(system, 8, 1e-12, &few.solution);
  BOOST_TEST((cold.solution.coefficients() - warm.solution.coefficients()).norm() < 1e-9);
  BOOST_TEST(warm.newton_steps < cold.newton_steps);
}

BOOST_AUTO_TEST_CASE(unconstrained_coordinate_is_held_by_the_constant_load) {
  // m x'' + c x' = f0 + f1 cos wt: the mean of x is zero, the load that holds it is f0 as the row
  // is written, and x = A cos wt + B sin wt with -m w^2 A + c w B = f1, -m w^2 B - c w A = 0.
  const analysis::Trim trim = solve_harmonic_balance(FreeSlide(), 2, 1e-12, nullptr);
  using S = FreeSlide;
  BOOST_REQUIRE(trim.held.size() == 1U);
  BOOST_TEST(trim.held[0].name == "slide");
  BOOST_TEST(trim.held[0].load == S::f0, boost::test_tools::tolerance(1e-12));
  const double p = -S::m * S::w * S::w;
  const double q = S::c * S::w;
  const double size = p * p + q * q;
  const Eigen::MatrixXd& h = trim.solution.coefficients();
  BOOST_TEST(std::abs(h(0, 0)) == 0.0);
  BOOST_TEST(h(0, 1) == S::f1 * p / size, boost::test_tools::tolerance(1e-11));
  BOOST_TEST(h(0, 2) == S::f1 * q / size, boost::test_tools::tolerance(1e-11));
  BOOST_TEST(trim.residual < 1e-11);
  BOOST_TEST(trim.residual_between < 1e-11);
}

BOOST_AUTO_TEST_CASE(automatic_harmonics_reach_the_tolerance_and_tell_the_way) {
  const Duffing system(0.7);
  analysis::TrimOptions options;
  options.automatic = true;
  options.auto_tolerance = 1e-6;
  analysis::Observer observer;
  const analysis::Trim trim = find_trim(system, options, observer);
  BOOST_TEST(trim.residual_between <= 1e-6);  // this system has no internal loads: level 1
  BOOST_REQUIRE(trim.attempts.size() > 2U);
  BOOST_TEST(trim.attempts.back().first == trim.solution.harmonics());
  BOOST_TEST(trim.attempts.back().second == trim.residual_between);
  for (std::size_t i = 0; i + 1 < trim.attempts.size(); ++i)
    BOOST_TEST(trim.attempts[i].second > 1e-6);
}

BOOST_AUTO_TEST_CASE(automatic_harmonics_rise_by_a_third_and_lose_nothing_on_the_way) {
  const Duffing system(0.7);
  analysis::TrimOptions options;
  options.automatic = true;
  options.auto_tolerance = 1e-9;
  analysis::Observer observer;
  const analysis::Trim trim = find_trim(system, options, observer);
  int before = 0;
  for (const auto& [harmonics, residual] : trim.attempts) {
    if (before > 0) BOOST_TEST(harmonics == before + (before + 2) / 3);
    before = harmonics;
  }
  const analysis::Trim anew = solve_harmonic_balance(system, before, options.tolerance, nullptr);
  const Eigen::MatrixXd change = trim.solution.coefficients() - anew.solution.coefficients();
  BOOST_TEST(change.cwiseAbs().maxCoeff() < options.tolerance);
}

BOOST_AUTO_TEST_CASE(automatic_harmonics_end_at_the_most_that_are_tried) {
  const Duffing system(0.7);
  analysis::TrimOptions options;
  options.automatic = true;
  options.auto_tolerance = 1e-300;
  struct LastNote : analysis::Observer {
    void note(const std::string& text) override { last = text; }
    std::string last;
  } observer;
  BOOST_CHECK_THROW(find_trim(system, options, observer), ConvergenceError);
  BOOST_TEST(observer.last.find("60 harmonics") != std::string::npos, observer.last);
}

BOOST_AUTO_TEST_CASE(rest_is_found_as_a_constant) {
  analysis::TrimOptions options;
  options.harmonics = 6;
  analysis::Observer observer;
  const analysis::Trim trim = find_trim(Mathieu(2.5, 1.0), options, observer);
  BOOST_TEST(trim.solution.is_constant());
  BOOST_TEST(trim.solution.coefficients().norm() == 0.0);
}
