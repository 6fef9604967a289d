#include "samara/math/quadrature.hpp"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara::math;

/// Orders that a case file may ask for.
constexpr int largest_order = 6;

/// Sums of up to ten products of order one.
constexpr double round_off = 2e-15;

/// Derivatives grow with the square of the order, and their round-off with them.
constexpr double derivative_round_off = 1e-12;

double integrate_power(const QuadratureRule& rule, int power) {
  double sum = 0.0;
  for (std::size_t j = 0; j < rule.points.size(); ++j)
    sum += rule.weights[j] * std::pow(rule.points[j], power);
  return sum;
}

/// Error of the rule of n points for the integral of x^(2n) over [0, 1] (Abramowitz & Stegun,
/// 25.4.30): (n!)^4 / ((2n + 1) ((2n)!)^2).
double gauss_error_of_first_inexact_power(int n) {
  const double factorial = std::tgamma(n + 1.0);
  const double double_factorial = std::tgamma(2.0 * n + 1.0);
  return std::pow(factorial, 4) / ((2.0 * n + 1.0) * double_factorial * double_factorial);
}

double interpolate(const std::vector<double>& nodes, double x, double (*function)(double),
                   double (*shape)(const std::vector<double>&, int, double)) {
  double sum = 0.0;
  for (std::size_t a = 0; a < nodes.size(); ++a)
    sum += function(nodes[a]) * shape(nodes, static_cast<int>(a), x);
  return sum;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(quadrature)

BOOST_AUTO_TEST_CASE(gauss_weights_are_positive_and_sum_to_one) {
  for (int n = 1; n <= 2 * largest_order; ++n) {
    const QuadratureRule rule = gauss_rule(n);
    BOOST_TEST(rule.points.size() == static_cast<std::size_t>(n));
    BOOST_TEST(rule.weights.size() == static_cast<std::size_t>(n));
    for (const double w : rule.weights) BOOST_TEST(w > 0.0);
    const double sum = std::accumulate(rule.weights.begin(), rule.weights.end(), 0.0);
    BOOST_TEST(std::abs(sum - 1.0) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(gauss_points_ascend_inside_the_interval_and_mirror_about_its_middle) {
  for (int n = 1; n <= 2 * largest_order; ++n) {
    const QuadratureRule rule = gauss_rule(n);
    const auto count = static_cast<std::size_t>(n);
    double before = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      BOOST_TEST(rule.points[j] > before);
      BOOST_TEST(rule.points[j] < 1.0);
      before = rule.points[j];
      BOOST_TEST(std::abs(rule.points[j] + rule.points[count - 1 - j] - 1.0) < round_off);
      BOOST_TEST(std::abs(rule.weights[j] - rule.weights[count - 1 - j]) < round_off);
    }
  }
}

BOOST_AUTO_TEST_CASE(gauss_rule_of_n_points_is_exact_to_degree_2n_minus_1) {
  for (int n = 1; n <= 2 * largest_order; ++n) {
    const QuadratureRule rule = gauss_rule(n);
    for (int power = 0; power <= 2 * n - 1; ++power)
      BOOST_TEST(std::abs(integrate_power(rule, power) - 1.0 / (power + 1)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(gauss_rule_errs_by_its_closed_form_at_degree_2n) {
  for (int n = 1; n <= largest_order; ++n) {
    const double error = 1.0 / (2 * n + 1) - integrate_power(gauss_rule(n), 2 * n);
    BOOST_TEST(std::abs(error - gauss_error_of_first_inexact_power(n)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(lobatto_nodes_ascend_from_end_to_end) {
  for (int n = 1; n <= largest_order; ++n) {
    const std::vector<double> nodes = lobatto_nodes(n);
    BOOST_TEST(nodes.size() == static_cast<std::size_t>(n) + 1);
    BOOST_TEST(nodes.front() == 0.0);
    BOOST_TEST(nodes.back() == 1.0);
    for (std::size_t a = 1; a < nodes.size(); ++a) BOOST_TEST(nodes[a] > nodes[a - 1]);
  }
  BOOST_TEST(std::abs(lobatto_nodes(2)[1] - 0.5) < round_off);
  BOOST_TEST(std::abs(lobatto_nodes(3)[1] - 0.25) < round_off);
}

BOOST_AUTO_TEST_CASE(lagrange_polynomials_are_one_at_their_node_and_zero_at_the_others) {
  for (int n = 1; n <= largest_order; ++n) {
    const std::vector<double> nodes = lobatto_nodes(n);
    for (int a = 0; a <= n; ++a)
      for (int b = 0; b <= n; ++b)
        BOOST_TEST(std::abs(lagrange(nodes, a, nodes[static_cast<std::size_t>(b)]) -
                            (a == b ? 1.0 : 0.0)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(lagrange_polynomials_sum_to_one_and_their_slopes_to_zero) {
  const auto one = [](double) { return 1.0; };
  for (int n = 1; n <= largest_order; ++n) {
    const std::vector<double> nodes = lobatto_nodes(n);
    for (const double x : gauss_rule(7).points) {
      BOOST_TEST(std::abs(interpolate(nodes, x, one, lagrange) - 1.0) < round_off);
      BOOST_TEST(std::abs(interpolate(nodes, x, one, lagrange_derivative)) < derivative_round_off);
    }
  }
}

BOOST_AUTO_TEST_CASE(lagrange_interpolation_reproduces_polynomials_of_its_degree_and_their_slopes) {
  const std::vector<double> nodes = lobatto_nodes(4);
  const auto quartic = [](double x) { return 2.0 + x - 3.0 * x * x + x * x * x * x; };
  const auto slope = [](double x) { return 1.0 - 6.0 * x + 4.0 * x * x * x; };
  for (const double x : {0.0, 0.13, 0.25, 0.5, 0.77, 1.0}) {
    BOOST_TEST(std::abs(interpolate(nodes, x, quartic, lagrange) - quartic(x)) < round_off);
    BOOST_TEST(std::abs(interpolate(nodes, x, quartic, lagrange_derivative) - slope(x)) <
               derivative_round_off);
  }
}

BOOST_AUTO_TEST_SUITE_END()
