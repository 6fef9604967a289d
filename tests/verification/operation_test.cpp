// Operating points of the NREL 5 MW turbine against its published schedule.
#include "samara/simulation/operation.hpp"

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/io/case.hpp"
#include "samara/io/operation_table.hpp"

#include "../io/folder.hpp"

using namespace samara;
using boost::test_tools::tolerance;
using simulation::OperatingPoint;
using simulation::OperatingRegion;

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double rpm = std::numbers::pi / 30.0;

/// Coarse blades; the operation of the input.
io::Case turbine_at(const std::vector<std::string>& settings) {
  std::vector<std::string> all{"blades.elements=3", "blades.order=4"};
  all.insert(all.end(), settings.begin(), settings.end());
  return io::read_case(std::string(SAMARA_SOURCE_DIR) + "/inputs/nrel5mw/land.yaml", all);
}

std::vector<OperatingPoint> points_of(const io::Case& input,
                                      const std::vector<simulation::ScheduledPoint>& table = {}) {
  analysis::Observer observer;
  return simulation::find_operation(input, table, observer);
}

bool says(const InputError& error, const std::string& words) {
  return std::string(error.what()).find(words) != std::string::npos;
}

}  // namespace

/// Pitch of the published table (NREL/TP-500-38060, table 7-1), of a rotor without torsion.
BOOST_AUTO_TEST_CASE(pitch_at_rated_power_is_that_of_the_published_schedule) {
  const std::vector<std::pair<double, double>> published{
      {12.0, 3.83}, {15.0, 10.45}, {20.0, 17.47}, {25.0, 23.47}};
  const std::vector<OperatingPoint> points =
      points_of(turbine_at({"wind.speed=12", "operation.wind_speeds=[12,15,20,25]"}));
  for (std::size_t i = 0; i < published.size(); ++i) {
    BOOST_TEST_CONTEXT(published[i].first << " m/s") {
      const OperatingPoint& point = points[i];
      BOOST_TEST((point.region == OperatingRegion::rated_power));
      BOOST_TEST(point.speed == 12.1 * rpm, tolerance(1e-12));
      BOOST_TEST(std::abs(point.pitch / degree - published[i].second) <
                 (point.wind > 22.5 ? 0.6 : 0.3));
      // Torque times speed of the generator, 97 times that of the rotor.
      BOOST_TEST(point.torque * point.speed * 97.0 == 5.29661e6, tolerance(2e-5));
      BOOST_TEST(point.power == 5.29661e6, tolerance(2e-3));
    }
  }
}

/// Rotor speed of the same table at 8 m/s, 9.16 rpm, where the torque is 2.332287 N m s^2 times the
/// square of the generator's speed; below, the least speed.
BOOST_AUTO_TEST_CASE(torque_law_and_least_speed_hold_below_the_rated_power) {
  const std::vector<OperatingPoint> points =
      points_of(turbine_at({"wind.speed=8", "operation.wind_speeds=[4,8,11]"}));
  BOOST_TEST((points[0].region == OperatingRegion::least_speed));
  BOOST_TEST(points[0].speed == 6.9 * rpm, tolerance(1e-12));
  BOOST_TEST((points[1].region == OperatingRegion::torque_law));
  BOOST_TEST(points[1].speed == 9.16 * rpm, tolerance(1e-2));
  const double own = 97.0 * points[1].speed;
  BOOST_TEST(points[1].torque == 2.332287 * own * own, tolerance(2e-5));
  BOOST_TEST((points[2].region == OperatingRegion::rated_speed));
  BOOST_TEST(points[2].torque < 5.29661e6 / (97.0 * 12.1 * rpm));
  BOOST_TEST(points[2].pitch == 0.0);
}

/// The pitch does not depend on the way to it: one wind speed alone gives the same as the last one
/// of several.
BOOST_AUTO_TEST_CASE(a_point_does_not_depend_on_those_before_it) {
  const OperatingPoint alone =
      points_of(turbine_at({"wind.speed=18", "operation.wind_speeds=[18]"})).front();
  const OperatingPoint last =
      points_of(turbine_at({"wind.speed=18", "operation.wind_speeds=[14,16,18]"})).back();
  BOOST_TEST(alone.pitch == last.pitch, tolerance(1e-4));
  BOOST_TEST(alone.thrust == last.thrust, tolerance(1e-4));
}

BOOST_AUTO_TEST_CASE(a_table_gives_speed_and_pitch) {
  const io::Case input = turbine_at({"wind.speed=8", "operation={wind_speeds: [9, 13]}"});
  const std::vector<simulation::ScheduledPoint> table{
      {8.0, 0.9, 0.0}, {10.0, 1.1, 0.02}, {14.0, 1.3, 0.14}};
  const std::vector<OperatingPoint> points = points_of(input, table);
  BOOST_TEST((points[0].region == OperatingRegion::given));
  BOOST_TEST(points[0].speed == 1.0, tolerance(1e-12));
  BOOST_TEST(points[0].pitch == 0.01, tolerance(1e-12));
  BOOST_TEST(points[1].speed == 1.25, tolerance(1e-12));
  BOOST_TEST(points[1].pitch == 0.11, tolerance(1e-12));
  // The coefficients are those of power and thrust.
  const double pressure = 0.5 * 1.225 * 81.0 * std::numbers::pi * std::pow(points[0].speed, -2) *
                          std::pow(points[0].tip_speed_ratio * 9.0, 2);
  BOOST_TEST(points[0].thrust == points[0].thrust_coefficient * pressure, tolerance(1e-9));
  BOOST_TEST(points[0].power == points[0].power_coefficient * pressure * 9.0, tolerance(1e-9));
  BOOST_CHECK_EXCEPTION(
      points_of(turbine_at({"wind.speed=8", "operation={wind_speeds: [15]}"}), table), InputError,
      [](const InputError& error) { return says(error, "from 8 to 14 m/s only"); });
}

BOOST_AUTO_TEST_CASE(points_that_do_not_exist_are_refused_with_the_reason) {
  BOOST_CHECK_EXCEPTION(points_of(turbine_at({"wind.speed=2", "operation.wind_speeds=[2]"})),
                        InputError, [](const InputError& error) {
                          return says(error, "operation at 2 m/s: the wind does not drive");
                        });
}

BOOST_AUTO_TEST_CASE(opt_files_come_back) {
  const std::vector<OperatingPoint> points{
      {.wind = 8.0, .speed = 0.95, .pitch = 0.01, .power = 1.9e6, .thrust = 3.8e5},
      {.wind = 12.0, .speed = 1.27, .pitch = 0.07, .power = 5.3e6, .thrust = 5.9e5}};
  const test::Folder folder;
  const std::string path = folder.file("points.opt");
  io::write_opt_file(path, points);
  const std::vector<simulation::ScheduledPoint> rows = io::read_opt_file(path);
  BOOST_REQUIRE(rows.size() == 2u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    BOOST_TEST(rows[i].wind == points[i].wind, tolerance(1e-9));
    BOOST_TEST(rows[i].speed == points[i].speed, tolerance(1e-6));
    BOOST_TEST(rows[i].pitch == points[i].pitch, tolerance(1e-6));
  }
  const auto refuses = [&path](const std::string& text, const std::string& words) {
    std::ofstream(path) << text;
    BOOST_CHECK_EXCEPTION(io::read_opt_file(path), InputError,
                          [&words](const InputError& error) { return says(error, words); });
  };
  refuses("wind pitch\n", "points.opt:1: expected the number of rows");
  refuses("2 wind pitch\n 8 0 9\n", "points.opt:3: the file ends after 1 of 2 rows");
  refuses("2 wind pitch\n 8 0 9\n 8 0 9\n", "points.opt:3: the wind speed must be higher");
  refuses("1 wind pitch\n 8 0\n", "points.opt:2: expected wind speed");
  refuses("1 wind pitch\n 8 0 -9\n", "points.opt:2: the rotor speed must be > 0");
}
