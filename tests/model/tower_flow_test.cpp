// elements/tower_flow.hpp: potential flow around a cylinder, wakes and seams.
#include "samara/elements/tower_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/elements/wind.hpp"

namespace {

using namespace samara;
using namespace samara::elements;
using std::numbers::pi;
constexpr double round_off = 1e-12;

/// A vertical tower of 2 m radius and 80 m height.
Wind wind_of(TowerPotential potential, TowerWake wake = TowerWake::none, double drag = 0.5) {
  Wind wind;
  wind.mean.speed = 10.0;
  wind.tower.potential = potential;
  wind.tower.wake = wake;
  wind.tower.top = Vector3(0.0, 0.0, 80.0);
  wind.tower.diameter = math::TimeCurve::through({{0.0, 4.0}, {80.0, 4.0}});
  wind.tower.drag = math::TimeCurve::through({{0.0, drag}, {80.0, drag}});
  return wind;
}

/// Velocity at a place in tower radii; n2 is downwind.
Vector3 at(const Wind& wind, double downwind, double left, double height = 40.0) {
  return wind.at<double>(Vector3(-2.0 * left, 2.0 * downwind, height), 0.0);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(tower_flow)

BOOST_AUTO_TEST_CASE(potential_flow_has_its_stagnation_point_and_twice_the_speed_at_the_side) {
  const Wind wind = wind_of(TowerPotential::plain);
  constexpr double outside = 1.0 + 1e-7;
  BOOST_TEST(at(wind, -outside, 0.0).norm() < 1e-5);
  BOOST_TEST(std::abs(at(wind, 0.0, outside)(1) - 20.0) < 1e-5);
  // The velocity is that of the potential x (1 + 1/r^2).
  for (const auto& [x, y] : {std::pair(-2.0, 0.7), std::pair(-1.5, -1.1), std::pair(3.0, 0.2)}) {
    const auto potential = [](double a, double b) { return a * (1.0 + 1.0 / (a * a + b * b)); };
    constexpr double h = 1e-5;
    const Vector3 v = at(wind, x, y);
    const double u = (potential(x + h, y) - potential(x - h, y)) / (2.0 * h);
    const double w = (potential(x, y + h) - potential(x, y - h)) / (2.0 * h);
    BOOST_TEST(std::abs(v(1) - 10.0 * u) < 1e-6);
    BOOST_TEST(std::abs(v(0) + 10.0 * w) < 1e-6);  // to the left is -n1
    BOOST_TEST(v(2) == 0.0);
  }
}

/// Iterations may pass through the tower, solutions may not.
BOOST_AUTO_TEST_CASE(the_flow_is_continued_inside_the_tower) {
  for (const TowerPotential potential : {TowerPotential::plain, TowerPotential::bak}) {
    const Wind wind = wind_of(potential);
    BOOST_TEST(at(wind, 0.0, 0.0).norm() < 100.0);
    constexpr double h = 1e-6;
    for (const double angle : {0.3, 1.1, 2.0, 3.0}) {
      const auto along = [&](double r) {
        return at(wind, r * std::cos(angle) - (potential == TowerPotential::bak ? 0.1 : 0.0),
                  r * std::sin(angle));
      };
      const double edge = 0.9;
      const Vector3 inside = (along(edge) - along(edge - h)) / h;
      const Vector3 outside = (along(edge + h) - along(edge)) / h;
      BOOST_TEST((inside - outside).norm() < 1e-3);
      BOOST_TEST(inside.norm() > 1.0);
    }
    const TowerFlow& tower = wind.tower;
    BOOST_CHECK_THROW(tower.require_outside(Vector3(-1.0, 1.0, 40.0), "blade 1"), DomainError);
    BOOST_CHECK_NO_THROW(tower.require_outside(Vector3(-1.0, 2.0, 40.0), "blade 1"));
    BOOST_CHECK_NO_THROW(tower.require_outside(Vector3(0.0, 0.0, 84.5), "blade 1"));
  }
  BOOST_CHECK_NO_THROW(
      wind_of(TowerPotential::none).tower.require_outside(Vector3::Zero(), "blade 1"));
}

/// The formula of the potential with the drag, written out at a point 2.5 radii upwind.
BOOST_AUTO_TEST_CASE(bak_shifts_the_cylinder_and_adds_a_source) {
  const Wind wind = wind_of(TowerPotential::bak);
  const double X = -2.4;
  const double expected = 1.0 - 1.0 / (X * X) + 0.5 / (2.0 * pi * X);
  BOOST_TEST(std::abs(at(wind, -2.5, 0.0)(1) - 10.0 * expected) < 1e-6);
  const double y = 1.3;
  const double square = X * X + y * y;
  const double across = -2.0 * X * y / (square * square) + 0.5 * y / (2.0 * pi * square);
  BOOST_TEST(std::abs(at(wind, -2.5, y)(0) + 10.0 * across) < 1e-6);
}

BOOST_AUTO_TEST_CASE(wakes_have_their_deficits) {
  const Wind powles = wind_of(TowerPotential::none, TowerWake::powles);
  BOOST_TEST(std::abs(at(powles, 9.0, 0.0)(1) - 10.0 * (1.0 - 0.5 / 3.0)) < 1e-6);
  // Half way to the edge the cosine squared is one half; the edge is at sqrt(d).
  const double y = 1.5;
  const double width = std::sqrt(std::hypot(9.0, y));
  const double shape = std::pow(std::cos(0.5 * pi * y / width), 2);
  BOOST_TEST(std::abs(at(powles, 9.0, y)(1) - 10.0 * (1.0 - 0.5 / width * shape)) < 1e-6);
  BOOST_TEST(at(powles, 9.0, 3.2)(1) == 10.0);
  BOOST_TEST(at(powles, -3.0, 0.0)(1) == 10.0);
  Wind eames = wind_of(TowerPotential::none, TowerWake::eames);
  eames.tower.turbulence = 0.2;
  const double spread = 0.2 * 12.0;
  const double deficit = 0.5 / (spread * std::sqrt(2.0 * pi));
  BOOST_TEST(std::abs(at(eames, 12.0, 0.0)(1) - 10.0 * (1.0 - deficit)) < 1e-6);
  BOOST_TEST(std::abs(at(eames, 12.0, spread)(1) - 10.0 * (1.0 - deficit * std::exp(-0.5))) < 1e-6);
}

BOOST_AUTO_TEST_CASE(the_flow_turns_with_the_wind_and_ends_above_the_top) {
  Wind wind = wind_of(TowerPotential::bak, TowerWake::powles);
  const Vector3 place(3.0, 5.0, 40.0);
  const Vector3 there = wind.at<double>(place, 0.0);
  constexpr double angle = 0.7;
  wind.mean.direction = angle;
  const Matrix3 turn(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
  BOOST_TEST((wind.at<double>(turn * place, 0.0) - turn * there).norm() < round_off);
  BOOST_TEST((wind.at<double>(Vector3(3.0, 5.0, 84.0), 0.0) -
              wind.undisturbed_at<double>(Vector3(3.0, 5.0, 84.0), 0.0))
                 .norm() == 0.0);
  const Vector3 disturbed = there - wind_of(TowerPotential::none).at<double>(place, 0.0);
  const Vector3 above =
      wind_of(TowerPotential::bak, TowerWake::powles).at<double>(Vector3(3.0, 5.0, 82.0), 0.0) -
      Vector3(0.0, 10.0, 0.0);
  BOOST_TEST((above - 0.5 * disturbed).norm() < round_off);  // one radius above the top
}

/// Slopes do not jump where a wake begins, ends, or is limited, and at the top.
BOOST_AUTO_TEST_CASE(slopes_are_continuous) {
  constexpr double h = 1e-6;
  for (const TowerWake wake : {TowerWake::powles, TowerWake::eames}) {
    const Wind wind = wind_of(TowerPotential::bak, wake, 1.0);
    // The largest change of the slope from point to point falls with their distance.
    const auto along = [&](const Vector3& from, const Vector3& to) {
      double before = 0.0;
      for (const int points : {4000, 40000}) {
        double last = 0.0;
        double worst = 0.0;
        for (int i = 0; i <= points; ++i) {
          const Vector3 place = from + (to - from) * i / points;
          const Vector3 step = (to - from).normalized() * h;
          const double slope =
              (wind.at<double>(place + step, 0.0) - wind.at<double>(place - step, 0.0))(1) /
              (2.0 * h);
          if (i > 0) worst = std::max(worst, std::abs(slope - last));
          last = slope;
        }
        if (before > 0.0) BOOST_TEST(worst < 0.2 * before);
        before = worst;
      }
    };
    along({-20.0, 9.0, 40.0}, {20.0, 9.0, 40.0});
    along({2.6, -4.0, 40.0}, {2.6, 12.0, 40.0});
    along({0.0, 6.0, 70.0}, {0.0, 6.0, 90.0});
  }
}

BOOST_AUTO_TEST_SUITE_END()
