// Curves in time: what they go through, their rates, their integrals.
#include "samara/math/time_curve.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

using namespace samara;
using boost::test_tools::tolerance;
using math::TimeCurve;

namespace {

/// Rates against differences of the curve.
void check_rates(const TimeCurve& curve, double t) {
  constexpr double h = 1e-4;
  const TimeCurve::Value now = curve.at(t);
  const double ahead = curve.at(t + h).value;
  const double behind = curve.at(t - h).value;
  BOOST_TEST(std::abs(now.rate - (ahead - behind) / (2.0 * h)) < 1e-6);
  BOOST_TEST(std::abs(now.acceleration -
                      (curve.at(t + h).rate - curve.at(t - h).rate) / (2.0 * h)) < 1e-5);
}

}  // namespace

BOOST_AUTO_TEST_CASE(curve_through_points_does_not_overshoot_and_joins_its_constant_ends) {
  const TimeCurve curve = TimeCurve::through({{1.0, 0.0}, {2.0, 0.0}, {4.0, 3.0}, {5.0, 3.0}});
  for (const double t : {1.0, 2.0, 4.0, 5.0}) BOOST_TEST(std::abs(curve.at(t).rate) < 1e-14);
  BOOST_TEST(curve.at(4.0).value == 3.0, tolerance(1e-14));
  BOOST_TEST(curve.at(3.0).value == 1.5, tolerance(1e-14));
  BOOST_TEST(curve.at(0.0).value == 0.0);
  BOOST_TEST(curve.at(9.0).value == 3.0);
  for (double t = 0.0; t < 6.0; t += 0.01) {
    BOOST_TEST(curve.at(t).value >= 0.0);
    BOOST_TEST(curve.at(t).value <= 3.0 + 1e-14);
  }
  for (const double t : {2.3, 3.0, 3.9}) check_rates(curve, t);
  // Many points of a smooth function give the function.
  std::vector<TimeCurve::Point> points;
  for (int i = 0; i <= 400; ++i) points.emplace_back(0.01 * i, std::exp(0.01 * i));
  BOOST_TEST(TimeCurve::through(points).at(2.005).value == std::exp(2.005), tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(straight_lines_formulas_and_ramps_have_their_rates) {
  const TimeCurve line = TimeCurve::along({{0.0, 1.0}, {2.0, 5.0}});
  BOOST_TEST(line.at(0.5).value == 2.0, tolerance(1e-14));
  BOOST_TEST(line.at(0.5).rate == 2.0, tolerance(1e-14));
  BOOST_TEST(line.at(3.0).rate == 0.0);
  const TimeCurve wave = TimeCurve::formula("2*sin(3*t) + t^2");
  const TimeCurve::Value now = wave.at(0.7);
  BOOST_TEST(now.value == 2.0 * std::sin(2.1) + 0.49, tolerance(1e-14));
  BOOST_TEST(now.rate == 6.0 * std::cos(2.1) + 1.4, tolerance(1e-10));
  BOOST_TEST(now.acceleration == -18.0 * std::sin(2.1) + 2.0, tolerance(1e-8));
  const TimeCurve ramp = TimeCurve::ramp(2.0, 0.1, -0.5, 0.3);
  BOOST_TEST(ramp.at(2.0).value == 0.1);
  BOOST_TEST(ramp.at(99.0).value == -0.5);
  double fastest = 0.0;
  for (double t = 2.0; t < 6.0; t += 1e-3) fastest = std::max(fastest, std::abs(ramp.at(t).rate));
  BOOST_TEST(fastest == 0.3, tolerance(1e-5));
  for (const double t : {2.5, 3.0, 4.0}) check_rates(ramp, t);
  BOOST_CHECK_THROW(TimeCurve::formula("2*("), InputError);
  BOOST_CHECK_THROW(TimeCurve::formula("1/t"), InputError);
}

BOOST_AUTO_TEST_CASE(integral_of_a_speed_is_the_angle) {
  const math::IntegratedCurve turned(TimeCurve::formula("6 + 0.5*sin(2*t)"), 20.0);
  for (const double t : {0.0, 0.013, 7.7, 20.0}) {
    BOOST_TEST(turned.at(t).value == 6.0 * t + 0.25 * (1.0 - std::cos(2.0 * t)), tolerance(1e-12));
    BOOST_TEST(turned.at(t).rate == 6.0 + 0.5 * std::sin(2.0 * t), tolerance(1e-12));
  }
}
