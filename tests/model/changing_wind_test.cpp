// model/changing_wind.hpp: gusts of IEC 61400-1 by hand, boxes of turbulence, curves of the mean
// wind.
#include "samara/model/changing_wind.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

namespace {

using namespace samara;
using namespace samara::model;
using std::numbers::pi;
constexpr double round_off = 1e-12;
constexpr double degree = pi / 180.0;

/// A hub at 90 m, where Lambda_1 is 42 m, a rotor of 126 m, 12 m/s.
constexpr GustSite site{12.0, 90.0, 126.0};

elements::MeanWind mean_wind() {
  elements::MeanWind wind;
  wind.speed = 12.0;
  wind.height = 90.0;
  return wind;
}

/// A box whose velocities are linear in the place and the time, so that linear interpolation is
/// exact: u = 10 + t/4 + y/20 + z/50, v = -t/8, w = z/25.
WindBox linear_box(bool is_periodic) {
  WindBox box;
  box.times = 41;
  box.rows = 5;
  box.columns = 4;
  box.step = 0.5;
  box.width = 20.0;
  box.height = 15.0;
  box.bottom = 30.0;
  box.speed = 10.0;
  box.front = is_periodic ? 0.0 : 30.0;
  box.is_periodic = is_periodic;
  for (int i = 0; i < box.times; ++i)
    for (int j = 0; j < box.rows; ++j)
      for (int k = 0; k < box.columns; ++k) {
        const double t = box.step * i;
        const double y = box.width * (k - 1.5);
        const double z = box.bottom + box.height * j;
        box.values.push_back(static_cast<float>(10.0 + t / 4.0 + y / 20.0 + z / 50.0));
        box.values.push_back(static_cast<float>(-t / 8.0));
        box.values.push_back(static_cast<float>(z / 25.0));
      }
  return box;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(changing_wind)

/// Laws of the mean wind by hand, at a place 30 m above the reference height and 10 m to the left.
BOOST_AUTO_TEST_CASE(profiles_of_the_mean_wind) {
  const Vector3 place(-10.0, 0.0, 120.0);  // left of one who looks along n2
  const auto speed_of = [&](const elements::MeanWind& wind) { return wind.at<double>(place)(1); };
  elements::MeanWind wind = mean_wind();
  wind.profile = elements::WindProfile::power;
  wind.exponent = 0.2;
  BOOST_TEST(std::abs(speed_of(wind) - 12.0 * std::pow(120.0 / 90.0, 0.2)) < round_off * 12.0);
  wind.profile = elements::WindProfile::logarithmic;
  wind.roughness = 0.03;
  BOOST_TEST(std::abs(speed_of(wind) - 12.0 * std::log(4000.0) / std::log(3000.0)) < 1e-11);
  wind = mean_wind();
  wind.shear_up = 0.01;
  wind.shear_left = 0.02;
  BOOST_TEST(std::abs(speed_of(wind) - 12.5) < 1e-11);
  // Veer turns the wind with the height: 0.001 rad/m counter-clockwise seen from above.
  wind = mean_wind();
  wind.direction = 0.1;
  wind.veer = 0.001;
  wind.upflow = 0.05;
  const Vector3 velocity = wind.at<double>(place);
  BOOST_TEST(std::abs(velocity(0) + 12.0 * std::cos(0.05) * std::sin(0.13)) < 1e-11);
  BOOST_TEST(std::abs(velocity(1) - 12.0 * std::cos(0.05) * std::cos(0.13)) < 1e-11);
  BOOST_TEST(std::abs(velocity(2) - 12.0 * std::sin(0.05)) < 1e-11);
}

/// Class I A at 12 m/s: sigma_1 = 0.16 (9 + 5.6) = 2.336 m/s, D/Lambda_1 = 3, V_e1 = 56 m/s:
/// V_gust = min(59.4, 3.3 x 2.336/1.3) = 5.929846 m/s.
BOOST_AUTO_TEST_CASE(the_operating_gust_has_the_values_of_the_standard) {
  GustDefinition gust;
  gust.start = 5.0;
  const double rise = 3.3 * 2.336 / 1.3;
  BOOST_TEST(std::abs(rise - 5.929846) < 1e-6);
  BOOST_TEST(gust_at(gust, site, 5.0).speed == 0.0);
  // Half way: sin(3 pi/2) = -1, 1 - cos(pi) = 2.
  BOOST_TEST(std::abs(gust_at(gust, site, 5.0 + 5.25).speed - 0.74 * rise) < round_off);
  // A quarter of the time: sin(3 pi/4) = 1/sqrt(2), 1 - cos(pi/2) = 1: the dip before the gust.
  BOOST_TEST(std::abs(gust_at(gust, site, 5.0 + 2.625).speed + 0.37 * rise / std::sqrt(2.0)) <
             round_off);
  BOOST_TEST(gust_at(gust, site, 16.0).speed == 0.0);
  // Near the extreme speed the other bound holds: 1.35 (0.8 x 1.4 x 37.5 - 41) = 1.35.
  gust.reference_speed = 37.5;
  BOOST_TEST(std::abs(gust_at(gust, {41.0, 90.0, 126.0}, 10.25).speed - 0.74 * 1.35) < 1e-9);
}

BOOST_AUTO_TEST_CASE(changes_of_direction_have_the_values_of_the_standard) {
  GustDefinition gust;
  gust.type = GustDefinition::Type::direction;
  const double most = 4.0 * std::atan(2.336 / (12.0 * 1.3));
  BOOST_TEST(std::abs(gust_at(gust, site, 3.0).direction - 0.5 * most) < round_off);
  BOOST_TEST(std::abs(gust_at(gust, site, 100.0).direction - most) < round_off);
  gust.is_negative = true;
  BOOST_TEST(std::abs(gust_at(gust, site, 6.0).direction + most) < round_off);
  gust.is_negative = false;
  gust.type = GustDefinition::Type::coherent;
  BOOST_TEST(std::abs(gust_at(gust, site, 5.0).speed - 7.5) < round_off);
  BOOST_TEST(std::abs(gust_at(gust, site, 50.0).speed - 15.0) < round_off);
  BOOST_TEST(std::abs(gust_at(gust, site, 50.0).direction - 60.0 * degree) < round_off);  // 720/12
  BOOST_TEST(std::abs(gust_at(gust, {3.0, 90.0, 126.0}, 50.0).direction - pi) < round_off);
}

/// 2.5 + 0.2 x 6.4 x 2.336 x 3^(1/4) across the diameter, twice that at the middle of the gust.
BOOST_AUTO_TEST_CASE(extreme_shears_have_the_values_of_the_standard) {
  GustDefinition gust;
  gust.type = GustDefinition::Type::vertical_shear;
  const double across = 2.0 * (2.5 + 1.28 * 2.336 * std::pow(3.0, 0.25));
  const GustState state = gust_at(gust, site, 6.0);
  BOOST_TEST(std::abs(state.shear_up * 126.0 - across) < round_off);
  BOOST_TEST(state.shear_left == 0.0);
  gust.type = GustDefinition::Type::horizontal_shear;
  BOOST_TEST(std::abs(gust_at(gust, site, 6.0).shear_left * 126.0 - across) < round_off);
  BOOST_TEST(gust_at(gust, site, 12.5).shear_left == 0.0);
}

BOOST_AUTO_TEST_CASE(curves_replace_the_parameters_of_the_mean_wind) {
  WindChange change;
  change.speed = math::TimeCurve::along({{0.0, 12.0}, {10.0, 16.0}});
  change.direction = math::TimeCurve::along({{0.0, 0.0}, {10.0, 0.2}});
  change.shear_up = math::TimeCurve::along({{0.0, 0.1}, {10.0, 0.1}});
  const auto wind = make_changing_wind(change, mean_wind(), 126.0, site);
  const Vector3 place(3.0, -4.0, 110.0);
  const auto sample = wind->at(place, 5.0);
  const double speed = 14.0 * (1.0 + 0.1 * 20.0 / 126.0);
  const Vector3 ahead(-std::sin(0.1), std::cos(0.1), 0.0);
  BOOST_TEST((sample.velocity - speed * ahead).norm() < 1e-12);
  Matrix3 gradient = Matrix3::Zero();
  gradient.col(2) = 14.0 * 0.1 / 126.0 * ahead;
  BOOST_TEST((sample.gradient - gradient).norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_box_is_linear_between_its_points_and_moves_with_its_speed) {
  const WindBox box = linear_box(false);
  const Vector3 place(-6.0, 7.0, 61.0);  // 6 m upwind, 7 m to the left
  const double instant = 4.0 + (30.0 + 6.0) / 10.0;
  const auto sample = box.at(place, 4.0);
  BOOST_TEST(std::abs(sample.velocity(0) - (10.0 + instant / 4.0 + 7.0 / 20.0 + 61.0 / 50.0)) <
             1e-5);
  BOOST_TEST(std::abs(sample.velocity(1) + instant / 8.0) < 1e-5);
  BOOST_TEST(std::abs(sample.velocity(2) - 61.0 / 25.0) < 1e-5);
  Matrix3 gradient;
  gradient << -1.0 / 40.0, 1.0 / 20.0, 1.0 / 50.0, 1.0 / 80.0, 0.0, 0.0, 0.0, 0.0, 1.0 / 25.0;
  BOOST_TEST((sample.gradient - gradient).cwiseAbs().maxCoeff() < 1e-5);
  // At a corner of the grid, and below the lowest row.
  BOOST_TEST(std::abs(box.at({0.0, 30.0, 90.0}, 0.0).velocity(2) - 90.0 / 25.0) < 1e-5);
  BOOST_TEST(std::abs(box.at({0.0, 0.0, 1.0}, 0.0).velocity(2) - 30.0 / 25.0) < 1e-5);
  BOOST_TEST(box.at({0.0, 0.0, 1.0}, 0.0).gradient(2, 2) == 0.0);
  BOOST_CHECK_THROW(box.at({0.0, 31.0, 60.0}, 0.0), DomainError);
  BOOST_CHECK_THROW(box.at({0.0, 0.0, 91.0}, 0.0), DomainError);
  BOOST_CHECK_THROW(box.at({0.0, 0.0, 60.0}, 17.1), DomainError);
  BOOST_CHECK_THROW(box.at({31.0, 0.0, 60.0}, 0.0), DomainError);
}

BOOST_AUTO_TEST_CASE(a_periodic_box_begins_anew) {
  const WindBox box = linear_box(true);
  const Vector3 place(2.0, -3.0, 50.0);
  const double period = 0.5 * 41;
  for (const double t : {0.0, 3.3, 20.1, 20.4}) {
    BOOST_TEST((box.at(place, t).velocity - box.at(place, t + period).velocity).norm() < 1e-9);
    BOOST_TEST((box.at(place, t).velocity - box.at(place, t - period).velocity).norm() < 1e-9);
  }
  // Between the last instant and the first one.
  const double u = box.at({0.0, 0.0, 50.0}, 20.25).velocity(0);
  BOOST_TEST(std::abs(u - (10.0 + 0.5 * (20.0 + 0.0) / 4.0 + 1.0)) < 1e-5);
}

BOOST_AUTO_TEST_CASE(a_box_of_fluctuations_turns_with_the_wind_and_is_added) {
  WindChange change;
  WindBox box = linear_box(true);
  box.is_fluctuation = true;
  change.box = std::make_shared<const WindBox>(box);
  elements::MeanWind mean = mean_wind();
  mean.direction = 0.3;
  const auto wind = make_changing_wind(change, mean, 0.0, site);
  // 5 m downwind of the tower, 10 m to the left.
  const Matrix3 turn(Eigen::AngleAxisd(0.3, Vector3::UnitZ()));
  const auto there = wind->at(turn * Vector3(-10.0, 5.0, 60.0), 2.0);
  const Vector3 own = box.at({5.0, 10.0, 60.0}, 2.0).velocity;
  BOOST_TEST((there.velocity - turn * Vector3(-own(1), 12.0 + own(0), own(2))).norm() < 1e-9);
  // The gradient is that of differences.
  constexpr double h = 1e-3;
  for (int j = 0; j < 3; ++j) {
    const Vector3 place = turn * Vector3(-10.0, 5.0, 61.0);
    const Vector3 step = h * Vector3::Unit(j);
    const Vector3 slope =
        (wind->at(place + step, 2.0).velocity - wind->at(place - step, 2.0).velocity) / (2.0 * h);
    BOOST_TEST((slope - wind->at(place, 2.0).gradient.col(j)).norm() < 1e-6);
  }
}

BOOST_AUTO_TEST_SUITE_END()
