#include "samara/math/smoothed_curve.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/math/autodiff.hpp"

namespace {

using namespace samara;
using math::SmoothedCurve;

constexpr double round_off = 1e-14;

const std::vector<double> knots{-2.0, -1.5, -0.2, 0.0, 0.1, 1.0, 2.5, 3.0};
const std::vector<double> values{0.0, 0.0, 0.9, 1.0, 1.0, 0.3, 0.0, 0.0};

}  // namespace

BOOST_AUTO_TEST_SUITE(smoothed_curve)

BOOST_AUTO_TEST_CASE(it_rises_and_falls_only_where_the_points_do) {
  const SmoothedCurve curve(knots, values);
  double last = values.front();
  bool falls = false;
  for (double x = knots.front(); x <= knots.back(); x += 0.001) {
    const double here = curve.at(x).value;
    BOOST_TEST((here >= 0.0 && here <= 1.0));
    if (here < last - round_off) falls = true;
    BOOST_TEST((!falls || here <= last + round_off));
    last = here;
  }
  BOOST_TEST(falls);
}

BOOST_AUTO_TEST_CASE(at_equal_distances_it_is_a_mean_of_three_points) {
  const std::vector<double> y{0.3, -1.0, 2.0, 0.7, 5.0, 1.0, 0.0};
  const SmoothedCurve curve({0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0}, y);
  for (std::size_t i = 2; i <= 4; ++i) {
    const double x = 0.5 * static_cast<double>(i);
    // The second coefficient is that of the first point, the last but one that of the last.
    const double left = i == 2 ? y[0] : y[i - 1];
    const double right = i == 4 ? y[6] : y[i + 1];
    BOOST_TEST(std::abs(curve.at(x).value - (left + 4.0 * y[i] + right) / 6.0) < round_off);
    BOOST_TEST(std::abs(curve.at(x).slope - (right - left)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(lines_are_met_beyond_three_intervals_from_the_ends) {
  std::vector<double> line;
  for (const double x : knots) line.push_back(1.0 - 2.0 * x);
  const SmoothedCurve curve(knots, line);
  for (double x = knots[3]; x <= knots[4]; x += 0.01) {
    BOOST_TEST(std::abs(curve.at(x).value - (1.0 - 2.0 * x)) < 10.0 * round_off);
    BOOST_TEST(std::abs(curve.at(x).slope + 2.0) < 10.0 * round_off);
  }
}

BOOST_AUTO_TEST_CASE(slopes_and_curvatures_are_continuous_and_zero_at_the_ends) {
  const SmoothedCurve curve(knots, values);
  constexpr double step = 1e-6;
  const auto curvature = [&](double x) {
    return (curve.at(x + step).slope - curve.at(x - step).slope) / (2.0 * step);
  };
  for (const double knot : knots) {
    BOOST_TEST(std::abs(curve.at(knot + step).slope - curve.at(knot - step).slope) < 1e-3);
    BOOST_TEST(std::abs(curvature(knot + 2.0 * step) - curvature(knot - 2.0 * step)) < 1e-2);
  }
  const SmoothedCurve open({0.0, 1.0, 2.0, 3.0, 4.0}, {2.0, 7.0, 5.0, 9.0, 3.0});
  BOOST_TEST(open.at(-5.0).value == 2.0);
  BOOST_TEST(open.at(0.0).value == 2.0);
  BOOST_TEST(open.at(5.0).value == 3.0);
  BOOST_TEST(open.at(-5.0).slope == 0.0);
  BOOST_TEST(open.at(0.0).slope == 0.0);
  BOOST_TEST(std::abs(open.at(4.0).slope) < round_off);
  BOOST_TEST(open.at(5.0).slope == 0.0);
  BOOST_TEST(open.at(std::numeric_limits<double>::infinity()).value == 3.0);
}

BOOST_AUTO_TEST_CASE(it_approaches_a_smooth_function_with_the_square_of_the_distance) {
  double before = 0.0;
  for (const int n : {40, 80, 160}) {
    std::vector<double> x;
    std::vector<double> y;
    for (int i = 0; i <= n; ++i) {
      x.push_back(-1.0 + 2.0 * i / n);
      y.push_back(std::cos(2.0 * x.back()));
    }
    const SmoothedCurve curve(x, y);
    double worst = 0.0;
    for (double at = -0.7; at <= 0.7; at += 0.01)
      worst = std::max(worst, std::abs(curve.at(at).value - std::cos(2.0 * at)));
    const double h = 2.0 / n;
    BOOST_TEST(std::abs(worst / (h * h / 6.0 * 4.0) - 1.0) < 0.02);  // h^2/6 |f''| at 0
    if (before > 0.0) BOOST_TEST(std::abs(before / worst - 4.0) < 0.05);
    before = worst;
  }
}

BOOST_AUTO_TEST_CASE(slopes_agree_for_all_scalars) {
  const SmoothedCurve curve(knots, values);
  constexpr double tiny = 1e-30;
  constexpr double step = 1e-6;
  for (const double x : {-7.0, -1.7, -1.0, 0.05, 0.6, 1.9, 2.7, 8.0}) {
    const math::Dual<1> dual = curve(math::independent<1>(x, 0));
    BOOST_TEST(dual.value() == curve.at(x).value);
    BOOST_TEST(dual.derivatives()(0) == curve.at(x).slope);
    BOOST_TEST(std::abs(curve(std::complex<double>(x, tiny)).imag() / tiny - curve.at(x).slope) <
               round_off);
    const double difference = (curve(x + step) - curve(x - step)) / (2.0 * step);
    BOOST_TEST(std::abs(difference - curve.at(x).slope) < 1e-8);  // step^2 times f'''
  }
  BOOST_TEST(curve(math::Dependence::on(3)).is_on(3));
  BOOST_TEST(SmoothedCurve()(math::Dependence::on(3)).is_on(3));
}

BOOST_AUTO_TEST_CASE(wrong_points_are_refused) {
  using Error = std::invalid_argument;
  BOOST_CHECK_THROW(SmoothedCurve({0.0, 0.0, 1.0, 2.0}, {0.0, 1.0, 1.0, 1.0}), Error);
  BOOST_CHECK_THROW(SmoothedCurve({0.0, 1.0, 2.0, 3.0}, {0.0}), Error);
  BOOST_CHECK_THROW(SmoothedCurve({0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}), Error);
  BOOST_TEST(SmoothedCurve().at(1.0).value == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
