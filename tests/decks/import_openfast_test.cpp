#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>
#include <tuple>

#include "samara/model/reference_line.hpp"

#include "import_test.hpp"

namespace {

using namespace samara;
using namespace samara::test;
using decks::Import;
using decks::import_openfast;
using decks::ImportLine;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double round_off = 1e-13;

Import import_main(const DeckFolder& folder, const std::string& main = "Main.fst") {
  return import_openfast(folder / main, {});
}

bool is_near(double a, double b) {
  return std::abs(a - b) <= round_off * std::max(1.0, std::abs(b));
}

const ImportLine* find_line(const Import& import, const std::string& key) {
  const auto found = std::find_if(import.report.begin(), import.report.end(),
                                  [&](const ImportLine& line) { return line.key == key; });
  return found == import.report.end() ? nullptr : &*found;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string join(const std::vector<std::string>& lines, const std::string& end = "\n") {
  std::string text;
  for (const std::string& line : lines) text += line + end;
  return text;
}

const std::vector<double> tower_at = {0.0, 0.35, 0.7, 1.0};
const std::vector<double> blade_at = {0.0, 0.2, 0.65, 1.0};

std::vector<double> times(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(import_openfast_suite)

BOOST_AUTO_TEST_CASE(geometry_keeps_the_signs_of_the_case_file) {
  const DeckFolder folder("three");
  const model::TurbineDefinition t = parse(import_main(folder)).turbine;
  BOOST_TEST(t.gravity == 9.81);
  BOOST_TEST(is_near(t.shaft.speed, 18.5 * 2.0 * std::numbers::pi / 60.0));
  BOOST_TEST(t.shaft.overhang == -3.2);
  BOOST_TEST(is_near(t.shaft.tilt, -4.0 * degree));
  BOOST_TEST(t.shaft.height == 1.1);
  BOOST_TEST(is_near(t.shaft.azimuth, 20.0 * degree));  // 30 - AzimB1Up
  BOOST_TEST(t.hub.radius == 1.5);
  BOOST_TEST(t.blades.count == 3);
  BOOST_TEST(is_near(t.blades.precone, -2.5 * degree));
  BOOST_TEST(is_near(t.blades.pitch, 1.5 * degree));
  BOOST_TEST(t.blades.each.empty());
  BOOST_TEST(t.blades.beam.length == 20.0);
  BOOST_TEST(t.tower.length == 40.0);
  BOOST_TEST(is_near(t.blades.beam.sections[1].twist, 11.0 * degree));
  BOOST_TEST(is_near(t.blades.beam.sections[3].twist, -0.5 * degree));
}

BOOST_AUTO_TEST_CASE(bodies_keep_their_masses_and_moments) {
  const DeckFolder folder("three");
  const model::TurbineDefinition t = parse(import_main(folder)).turbine;
  BOOST_TEST(t.nacelle.mass == 9000.0);
  // y of OpenFAST is to the left for one who looks downwind, y1 to the right.
  BOOST_TEST(t.nacelle.center_of_mass == Vector3(-0.2, 0.6, 0.75));
  BOOST_TEST(is_near(t.nacelle.inertia(2) + 9000.0 * (0.6 * 0.6 + 0.2 * 0.2), 18500.0));
  BOOST_TEST(t.nacelle.inertia(0) == 0.0);
  BOOST_TEST(t.tower.tip_mass == 450.0);
  BOOST_TEST(t.shaft.generator.inertia == 14.25);
  BOOST_TEST(t.shaft.gear_ratio == 22.0);
  BOOST_TEST(t.hub.mass == 2500.0);
  BOOST_TEST(t.hub.center_of_mass == 0.15);
  BOOST_TEST(t.hub.inertia == Vector3(0.0, 1900.0, 0.0));
  BOOST_TEST(t.blades.beam.tip_mass == 12.0);
}

BOOST_AUTO_TEST_CASE(masses_of_beams_survive) {
  const DeckFolder folder("three");
  const model::TurbineDefinition t = parse(import_main(folder)).turbine;
  require_same(integrate(t.tower, 0, 0),
               integrate(tower_at, times({1250.0, 1040.0, 830.0, 710.0}, 1.02), 40.0));
  require_same(integrate(t.blades.beam, 0, 0),
               integrate(blade_at, times({180.0, 120.0, 70.0, 14.0}, 1.04), 20.0));
}

BOOST_AUTO_TEST_CASE(factors_and_tuners_are_applied) {
  const DeckFolder folder("three");
  const model::TurbineDefinition t = parse(import_main(folder)).turbine;
  const model::SectionDefinition& blade = t.blades.beam.sections[1];
  BOOST_TEST(is_near(blade.stiffness(4, 4), 2.3e8 * 1.01 * 0.95));
  BOOST_TEST(is_near(blade.stiffness(5, 5), 5.1e8 * 1.07));
  const model::SectionDefinition& tower = t.tower.sections[2];
  BOOST_TEST(is_near(tower.stiffness(4, 4), 1.1e10 * 0.98 * 1.1));
  BOOST_TEST(is_near(tower.stiffness(5, 5), 1.2e10 * 1.03));
}

BOOST_AUTO_TEST_CASE(what_elastodyn_lacks_is_rigid) {
  const DeckFolder folder("three");
  const model::TurbineDefinition t = parse(import_main(folder)).turbine;
  const std::array<bool, 6> bending_only = {true, true, true, true, false, false};
  BOOST_TEST(t.tower.sections[0].rigid == bending_only);
  BOOST_TEST(t.blades.beam.sections[3].rigid == bending_only);
}

/// The blade of the deck without twist, of constant section, with the shapes x^2 and x^3: stiffness
/// 4 EI/L^3 and 12 EI/L^3, mass m L/5 and m L/7.
void make_uniform(const DeckFolder& folder) {
  std::vector<std::string> lines = lines_of(folder.text("Blade.dat"));
  for (std::string& line : lines) {
    for (const char* at : {"0.0000000E+00", "2.0000000E-01", "6.5000000E-01", "1.0000000E+00"})
      if (line.starts_with(at)) line = std::string(at) + " 0 100 2e8 5e8";
    const std::size_t shape = line.find("Sh(");
    if (shape == std::string::npos) continue;
    const char* only = line.find("Fl2") == std::string::npos ? "Sh(2)" : "Sh(3)";
    line = (line.substr(shape, 5) == only ? "1 " : "0 ") + line.substr(shape - 6);
  }
  folder.write("Blade.dat", join(lines));
}

/// Frequency of the shape x^2 (20) or x^3 (84).
double uniform_frequency(double factor, double stiffness) {
  return std::sqrt(factor * stiffness / (104.0 * std::pow(20.0, 4)));
}

BOOST_AUTO_TEST_CASE(both_ratios_of_a_direction_are_met) {
  const DeckFolder folder("three");
  make_uniform(folder);
  constexpr double quadrature = 1e-5;
  const double flap = 2e8 * 1.01 * 0.95;
  const double first = uniform_frequency(20.0, flap);
  const double second = uniform_frequency(84.0, flap);
  for (const double ratio : {0.5, 0.6, 1.0}) {
    std::vector<std::string> lines = lines_of(folder.text("Blade.dat"));
    for (std::string& line : lines)
      if (line.find("BldFlDmp(2)") != std::string::npos)
        line = std::to_string(ratio) + " BldFlDmp(2) - percent";
    folder.write("Blade.dat", join(lines));
    const Import import = import_main(folder);
    const model::BeamDefinition blade = parse(import).turbine.blades.beam;
    const double mu = blade.damping(4);
    const double alpha = blade.mass_damping(2);
    BOOST_TEST(std::abs(0.5 * (mu * first + alpha / first) / 0.005 - 1.0) < quadrature);
    BOOST_TEST(std::abs(0.5 * (mu * second + alpha / second) / (0.01 * ratio) - 1.0) < quadrature);
    BOOST_TEST(std::none_of(import.warnings.begin(), import.warnings.end(),
                            [](const auto& words) { return holds(words, "is not met"); }));
    const double edge = uniform_frequency(20.0, 5e8 * 1.07);
    BOOST_TEST(std::abs(0.5 * blade.damping(5) * edge / 0.007 - 1.0) < quadrature);
    BOOST_TEST(blade.mass_damping(1) == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(ratios_that_ask_for_a_negative_constant_get_the_nearest) {
  const DeckFolder folder("three");
  make_uniform(folder);
  const double flap = 2e8 * 1.01 * 0.95;
  const double a = uniform_frequency(20.0, flap);
  const double b = uniform_frequency(84.0, flap);
  for (const double ratio : {0.05, 0.00005}) {  // far above and far below the first's 0.5 %
    std::vector<std::string> lines = lines_of(folder.text("Blade.dat"));
    for (std::string& line : lines)
      if (line.find("BldFlDmp(2)") != std::string::npos)
        line = std::to_string(100.0 * ratio) + " BldFlDmp(2) - percent";
    folder.write("Blade.dat", join(lines));
    const Import import = import_main(folder);
    const model::BeamDefinition blade = parse(import).turbine.blades.beam;
    const double mu = blade.damping(4);
    const double alpha = blade.mass_damping(2);
    BOOST_TEST((ratio > 0.005 ? alpha == 0.0 && mu > 0.0 : mu == 0.0 && alpha > 0.0));
    const auto misfit = [&](double m, double n) {
      return std::hypot(0.5 * (m * a + n / a) - 0.005, 0.5 * (m * b + n / b) - ratio);
    };
    for (const double factor : {0.999, 1.001})
      BOOST_TEST(misfit(mu, alpha) < misfit(factor * mu, factor * alpha));
    BOOST_TEST(std::count_if(import.warnings.begin(), import.warnings.end(), [](const auto& words) {
                 return holds(words, "is not met, the mode gets");
               }) >= 2);
  }
}

BOOST_AUTO_TEST_CASE(a_second_tuner_is_reported) {
  const DeckFolder folder("three");
  const Import import = import_main(folder);
  BOOST_TEST((find_line(import, "FAStTunr(2)")->fate == decks::Fate::ignored));
  BOOST_TEST((find_line(import, "FlStTunr(2)")->fate == decks::Fate::derived));
}

BOOST_AUTO_TEST_CASE(freedoms_without_their_driver_are_locked_and_said) {
  const DeckFolder folder("three");
  folder.replace("ElastoDyn.dat", "False         YawDOF", "True          YawDOF");
  folder.replace("Main.fst", "0             CompServo", "1             CompServo");
  const Import import = import_main(folder);
  BOOST_TEST((parse(import).turbine.nacelle.yaw.kind == model::JointKind::locked));
  BOOST_TEST(holds(find_line(import, "GenDOF")->words, "locked"));
  BOOST_TEST(holds(find_line(import, "YawDOF")->words, "ServoDyn cannot be read"));
  BOOST_TEST(std::any_of(import.warnings.begin(), import.warnings.end(), [](const auto& words) {
    return holds(words, "ServoFile: warning") && holds(words, "yaw is locked");
  }));
}

BOOST_AUTO_TEST_CASE(a_free_yaw_has_the_spring_and_damper_of_servodyn) {
  const DeckFolder folder("three");
  folder.replace("ElastoDyn.dat", "False         YawDOF", "True          YawDOF");
  const model::JointDefinition alone = parse(import_main(folder)).turbine.nacelle.yaw;
  BOOST_TEST((alone.kind == model::JointKind::free));
  BOOST_TEST(alone.stiffness == 0.0);
  folder.replace("Main.fst", "0             CompServo", "1             CompServo");
  folder.replace("Main.fst", "\"unused\"      ServoFile", "\"Servo.dat\"   ServoFile");
  folder.write("Servo.dat",
               "---- SERVODYN ----\nText\n  2.5e6 YawSpr - spring (N-m/rad)\n"
               "  3e4 YawDamp - damper\n  4 YawNeut - neutral angle (degrees)\n");
  const model::JointDefinition driven = parse(import_main(folder)).turbine.nacelle.yaw;
  BOOST_TEST((driven.kind == model::JointKind::free));
  BOOST_TEST(driven.stiffness == 2.5e6);
  BOOST_TEST(driven.damping == 3e4);
}

/// A deck with this file of ServoDyn. Its rotor turns at 18.5 rpm and the generator 22 times as
/// fast.
Import import_with_servo(const std::string& keys) {
  const DeckFolder folder("three");
  folder.replace("Main.fst", "0             CompServo", "1             CompServo");
  folder.replace("Main.fst", "\"unused\"      ServoFile", "\"Servo.dat\"   ServoFile");
  folder.write("Servo.dat", "---- SERVODYN ----\nText\n" + keys);
  return import_main(folder);
}

BOOST_AUTO_TEST_CASE(simple_generators_are_laws_of_the_operating_points) {
  constexpr double rpm = std::numbers::pi / 30.0;
  const auto variable = [](const std::string& speed) {
    return import_with_servo("1 VSContrl - mode\n1 GenModel - model\n" + speed +
                             " VS_RtGnSp - rpm\n500 VS_RtTq - N-m\n0.003 VS_Rgn2K - N-m/rpm^2\n"
                             "10 VS_SlPc - slip\n");
  };
  const auto operation = parse(variable("440")).operation;
  BOOST_TEST(operation.rated_speed == 20.0 * rpm, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(operation.rated_power == 440.0 * rpm * 500.0, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(operation.torque_gain == 0.003 / (rpm * rpm), boost::test_tools::tolerance(1e-12));
  // A speed of the rotor in its place.
  const Import far = variable("20");
  BOOST_TEST(parse(far).operation.torque_gain == 0.0);
  BOOST_TEST(std::ranges::any_of(far.warnings, [](const std::string& words) {
    return holds(words, "VS_RtGnSp: warning: a speed of the generator that is far from RotSpeed");
  }));
  const auto induction =
      parse(import_with_servo("0 VSContrl - mode\n1 GenModel - model\n2 SIG_SlPc - %\n"
                              "400 SIG_SySp - rpm\n300 SIG_RtTq - N-m\n1.5 SIG_PORt - ratio\n"))
          .operation;
  BOOST_REQUIRE(induction.torque_table.size() == 2u);
  BOOST_TEST(induction.torque_table[0].first == 400.0 * rpm, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(induction.torque_table[0].second == 0.0);
  BOOST_TEST(induction.torque_table[1].first == 412.0 * rpm, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(induction.torque_table[1].second == 450.0, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(induction.rated_speed == 412.0 / 22.0 * rpm, boost::test_tools::tolerance(1e-12));
  const auto library =
      parse(import_with_servo("5 VSContrl - mode\n1 GenModel - model\n")).operation;
  BOOST_TEST(library.rated_speed == 0.0);
  // A structure needs no law.
  for (const std::string fault :
       {"-5 VS_RtTq - N-m\n0.003 VS_Rgn2K - gain\n", "500 VS_RtTq - N-m\n"}) {
    const Import without = import_with_servo("1 VSContrl - mode\n440 VS_RtGnSp - rpm\n" + fault);
    BOOST_TEST(parse(without).operation.rated_speed == 0.0);
    BOOST_TEST(std::ranges::any_of(without.warnings, [](const std::string& words) {
      return holds(words, "VS_R") &&
             holds(words, ": warning: the law of the generator's torque is left out");
    }));
  }
  BOOST_TEST(parse(import_with_servo("1 VSContrl - mode\n440 VS_RtGnSp - rpm\n0 VS_RtTq - N-m\n"
                                     "0 VS_Rgn2K - gain\n"))
                 .operation.rated_power == 0.0);
}

BOOST_AUTO_TEST_CASE(shaft_torsion_is_taken_with_its_spring_or_locked) {
  const DeckFolder folder("three");
  for (const bool free : {true, false}) {
    if (!free) folder.replace("ElastoDyn.dat", "True          DrTrDOF", "False         DrTrDOF");
    const model::JointDefinition torsion = parse(import_main(folder)).turbine.shaft.torsion;
    BOOST_TEST((torsion.kind == (free ? model::JointKind::free : model::JointKind::locked)));
    BOOST_TEST(torsion.stiffness == (free ? 8.5e6 : 0.0));
    BOOST_TEST(torsion.damping == (free ? 6.2e4 : 0.0));
  }
}

BOOST_AUTO_TEST_CASE(a_direction_without_freedoms_is_rigid) {
  const DeckFolder folder("three");
  for (const char* key : {"FlapDOF1", "FlapDOF2", "TwFADOF1", "TwFADOF2", "TwSSDOF1"})
    folder.replace("ElastoDyn.dat", std::string("True          ") + key,
                   std::string("False         ") + key);
  const model::TurbineDefinition t = parse(import_main(folder)).turbine;
  BOOST_TEST(t.blades.beam.sections[0].rigid[4]);
  BOOST_TEST(!t.blades.beam.sections[0].rigid[5]);
  BOOST_TEST(t.tower.sections[0].rigid[4]);
  BOOST_TEST(t.tower.sections[0].rigid[5]);
}

BOOST_AUTO_TEST_CASE(one_of_two_modes_is_kept_and_said) {
  const DeckFolder folder("three");
  const Import import = import_main(folder);
  BOOST_TEST(!parse(import).turbine.tower.sections[0].rigid[5]);
  BOOST_TEST(holds(find_line(import, "TwSSDOF2")->words, "kept"));
}

BOOST_AUTO_TEST_CASE(teetering_rotor) {
  const DeckFolder folder("teeter");
  const Import import = import_main(folder);
  const model::TurbineDefinition t = parse(import).turbine;
  BOOST_TEST(t.gravity == 9.805);  // FAST 8.16 has it in the file of ElastoDyn
  BOOST_TEST(t.blades.count == 2);
  BOOST_TEST(is_near(t.blades.precone, 7.0 * degree));
  BOOST_TEST((t.hub.teeter.kind == model::JointKind::free));
  BOOST_TEST(t.hub.teeter.stiffness == 4500.0);
  BOOST_TEST(t.hub.teeter.damping == 350.0);
  // OpenFAST: from the pin to the apex upwind, from the apex to the hub's centre downwind.
  BOOST_TEST(t.hub.undersling == -0.35);
  BOOST_TEST(is_near(t.hub.center_of_mass, 0.15 - 0.35));
  const double own = 1900.0 - 2500.0 * 0.2 * 0.2;
  BOOST_TEST(is_near(t.hub.inertia(0), own));
  BOOST_TEST(is_near(t.hub.inertia(1), own));
  BOOST_TEST(is_near(t.blades.each.at(2).pitch, 0.25 * degree));
  BOOST_TEST(is_near(t.blades.each.at(2).mass_factor, 1.0504 / 1.04));
  BOOST_TEST(is_near(t.blades.each.at(2).stiffness_factor, 1.0));
}

BOOST_AUTO_TEST_CASE(the_teeter_inertia_of_openfast_5_is_known) {
  const DeckFolder folder("teeter");
  folder.replace("ElastoDyn.dat", "      14.25   GenIner",
                 "        700   HubIner_Teeter - about the teeter axis\n      14.25   GenIner");
  const model::TurbineDefinition t = parse(import_main(folder)).turbine;
  BOOST_TEST(is_near(t.hub.inertia(0), 700.0 - 2500.0 * 0.2 * 0.2));
  BOOST_TEST(t.hub.inertia(1) == 1900.0);
}

BOOST_AUTO_TEST_CASE(a_teeter_by_a_user_routine_is_locked) {
  const DeckFolder folder("teeter");
  folder.replace("ElastoDyn.dat", "          1   TeetMod", "          2   TeetMod");
  const Import import = import_main(folder);
  BOOST_TEST((parse(import).turbine.hub.teeter.kind == model::JointKind::locked));
  BOOST_TEST(holds(find_line(import, "TeetMod")->words, "locked"));
}

BOOST_AUTO_TEST_CASE(blades_that_differ_by_more_than_factors_are_refused) {
  const DeckFolder folder("teeter");
  folder.replace("Blade_heavy.dat", "7.0000000E+01", "7.1000000E+01");
  const std::string message = message_of([&] { import_main(folder); });
  BOOST_TEST(holds(message, "Blade_heavy.dat"));
  BOOST_TEST(holds(message, "blade 2 differs"));
}

// BeamDyn's axes in ours, written down once more: b1 = z, b2 = -y, b3 = x. Strains and speeds are
// vectors, so the energies of any of them must be the same in both descriptions.
BOOST_AUTO_TEST_CASE(beamdyn_matrices_are_turned) {
  const DeckFolder folder("three");
  const model::BeamDefinition blade =
      parse(import_main(folder, "Main_BeamDyn.fst")).turbine.blades.beam;
  const std::vector<std::string> lines = lines_of(folder.text("BeamDyn_Blade.dat"));
  Matrix6 stiffness;
  Matrix6 mass;
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 10; i < lines.size() && rows.size() < 13; ++i) {
    std::istringstream stream(lines[i]);
    std::vector<double> row;
    for (double value = 0.0; stream >> value;) row.push_back(value);
    if (!row.empty()) rows.push_back(row);
  }
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j) {
      stiffness(i, j) = rows[static_cast<std::size_t>(1 + i)][static_cast<std::size_t>(j)];
      mass(i, j) = rows[static_cast<std::size_t>(7 + i)][static_cast<std::size_t>(j)];
    }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    Vector6 theirs;
    for (double& value : theirs) value = any(random);
    Vector6 ours;
    ours << theirs(2), -theirs(1), theirs(0), theirs(5), -theirs(4), theirs(3);
    for (const auto& [ours_matrix, theirs_matrix] :
         {std::pair{blade.sections[0].stiffness, stiffness}, {blade.sections[0].mass, mass}}) {
      const double a = ours.dot(ours_matrix * ours);
      const double b = theirs.dot(theirs_matrix * theirs);
      BOOST_TEST(std::abs(a - b) <= round_off * std::abs(b));
    }
  }
  // The centre of mass, x toward the suction side and y toward the trailing edge.
  BOOST_TEST(is_near(blade.sections[0].mass(0, 4) / 180.0, 0.02));   // b3 = x
  BOOST_TEST(is_near(-blade.sections[0].mass(0, 5) / 180.0, 0.03));  // b2 = -y = 0.03
  // K44 is the edgewise one, EI3.
  BOOST_TEST(blade.sections[0].stiffness(5, 5) == 7.2e8);
  BOOST_TEST(blade.sections[0].stiffness(4, 4) == 6.1e8);
  Vector6 damping;
  damping << 3e-3, 2e-3, 1e-3, 6e-3, 5e-3, 4e-3;
  BOOST_TEST(blade.damping == damping);
}

BOOST_AUTO_TEST_CASE(masses_of_a_beamdyn_blade_survive) {
  const DeckFolder folder("three");
  const model::BeamDefinition blade =
      parse(import_main(folder, "Main_BeamDyn.fst")).turbine.blades.beam;
  const std::vector<double> at = {0.0, 0.4, 1.0};
  const double length = blade.length;
  require_same(integrate(blade, 0, 0), integrate(at, {180.0, 95.0, 14.0}, length));
  require_same(integrate(blade, 0, 4), integrate(at, {3.6, 2.85, 0.14}, length));
  require_same(integrate(blade, 0, 5), integrate(at, {-5.4, 11.4, 0.56}, length));
  require_same(integrate(blade, 3, 3), integrate(at, {75.0, 31.0, 1.5}, length));
  require_same(integrate(blade, 4, 4), integrate(at, {35.0, 9.0, 0.3}, length));
  require_same(integrate(blade, 5, 5), integrate(at, {40.0, 22.0, 1.2}, length));
  require_same(integrate(blade, 4, 5), integrate(at, {1.5, -1.0, 0.05}, length));
}

using KeyPoints = std::array<double, 4>;

/// The polynomial of degree 3 through four values at the key points of the decks.
double through_key_points(const KeyPoints& values, double z) {
  constexpr KeyPoints places = {0.0, 4.0, 13.0, 20.0};
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    double term = values[i];
    for (std::size_t j = 0; j < 4; ++j)
      if (j != i) term *= (z - places[j]) / (places[i] - places[j]);
    sum += term;
  }
  return sum;
}

/// A column of the key points of the curved blade.
KeyPoints curved_key_points(const DeckFolder& folder, std::size_t column) {
  KeyPoints values{};
  const std::vector<std::string> lines = lines_of(folder.text("BeamDyn_curved.dat"));
  const auto header = std::find_if(lines.begin(), lines.end(),
                                   [](const auto& line) { return holds(line, "kp_xr "); });
  for (std::size_t i = 0; i < 4; ++i) {
    std::istringstream row(*(header + 2 + static_cast<std::ptrdiff_t>(i)));
    for (std::size_t k = 0; k <= column; ++k) row >> values[i];
  }
  return values;
}

BOOST_AUTO_TEST_CASE(straight_key_points_make_a_length) {
  const DeckFolder folder("three");
  const model::BeamDefinition blade =
      parse(import_main(folder, "Main_BeamDyn.fst")).turbine.blades.beam;
  BOOST_TEST(blade.length == 20.0);
  BOOST_TEST(blade.reference_line.empty());
  // The twist is the cubic polynomial through the four key points.
  constexpr double twist_limit = 3e-3 * degree;
  for (const double at : {0.1, 0.2, 0.4, 0.65, 0.8}) {
    const double twist = model::interpolate_section(blade, at).twist / degree;
    BOOST_TEST(std::abs(twist - through_key_points({12.5, 11.0, 4.5, -0.5}, 20.0 * at)) * degree <
               twist_limit);
  }
}

/// The first of the deck's two members has two key points, the second three.
double through_members(const KeyPoints& values, double z) {
  if (z < 4.0) return values[0] + (values[1] - values[0]) * z / 4.0;
  const double a = (z - 13.0) * (z - 20.0) / ((4.0 - 13.0) * (4.0 - 20.0));
  const double b = (z - 4.0) * (z - 20.0) / ((13.0 - 4.0) * (13.0 - 20.0));
  const double c = (z - 4.0) * (z - 13.0) / ((20.0 - 4.0) * (20.0 - 13.0));
  return a * values[1] + b * values[2] + c * values[3];
}

BOOST_AUTO_TEST_CASE(curved_key_points_make_a_line) {
  const DeckFolder folder("three");
  const model::BeamDefinition blade =
      parse(import_main(folder, "Main_curved.fst")).turbine.blades.beam;
  BOOST_TEST(blade.reference_line.back() == Vector3(20.0, -0.4, -0.9));
  BOOST_TEST(blade.length > 20.0);
  const KeyPoints x = curved_key_points(folder, 0);
  const KeyPoints y = curved_key_points(folder, 1);
  const model::ReferenceLine line("blade", blade);
  const double first_share = Vector3(4.0, x[1], y[1]).norm() / blade.length;
  double arc = 0.0;
  double mass = 0.0;
  constexpr int steps = 4000;
  for (int i = 0; i < steps; ++i) {
    const double z = 20.0 * (i + 0.5) / steps;
    constexpr double h = 1e-4;
    const double slope_x = (through_members(x, z + h) - through_members(x, z - h)) / (2.0 * h);
    const double slope_y = (through_members(y, z + h) - through_members(y, z - h)) / (2.0 * h);
    const double step = 20.0 / steps * std::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
    // Members by their arcs, places within them by z.
    const double part =
        z < 4.0 ? first_share * z / 4.0 : first_share + (1.0 - first_share) * (z - 4.0) / 16.0;
    mass += step * (part < 0.4 ? 180.0 - 85.0 * part / 0.4 : 95.0 - 81.0 * (part - 0.4) / 0.6);
    const Vector3 there = line.at((arc + 0.5 * step) / blade.length).x;
    arc += step;
    const Vector3 expected(z, -through_members(y, z), through_members(x, z));
    const double limit = std::abs(z - 4.0) < 0.2 ? 3e-4 : 1e-5;  // the spline rounds the kink off
    BOOST_TEST_INFO(z);
    BOOST_REQUIRE_SMALL((there - expected).norm(), limit);
  }
  BOOST_TEST(std::abs(arc - blade.length) < 1e-5);
  BOOST_TEST(std::abs(mass - integrate(blade, 0, 0).zeroth) < 1e-4 * mass);
}

BOOST_AUTO_TEST_CASE(every_key_is_accounted_for_once) {
  for (const char* name : {"three", "teeter"}) {
    const DeckFolder folder(name);
    const Import import = import_main(folder);
    for (const char* file : {"Main.fst", "ElastoDyn.dat", "Tower.dat", "Blade.dat"}) {
      const std::vector<std::string> lines = lines_of(folder.text(file));
      for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::size_t dash = lines[i].find(" - ");
        if (dash == std::string::npos || lines[i].starts_with("\"RotSpeed") ||
            lines[i].starts_with("\"NacYaw") || lines[i].starts_with("      ") == false)
          continue;
        if (lines[i].find("OutList") != std::string::npos) continue;
        const std::string place = std::string(file) + ":" + std::to_string(i + 1);
        const auto count =
            std::count_if(import.report.begin(), import.report.end(), [&](const ImportLine& line) {
              return line.place.ends_with("/" + place) && !line.words.empty();
            });
        BOOST_TEST(count == 1, place + " " + lines[i]);
      }
    }
  }
}

// ---- mangled decks

BOOST_AUTO_TEST_CASE(line_ends_tabs_order_and_comments_do_not_matter) {
  const DeckFolder whole("three");
  for (const char* main : {"Main.fst", "Main_BeamDyn.fst"}) {
    const std::string expected = import_main(whole, main).text;
    for (const char* end : {"\r\n", "\r"}) {
      const DeckFolder folder("three");
      for (const auto& file : fs::directory_iterator(folder.path)) {
        const std::string name = file.path().filename().string();
        std::string text = join(lines_of(folder.text(name)), end);
        folder.write(name, "\xef\xbb\xbf" + text);
      }
      BOOST_TEST(import_main(folder, main).text == expected);
    }
    const DeckFolder folder("three");
    for (const auto& file : fs::directory_iterator(folder.path)) {
      const std::string name = file.path().filename().string();
      std::vector<std::string> lines = lines_of(folder.text(name));
      for (std::size_t i = 2; i < lines.size(); ++i) {
        std::string tabs;
        for (const char c : lines[i]) tabs += c == ' ' ? '\t' : c;
        if (lines[i].find('"') == std::string::npos) lines[i] = tabs + " \t ! a comment, 5 of them";
      }
      folder.write(name, join(lines));
    }
    BOOST_TEST(import_main(folder, main).text == expected);
  }
}

BOOST_AUTO_TEST_CASE(keys_may_stand_in_any_order) {
  const DeckFolder folder("three");
  const std::string expected = import_main(folder).text;
  std::vector<std::string> lines = lines_of(folder.text("ElastoDyn.dat"));
  const auto output = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.find("OutList") != std::string::npos;
  });
  std::reverse(lines.begin() + 2, output);
  folder.write("ElastoDyn.dat", join(lines));
  BOOST_TEST(import_main(folder).text == expected);
}

BOOST_AUTO_TEST_CASE(columns_may_stand_in_any_order) {
  const DeckFolder folder("teeter");  // its blade has one column more, too
  const model::BeamDefinition blade = parse(import_main(folder)).turbine.blades.beam;
  BOOST_TEST(is_near(blade.sections[1].twist, 11.0 * degree));
  BOOST_TEST(is_near(blade.sections[1].mass(0, 0), 120.0 * 1.04));
}

BOOST_AUTO_TEST_CASE(all_missing_keys_come_at_once) {
  const DeckFolder folder("three");
  for (const char* key : {"OverHang", "NacMass"}) folder.replace("ElastoDyn.dat", key, "Other");
  const std::string message = message_of([&] { import_main(folder); });
  BOOST_TEST(holds(message, "ElastoDyn.dat: missing key \"OverHang\""));
  BOOST_TEST(holds(message, "ElastoDyn.dat: missing key \"NacMass\""));
}

BOOST_AUTO_TEST_CASE(wrong_numbers_come_with_file_and_line) {
  const DeckFolder folder("three");
  folder.replace("ElastoDyn.dat", "       -3.2   OverHang", "       -3,2   OverHang");
  folder.replace("ElastoDyn.dat", "         -4   ShftTilt", "       -4.l   ShftTilt");
  const std::string message = message_of([&] { import_main(folder); });
  BOOST_TEST(holds(message, "ElastoDyn.dat:40: OverHang: expected one number, got 2 values"));
  BOOST_TEST(holds(message, "ElastoDyn.dat:42: ShftTilt: expected a number, got \"-4.l\""));
}

BOOST_AUTO_TEST_CASE(a_table_with_a_wrong_number_of_rows_is_refused) {
  const DeckFolder folder("three");
  folder.replace("Tower.dat", "3.5000000E-01  1.0400000E+03  1.6000000E+10  1.7000000E+10\n", "");
  BOOST_TEST(
      holds(message_of([&] { import_main(folder); }), "the table has 3 rows, NTwInpSt states 4"));
  const DeckFolder more("three");
  more.replace("Tower.dat", "          4   NTwInpSt", "          3   NTwInpSt");
  BOOST_TEST(holds(message_of([&] { import_main(more); }), "NTwInpSt states 3"));
}

BOOST_AUTO_TEST_CASE(a_table_with_a_bad_row_is_refused) {
  const DeckFolder folder("three");
  folder.replace("Tower.dat", "1.0400000E+03  1.6000000E+10", "1.0400000E+03");
  const std::string message = message_of([&] { import_main(folder); });
  BOOST_TEST(holds(message, "Tower.dat:21: "));
}

BOOST_AUTO_TEST_CASE(a_key_given_twice_is_refused) {
  const DeckFolder folder("three");
  folder.write("ElastoDyn.dat",
               "-----\nfree text\n7 OverHang - again\n" + folder.text("ElastoDyn.dat"));
  BOOST_TEST(holds(message_of([&] { import_main(folder); }), "OverHang: given twice"));
}

BOOST_AUTO_TEST_CASE(a_missing_file_is_named_where_it_is_asked_for) {
  const DeckFolder folder("three");
  fs::remove(folder.path / "Tower.dat");
  const std::string message = message_of([&] { import_main(folder); });
  BOOST_TEST(holds(message, "ElastoDyn.dat:"));
  BOOST_TEST(holds(message, "TwrFile: no such file"));
}

BOOST_AUTO_TEST_CASE(utf16_is_refused) {
  const DeckFolder folder("three");
  std::string wide;
  for (const char c : folder.text("Main.fst")) wide += {c, '\0'};
  folder.write("Main.fst", wide);
  BOOST_TEST(holds(message_of([&] { import_main(folder); }), "UTF-16"));
}

BOOST_AUTO_TEST_CASE(a_substructure_is_refused_with_what_to_do) {
  const DeckFolder folder("three");
  folder.replace("Main.fst", "0             CompSub", "1             CompSub");
  BOOST_TEST(holds(message_of([&] { import_main(folder); }), "--tower-only"));
  BOOST_TEST(parse(import_openfast(folder / "Main.fst", {true})).turbine.tower.length == 40.0);
}

BOOST_AUTO_TEST_CASE(implausible_bodies_are_refused) {
  const DeckFolder folder("three");
  folder.replace("ElastoDyn.dat", "1.85D+04  NacYIner", "1.85D+03  NacYIner");
  folder.replace("Tower.dat", "1.6000000E+10", "-1.600000E+10");
  const std::string message = message_of([&] { import_main(folder); });
  BOOST_TEST(holds(message, "NacYIner"));
}

// Wherever a file is cut off, the import is right or refused, never something else.
BOOST_AUTO_TEST_CASE(a_truncated_deck_gives_no_wrong_number) {
  constexpr std::size_t stride = 53;
  for (const auto& [main, files] :
       {std::pair<std::string, std::vector<std::string>>{
            "Main.fst", {"Main.fst", "ElastoDyn.dat", "Tower.dat", "Blade.dat"}},
        {"Main_BeamDyn.fst", {"BeamDyn.dat", "BeamDyn_Blade.dat"}}}) {
    const DeckFolder folder("three");
    const std::string expected = import_main(folder, main).text;
    for (const std::string& file : files) {
      const std::string text = folder.text(file);
      for (std::size_t size = 0; size < text.size(); size += stride) {
        folder.write(file, text.substr(0, size));
        try {
          const std::string result = import_main(folder, main).text;
          BOOST_TEST(result == expected, file + " cut off after " + std::to_string(size));
        } catch (const InputError& error) {
          BOOST_TEST(holds(error.what(), folder.path.string()));
        }
      }
      // The last digits, where a number could be cut off.
      for (std::size_t cut = 1; cut < 24 && cut < text.size(); ++cut) {
        folder.write(file, text.substr(0, text.size() - cut));
        try {
          BOOST_TEST(import_main(folder, main).text == expected, file + " lacks its end");
        } catch (const InputError&) {
        }
      }
      folder.write(file, text);
    }
  }
}

// Without one of its lines, or with one given twice, a deck is refused or gives the same case.
BOOST_AUTO_TEST_CASE(a_line_too_few_or_too_many_gives_no_wrong_number) {
  for (const auto& [name, main, files] :
       {std::tuple<std::string, std::string, std::vector<std::string>>{
            "three", "Main.fst", {"Main.fst", "ElastoDyn.dat", "Tower.dat", "Blade.dat"}},
        {"three", "Main_BeamDyn.fst", {"Main_BeamDyn.fst", "BeamDyn.dat", "BeamDyn_Blade.dat"}},
        {"teeter", "Main.fst", {"ElastoDyn.dat", "Blade_heavy.dat"}}}) {
    const DeckFolder folder(name);
    const std::string expected = import_main(folder, main).text;
    for (const std::string& file : files) {
      const std::string text = folder.text(file);
      const std::vector<std::string> lines = lines_of(text);
      for (std::size_t i = 2; i < lines.size(); ++i)  // behind the title
        for (const bool twice : {false, true}) {
          if (twice && i % 4 != 0) continue;  // spares time
          std::vector<std::string> mangled = lines;
          if (twice)
            mangled.insert(mangled.begin() + static_cast<long>(i), lines[i]);
          else
            mangled.erase(mangled.begin() + static_cast<long>(i));
          folder.write(file, join(mangled));
          try {
            BOOST_TEST(import_main(folder, main).text == expected, file + ": " + lines[i]);
          } catch (const InputError& error) {
            BOOST_TEST(holds(error.what(), folder.path.string()));
          }
        }
      folder.write(file, text);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
