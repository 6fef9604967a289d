// Faults of wind and air of a turbine that a program has made.
#include "samara/model/validation.hpp"

#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

namespace samara::model {
namespace {

constexpr double pi = std::numbers::pi;

PolarDefinition circle() { return {0.0, {-pi, pi}, {0.0, 0.0}, {0.5, 0.5}, {0.0, 0.0}}; }

TurbineDefinition rotor() {
  TurbineDefinition turbine;
  SectionDefinition section;
  section.stiffness.setIdentity();
  section.mass.setIdentity();
  turbine.blades.beam.length = 10.0;
  turbine.blades.beam.sections = {section};
  turbine.blades.airfoils["circle"].polars = {circle()};
  turbine.blades.aero_sections = {{0.2, 1.0, 0.0, "circle", {}}, {0.8, 0.5, 0.0, "circle", {}}};
  turbine.wind.emplace();
  turbine.wind->speed = 8.0;
  turbine.aero.emplace();
  return turbine;
}

std::vector<std::string> fields_of(const std::vector<Fault>& faults) {
  std::vector<std::string> fields;
  for (const Fault& fault : faults) fields.push_back(fault.field);
  return fields;
}

void check(const TurbineDefinition& turbine, const std::vector<std::string>& expected) {
  BOOST_TEST(fields_of(find_faults(turbine)) == expected, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_SUITE(air_of_a_definition)

BOOST_AUTO_TEST_CASE(sound_air_has_no_fault) {
  check(rotor(), {});
  BOOST_TEST(find_notes(rotor()).empty());
}

BOOST_AUTO_TEST_CASE(air_needs_wind_sections_and_blades) {
  TurbineDefinition turbine = rotor();
  turbine.wind.reset();
  check(turbine, {});
  BOOST_TEST(fields_of(find_notes(turbine)) == std::vector<std::string>{"aero"},
             boost::test_tools::per_element());
  turbine.aero.reset();
  check(turbine, {});
  turbine = rotor();
  turbine.blades.aero_sections.clear();
  check(turbine, {"aero"});
}

BOOST_AUTO_TEST_CASE(a_profile_needs_a_height_above_its_roughness) {
  TurbineDefinition turbine = rotor();
  turbine.wind->profile = WindDefinition::Profile::logarithmic;
  turbine.wind->roughness = 0.03;
  check(turbine, {"wind.height"});
  turbine.wind->height = 0.03;
  check(turbine, {"wind.shear.log"});
  turbine.wind->height = 90.0;
  check(turbine, {});
  turbine.wind->shear_up = 0.1;
  check(turbine, {"wind.shear.length"});
}

BOOST_AUTO_TEST_CASE(sections_rise_and_have_airfoils_and_chords) {
  TurbineDefinition turbine = rotor();
  turbine.blades.aero_sections[1].at = 0.2;
  turbine.blades.aero_sections[0].airfoil = "square";
  turbine.blades.aero_sections[1].chord = 0.0;
  check(turbine, {"blades.aero_sections[0].airfoil", "blades.aero_sections[1].at",
                  "blades.aero_sections[1].chord"});
}

BOOST_AUTO_TEST_CASE(airfoils_have_sound_polars) {
  TurbineDefinition turbine = rotor();
  AirfoilDefinition& airfoil = turbine.blades.airfoils["circle"];
  airfoil.polars[0].angles[0] = 0.0;
  check(turbine, {"blades.airfoils.circle.polars[0]"});
  airfoil.polars = {circle(), circle()};
  check(turbine,
        {"blades.airfoils.circle.polars[0].reynolds", "blades.airfoils.circle.polars[1].reynolds"});
  airfoil.polars[0].reynolds = airfoil.polars[1].reynolds = 1e6;
  check(turbine, {"blades.airfoils.circle.polars[1].reynolds"});
  airfoil.polars.clear();
  check(turbine, {"blades.airfoils.circle.polars"});
}

BOOST_AUTO_TEST_CASE(a_shed_wake_decays) {
  TurbineDefinition turbine = rotor();
  turbine.aero->wake[3] = 0.0;
  check(turbine, {"aero.wake_constants"});
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
}  // namespace samara::model
