#include "samara/math/monotone_curve.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara;
using math::MonotoneCurve;

constexpr double round_off = 1e-14;

const std::vector<double> knots{-2.0, -1.5, -0.2, 0.0, 0.1, 1.0, 2.5, 3.0};
const std::vector<double> values{0.0, 0.0, 0.9, 1.0, 1.0, 0.3, 0.0, 0.0};

}  // namespace

BOOST_AUTO_TEST_SUITE(monotone_curve)

BOOST_AUTO_TEST_CASE(it_goes_through_its_points_and_stays_between_neighbours) {
  const MonotoneCurve curve(knots, values);
  for (std::size_t i = 0; i < knots.size(); ++i)
    BOOST_TEST(std::abs(curve.at(knots[i]).value - values[i]) < round_off);
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double rise = values[i + 1] - values[i];
    double last = values[i];
    for (int k = 0; k <= 100; ++k) {
      const double x = knots[i] + (knots[i + 1] - knots[i]) * k / 100.0;
      const math::ValueAndSlope here = curve.at(x);
      BOOST_TEST((here.value - last) * rise >= -round_off);
      if (k < 100) BOOST_TEST(here.slope * rise >= 0.0);
      if (rise == 0.0) BOOST_TEST(here.value == values[i]);
      last = here.value;
    }
    BOOST_TEST(std::abs(last - values[i + 1]) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(slopes_at_the_knots_are_those_of_fritsch_and_butland) {
  const MonotoneCurve curve({0.0, 1.0, 3.0, 4.0}, {0.0, 1.0, 5.0, 4.0});
  // Chords 1, 2, -1 over the lengths 1, 2, 1. At 1: weights 2*2 + 1 and 2 + 2*1.
  BOOST_TEST(std::abs(curve.at(1.0).slope - 9.0 / (5.0 / 1.0 + 4.0 / 2.0)) < round_off);
  BOOST_TEST(curve.at(3.0).slope == 0.0);
  // At the ends, of the parabola through three points: ((2 + 2) 1 - 1*2)/3 and, from behind,
  // ((2 + 2)(-1) - 1*2)/3 = -2.
  BOOST_TEST(std::abs(curve.at(0.0).slope - 2.0 / 3.0) < round_off);
  BOOST_TEST(std::abs(curve.at(4.0).slope + 2.0) < round_off);
  // Limited to zero where the parabola turns, and to three times the chord.
  BOOST_TEST(MonotoneCurve({0.0, 1.0, 2.0}, {0.0, 1.0, 9.0}).at(0.0).slope == 0.0);
  BOOST_TEST(std::abs(MonotoneCurve({0.0, 1.0, 2.0}, {0.0, 1.0, -9.0}).at(0.0).slope - 3.0) <
             round_off);
}

BOOST_AUTO_TEST_CASE(lines_are_met_exactly) {
  const MonotoneCurve line({0.0, 0.3, 1.0, 4.0}, {1.0, 0.4, -1.0, -7.0});
  const MonotoneCurve two({0.0, 4.0}, {1.0, -7.0});
  for (double x = 0.0; x <= 4.0; x += 0.05) {
    BOOST_TEST(std::abs(line.at(x).value - (1.0 - 2.0 * x)) < round_off);
    BOOST_TEST(std::abs(line.at(x).slope + 2.0) < round_off);
    BOOST_TEST(std::abs(two.at(x).value - (1.0 - 2.0 * x)) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(slopes_are_continuous_and_zero_beyond_the_ends) {
  const MonotoneCurve curve(knots, values);
  constexpr double step = 1e-9;
  for (const double knot : knots)
    BOOST_TEST(std::abs(curve.at(knot + step).slope - curve.at(knot - step).slope) < 1e-6);
  const MonotoneCurve open({0.0, 1.0}, {2.0, 3.0});
  BOOST_TEST(open.at(-5.0).value == 2.0);
  BOOST_TEST(open.at(5.0).value == 3.0);
  BOOST_TEST(open.at(-5.0).slope == 0.0);
  BOOST_TEST(open.at(5.0).slope == 0.0);
  BOOST_TEST(open.at(std::numeric_limits<double>::infinity()).value == 3.0);
}

BOOST_AUTO_TEST_CASE(slopes_agree_for_all_scalars) {
  const MonotoneCurve curve(knots, values);
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
  BOOST_TEST(MonotoneCurve()(math::Dependence::on(3)).is_on(3));
}

BOOST_AUTO_TEST_CASE(wrong_points_are_refused) {
  using Error = std::invalid_argument;
  BOOST_CHECK_THROW(MonotoneCurve({0.0, 0.0}, {0.0, 1.0}), Error);
  BOOST_CHECK_THROW(MonotoneCurve({0.0, 1.0}, {0.0}), Error);
  BOOST_CHECK_THROW(MonotoneCurve({0.0}, {0.0}), Error);
  BOOST_TEST(MonotoneCurve().at(1.0).value == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
