// Wind and air of imported decks: AeroDyn, InflowWind, airfoils of windIO.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "samara/model/reference_line.hpp"

#include "import_test.hpp"

namespace {

using namespace samara;
using namespace samara::test;
using decks::Import;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double round_off = 1e-12;

bool is_near(double a, double b, double tolerance = round_off) {
  return std::abs(a - b) <= tolerance * std::max(1.0, std::abs(b));
}

Import import_main(const DeckFolder& folder, const std::string& main = "Main_air.fst") {
  return decks::import_openfast(folder / main, {});
}

model::TurbineDefinition read(const DeckFolder& folder, const std::string& main = "Main_air.fst") {
  return parse(import_main(folder, main)).turbine;
}

bool warns(const Import& import, const std::string& words) {
  return std::ranges::any_of(import.warnings,
                             [&](const std::string& warning) { return holds(warning, words); });
}

std::string fault_of(const DeckFolder& folder) {
  return message_of([&] { import_main(folder); });
}

/// The keys of AeroDyn as OpenFAST 3 spells them.
void make_old(const DeckFolder& folder, int wake) {
  std::istringstream text(folder.text("AeroDyn.dat"));
  std::string old;
  for (std::string line; std::getline(text, line);) {
    const auto drops = [&](const char* key) { return holds(line, std::string(" ") + key + " "); };
    if (drops("Wake_Mod")) line = std::to_string(wake) + "  WakeMod - wake";
    if (drops("Skew_Mod")) line = "2  SkewMod - skew";
    if (drops("SkewRedistrFactor")) line = "1.2  SkewModFactor - factor";
    if (drops("UA_Mod")) line = "2  AFAeroMod - airfoils\n4  UAMod - dynamics";
    if (!drops("BEM_Mod") && !drops("SkewMomCorr") && !drops("SkewRedistr_Mod") && !drops("AoA34"))
      old += line + "\n";
  }
  folder.write("AeroDyn.dat", old);
}

const std::string airfoils_of_windio = R"(
airfoils:
  - name: round/50
    aerodynamic_center: 0.5
    rthick: 0.5
    polars:
      - configuration: default
        re_sets:
          - re: 3.0e+6
            cl: {grid: [-180.0, 180.0], values: [0.0, 0.0]}
            cd: {grid: [-180.0, 180.0], values: [0.4, 0.4]}
            cm: {grid: [-180.0, 180.0], values: [0.0, 0.0]}
  - name: thin
    aerodynamic_center: 0.25
    rthick: 0.2
    polars:
      - configuration: other
        re_sets:
          - re: 3.0e+6
            cl: {grid: [-180.0, 180.0], values: [9.0, 9.0]}
            cd: {grid: [-180.0, 180.0], values: [9.0, 9.0]}
            cm: {grid: [-180.0, 180.0], values: [9.0, 9.0]}
      - configuration: default
        re_sets:
          - re: 3.0e+6
            cl: {grid: [-180.0, -10.0, 10.0, 180.0], values: [0.0, -0.6, 1.4, 0.0]}
            cd: {grid: [-180.0, 0.0, 180.0], values: [0.1, 0.0, 0.1]}
            cm: {grid: [-180.0, 180.0], values: [-0.1, -0.1]}
)";

/// The turbine of windIO 2.0 with airfoils; the thickness falls faster than the span grows.
void add_airfoils(const DeckFolder& folder) {
  folder.replace("second.yaml", "      chord: {grid: [0.0, 1.0], values: [1.5, 0.4]}\n",
                 R"(      chord: {grid: [0.0, 0.5, 1.0], values: [1.5, 1.6, 0.4]}
      section_offset_y: {grid: [0.0, 0.5, 1.0], values: [0.75, 0.6, 0.1]}
      rthick: {grid: [0.0, 0.5, 1.0], values: [0.5, 0.26, 0.2]}
      airfoils:
        - {name: round/50, spanwise_position: 0.0, configuration: [default], weight: [1.0]}
        - {name: thin, spanwise_position: 1.0, configuration: [default], weight: [1.0]}
)");
  folder.write("second.yaml", folder.text("second.yaml") + airfoils_of_windio);
}

Import import_second(const DeckFolder& folder) {
  return decks::import_windio(folder / "second.yaml", {.tower_only = true});
}

}  // namespace

BOOST_AUTO_TEST_SUITE(import_air_suite)

BOOST_AUTO_TEST_CASE(models_of_the_air_are_those_of_aerodyn) {
  const DeckFolder folder("three");
  const model::TurbineDefinition t = read(folder);
  BOOST_REQUIRE(t.aero.has_value());
  BOOST_TEST((t.aero->induction == model::Induction::full));
  BOOST_TEST((t.aero->inflow == model::Inflow::oye));
  BOOST_TEST(t.aero->tau1.value() == 2.5);
  BOOST_TEST((t.aero->thrust == model::ThrustLaw::glauert_skew));
  BOOST_TEST(t.aero->tip_loss);
  BOOST_TEST(!t.aero->hub_loss);
  BOOST_TEST(!t.aero->axial_drag);
  BOOST_TEST(t.aero->tangential_drag);
  BOOST_TEST(t.aero->skew == 1.2);
  BOOST_TEST((t.aero->dynamics == model::AirfoilDynamics::hgm));
  // Those of the airfoil at three quarters of the blade; OpenFAST's defaults for A2 and b2.
  BOOST_TEST((t.aero->wake == model::WakeConstants{0.25, 0.7, 0.2, 0.53}));
  BOOST_TEST(t.aero->pressure_lag == 1.9);
  BOOST_TEST(t.aero->separation_lag == 4.5);
  BOOST_TEST(is_near(t.aero->cut_out, 40.0 * degree));
}

BOOST_AUTO_TEST_CASE(each_switch_has_its_model) {
  const auto aero_with = [](const std::string& from, const std::string& to) {
    const DeckFolder folder("three");
    folder.replace("AeroDyn.dat", from, to);
    return read(folder).aero.value();
  };
  BOOST_TEST((aero_with("1             Wake_Mod", "0             Wake_Mod").induction ==
              model::Induction::none));
  BOOST_TEST((aero_with("True          TanInd", "False         TanInd").induction ==
              model::Induction::axial));
  BOOST_TEST((aero_with("2             BEM_Mod", "1             BEM_Mod").thrust ==
              model::ThrustLaw::buhl_f));
  BOOST_TEST((aero_with("1             DBEMT_Mod", "0             DBEMT_Mod").inflow ==
              model::Inflow::equilibrium));
  BOOST_TEST(!aero_with("1             DBEMT_Mod", "2             DBEMT_Mod").tau1.has_value());
  BOOST_TEST(aero_with("1             Skew_Mod", "0             Skew_Mod").skew == 0.0);
  BOOST_TEST(aero_with("default       SkewRedistr_Mod", "0       SkewRedistr_Mod").skew == 0.0);
  BOOST_TEST(aero_with("1.2           SkewRedistrFactor", "default  SkewRedistrFactor").skew ==
             15.0 * std::numbers::pi / 32.0);
  BOOST_TEST((aero_with("4             UA_Mod", "6             UA_Mod").dynamics ==
              model::AirfoilDynamics::oye));
  BOOST_TEST((aero_with("4             UA_Mod", "5             UA_Mod").dynamics ==
              model::AirfoilDynamics::hgm));
  BOOST_TEST((aero_with("4             UA_Mod", "0             UA_Mod").dynamics ==
              model::AirfoilDynamics::quasi_steady));
  BOOST_TEST((aero_with("True          AoA34           - Sample the angle of attack at the 3/4 "
                        "chord? (flag)\n4 ",
                        "False         AoA34           - x\n0 ")
                  .dynamics == model::AirfoilDynamics::static_polar));
}

BOOST_AUTO_TEST_CASE(names_of_openfast_3_give_the_same_models) {
  const DeckFolder folder("three");
  model::AeroDefinition expected = read(folder).aero.value();
  expected.thrust = model::ThrustLaw::buhl_f;  // there is no BEM_Mod
  make_old(folder, 2);
  BOOST_TEST((read(folder).aero.value() == expected));
  folder.replace("AeroDyn.dat", "2  AFAeroMod", "1  AFAeroMod");
  BOOST_TEST((read(folder).aero->dynamics == model::AirfoilDynamics::static_polar));
  folder.replace("AeroDyn.dat", "2  WakeMod", "1  WakeMod");
  BOOST_TEST((read(folder).aero->inflow == model::Inflow::equilibrium));
  folder.replace("AeroDyn.dat", "2  SkewMod", "1  SkewMod");
  BOOST_TEST(read(folder).aero->skew == 0.0);
}

BOOST_AUTO_TEST_CASE(what_a_case_cannot_have_is_said) {
  const DeckFolder folder("three");
  folder.replace("AeroDyn.dat", "1             Wake_Mod", "3             Wake_Mod");
  folder.replace("AeroDyn.dat", "4             UA_Mod", "3             UA_Mod");
  const Import import = import_main(folder);
  BOOST_TEST(warns(import, "OLAF"));
  BOOST_TEST(warns(import, "UA_Mod: note: 3"));
  BOOST_TEST(warns(import, "airfoils differ in A1"));
}

// The aerodynamic centre of AeroDyn is in axes of the root: x downwind, y to the trailing edge. The
// section's b2 points to the leading edge, turned toward feather (upwind) by the structural twist.
BOOST_AUTO_TEST_CASE(sections_are_in_the_axes_of_the_structure) {
  const DeckFolder folder("three");
  const model::BladesDefinition blades = read(folder).blades;
  BOOST_REQUIRE(blades.aero_sections.size() == 4u);
  const model::AeroSectionDefinition& s = blades.aero_sections[1];
  BOOST_TEST(is_near(s.at, 4.0 / 20.0));
  BOOST_TEST(s.chord == 1.8);
  BOOST_TEST(is_near(s.twist, 12.0 * degree));  // not relative to the structure's 11
  BOOST_TEST(s.airfoil == "thick 40");
  const double t = 11.0 * degree;
  BOOST_TEST(is_near(s.center[0], 0.3 * std::cos(t) - 0.1 * std::sin(t)));
  BOOST_TEST(is_near(s.center[1], 0.3 * std::sin(t) + 0.1 * std::cos(t)));
  // A section that leans by 4 degrees: tan of the twist across the straight beam.
  BOOST_TEST(is_near(std::tan(blades.aero_sections[2].twist),
                     std::tan(5.0 * degree) * std::cos(4.0 * degree)));
}

BOOST_AUTO_TEST_CASE(sections_of_a_curved_blade_are_where_aerodyn_has_them) {
  const DeckFolder folder("three");
  std::string main = folder.text("Main_curved.fst");
  main.replace(main.find("0             CompServo "), 0,
               "1  CompInflow - wind\n2  CompAero - air\n\"Inflow.dat\" InflowFile - wind\n"
               "\"AeroDyn.dat\" AeroFile - air\n");
  folder.write("Main_both.fst", main);
  const model::BladesDefinition blades = read(folder, "Main_both.fst").blades;
  const model::ReferenceLine line("blades", blades.beam);
  BOOST_REQUIRE(!blades.beam.reference_line.empty());
  BOOST_REQUIRE(blades.aero_sections.size() == 4u);
  // The spline of a case follows BeamDyn's line within 1e-7 of its 20 m.
  constexpr double distance = 2e-6;  // [m]
  constexpr double angle = 1e-7;
  for (const auto& [i, point, twist, lean] :
       {std::tuple<std::size_t, Vector3, double, double>{0, {0.0, 0.0, 0.0}, 13.0, 0.0},
        {1, {0.1, -0.3, 4.0}, 12.0, 0.0},
        {2, {-0.2, -0.05, 13.0}, 5.0, -4.0}}) {
    const model::AeroSectionDefinition& s = blades.aero_sections[i];
    const model::ReferenceLine::Station station =
        line.at(s.at, model::interpolate_section(blades.beam, s.at).twist);
    const Vector3 found = station.x + station.C_ab * Vector3(0.0, s.center[0], s.center[1]);
    BOOST_TEST((found - Vector3(point(2), -point(1), point(0))).norm() < distance);
    // AeroDyn turns about y by the lean, then about the new z by the twist toward feather. The
    // chord of the case is its projection onto the plane across the line.
    const double b = twist * degree;
    const double l = lean * degree;
    const Vector3 chord(std::sin(b) * std::sin(l), std::cos(b), -std::sin(b) * std::cos(l));
    const model::ReferenceLine::Station turned = line.at(s.at, s.twist);
    BOOST_TEST(std::abs(turned.C_ab.col(2).dot(chord)) < angle);
    BOOST_TEST(turned.C_ab.col(1).dot(chord) > 0.9);
  }
}

BOOST_AUTO_TEST_CASE(polars_are_in_the_case) {
  const DeckFolder folder("three");
  const Import import = import_main(folder);
  const model::BladesDefinition blades = parse(import).turbine.blades;
  BOOST_REQUIRE(blades.airfoils.contains("thin"));
  const model::AirfoilDefinition& thin = blades.airfoils.at("thin");
  // AFTabMod 1: the first table of the file, though the second has the lower Reynolds number.
  BOOST_REQUIRE(thin.polars.size() == 1u);
  BOOST_TEST(thin.polars[0].reynolds == 2e6);
  BOOST_TEST(thin.polars[0].lift[4] == 0.4);
  BOOST_TEST(thin.polars[0].moment[4] == -0.05);
  BOOST_TEST(is_near(thin.polars[0].angles[3], -10.0 * degree));
  BOOST_TEST(!holds(import.text, "file:"));
  folder.replace("AeroDyn.dat", "1             AFTabMod", "2             AFTabMod");
  BOOST_TEST(read(folder).blades.airfoils.at("thin").polars.size() == 2u);
  folder.replace("AeroDyn.dat", "True          UseBlCm", "False         UseBlCm");
  BOOST_TEST(read(folder).blades.airfoils.at("thin").polars[0].moment[4] == 0.0);
}

BOOST_AUTO_TEST_CASE(steady_wind_is_taken) {
  const DeckFolder folder("three");
  const model::WindDefinition wind = read(folder).wind.value();
  BOOST_TEST(wind.speed == 11.5);
  BOOST_TEST(wind.height == 42.0);  // above the tower's foot, which is at 1 m
  BOOST_TEST((wind.profile == model::WindDefinition::Profile::power));
  BOOST_TEST(wind.exponent == 0.15);
  BOOST_TEST(is_near(wind.direction, -8.0 * degree));  // OpenFAST counts clockwise
  BOOST_TEST(is_near(wind.upflow, 3.0 * degree));
  BOOST_TEST(wind.density == 1.2);
  folder.replace("AeroDyn.dat", "\"default\"     AirDens", "1.1           AirDens");
  BOOST_TEST(read(folder).wind->density == 1.1);
  // A locked nacelle that has turned by 5 degrees counter-clockwise sees the wind turned back.
  folder.replace("ElastoDyn.dat", "0   NacYaw", "5   NacYaw");
  BOOST_TEST(is_near(read(folder).wind->direction, -13.0 * degree));
}

BOOST_AUTO_TEST_CASE(uniform_wind_is_that_at_the_start) {
  const DeckFolder folder("three");
  folder.replace("Inflow.dat", "1             WindType", "2             WindType");
  const Import import = import_main(folder);
  const model::WindDefinition wind = parse(import).turbine.wind.value();
  BOOST_TEST(warns(import, "changes with time"));
  BOOST_TEST(is_near(wind.speed, 9.0));  // half way from 8 to 10
  BOOST_TEST(wind.height == 40.0);
  BOOST_TEST(is_near(wind.direction, -(8.0 + 15.0) * degree));
  BOOST_TEST(wind.exponent == 0.2);
  BOOST_TEST(wind.shear_left == 0.1);
  BOOST_TEST(wind.shear_up == 0.05);
  BOOST_TEST(wind.shear_length == 40.0);
  folder.write("uniform.wnd", "! constant\n 0 7 0 0 0 0 0 0\n 99 7 0 0 0 0 0 0\n");
  const Import steady = import_main(folder);
  BOOST_TEST(!warns(steady, "changes with time"));
  BOOST_TEST(parse(steady).turbine.wind->speed == 7.0);
  folder.write("uniform.wnd", " 0 7 0 0 0\n");
  const std::string fault = fault_of(folder);
  BOOST_TEST(holds(fault, "uniform.wnd:1: expected 8 or 9 columns"));
  BOOST_TEST(holds(fault, "got 5"));
}

BOOST_AUTO_TEST_CASE(names_of_older_inflow_files_are_read_by_their_section) {
  const DeckFolder folder("three");
  folder.replace("Inflow.dat", "FileName_Uni", "Filename    ");
  folder.replace("Inflow.dat", "RefHt_Uni", "RefHt    ");
  folder.replace("Inflow.dat", "FileName_BTS", "Filename    ");
  BOOST_TEST(read(folder).wind->height == 42.0);
  folder.replace("Inflow.dat", "1             WindType", "2             WindType");
  BOOST_TEST(read(folder).wind->height == 40.0);
}

BOOST_AUTO_TEST_CASE(the_tower_in_the_wind_is_imported) {
  const auto with = [](const std::string& wake, const std::string& rows) {
    const DeckFolder folder("three");
    folder.replace("AeroDyn.dat", "1             TwrShadow", wake + "             TwrShadow");
    folder.replace("AeroDyn.dat", "3             NumTwrNds", rows);
    return import_main(folder);
  };
  const Import import = with("2", "3             NumTwrNds");
  const model::TowerFlowDefinition flow = parse(import).turbine.wind->tower.value();
  BOOST_TEST((flow.potential == elements::TowerPotential::none));
  BOOST_TEST((flow.wake == elements::TowerWake::eames));
  BOOST_TEST(!flow.drag_load);
  // The foot of the tower is 1 m above the ground.
  BOOST_TEST(flow.heights == (std::vector{-1.0, 19.0, 39.0}), boost::test_tools::per_element());
  BOOST_TEST(flow.diameters == (std::vector{3.0, 2.5, 2.0}), boost::test_tools::per_element());
  BOOST_TEST(flow.drags == (std::vector{0.5, 0.6, 0.7}), boost::test_tools::per_element());
  BOOST_TEST(is_near(flow.turbulence, 0.2));
  BOOST_TEST(!parse(with("0", "3             NumTwrNds")).turbine.wind->tower.has_value());
}

BOOST_AUTO_TEST_CASE(without_a_steady_wind_the_case_has_models_without_air) {
  const DeckFolder folder("three");
  folder.replace("Inflow.dat", "1             WindType", "3             WindType");
  const Import import = import_main(folder);
  const model::TurbineDefinition t = parse(import).turbine;
  BOOST_TEST(!t.wind.has_value());
  BOOST_TEST(t.aero.value().tau1.value() == 2.5);
  BOOST_TEST(t.blades.aero_sections.size() == 4u);
  BOOST_TEST(warns(import, "turbulence is not read"));
  BOOST_TEST(warns(import, "the flow around the tower, which needs a steady wind"));
  BOOST_TEST(holds(import.text, "density: 1.2}"));
}

BOOST_AUTO_TEST_CASE(a_file_of_turbsim_gives_its_mean_wind) {
  // Two instants of three rows at 20, 40 and 60 m, with the means 20 (z/40)^0.5, and two columns.
  std::string bytes;
  const auto add = [&bytes]<class T>(T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  add(std::int16_t{7});
  for (const int number : {3, 2, 0, 2}) add(std::int32_t{number});
  // Distances up and across, time step, speed, height of the hub, of the lowest row.
  for (const float number : {20.0F, 30.0F, 0.5F, 20.0F, 40.0F, 20.0F}) add(number);
  for (int c = 0; c < 3; ++c)
    for (const float number : {1000.0F, 0.0F}) add(number);
  add(std::int32_t{0});
  for (const double gust : {-0.5, 0.5})
    for (const double height : {20.0, 40.0, 60.0})
      for (const double side : {-0.2, 0.2})
        for (const double speed : {20.0 * std::sqrt(height / 40.0) + gust + side, 0.0, 0.0})
          add(static_cast<std::int16_t>(std::lround(1000.0 * speed)));
  const DeckFolder folder("three");
  folder.replace("Inflow.dat", "1             WindType", "3             WindType");
  folder.write("turbulence.bts", bytes);
  const Import import = import_main(folder);
  const model::WindDefinition wind = parse(import).turbine.wind.value();
  BOOST_TEST(std::abs(wind.speed - 20.0) < 1e-3);
  BOOST_TEST((wind.profile == model::WindDefinition::Profile::power));
  BOOST_TEST(std::abs(wind.exponent - 0.5) < 1e-4);
  BOOST_TEST(warns(import, "transient.wind: {box: {file: ...}}"));
}

BOOST_AUTO_TEST_CASE(decks_without_air_stay_structures) {
  const DeckFolder folder("three");
  const std::string expected = import_main(folder, "Main.fst").text;
  folder.replace("Main_air.fst", "2             CompAero", "0             CompAero");
  const Import off = import_main(folder);
  BOOST_TEST(warns(off, "CompAero: note: 0"));
  BOOST_TEST(off.text.substr(off.text.find("samara:")) ==
             expected.substr(expected.find("samara:")));
  folder.replace("Main_air.fst", "0             CompAero", "2             CompAero");
  folder.replace("Main_air.fst", "1             CompInflow", "0             CompInflow");
  const Import still = import_main(folder);
  BOOST_TEST(warns(still, "CompInflow: note"));
  BOOST_TEST(!parse(still).turbine.wind.has_value());
  folder.replace("Main_air.fst", "\"AeroDyn.dat\" ", "\"missing.dat\" ");
  const Import missing = import_main(folder);
  BOOST_TEST(warns(missing, "AeroFile: warning: there is no such file"));
  BOOST_TEST(parse(missing).turbine.blades.aero_sections.empty());
}

BOOST_AUTO_TEST_CASE(faults_of_aerodynamic_files_have_their_place) {
  const auto fault_with = [](const char* file, const std::string& from, const std::string& to) {
    const DeckFolder folder("three");
    folder.replace(file, from, to);
    return fault_of(folder);
  };
  const std::string missing = fault_with("AeroDyn.dat", "\"thin.dat\"", "\"Thin.dat\"");
  BOOST_TEST(holds(missing, "AeroDyn.dat:47: AFNames: no such file"));
  BOOST_TEST(holds(missing, "upper and lower case"));
  BOOST_TEST(holds(fault_with("AeroDyn_blade.dat", "1.1       2     0.0    0.0      0.0",
                              "1.1       2     0.0    0.0"),
                   "AeroDyn_blade.dat:11: expected 10 numbers in this row of the table, got 9"));
  BOOST_TEST(holds(fault_with("AeroDyn_blade.dat", "1.1       2 ", "1.1       3 "),
                   "AeroDyn_blade.dat:11: BlAFID: expected an integer from 1 to 2"));
  BOOST_TEST(holds(fault_with("AeroDyn_blade.dat", "1.1       2 ", "0.0       2 "),
                   "AeroDyn_blade.dat:11: BlChord: expected a number > 0, got 0; hint:"));
  BOOST_TEST(holds(fault_with("AeroDyn_blade.dat", " 13.0    -0.2", " 3.0    -0.2"),
                   "AeroDyn_blade.dat:11: BlSpn: expected more"));
  BOOST_TEST(holds(fault_with("thin.dat", "9             NumAlf", "8             NumAlf"),
                   "thin.dat:30: one more row of the table; hint: NumAlf"));
  BOOST_TEST(
      holds(fault_with("thin.dat", "   -180.0   0.0000", "   -170.0   0.0000"), "thin.dat: "));
  BOOST_TEST(holds(fault_with("AeroDyn.dat", "4             InCol_Cm", "5             InCol_Cm"),
                   "AeroDyn.dat:43: InCol_Cm: expected 4"));
  BOOST_TEST(holds(fault_with("AeroDyn.dat", "2.5           tau1_const", "0  tau1_const"),
                   "tau1_const: expected a number > 0"));
  const DeckFolder folder("three");
  folder.write("other.dat", folder.text("AeroDyn_blade.dat"));
  folder.replace("AeroDyn.dat", "\"AeroDyn_blade.dat\"  ADBlFile(3)", "\"other.dat\"  ADBlFile(3)");
  BOOST_TEST(read(folder).blades.aero_sections.size() == 4u);
  folder.replace("other.dat", " 12.0      1.8", " 12.5      1.8");
  BOOST_TEST(holds(fault_of(folder), "AeroDyn.dat:52: ADBlFile(3): differs from blade 1"));
}

// Without one of its lines a file of the air is refused or gives the same case.
BOOST_AUTO_TEST_CASE(a_line_too_few_gives_no_wrong_number) {
  const DeckFolder folder("three");
  const std::string expected = import_main(folder).text;
  for (const std::string file : {"AeroDyn.dat", "AeroDyn_blade.dat", "Inflow.dat", "thin.dat"}) {
    const std::string text = folder.text(file);
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    for (std::size_t i = 2; i < lines.size(); ++i) {
      std::string mangled;
      for (std::size_t k = 0; k < lines.size(); ++k)
        if (k != i) mangled += lines[k] + "\n";
      folder.write(file, mangled);
      // Constants of the airfoil dynamics and SkewRedistrFactor have defaults in OpenFAST.
      const bool has_default =
          std::ranges::any_of(std::array{"T_f0", "T_p ", "b1 ", "A1 ", "UACutout", "Factor"},
                              [&](const char* key) { return holds(lines[i], key); });
      // The Reynolds number may be missing.
      if (has_default || holds(lines[i], " Re ") || holds(lines[i], "NumTabs")) continue;
      try {
        BOOST_TEST(import_main(folder).text == expected, file + ": " + lines[i]);
      } catch (const InputError& error) {
        BOOST_TEST(holds(error.what(), folder.path.string()));
      }
    }
    folder.write(file, text);
  }
}

BOOST_AUTO_TEST_CASE(windio_gives_sections_and_airfoils_between_those_of_the_deck) {
  const DeckFolder folder("windio");
  add_airfoils(folder);
  const Import import = import_second(folder);
  const model::TurbineDefinition t = parse(import).turbine;
  BOOST_TEST(!t.wind.has_value());
  BOOST_TEST(warns(import, "the deck has no wind"));
  BOOST_REQUIRE(t.blades.aero_sections.size() == 5u);  // 0, 0.3, 0.5, 0.7, 1
  const model::AeroSectionDefinition& first = t.blades.aero_sections[0];
  BOOST_TEST(first.thickness.value() == 0.5);
  BOOST_TEST(first.airfoil.empty());
  BOOST_TEST(is_near(first.twist, 12.5 * degree));
  BOOST_TEST(first.center[0] == 0.0);  // 0.75 - 0.5 x 1.5
  // Half way the blade has 26 % thickness: four fifths of the way from 50 to 20.
  const model::AeroSectionDefinition& middle = t.blades.aero_sections[2];
  BOOST_TEST(middle.at == 0.5);
  BOOST_TEST(middle.chord == 1.6);
  BOOST_TEST(is_near(middle.thickness.value(), 0.26));
  BOOST_TEST(is_near(middle.center[0], 0.6 - (0.2 * 0.5 + 0.8 * 0.25) * 1.6));
  BOOST_TEST(middle.center[1] == 0.0);
  BOOST_TEST(t.blades.airfoils.size() == 2u);
  BOOST_TEST(is_near(t.blades.aero_sections[4].thickness.value(), 0.2));
  // With a wind it is a case with air.
  std::string text = import.text + "\nwind: {speed: 8}\n";
  BOOST_TEST(io::parse_case("case.yaml", text, {}).turbine.aero.has_value());
}

BOOST_AUTO_TEST_CASE(windio_without_thickness_is_linear_in_the_span) {
  const DeckFolder folder("windio");
  add_airfoils(folder);
  folder.replace("second.yaml", "      rthick: {grid: [0.0, 0.5, 1.0], values: [0.5, 0.26, 0.2]}\n",
                 "");
  const model::TurbineDefinition t = parse(import_second(folder)).turbine;
  const std::string& name = t.blades.aero_sections.at(2).airfoil;
  BOOST_TEST(name == "round_50 to thin 500");
  BOOST_TEST(!t.blades.aero_sections.at(2).thickness.has_value());
  const model::PolarDefinition& polar = t.blades.airfoils.at(name).polars.at(0);
  BOOST_TEST(polar.reynolds == 3e6);
  BOOST_REQUIRE(polar.angles.size() == 5u);  // -180, -10, 0, 10, 180
  BOOST_TEST(is_near(polar.lift[3], 0.5 * 1.4));
  BOOST_TEST(is_near(polar.lift[2], 0.5 * 0.4));
  BOOST_TEST(is_near(polar.drag[2], 0.5 * 0.4));
  BOOST_TEST(is_near(polar.moment[1], -0.05));
}

BOOST_AUTO_TEST_CASE(both_versions_of_windio_give_the_same_air) {
  const DeckFolder folder("windio");
  const std::string outer = R"(      pitch_axis: {grid: [0.0, 1.0], values: [0.5, 0.25]}
      airfoil_position: {grid: [0.0, 1.0], labels: [thin, thin]}
)";
  const std::string airfoils = R"(
airfoils:
  - name: thin
    aerodynamic_center: 0.25
    relative_thickness: 0.2
    polars:
      - configuration: default
        re: 3.0e+6
        c_l: {grid: [-3.141592653589793, 0.5, 3.141592653589793], values: [0.0, 1.0, 0.0]}
        c_d: {grid: [-3.141592653589793, 3.141592653589793], values: [0.1, 0.1]}
        c_m: {grid: [-3.141592653589793, 3.141592653589793], values: [0.0, 0.0]}
)";
  folder.replace("first.yaml", "      chord: {grid: [0.0, 1.0], values: [1.5, 0.4]}\n",
                 "      chord: {grid: [0.0, 1.0], values: [1.5, 0.4]}\n" + outer);
  folder.write("first.yaml", folder.text("first.yaml") + airfoils);
  const model::TurbineDefinition t =
      parse(decks::import_windio(folder / "first.yaml", {.tower_only = true})).turbine;
  BOOST_REQUIRE(t.blades.aero_sections.size() == 4u);
  BOOST_TEST(is_near(t.blades.aero_sections[0].center[0], 0.25 * 1.5));
  BOOST_TEST(is_near(t.blades.aero_sections[1].twist, 10.0 * degree));
  BOOST_TEST(is_near(t.blades.airfoils.at("thin").polars.at(0).angles.at(1), 0.5));
}

BOOST_AUTO_TEST_CASE(faults_of_windio_airfoils_have_their_place) {
  const auto fault_with = [](const std::string& from, const std::string& to) {
    const DeckFolder folder("windio");
    add_airfoils(folder);
    folder.replace("second.yaml", from, to);
    return message_of([&] { import_second(folder); });
  };
  BOOST_TEST(holds(fault_with("{name: thin, spanwise", "{name: thing, spanwise"),
                   "there is no airfoil \"thing\" in airfoils"));
  BOOST_TEST(holds(fault_with("values: [1.5, 1.6, 0.4]", "values: [1.5, 1.6, 0.0]"),
                   "outer_shape.chord: expected numbers > 0, got 0"));
  BOOST_TEST(holds(fault_with("values: [0.0, -0.6, 1.4, 0.0]", "values: [0.0, -0.6, 1.4]"),
                   "airfoils.thin.polars.cl: grid has 4 angles, values 3"));
  BOOST_TEST(
      holds(fault_with("cl: {grid: [-180.0, -10.0,", "cl: {grid: [-18.0, -10.0,"),
            "airfoils.thin.polars.cl.grid: expected rising angles from -180 to 180 degrees"));
}

BOOST_AUTO_TEST_CASE(drag_of_the_nacelle_in_its_axes) {
  const DeckFolder folder("three");
  folder.replace("AeroDyn.dat", "False         NacelleDrag ", "True          NacelleDrag ");
  const std::string keys =
      "3, 4, 5   NacArea - areas\n0.7, 0.8, 0.9   NacCd - drag\n1, 2, 3   NacDragAC - centre\n";
  folder.replace("AeroDyn.dat", "======  Unsteady", keys + "======  Unsteady");
  const std::optional<model::WindDefinition> wind = parse(import_main(folder)).turbine.wind;
  BOOST_REQUIRE((wind && wind->nacelle));
  BOOST_TEST((wind->nacelle->areas == std::array{4.0, 3.0, 5.0}));
  BOOST_TEST((wind->nacelle->drags == std::array{0.8, 0.7, 0.9}));
  BOOST_TEST((wind->nacelle->center == std::array{-2.0, 1.0, 3.0}));
}

BOOST_AUTO_TEST_SUITE_END()
