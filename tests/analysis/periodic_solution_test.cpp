#include "samara/analysis/periodic_solution.hpp"

#include <boost/test/unit_test.hpp>

#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using analysis::PeriodicSolution;

namespace {

struct Values {
  Eigen::VectorXd z, z_dot;
};

Values values_of(const PeriodicSolution& solution, double t) {
  const auto n = static_cast<PetscInt>(solution.coefficients().rows());
  const petsc::Handle<Vec> z = petsc::make_vector(PETSC_COMM_SELF, n, n);
  const petsc::Handle<Vec> z_dot = petsc::make_vector(PETSC_COMM_SELF, n, n);
  petsc::check(VecSet(z_dot.get(), 99.0));  // must be overwritten
  solution.evaluate(t, z.get(), z_dot.get());
  const petsc::ReadView a(z.get());
  const petsc::ReadView b(z_dot.get());
  return {Eigen::Map<const Eigen::VectorXd>(a.data(), n),
          Eigen::Map<const Eigen::VectorXd>(b.data(), n)};
}

}  // namespace

BOOST_AUTO_TEST_CASE(series_is_mean_then_cosine_and_sine_of_each_harmonic) {
  constexpr double period = 2.5;
  constexpr double w = 2.0 * pi / period;
  Eigen::MatrixXd h(2, 5);
  h << 1.0, 2.0, -3.0, 0.5, 4.0,  //
      -1.0, 0.0, 0.0, 0.0, 7.0;
  const PeriodicSolution solution(h, period);
  BOOST_TEST(solution.harmonics() == 2);
  BOOST_TEST(!solution.is_constant());
  for (const double t : {0.0, 0.3, 1.7, 2.5, 11.0}) {
    const Values v = values_of(solution, t);
    const double first = 1.0 + 2.0 * std::cos(w * t) - 3.0 * std::sin(w * t) +
                         0.5 * std::cos(2.0 * w * t) + 4.0 * std::sin(2.0 * w * t);
    const double rate = w * (-2.0 * std::sin(w * t) - 3.0 * std::cos(w * t) -
                             std::sin(2.0 * w * t) + 8.0 * std::cos(2.0 * w * t));
    BOOST_TEST(std::abs(v.z(0) - first) < 1e-13);
    BOOST_TEST(std::abs(v.z_dot(0) - rate) < 1e-12);
    BOOST_TEST(std::abs(v.z(1) + 1.0 - 7.0 * std::sin(2.0 * w * t)) < 1e-13);
    BOOST_TEST(std::abs(v.z_dot(1) - 14.0 * w * std::cos(2.0 * w * t)) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(rates_are_derivatives_of_the_values) {
  const Eigen::MatrixXd h = Eigen::MatrixXd::Random(3, 9);
  const PeriodicSolution solution(h, 1.7);
  constexpr double d = 1e-4;  // five-point rule: d^4 w^5 / 30 = 2e-13 of the highest harmonic
  for (const double t : {0.1, 0.9}) {
    const Eigen::VectorXd slope =
        (8.0 * (values_of(solution, t + d).z - values_of(solution, t - d).z) -
         (values_of(solution, t + 2.0 * d).z - values_of(solution, t - 2.0 * d).z)) /
        (12.0 * d);
    BOOST_TEST((slope - values_of(solution, t).z_dot).norm() < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(solution_repeats_after_its_period) {
  const PeriodicSolution solution(Eigen::MatrixXd::Random(4, 13), 0.8);
  const Values now = values_of(solution, 0.21);
  const Values later = values_of(solution, 0.21 + 5.0 * 0.8);
  BOOST_TEST((now.z - later.z).norm() < 1e-12);
  BOOST_TEST((now.z_dot - later.z_dot).norm() < 1e-10);
}

BOOST_AUTO_TEST_CASE(constant_has_no_rate_with_and_without_a_period) {
  for (const double period : {0.0, 3.0}) {
    const PeriodicSolution solution(Eigen::Vector3d(1.0, 2.0, 3.0), period);
    BOOST_TEST(solution.is_constant());
    BOOST_TEST(solution.harmonics() == 0);
    const Values v = values_of(solution, 0.77);
    BOOST_TEST((v.z - Eigen::Vector3d(1.0, 2.0, 3.0)).norm() == 0.0);
    BOOST_TEST(v.z_dot.norm() == 0.0);
  }
}
