// Wind, models of the air, airfoils and aerodynamic sections in a case file.
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/io/case.hpp"
#include "samara/io/polar_file.hpp"
#include "samara/io/result_file.hpp"
#include "samara/io/result_reader.hpp"
#include "samara/io/same_model.hpp"

#include "folder.hpp"

namespace samara::io {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;
using test::Folder;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double round_off = 1e-14;

/// Eight lines; tests append keys of `blades` from line 9.
const std::string blades = R"(samara: 1
blades:
  count: 2
  length: 10
  sections:
    - mass: 5
      inertia: [1, 0.5, 0.5]
      stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: 1e6, EI2: 2e6, EI3: 3e6}
)";

/// Line 9 to 11.
const std::string sections = R"(  airfoils:
    circle: {polars: [{table: [[-180, 0, 0.5, 0], [180, 0, 0.5, 0]]}]}
  aero_sections: [{chord: 1, airfoil: circle}]
)";

model::TurbineDefinition read(const std::string& text, const Strings& settings = {}) {
  return parse_case("case.yaml", text, settings).turbine;
}

void check_errors(const std::string& text, const Strings& expected, const Strings& settings = {}) {
  std::string whole;
  for (const std::string& line : expected) whole += (whole.empty() ? "" : "\n") + line;
  try {
    parse_case("case.yaml", text, settings);
    BOOST_ERROR("no error, expected: " + whole);
  } catch (const InputError& error) {
    BOOST_TEST(error.what() == whole);
  }
}

void check_error(const std::string& text, const std::string& expected) {
  check_errors(text, {"case.yaml:" + expected});
}

BOOST_AUTO_TEST_SUITE(air_of_a_case)

BOOST_AUTO_TEST_CASE(wind_is_read) {
  const model::WindDefinition wind = *read(blades + sections + R"(wind:
  speed: 12
  height: 90
  shear: {power: 0.2, left: 0.1, up: -0.05, length: 126}
  direction_deg: -30
  veer_deg: 0.1
  upflow_deg: 8
  density: 1.2
)")
                                          .wind;
  BOOST_TEST(wind.speed == 12.0);
  BOOST_TEST(wind.height == 90.0);
  BOOST_TEST((wind.profile == model::WindDefinition::Profile::power));
  BOOST_TEST(wind.exponent == 0.2);
  BOOST_TEST(wind.shear_left == 0.1);
  BOOST_TEST(wind.shear_up == -0.05);
  BOOST_TEST(wind.shear_length == 126.0);
  BOOST_TEST(wind.direction == -30.0 * degree, boost::test_tools::tolerance(round_off));
  BOOST_TEST(wind.veer == 0.1 * degree, boost::test_tools::tolerance(round_off));
  BOOST_TEST(wind.upflow == 8.0 * degree, boost::test_tools::tolerance(round_off));
  BOOST_TEST(wind.density == 1.2);
  const model::WindDefinition log =
      *read(blades + sections + "wind: {speed: 8, height: 90, shear: {log: 0.03}}\n").wind;
  BOOST_TEST((log.profile == model::WindDefinition::Profile::logarithmic));
  BOOST_TEST(log.roughness == 0.03);
  BOOST_TEST(log.density == 1.225);
}

BOOST_AUTO_TEST_CASE(models_are_read) {
  const model::AeroDefinition aero = *read(blades + sections + R"(wind: {speed: 8}
aero:
  induction: axial
  inflow: equilibrium
  tau1: 4
  closure: load
  thrust: buhl
  tip_loss: false
  hub_loss: false
  axial_drag: false
  tangential_drag: false
  skew: none
  airfoil_dynamics: static
  wake_constants: [0.3, 0.7, 0.14, 0.53]
  T_p: 1.5
  T_f: 6
  cut_out_deg: 30
)")
                                          .aero;
  BOOST_TEST((aero.induction == model::Induction::axial));
  BOOST_TEST((aero.inflow == model::Inflow::equilibrium));
  BOOST_TEST(aero.tau1.value() == 4.0);
  BOOST_TEST((aero.closure == model::MomentumLoad::actual));
  BOOST_TEST((aero.thrust == model::ThrustLaw::buhl));
  BOOST_TEST((!aero.tip_loss && !aero.hub_loss && !aero.axial_drag && !aero.tangential_drag));
  BOOST_TEST(aero.skew == 0.0);
  BOOST_TEST((aero.dynamics == model::AirfoilDynamics::static_polar));
  BOOST_TEST((aero.wake == model::WakeConstants{0.3, 0.7, 0.14, 0.53}));
  BOOST_TEST(aero.pressure_lag == 1.5);
  BOOST_TEST(aero.separation_lag == 6.0);
  BOOST_TEST(aero.cut_out == 30.0 * degree, boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(words_stand_for_the_default_models) {
  const std::string wind = blades + sections + "wind: {speed: 8}\n";
  const model::AeroDefinition defaults;
  BOOST_TEST((read(wind).aero == defaults));
  BOOST_TEST((read(wind + "aero: {}\n").aero == defaults));
  BOOST_TEST((read(wind + "aero: {tau1: auto, skew: pitt_peters, wake_constants: jones}\n").aero ==
              defaults));
}

BOOST_AUTO_TEST_CASE(air_acts_where_there_are_wind_and_sections) {
  BOOST_TEST(!read(blades).aero);
  BOOST_TEST(!read(blades + sections).aero);
  BOOST_TEST(!read(blades + "wind: {speed: 8}\n").aero);
  BOOST_TEST(!read(blades + sections + "wind: {speed: 8}\naero: none\n").aero);
  BOOST_TEST(read("wind: {speed: 8}\n" + blades + sections).aero.has_value());
}

BOOST_AUTO_TEST_CASE(wind_without_sections_is_noted) {
  const Case input = parse_case("case.yaml", blades + "wind: {speed: 8}\n", {});
  BOOST_TEST(input.notes == Strings{"case.yaml:9:1: wind: note: without effect, there are no "
                                    "blades.aero_sections"},
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(models_without_wind_are_kept_and_noted) {
  const Case input = parse_case("case.yaml", blades + sections + "aero: {tau1: 5}\n", {});
  BOOST_TEST(input.turbine.aero->tau1.value() == 5.0);
  BOOST_TEST(!model::build_turbine(input.turbine).air.has_value());
  BOOST_TEST(input.notes == Strings{"case.yaml:12:1: aero: note: without effect, there is no wind"},
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(the_tower_in_the_wind_is_read) {
  const std::string tower = R"(tower:
  length: 30
  sections:
    - {mass: 5, inertia: [1, 0.5, 0.5], stiffness: {EA: 1, GA2: 1, GA3: 1, GJ: 1, EI2: 1, EI3: 1}}
)";
  const model::TowerFlowDefinition flow = read(blades + sections + tower + R"(wind:
  speed: 8
  tower:
    sections: [[0, 6, 0.5], [30, 4, 0.7]]
    potential: plain
    wake: eames
    turbulence: 0.2
    drag_load: false
)")
                                              .wind->tower.value();
  BOOST_TEST(flow.heights == (std::vector{0.0, 30.0}), boost::test_tools::per_element());
  BOOST_TEST(flow.diameters == (std::vector{6.0, 4.0}), boost::test_tools::per_element());
  BOOST_TEST(flow.drags == (std::vector{0.5, 0.7}), boost::test_tools::per_element());
  BOOST_TEST((flow.potential == elements::TowerPotential::plain));
  BOOST_TEST((flow.wake == elements::TowerWake::eames));
  BOOST_TEST(flow.turbulence == 0.2);
  BOOST_TEST(!flow.drag_load);
  const std::string wind = "wind: {speed: 8, tower: {sections: ";
  check_error(blades + tower + wind + "[[0, 6, 0.5], [0, 4, 0.5]]}}\n",
              "13:26: wind.tower.sections: the heights do not rise (0, then 0)");
  check_error(blades + tower + wind + "[[0, 0, 0.5]]}}\n",
              "13:26: wind.tower.sections: expected diameters > 0, got 0");
  check_error(blades + wind + "[[0, 6, 0.5]]}}\n", "9:18: wind.tower: there is no tower");
}

BOOST_AUTO_TEST_CASE(sections_by_thickness_are_read) {
  const std::string airfoils = R"(  airfoils:
    thin: {thickness: 0.2, polars: [{table: [[-180, 0, 0.1, 0], [180, 0, 0.1, 0]]}]}
    thick: {thickness: 0.6, polars: [{table: [[-180, 0, 0.5, 0], [180, 0, 0.5, 0]]}]}
    other: {polars: [{table: [[-180, 0, 9, 0], [180, 0, 9, 0]]}]}
)";
  const auto with = [&](const std::string& list) {
    return blades + airfoils + "  aero_sections: " + list + "\nwind: {speed: 8}\n";
  };
  const model::TurbineDefinition turbine =
      read(with("[{at: 0, chord: 1, thickness: 0.6}, {at: 1, chord: 1, thickness: 0.4}]"));
  BOOST_TEST(turbine.blades.aero_sections[1].thickness.value() == 0.4);
  BOOST_TEST(turbine.blades.aero_sections[1].airfoil.empty());
  // Drag 0.5 at thickness 0.6, 0.1 at 0.2: linear in the thickness, which is linear in the span.
  const model::Turbine built = model::build_turbine(turbine);
  for (std::size_t p = 0; p < built.air->stations[0].size(); ++p) {
    const double thickness = 0.6 - 0.2 * built.blades[0].fractions[p];
    BOOST_TEST(built.air->stations[0][p].airfoil->drag_at(0.1) == 0.5 - 0.6 + thickness,
               boost::test_tools::tolerance(1e-12));
  }
  check_error(with("[{at: 0, chord: 1}]"),
              "13:19: blades.aero_sections[0]: missing key \"airfoil\" (a name of "
              "blades.airfoils, or a thickness)");
  check_error(with("[{at: 0, chord: 1, airfoil: thin}, {at: 1, chord: 1, thickness: 0.4}]"),
              "13:53: blades.aero_sections[1]: expected a thickness at all sections or at none");
  check_error(with("[{at: 0, chord: 1, thickness: 0.1}]"),
              "13:37: blades.aero_sections[0].thickness: expected 0.2 to 0.6, those of "
              "blades.airfoils, got 0.1");
  check_error(with("[{at: 0, chord: 1, airfoil: thin, thickness: 0.4}]"),
              "13:52: blades.aero_sections[0].thickness: given together with airfoil; leave one of "
              "them out");
}

BOOST_AUTO_TEST_CASE(airfoils_and_sections_are_read) {
  const model::BladesDefinition definition = read(blades + R"(  airfoils:
    FFA-W3-241:
      polars:
        - reynolds: 1e6
          table: [[-180, 0, 0.5, 0.1], [90, 0, 1, 0.2], [180, 0, 0.5, 0.1]]
        - {reynolds: 2e6, table: [[-180, 0, 0.4, 0], [180, 0, 0.4, 0]]}
      thickness: 0.241
      lift_slope: 6.2
  aero_sections:
    - {at: 0.2, chord: 3, airfoil: FFA-W3-241}
    - {at: 1, chord: 1, twist_deg: 10, airfoil: FFA-W3-241, center: [0.1, -0.2]}
)")
                                                 .blades;
  const model::AirfoilDefinition& airfoil = definition.airfoils.at("FFA-W3-241");
  BOOST_TEST(airfoil.file == "");
  BOOST_REQUIRE(airfoil.polars.size() == 2u);
  BOOST_TEST(airfoil.polars[0].reynolds == 1e6);
  BOOST_TEST(airfoil.polars[0].angles[1] == 90.0 * degree, boost::test_tools::tolerance(round_off));
  BOOST_TEST((airfoil.polars[0].lift == std::vector<double>{0.0, 0.0, 0.0}));
  BOOST_TEST((airfoil.polars[0].drag == std::vector<double>{0.5, 1.0, 0.5}));
  BOOST_TEST((airfoil.polars[0].moment == std::vector<double>{0.1, 0.2, 0.1}));
  BOOST_TEST(airfoil.thickness.value() == 0.241);
  BOOST_TEST(airfoil.lift_slope.value() == 6.2);
  BOOST_REQUIRE(definition.aero_sections.size() == 2u);
  BOOST_TEST(definition.aero_sections[0].at == 0.2);
  BOOST_TEST(definition.aero_sections[1].chord == 1.0);
  BOOST_TEST(definition.aero_sections[1].twist == 10.0 * degree,
             boost::test_tools::tolerance(round_off));
  BOOST_TEST((definition.aero_sections[1].center == std::array<double, 2>{0.1, -0.2}));
}

// ---- files -------------------------------------------------------------------------------------

const std::string columns = "-180 0 0.5 0\n-7.3 -0.2 0.01 0.1\n9.1 0.8 0.013 -0.1\n180 0 0.5 0\n";
const std::string with_file = blades + R"(  airfoils: {thin one: {file: polars/thin.dat}}
  aero_sections: [{chord: 1, airfoil: thin one}]
wind: {speed: 8}
)";

BOOST_AUTO_TEST_CASE(a_polar_file_is_found_from_the_folder_of_the_case) {
  const Folder folder;
  const std::string polars = folder.write("polars/thin.dat", columns);
  const Case input = read_case(folder.write("case.yaml", with_file), {});
  const model::AirfoilDefinition& airfoil = input.turbine.blades.airfoils.at("thin one");
  BOOST_TEST((airfoil.polars == read_polar_file(polars)));
  // The same polars in the case itself make the same model.
  const Case inside = parse_case(
      "case.yaml",
      blades +
          "  airfoils: {thin one: {polars: [{table: [[-180, 0, 0.5, 0], [-7.3, -0.2, 0.01, "
          "0.1], [9.1, 0.8, 0.013, -0.1], [180, 0, 0.5, 0]]}]}}\n" +
          "  aero_sections: [{chord: 1, airfoil: thin one}]\nwind: {speed: 8}\n",
      {});
  BOOST_TEST((inside.turbine == input.turbine));
  BOOST_TEST(inside.model_text == input.model_text);
  BOOST_TEST(input.model_text.find("blades.airfoils.thin one.polars[0].table[1]: "
                                   "-7.2999999999999998, -0.20000000000000001") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_result_has_the_polars_of_the_files) {
  const Folder folder;
  folder.write("polars/thin.dat", columns);
  const Case input = read_case(folder.write("case.yaml", with_file), {"blades.elements=3"});
  const std::string result = folder.path / "result.h5";
  {
    ResultFile file(result, input, {});
    file.publish();
  }
  fs::remove(folder.path / "polars/thin.dat");
  const Case again = read_result_case(result);
  BOOST_TEST((again.turbine == input.turbine));
  BOOST_TEST(again.model_text == input.model_text);
  BOOST_TEST(again.text == input.text);
  BOOST_CHECK_NO_THROW(require_same_model("a", again.model_text, input.model_text));
}

BOOST_AUTO_TEST_CASE(a_setting_replaces_polars_by_a_file) {
  const Folder folder;
  folder.write("polars/thin.dat", columns);
  const std::string file = folder.write("case.yaml", blades + sections);
  const Case input = read_case(file, {"blades.airfoils.circle.file=polars/thin.dat"});
  BOOST_TEST(input.turbine.blades.airfoils.at("circle").polars[0].angles.size() == 4u);
  const Case other =
      read_case(folder.write("other.yaml", with_file),
                {"blades.airfoils.thin one.polars=[{table: [[-180, 0, 1, 0], [180, 0, 1, 0]]}]"});
  BOOST_TEST(other.turbine.blades.airfoils.at("thin one").polars[0].angles.size() == 2u);
}

BOOST_AUTO_TEST_CASE(faults_of_polar_files_have_both_places) {
  const Folder folder;
  const std::string file = folder.write("case.yaml", with_file);
  const std::string polars = folder.path / "polars/thin.dat";
  const std::string start = file + ":9:25: blades.airfoils.thin one.";
  const auto error_of = [&file] {
    try {
      read_case(file, {});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  BOOST_TEST(error_of() == start + "file: " + polars + ": no such file");
  folder.write("polars/thin.dat", "-180 0 1\n180 x 1\n");
  BOOST_TEST(error_of() == start + "file: " + polars +
                               ":2: expected numbers: angle [deg], Cl, Cd, Cm; got \"x\"; hint: "
                               "comments start with #, ! or %");
  folder.write("polars/thin.dat", "-180 0 1\n170 0 1\n");
  BOOST_TEST(error_of().starts_with(start + "polars[0]: the angles do not span -180 to 180"));
}

BOOST_AUTO_TEST_CASE(polars_of_a_case_are_limited) {
  const Folder folder;
  std::string many;
  for (int i = 0; i < 5000; ++i) many += std::to_string(-180.0 + i * 360.0 / 4999.0) + " 0 1\n";
  folder.write("polars/thin.dat", many);
  std::string text = blades + "  airfoils:\n";
  for (int i = 0; i < 41; ++i) text += "    a" + std::to_string(i) + ": {file: polars/thin.dat}\n";
  const std::string file = folder.write("case.yaml", text);
  BOOST_CHECK_EXCEPTION(read_case(file, {}), InputError, [&](const InputError& error) {
    return error.what() == file +
                               ":50:11: blades.airfoils.a40.file: the polars of the case have more "
                               "than 200000 rows";
  });
}

// ---- faults ------------------------------------------------------------------------------------

BOOST_AUTO_TEST_CASE(air_needs_wind_and_sections) {
  check_error(blades + "wind: {speed: 8}\naero: {}\n",
              "10:1: aero: needs blades.aero_sections, the chords and airfoils of the blades");
  check_error(blades + sections + "wind: {height: 90}\n", "12:1: wind: missing key \"speed\"");
  check_error(blades + sections + "wind: {speed: 8}\naero: 5\n",
              "13:1: aero: expected none or models, got 5");
}

BOOST_AUTO_TEST_CASE(wind_needs_blades) {
  const std::string tower = R"(samara: 1
tower:
  length: 30
  sections:
    - mass: 5
      inertia: [1, 0.5, 0.5]
      stiffness: {EA: 1, GA2: 1, GA3: 1, GJ: 1, EI2: 1, EI3: 1}
)";
  check_errors(
      tower + "wind: {speed: 8, shear: {up: 1}}\naero: {}\n",
      {"case.yaml:8:1: wind: there are no blades", "case.yaml:9:1: aero: there are no blades"});
}

BOOST_AUTO_TEST_CASE(shear_and_veer_need_a_height) {
  const std::string hint =
      "expected a number > 0; hint: shear and veer count from the height at which the wind has its "
      "speed, e.g. that of the hub";
  for (const std::string keys : {"shear: {power: 0.2}", "shear: {log: 0.03}", "veer_deg: 0.1",
                                 "shear: {up: 0.1, length: 100}"})
    check_error(blades + "wind: {speed: 8, " + keys + "}\n", "9:1: wind.height: " + hint);
  BOOST_TEST(read(blades + "wind: {speed: 8, shear: {left: 0.1, length: 9}}\n").wind->shear_left ==
             0.1);
  check_error(
      blades + "wind: {speed: 8, height: 9, shear: {left: 0.1}}\n",
      "9:29: wind.shear.length: expected a number > 0; hint: left and up are changes of the "
      "speed by this length, e.g. the diameter of the rotor");
  check_error(blades + "wind: {speed: 8, height: 9, shear: {log: 9}}\n",
              "9:37: wind.shear.log: expected less than the height, 9 m; hint: a roughness length "
              "in metres, such as 0.03");
  check_error(blades + "wind: {speed: 8, height: 9, shear: {}}\n",
              "9:29: wind.shear: missing key \"power\" (or \"log\", \"left\", \"up\")");
  check_error(blades + "wind: {speed: 8, height: 9, shear: {power: 0.1, log: 0.1}}\n",
              "9:49: wind.shear.log: given together with power; leave one of them out");
}

BOOST_AUTO_TEST_CASE(values_of_wind_and_models_are_checked) {
  check_error(blades + "wind: {speed: -1}\n", "9:8: wind.speed: expected a number >= 0, got -1");
  check_error(blades + "wind: {speed: 1, density: 0}\n",
              "9:18: wind.density: expected a number > 0, got 0");
  const std::string aero = blades + sections + "wind: {speed: 8}\n";
  check_error(aero + "aero: {tau1: 0}\n", "13:8: aero.tau1: expected a number > 0 or auto, got 0");
  check_error(aero + "aero: {skew: glauert}\n",
              "13:8: aero.skew: expected a number >= 0, pitt_peters or none, got \"glauert\"");
  check_error(aero + "aero: {wake_constants: leishman}\n",
              "13:8: aero.wake_constants: expected a list of 4 numbers or jones, got \"leishman\"");
  check_error(aero + "aero: {wake_constants: [1, 0, 0, 1]}\n",
              "13:8: aero.wake_constants: expected decay rates b1, b2 > 0");
  check_error(
      aero + "aero: {thrust: glauert}\n",
      "13:8: aero.thrust: expected glauert_skew, buhl, buhl_f or madsen, got \"glauert\"; did you "
      "mean \"glauert_skew\"?");
  check_error(aero + "aero: {cut_out_deg: 4}\n",
              "13:8: aero.cut_out_deg: expected an angle from 5 to 180 degrees, got 4");
}

BOOST_AUTO_TEST_CASE(sections_are_checked) {
  const std::string airfoils =
      "  airfoils: {circle: {polars: [{table: [[-180, 0, 1, 0], [180, 0, 1, 0]]}]}}\n";
  const auto with = [&](const std::string& list) { return blades + airfoils + list + "\n"; };
  check_error(with("  aero_sections: [{chord: 1, airfoil: cricle}]"),
              "10:30: blades.aero_sections[0].airfoil: there is no airfoil \"cricle\" in "
              "blades.airfoils; did you mean \"circle\"?");
  check_error(with("  aero_sections: [{chord: 0, airfoil: circle}]"),
              "10:20: blades.aero_sections[0].chord: expected a number > 0, got 0");
  check_error(
      with("  aero_sections: [{chord: 1, airfoil: circle}, {chord: 1, airfoil: circle}]"),
      "10:19: blades.aero_sections[0]: missing key \"at\" (the fraction of the length, from "
      "0 to 1)\ncase.yaml:10:48: blades.aero_sections[1]: missing key \"at\" (the fraction "
      "of the length, from 0 to 1)");
  check_error(with("  aero_sections: [{at: 0.5, chord: 1, airfoil: circle}, {at: 0.5, chord: 1, "
                   "airfoil: circle}]"),
              "10:58: blades.aero_sections[1].at: expected more than the section before has, got "
              "0.5");
  check_error(with("  aero_sections: []"),
              "10:3: blades.aero_sections: expected a list of aerodynamic sections (each starts "
              "with \"- \"), got a list of 0");
  check_error(
      blades + "  aero_sections: [{chord: 1, airfoil: a}]\n",
      "9:30: blades.aero_sections[0].airfoil: there is no airfoil \"a\" in blades.airfoils");
}

BOOST_AUTO_TEST_CASE(airfoils_are_checked) {
  const auto with = [&](const std::string& list) { return blades + "  airfoils: " + list + "\n"; };
  const std::string table = "table: [[-180, 0, 1, 0], [180, 0, 1, 0]]";
  check_error(with("{a: {}}"), "9:14: blades.airfoils.a: missing key \"polars\" (or \"file\")");
  check_error(with("[a]"),
              "9:3: blades.airfoils: expected airfoils by their names, {NAME: {file: FILE}}, got a "
              "list of 1");
  check_error(with("{a: {file: [b]}}"),
              "9:18: blades.airfoils.a.file: expected the name of a file, got a list of 1");
  check_error(
      with("{a: {polars: []}}"),
      "9:18: blades.airfoils.a.polars: expected a list of polars (each starts with \"- \"), "
      "got a list of 0");
  check_error(with("{a: {polars: [{table: []}]}}"),
              "9:28: blades.airfoils.a.polars[0].table: expected a list of rows [angle, Cl, Cd, "
              "Cm], got a list of 0");
  check_error(
      with("{a: {polars: [{table: [[-180, 0, 1]]}]}}"),
      "9:36: blades.airfoils.a.polars[0].table[0]: expected a list of 4 numbers, got a list "
      "of 3");
  check_error(with("{a: {polars: [{table: [[180, 0, 1, 0], [-180, 0, 1, 0]]}]}}"),
              "9:27: blades.airfoils.a.polars[0]: the angles do not rise (180 degrees, then -180 "
              "degrees)");
  check_error(with("{a: {file: b, polars: [{" + table + "}]}}"),
              "9:18: blades.airfoils.a.file: given together with polars; leave one of them out");
  check_error(with("{a: {polars: [{" + table + "}]}, a: {polars: [{" + table + "}]}}"),
              "9:73: duplicate key \"a\" in blades.airfoils, first given in line 9");
  check_error(with("{a.b: {polars: [{" + table + "}]}}"),
              "9:3: blades.airfoils: expected a name of letters, digits, spaces, \"_\", \"-\" and "
              "\"+\", got \"a.b\"");
  check_error(with("{'': {polars: [{" + table + "}]}}"), "9:14: blades.airfoils: a name is empty");
  check_error(
      with("{a: {polars: [{reynolds: 1e6, " + table + "}, {reynolds: 1e6, " + table + "}]}}"),
      "9:87: blades.airfoils.a.polars[1].reynolds: the same as of another polar");
  check_error(
      with("{a: {polars: [{reynolds: 1e6, " + table + "}, {" + table + "}]}}"),
      "9:86: blades.airfoils.a.polars[1]: missing key \"reynolds\" (the Reynolds number, by "
      "which several polars are told apart)");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
}  // namespace samara::io
