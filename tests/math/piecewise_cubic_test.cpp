#include "samara/math/piecewise_cubic.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara;
using math::PiecewiseCubic;

double cubic(double x) { return 1.0 - 2.0 * x + 0.5 * x * x + 0.25 * x * x * x; }
double cubic_slope(double x) { return -2.0 + x + 0.75 * x * x; }

/// Knots whose spacing varies by eight orders of magnitude.
std::vector<double> uneven_knots() {
  std::vector<double> knots;
  for (int i = 0; i <= 60; ++i) knots.push_back(-1.0 + std::pow(10.0, -8.0 + i * 8.0 / 60.0));
  for (int i = 1; i <= 7; ++i) knots.push_back(0.3 * i);
  return knots;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(piecewise_cubic)

BOOST_AUTO_TEST_CASE(a_cubic_is_met_between_any_knots) {
  const std::vector<double> knots = uneven_knots();
  std::vector<double> values;
  std::vector<double> slopes;
  for (const double knot : knots) {
    values.push_back(cubic(knot));
    slopes.push_back(cubic_slope(knot));
  }
  const PiecewiseCubic curve(knots, values, slopes);
  constexpr double tolerance = 1e-7;  // round-off over the shortest interval, as a slope
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    for (const double part : {0.0, 1e-3, 0.5, 0.999, 1.0}) {
      const double x = knots[i] + part * (knots[i + 1] - knots[i]);
      BOOST_TEST(std::abs(curve.at(x).value - cubic(x)) < 1e-14);
      BOOST_TEST(std::abs(curve.at(x).slope - cubic_slope(x)) < tolerance);
    }
}

BOOST_AUTO_TEST_CASE(every_place_is_in_its_own_interval) {
  // The value is 1 between knots i and i + 1 and less outside.
  std::vector<double> knots;
  for (int i = 0; i <= 541; ++i) knots.push_back(0.1 * i + 0.04 * std::sin(1.7 * i));
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    std::vector<double> values(knots.size(), 0.0);
    values[i] = values[i + 1] = 1.0;
    const PiecewiseCubic curve(knots, values, std::vector<double>(knots.size(), 0.0));
    for (const double part : {1e-9, 0.4, 1.0 - 1e-9})
      BOOST_TEST(curve.at(knots[i] + part * (knots[i + 1] - knots[i])).value == 1.0);
    BOOST_TEST(curve.at(knots[i]).value == 1.0);
  }
}

BOOST_AUTO_TEST_CASE(wrong_knots_are_refused) {
  using Error = std::invalid_argument;
  BOOST_CHECK_THROW(PiecewiseCubic({0.0, 0.0}, {1.0, 1.0}, {0.0, 0.0}), Error);
  BOOST_CHECK_THROW(PiecewiseCubic({0.0, 1.0}, {1.0, 1.0}, {0.0}), Error);
  BOOST_CHECK_THROW(PiecewiseCubic({0.0, std::nan("")}, {1.0, 1.0}, {0.0, 0.0}), Error);
  BOOST_TEST(PiecewiseCubic().at(3.0).value == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
