#include "samara/math/autodiff.hpp"

#include <cmath>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara;

/// Few operations on numbers of order one.
constexpr double round_off = 1e-15;

}  // namespace

BOOST_AUTO_TEST_SUITE(autodiff)

BOOST_AUTO_TEST_CASE(an_independent_quantity_has_a_unit_derivative_by_itself_alone) {
  const math::Dual<3> x = math::independent<3>(2.5, 1);
  BOOST_TEST(x.value() == 2.5);
  BOOST_TEST(x.derivatives()(0) == 0.0);
  BOOST_TEST(x.derivatives()(1) == 1.0);
  BOOST_TEST(x.derivatives()(2) == 0.0);
}

BOOST_AUTO_TEST_CASE(a_constant_has_no_derivative) {
  const math::Dual<3> c = math::constant<3>(2.5);
  BOOST_TEST(c.value() == 2.5);
  BOOST_TEST(c.derivatives().isZero(0.0));
  const math::Dual<3> from_number(2.5);
  BOOST_TEST(from_number.derivatives().isZero(0.0));
}

BOOST_AUTO_TEST_CASE(derivatives_follow_the_rules_of_calculus) {
  const double a = 0.7;
  const double b = -1.3;
  const math::Dual<2> x = math::independent<2>(a, 0);
  const math::Dual<2> y = math::independent<2>(b, 1);
  const math::Dual<2> product = x * y * 2.0;
  BOOST_TEST(std::abs(product.derivatives()(0) - 2.0 * b) < round_off);
  BOOST_TEST(std::abs(product.derivatives()(1) - 2.0 * a) < round_off);
  const math::Dual<2> quotient = x / y;
  BOOST_TEST(std::abs(quotient.derivatives()(0) - 1.0 / b) < round_off);
  BOOST_TEST(std::abs(quotient.derivatives()(1) + a / (b * b)) < round_off);
  using std::cos;
  using std::sin;
  const math::Dual<2> wave = sin(x) * cos(y);
  BOOST_TEST(std::abs(wave.value() - std::sin(a) * std::cos(b)) < round_off);
  BOOST_TEST(std::abs(wave.derivatives()(0) - std::cos(a) * std::cos(b)) < round_off);
  BOOST_TEST(std::abs(wave.derivatives()(1) + std::sin(a) * std::sin(b)) < round_off);
}

BOOST_AUTO_TEST_CASE(what_is_added_in_place_keeps_its_derivatives) {
  math::Dual<2> sum(0.0);
  for (int i = 0; i < 2; ++i) sum += math::independent<2>(3.0, i) * (i + 1.0);
  sum -= math::constant<2>(1.0);
  BOOST_TEST(sum.value() == 8.0);
  BOOST_TEST(sum.derivatives()(0) == 1.0);
  BOOST_TEST(sum.derivatives()(1) == 2.0);
}

BOOST_AUTO_TEST_SUITE_END()
