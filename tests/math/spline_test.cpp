#include "samara/math/spline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <boost/test/unit_test.hpp>

namespace {

using namespace samara;
using math::NaturalSpline;

constexpr double round_off = 1e-13;

std::vector<Vector3> arc(int intervals, double radius, double angle) {
  std::vector<Vector3> points;
  for (int i = 0; i <= intervals; ++i) {
    const double a = angle * i / intervals;
    points.emplace_back(radius * std::sin(a), radius - radius * std::cos(a), 0.0);
  }
  return points;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(natural_spline)

BOOST_AUTO_TEST_CASE(a_straight_line_is_met_exactly_and_goes_on_beyond_its_ends) {
  const Vector3 along = Vector3(1.0, -2.0, 2.0) / 3.0;
  const NaturalSpline spline({Vector3::Zero(), 0.5 * along, 4.0 * along, 6.0 * along});
  BOOST_TEST(std::abs(spline.length() - 6.0) < round_off);
  for (const double s : {-1.0, 0.0, 0.3, 0.5, 3.0, 6.0, 7.0}) {
    BOOST_TEST((spline.at(s).position - s * along).norm() < round_off * 10.0);
    BOOST_TEST((spline.at(s).tangent - along).norm() < round_off);
  }
}

BOOST_AUTO_TEST_CASE(it_goes_through_its_points) {
  const std::vector<Vector3> points{Vector3::Zero(), Vector3(1, 0.2, 0), Vector3(1.5, 1, -0.3),
                                    Vector3(4, 1.2, 0.5)};
  const NaturalSpline spline(points);
  // Each point is nearest to the curve at some arc length: distance zero within the search's grid.
  for (const Vector3& point : points) {
    double nearest = 1e9;
    for (int i = 0; i <= 20000; ++i)
      nearest = std::min(nearest, (spline.at(spline.length() * i / 20000).position - point).norm());
    BOOST_TEST(nearest < spline.length() / 20000);
  }
}

BOOST_AUTO_TEST_CASE(the_parameter_is_the_arc_length_and_the_tangent_its_derivative) {
  const NaturalSpline spline(
      {Vector3::Zero(), Vector3(1, 0.5, 0), Vector3(2, -0.3, 0.8), Vector3(2.5, 0.1, 2.0)});
  const double h = 1e-4;
  for (const double s : {0.3, 1.1, 1.9, 2.7}) {
    const Vector3 slope = (spline.at(s + h).position - spline.at(s - h).position) / (2.0 * h);
    BOOST_TEST((slope - spline.at(s).tangent).norm() < 1e-6);  // h^2 times the third derivative
    BOOST_TEST(std::abs(spline.at(s).tangent.norm() - 1.0) < round_off);
  }
}

BOOST_AUTO_TEST_CASE(points_of_an_arc_give_the_arc_to_fourth_order_away_from_the_ends) {
  const auto error = [](int intervals) {
    const NaturalSpline spline(arc(intervals, 2.0, 0.5 * std::numbers::pi));
    double worst = 0.0;
    for (double fraction = 0.4; fraction < 0.6; fraction += 0.001) {
      const Vector3 place = spline.at(fraction * spline.length()).position;
      worst = std::max(worst, std::abs((place - Vector3(0.0, 2.0, 0.0)).norm() - 2.0));
    }
    return worst;
  };
  BOOST_TEST(error(16) < 1e-6);
  BOOST_TEST(error(32) < error(16) / 14.0);
}

BOOST_AUTO_TEST_SUITE_END()
