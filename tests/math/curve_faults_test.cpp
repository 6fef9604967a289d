#include "samara/math/curve_faults.hpp"

#include <cmath>

#include <boost/test/unit_test.hpp>

using boost::test_tools::tolerance;
using samara::math::CurveFault;
using samara::math::find_jump;
using samara::math::find_kink;
using samara::math::TimeCurve;

namespace {

constexpr double step = 0.01;

/// Curve of a formula in t [s].
TimeCurve curve_of(const std::string& formula) { return TimeCurve::formula(formula); }

}  // namespace

BOOST_AUTO_TEST_CASE(jumps_are_found_with_time_and_size) {
  const auto jump = find_jump(curve_of("t < 0.503 ? 1 + t : 21 + t"), 1.0, step);
  BOOST_REQUIRE(jump);
  BOOST_TEST((jump->kind == CurveFault::Kind::jump));
  BOOST_TEST(jump->time == 0.503, tolerance(1e-6));
  BOOST_TEST(jump->size == 20.0, tolerance(1e-3));  // and the slope over the part of the step
}

BOOST_AUTO_TEST_CASE(a_table_that_rises_in_no_time_jumps) {
  const auto jump = find_jump(TimeCurve::through({{0, 0}, {1e-9, 90}, {1, 90}}), 1.0, step);
  BOOST_REQUIRE(jump);
  BOOST_TEST((jump->kind == CurveFault::Kind::jump));
  BOOST_TEST(jump->time < 1e-8);
  BOOST_TEST(jump->size == 90.0);
}

BOOST_AUTO_TEST_CASE(jumps_beside_many_steps_are_found) {
  const auto jump = find_jump(curve_of("t < 5000 ? sin(t) : 3 + sin(t)"), 1e4, step);
  BOOST_REQUIRE(jump);
  BOOST_TEST(jump->time == 5000.0, tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(motions_between_the_steps_are_fast) {
  BOOST_TEST(find_jump(curve_of("sin(1e9*t)"), 1.0, step).has_value());
  for (const TimeCurve& curve :
       {curve_of("sin(300*t)"), TimeCurve::through({{0, 0}, {0.501, 0}, {0.503, 1}, {1, 1}})}) {
    const auto fast = find_jump(curve, 1.0, step);
    BOOST_REQUIRE(fast);
    BOOST_TEST((fast->kind == CurveFault::Kind::fast));
    BOOST_TEST(fast->size > 0.1);
    BOOST_TEST(fast->size < 2.0);
  }
}

BOOST_AUTO_TEST_CASE(smooth_motions_have_no_fault) {
  for (const char* formula : {"0", "5", "3 + 2*t", "sin(2*t)", "10*sin(6*t) + 1e6", "exp(-3*t)",
                              "t^3", "1/(1 + exp(-40*(t - 0.5)))"}) {
    BOOST_TEST_CONTEXT(formula) {
      BOOST_TEST(!find_jump(curve_of(formula), 1.0, step));
      BOOST_TEST(!find_kink(curve_of(formula), 1.0, step));
      BOOST_TEST(!find_jump(curve_of(formula), 1.0, 1e-4));
      BOOST_TEST(!find_kink(curve_of(formula), 1.0, 1e-4));
    }
  }
  const TimeCurve table = TimeCurve::through({{0, 0}, {0.3, 1}, {0.35, 4}, {1, 5}});
  BOOST_TEST(!find_jump(table, 1.0, step));
  BOOST_TEST(!find_kink(table, 1.0, step));
  BOOST_TEST(!find_jump(TimeCurve::ramp(0.2, 0.0, 1.0, 4.0), 1.0, step));
  BOOST_TEST(!find_jump(TimeCurve::along({{0, 6}, {0.5, 8}, {1, 8}}), 1.0, step));
}

BOOST_AUTO_TEST_CASE(jumps_of_the_rate_are_found_with_time_and_size) {
  const TimeCurve bent = curve_of("t < 0.4037 ? 0 : 3*(t - 0.4037)");
  BOOST_TEST(!find_jump(bent, 1.0, step));
  const auto kink = find_kink(bent, 1.0, step);
  BOOST_REQUIRE(kink);
  BOOST_TEST(kink->time == 0.4037, tolerance(1e-4));
  BOOST_TEST(kink->size == 3.0, tolerance(1e-2));
}
