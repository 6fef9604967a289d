// Stations of the air whose elements have sections inside (docs/theory.md, 11.3).
#include "samara/model/air_stations.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/math/quadrature.hpp"

namespace samara::model {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double round_off = 1e-12;

PolarDefinition constant_drag(double drag) {
  return {0.0, {-pi, pi}, {0.0, 0.0}, {drag, drag}, {0.0, 0.0}};
}

/// A blade of one element of 10 m whose sections are `sections`.
TurbineDefinition blade(int order, std::vector<AeroSectionDefinition> sections) {
  TurbineDefinition turbine;
  SectionDefinition section;
  section.stiffness.setIdentity();
  section.mass.setIdentity();
  turbine.blades.beam.length = 10.0;
  turbine.blades.beam.elements = 1;
  turbine.blades.beam.order = order;
  turbine.blades.beam.sections = {section};
  turbine.blades.airfoils["thin"].polars = {constant_drag(0.1)};
  turbine.blades.airfoils["thick"].polars = {constant_drag(0.5)};
  turbine.blades.aero_sections = std::move(sections);
  turbine.wind.emplace();
  turbine.wind->speed = 8.0;
  turbine.aero.emplace();
  turbine.aero->induction = elements::Induction::none;
  return turbine;
}

std::vector<elements::AirStation> stations_of(const TurbineDefinition& definition) {
  const Turbine turbine = build_turbine(definition);
  BOOST_REQUIRE(turbine.air);
  return turbine.air->stations.at(0);
}

/// Sum of w_j xi_j^power times a property of the stations.
double moment(const std::vector<elements::AirStation>& stations, int power, auto property) {
  const math::QuadratureRule rule = math::gauss_rule(static_cast<int>(stations.size()));
  double sum = 0.0;
  for (std::size_t j = 0; j < stations.size(); ++j)
    sum += rule.weights[j] * std::pow(rule.points[j], power) * property(stations[j]);
  return sum;
}

double drag_of(const elements::AirStation& station) { return station.airfoil->drag_at(0.3); }

BOOST_AUTO_TEST_SUITE(air_stations)

/// Chord 2 up to 0.4, from there linearly to 1; twist 0 to 0.4, then to 0.3; thick to thin from
/// 0.4. The integrals are those of the polynomials of both parts, by hand.
BOOST_AUTO_TEST_CASE(moments_of_chord_twist_and_drag_are_those_of_the_table) {
  const std::vector<AeroSectionDefinition> table{{0.0, 2.0, 0.0, "thick", {0.1, 0.0}},
                                                 {0.4, 2.0, 0.0, "thick", {0.1, 0.0}},
                                                 {1.0, 1.0, 0.3, "thin", {-0.2, 0.0}}};
  for (const int order : {2, 3, 4}) {
    const auto stations = stations_of(blade(order, table));
    BOOST_REQUIRE(stations.size() == static_cast<std::size_t>(order));
    const auto chord = [](const auto& s) { return s.chord; };
    // int c = 0.8 + 0.6 (2 - 1/2); int xi c = 0.16 + 0.6 int (0.4 + 0.6 y)(2 - y) dy.
    BOOST_TEST(std::abs(moment(stations, 0, chord) - 1.7) < round_off);
    BOOST_TEST(std::abs(moment(stations, 1, chord) - (0.16 + 0.6 * (0.6 + 0.6 * (1 - 1.0 / 3)))) <
               round_off);
    // int c twist = 0.6 * 0.3 int y (2 - y) dy = 0.18 * 2/3
    const auto twist = [](const auto& s) { return s.chord * s.twist; };
    BOOST_TEST(std::abs(moment(stations, 0, twist) - 0.12) < round_off);
    // int c center = 0.8 * 0.1 + 0.6 int (2 - y)(0.1 - 0.3 y) dy
    const auto center = [](const auto& s) { return s.chord * s.center(1); };
    BOOST_TEST(std::abs(moment(stations, 0, center) - (0.08 + 0.6 * (0.15 - 0.2))) < round_off);
    // int c Cd = 0.8 * 0.5 + 0.6 int (2 - y)(0.5 - 0.4 y) dy
    const auto drag = [](const auto& s) { return s.chord * drag_of(s); };
    BOOST_TEST(std::abs(moment(stations, 0, drag) - (0.4 + 0.6 * (0.75 - 0.4 * 2.0 / 3))) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(without_sections_inside_a_station_has_the_section_of_its_place) {
  const auto stations =
      stations_of(blade(2, {{0.0, 2.0, 0.1, "thick", {}}, {1.0, 1.0, 0.3, "thin", {}}}));
  const std::vector<double> points = math::gauss_rule(2).points;
  for (std::size_t j = 0; j < 2; ++j) {
    BOOST_TEST(std::abs(stations[j].chord - (2.0 - points[j])) < round_off);
    BOOST_TEST(std::abs(stations[j].twist - (0.1 + 0.2 * points[j])) < round_off);
    BOOST_TEST(std::abs(drag_of(stations[j]) - (0.5 - 0.4 * points[j])) < 1e-10);
  }
}

/// The slope of the parts of three airfoils jumps at the thickness of the middle one, without a
/// section there: int Cd = 1/2 (0.1 + 0.3)/2 + 1/2 (0.3 + 1.1)/2.
BOOST_AUTO_TEST_CASE(thicknesses_of_airfoils_are_seams) {
  TurbineDefinition definition =
      blade(2, {{0.0, 1.0, 0.0, "", {}, 0.2}, {1.0, 1.0, 0.0, "", {}, 0.6}});
  definition.blades.airfoils["thin"].thickness = 0.2;
  definition.blades.airfoils["middle"] = {{}, {constant_drag(0.3)}, 0.4, {}};
  definition.blades.airfoils["thick"] = {{}, {constant_drag(1.1)}, 0.6, {}};
  BOOST_TEST(std::abs(moment(stations_of(definition), 0, drag_of) - 0.45) < 1e-10);
}

/// A cylinder with drag next to the root of an airfoil without any: the mean of the outer point
/// would have a negative drag.
BOOST_AUTO_TEST_CASE(no_station_has_a_negative_drag_by_its_mean) {
  TurbineDefinition definition = blade(
      2,
      {{0.0, 1.0, 0.0, "thick", {}}, {0.05, 1.0, 0.0, "thick", {}}, {0.06, 1.0, 0.0, "thin", {}}});
  definition.blades.airfoils["thin"].polars = {constant_drag(0.0)};
  for (const elements::AirStation& station : stations_of(definition))
    BOOST_TEST(drag_of(station) == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
}  // namespace samara::model
