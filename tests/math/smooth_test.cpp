#include "samara/math/smooth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara;
using Complex = std::complex<double>;
using Dual1 = math::Dual<1>;
using Dual2 = math::Dual<2>;

constexpr double round_off = 1e-14;
constexpr double tiny = 1e-30;  // a complex step without truncation error

template <class Function>
math::ValueAndSlope dual(const Function& f, double x) {
  const Dual1 y = f(math::independent<1>(x, 0));
  return {y.value(), y.derivatives()(0)};
}

/// The largest of the jumps of value by step, slope and second derivative at x.
template <class Function>
double jump(const Function& f, double x) {
  constexpr double step = 1e-6;
  const math::ValueAndSlope before = dual(f, x - step);
  const math::ValueAndSlope at = dual(f, x);
  const math::ValueAndSlope behind = dual(f, x + step);
  return std::max({std::abs(behind.value - at.value - step * at.slope) / step,
                   std::abs(before.value - at.value + step * at.slope) / step,
                   std::abs(behind.slope - 2.0 * at.slope + before.slope) / step});
}
constexpr double continuous = 1e-3;  // the step times the third derivatives, up to 300

/// Slope by automatic differentiation, by complex step and by central differences.
template <class Function>
void check_slope(const Function& f, double x) {
  constexpr double step = 1e-5;
  const double slope = dual(f, x).slope;
  const double difference = (f(x + step) - f(x - step)) / (2.0 * step);
  BOOST_TEST(dual(f, x).value == f(x));
  BOOST_TEST(std::abs(f(Complex(x, tiny)).imag() / tiny - slope) < round_off);
  BOOST_TEST(std::abs(slope - difference) < 1e-7);  // step^2 times the third derivative
}

const auto step_of = [](const auto& x) { return math::smoothstep(x); };
const auto abs_of = [](const auto& x) { return math::smooth_abs(x); };
template <class T>
T constant_like(const T&, double value) {
  return T(value);
}
const auto max_of = [](const auto& x) { return math::smooth_max(x, constant_like(x, 0.5)); };
const auto wide_max_of = [](const auto& x) {
  return math::smooth_max(x, constant_like(x, -0.3), 0.2);
};
const auto wide_min_of = [](const auto& x) {
  return math::smooth_min(x, constant_like(x, -0.3), 0.2);
};

}  // namespace

BOOST_AUTO_TEST_SUITE(smooth)

BOOST_AUTO_TEST_CASE(the_step_has_the_values_of_its_polynomial) {
  BOOST_TEST(math::smoothstep(-0.1) == 0.0);
  BOOST_TEST(math::smoothstep(0.0) == 0.0);
  BOOST_TEST(math::smoothstep(1.0) == 1.0);
  BOOST_TEST(math::smoothstep(7.0) == 1.0);
  for (double x = 0.05; x < 1.0; x += 0.05) {
    const double expected = 6.0 * std::pow(x, 5) - 15.0 * std::pow(x, 4) + 10.0 * std::pow(x, 3);
    BOOST_TEST(std::abs(math::smoothstep(x) - expected) < round_off);
    BOOST_TEST(std::abs(math::smoothstep(x) + math::smoothstep(1.0 - x) - 1.0) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(the_maximum_by_ratio_is_exact_outside_its_band) {
  BOOST_TEST(math::smooth_max(-3.0, 0.02) == 0.02);
  BOOST_TEST(math::smooth_max(0.0, 0.02) == 0.02);
  BOOST_TEST(math::smooth_max(0.04, 0.02) == 0.04);
  BOOST_TEST(math::smooth_max(5.3, 0.02) == 5.3);
  // m(1) = 1 + 1/4 - 1/16
  BOOST_TEST(std::abs(math::smooth_max(0.02, 0.02) - 0.02 * 1.1875) < round_off);
  for (double a = 0.0; a < 1.0; a += 0.01) {
    BOOST_TEST(math::smooth_max(a, 0.4) >= std::max(a, 0.4) - round_off);
    BOOST_TEST(std::abs(math::smooth_max(3.0 * a, 1.2) - 3.0 * math::smooth_max(a, 0.4)) <
               round_off);
  }
}

BOOST_AUTO_TEST_CASE(maximum_and_minimum_of_a_width_are_exact_outside_it_and_have_the_same_sum) {
  constexpr double width = 0.2;
  BOOST_TEST(math::smooth_max(1.0, 1.3, width) == 1.3);
  BOOST_TEST(math::smooth_max(1.0, 0.7, width) == 1.0);
  BOOST_TEST(math::smooth_min(1.0, 1.3, width) == 1.0);
  BOOST_TEST(math::smooth_min(1.0, 0.7, width) == 0.7);
  BOOST_TEST(std::abs(math::smooth_max(1.0, 1.0, width) - 1.0 - width * 0.1875) < round_off);
  for (double b = -0.5; b < 0.5; b += 0.03) {
    const double a = 0.1;
    const double largest = math::smooth_max(a, b, width);
    BOOST_TEST(std::abs(largest + math::smooth_min(a, b, width) - a - b) < round_off);
    BOOST_TEST(std::abs(largest - math::smooth_max(b, a, width)) < round_off);
    BOOST_TEST(std::abs(largest + math::smooth_min(-a, -b, width)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(the_absolute_value_is_even_and_exact_from_a_tenth) {
  for (const double x : {0.1, 0.11, 0.7, 3.0}) {
    BOOST_TEST(math::smooth_abs(x) == x);
    BOOST_TEST(math::smooth_abs(-x) == x);
  }
  BOOST_TEST(std::abs(math::smooth_abs(0.0) - 0.0375) < round_off);
  for (double x = 0.0; x < 0.1; x += 0.004) {
    BOOST_TEST(math::smooth_abs(x) == math::smooth_abs(-x));
    BOOST_TEST(math::smooth_abs(x) >= x);
  }
}

BOOST_AUTO_TEST_CASE(second_derivatives_are_continuous_where_branches_meet) {
  for (const double x : {0.0, 1.0}) BOOST_TEST(jump(step_of, x) < continuous);
  for (const double x : {0.0, 1.0}) BOOST_TEST(jump(max_of, x) < continuous);
  for (const double x : {-0.5, -0.1}) BOOST_TEST(jump(wide_max_of, x) < continuous);
  for (const double x : {-0.5, -0.1}) BOOST_TEST(jump(wide_min_of, x) < continuous);
  for (const double x : {-0.1, 0.1}) BOOST_TEST(jump(abs_of, x) < continuous);
  // The measure sees a second derivative that jumps from -2 to 2.
  const auto bent = [](const Dual1& x) { return Dual1(x * x * (x.value() > 0.0 ? 1.0 : -1.0)); };
  BOOST_TEST(jump(bent, 0.0) > 3.0);
}

BOOST_AUTO_TEST_CASE(slopes_agree_for_all_scalars) {
  for (const double x : {-0.6, -0.41, -0.2, -0.05, 0.03, 0.3, 0.55, 0.9, 1.4}) {
    check_slope(step_of, x);
    check_slope(max_of, x);
    check_slope(wide_max_of, x);
    check_slope(wide_min_of, x);
    check_slope(abs_of, x);
  }
}

BOOST_AUTO_TEST_CASE(maxima_have_slopes_by_both_arguments) {
  constexpr double step = 1e-6;
  constexpr double tolerance = 1e-9;  // step^2 times the third derivatives
  const auto check = [&](const auto& f, double a, double b) {
    const Dual2 y = f(math::independent<2>(a, 0), math::independent<2>(b, 1));
    const double by_a = (f(a + step, b) - f(a - step, b)) / (2.0 * step);
    const double by_b = (f(a, b + step) - f(a, b - step)) / (2.0 * step);
    BOOST_TEST(std::abs(y.derivatives()(0) - by_a) < tolerance);
    BOOST_TEST(std::abs(y.derivatives()(1) - by_b) < tolerance);
  };
  for (const double a : {-1.0, 0.3, 0.8, 1.1, 3.0}) {
    check([](const auto& x, const auto& y) { return math::smooth_max(x, y); }, a, 0.9);
    check([](const auto& x, const auto& y) { return math::smooth_max(x, y, 0.5); }, a, 0.9);
    check([](const auto& x, const auto& y) { return math::smooth_min(x, y, 0.5); }, a, 0.9);
  }
}

BOOST_AUTO_TEST_CASE(dependences_are_on_all_arguments) {
  using math::Dependence;
  const Dependence a = Dependence::on(0);
  const Dependence b = Dependence::on(1);
  BOOST_TEST(math::smoothstep(a).quantities() == 1U);
  BOOST_TEST(math::smooth_abs(b).quantities() == 2U);
  BOOST_TEST(math::smooth_max(a, b).quantities() == 3U);
  BOOST_TEST(math::smooth_max(a, b, 0.1).quantities() == 3U);
  BOOST_TEST(math::smooth_min(a, b, 0.1).quantities() == 3U);
  BOOST_TEST(math::smooth_max(a, Dependence(0.02)).quantities() == 1U);
  BOOST_TEST(math::smooth_max(Dependence(1.0), Dependence(0.02)).quantities() == 0U);
}

BOOST_AUTO_TEST_SUITE_END()
