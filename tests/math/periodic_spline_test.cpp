#include "samara/math/periodic_spline.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara;
using math::PeriodicSpline;
using std::numbers::pi;

constexpr double round_off = 1e-13;

struct Points {
  std::vector<double> knots;
  std::vector<double> values;
};

/// n uneven intervals from `first` to `first` + 2 pi with the values of a function.
template <class Function>
Points points_of(int n, double first, const Function& f) {
  Points points;
  for (int i = 0; i <= n; ++i) {
    const double part = static_cast<double>(i) / n;
    points.knots.push_back(first + 2.0 * pi * (part + 0.1 * std::sin(2.0 * pi * part)));
    points.values.push_back(f(points.knots.back()));
  }
  points.knots.back() = first + 2.0 * pi;
  points.values.back() = points.values.front();
  return points;
}

double waves(double x) { return std::sin(x) + 0.4 * std::cos(2.0 * x) - 0.2 * std::sin(3.0 * x); }
double waves_slope(double x) {
  return std::cos(x) - 0.8 * std::sin(2.0 * x) - 0.6 * std::cos(3.0 * x);
}

const Points ragged{{-pi, -2.9, -1.0, -0.99, 0.4, 2.0, pi}, {0.3, -1.0, 2.0, 2.1, 0.0, 0.7, 0.3}};

}  // namespace

BOOST_AUTO_TEST_SUITE(periodic_spline)

BOOST_AUTO_TEST_CASE(it_goes_through_its_points_in_every_revolution) {
  const PeriodicSpline spline(ragged.knots, ragged.values);
  for (std::size_t i = 0; i < ragged.knots.size(); ++i)
    for (const double turns : {-3.0, -1.0, 0.0, 1.0, 40.0})
      BOOST_TEST(std::abs(spline.at(ragged.knots[i] + 2.0 * pi * turns).value - ragged.values[i]) <
                 1e-11);  // round-off of the angle times slopes up to 20
}

BOOST_AUTO_TEST_CASE(it_is_periodic) {
  const PeriodicSpline spline(ragged.knots, ragged.values);
  for (double x = -pi; x < pi; x += 0.0371) {
    const math::ValueAndSlope here = spline.at(x);
    for (const double turn : {-2.0 * pi, 2.0 * pi, 6.0 * pi}) {
      BOOST_TEST(std::abs(spline.at(x + turn).value - here.value) < 1e-12);
      BOOST_TEST(std::abs(spline.at(x + turn).slope - here.slope) < 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(second_derivatives_are_continuous_at_all_knots_and_at_the_seam) {
  const PeriodicSpline spline(ragged.knots, ragged.values);
  const auto second = [&spline](double from, double to) {
    return (spline.at(to).slope - spline.at(from).slope) / (to - from);
  };
  double largest = 0.0;
  for (double x = -pi; x < pi; x += 1e-3) largest = std::max(largest, second(x, x + 1e-6));
  for (const double knot : ragged.knots) {
    // Extrapolated to the knot: slopes are parabolas on both sides.
    const double h = 1e-3;
    const double before = 2.0 * second(knot - h, knot) - second(knot - 2.0 * h, knot);
    const double behind = 2.0 * second(knot, knot + h) - second(knot, knot + 2.0 * h);
    BOOST_TEST(std::abs(behind - before) < 1e-9 * largest);
  }
}

BOOST_AUTO_TEST_CASE(waves_are_met_to_fourth_order_and_their_slopes_to_third) {
  const auto error = [](int intervals) {
    const Points points = points_of(intervals, -2.5, waves);
    const PeriodicSpline spline(points.knots, points.values);
    double value = 0.0;
    double slope = 0.0;
    for (double x = -pi; x < pi; x += 1e-3) {
      value = std::max(value, std::abs(spline.at(x).value - waves(x)));
      slope = std::max(slope, std::abs(spline.at(x).slope - waves_slope(x)));
    }
    return std::pair(value, slope);
  };
  const auto [coarse, coarse_slope] = error(60);
  const auto [fine, fine_slope] = error(120);
  BOOST_TEST(fine < 1e-5);
  BOOST_TEST(fine < coarse / 14.0);
  BOOST_TEST(fine_slope < coarse_slope / 7.0);
}

BOOST_AUTO_TEST_CASE(few_and_crowded_knots_are_possible) {
  const PeriodicSpline constant({-pi, pi}, {0.7, 0.7});
  BOOST_TEST(constant.at(1.0).value == 0.7);
  BOOST_TEST(constant.at(1.0).slope == 0.0);
  const PeriodicSpline two({-pi, 0.0, pi}, {-1.0, 1.0, -1.0});
  for (double x = 0.0; x < pi; x += 0.1)
    BOOST_TEST(std::abs(two.at(x).value - two.at(-x).value) < round_off);
  BOOST_TEST(std::abs(two.at(0.5 * pi).value) < round_off);
  std::vector<double> knots{-pi};
  for (int i = 0; i < 100; ++i) knots.push_back(1.0 + 1e-7 * i);
  knots.push_back(pi);
  std::vector<double> values(knots.size(), 0.25);
  const PeriodicSpline crowded(knots, values);
  for (const double x : {-pi, -1.0, 1.0, 1.0 + 3.5e-7, 1.0 + 99e-7, 2.0, pi})
    BOOST_TEST(std::abs(crowded.at(x).value - 0.25) < round_off);
}

BOOST_AUTO_TEST_CASE(slopes_agree_for_all_scalars) {
  const Points points = points_of(40, -pi, waves);
  const PeriodicSpline spline(points.knots, points.values);
  constexpr double tiny = 1e-30;
  constexpr double step = 1e-5;
  for (const double x : {-9.0, -3.0, -0.4, 0.0, 1.7, 3.2, 12.0}) {
    const math::Dual<1> dual = spline(math::independent<1>(x, 0));
    BOOST_TEST(dual.value() == spline.at(x).value);
    BOOST_TEST(dual.derivatives()(0) == spline.at(x).slope);
    BOOST_TEST(spline(std::complex<double>(x, tiny)).imag() / tiny == spline.at(x).slope,
               boost::test_tools::tolerance(1e-14));
    const double difference = (spline(x + step) - spline(x - step)) / (2.0 * step);
    BOOST_TEST(std::abs(difference - spline.at(x).slope) < 1e-8);  // step^2 times f'''
  }
  BOOST_TEST(spline(math::Dependence::on(5)).is_on(5));
  BOOST_TEST(PeriodicSpline()(math::Dependence::on(5)).is_on(5));
}

BOOST_AUTO_TEST_CASE(angles_that_are_not_finite_give_no_number) {
  const PeriodicSpline spline(ragged.knots, ragged.values);
  for (const double x :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    BOOST_TEST(std::isnan(spline.at(x).value));
  BOOST_TEST(std::isfinite(spline.at(1e300).value));
  BOOST_TEST(PeriodicSpline().at(1.0).value == 0.0);
}

BOOST_AUTO_TEST_CASE(wrong_points_are_refused) {
  using Error = std::invalid_argument;
  BOOST_CHECK_THROW(PeriodicSpline({-pi, 1.0, 1.0, pi}, {0, 1, 2, 0}), Error);
  BOOST_CHECK_THROW(PeriodicSpline({-pi, 1.0, 3.0}, {0, 1, 0}), Error);
  BOOST_CHECK_THROW(PeriodicSpline({-pi, 1.0, pi}, {0, 1, 0.1}), Error);
  BOOST_CHECK_THROW(PeriodicSpline({-pi, 1.0, pi}, {0, 1}), Error);
  BOOST_CHECK_THROW(PeriodicSpline(std::vector<double>{}, {}), Error);
}

BOOST_AUTO_TEST_SUITE_END()
