#include "samara/io/case.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/model/turbine.hpp"

#include "folder.hpp"

namespace {

using namespace samara;
using namespace samara::io;
using samara::analysis::FloquetPeriod;
using samara::analysis::TrimMethod;
using samara::model::JointKind;

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;
using samara::test::Folder;

const std::string lee2002 = std::string(SAMARA_SOURCE_DIR) + "/inputs/lee2002/";

constexpr double round_off = 1e-14;
constexpr double degree = std::numbers::pi / 180.0;

/// Eight lines; tests append from line 9.
const std::string minimal = R"(samara: 1
blades:
  count: 2
  length: 10
  sections:
    - mass: 5
      inertia: [1, 0.5, 0.5]
      stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: 1e6, EI2: 2e6, EI3: 3e6}
)";

const std::string tower = R"(tower:
  length: 30
  sections:
    - mass: 5
      inertia: [1, 0.5, 0.5]
      stiffness: {EA: 1, GA2: 1, GA3: 1, GJ: 1, EI2: 1, EI3: 1}
)";

std::string replace(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  BOOST_REQUIRE(place != std::string::npos);
  return text.replace(place, from.size(), to);
}

Case read_text(const std::string& text, const Strings& settings = {}) {
  const Folder folder;
  return read_case(folder.write("case.yaml", text), settings);
}

/// The lines of the error, without the folder of the file.
Strings read_errors(const std::string& text, const Strings& settings = {}) {
  const Folder folder;
  const std::string file = folder.write("case.yaml", text);
  Strings lines;
  try {
    read_case(file, settings);
  } catch (const InputError& error) {
    std::string rest = error.what();
    while (!rest.empty()) {
      std::string line = rest.substr(0, rest.find('\n'));
      rest.erase(0, line.size() + 1);
      if (line.starts_with(file)) line.replace(0, file.size(), "case.yaml");
      lines.push_back(line);
    }
  }
  return lines;
}

void check_errors(const std::string& text, const Strings& settings, const Strings& expected) {
  const Strings errors = read_errors(text, settings);
  BOOST_TEST(errors == expected, boost::test_tools::per_element());
}

void check_error(const std::string& text, const std::string& expected) {
  check_errors(text, {}, {expected});
}

void check_setting_error(const std::string& setting, const std::string& expected) {
  check_errors(minimal, {setting}, {"--set " + setting + ": " + expected});
}

/// The only error starts so: for messages whose end is a parser's or a list of keys.
void check_error_start(const std::string& text, const std::string& start) {
  const Strings errors = read_errors(text);
  BOOST_REQUIRE(errors.size() == 1u);
  BOOST_TEST(errors[0].substr(0, start.size()) == start);
}

/// Message of read_case for a path that holds no case.
std::string read_path_error(const std::string& path) {
  try {
    read_case(path, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(reading)

BOOST_AUTO_TEST_CASE(baseline_is_the_turbine_of_the_paper) {
  const Case on_its_mesh = read_case(lee2002 + "article_mesh.yaml", {});
  BOOST_TEST(on_its_mesh.turbine.tower.elements == 4);
  BOOST_TEST(on_its_mesh.turbine.tower.order == 1);
  BOOST_TEST(on_its_mesh.turbine.blades.beam.elements == 4);
  BOOST_TEST(on_its_mesh.turbine.blades.beam.order == 1);
  BOOST_TEST(on_its_mesh.floquet.order == 6);
  const Case result = read_case(lee2002 + "baseline.yaml", {});
  const model::TurbineDefinition& turbine = result.turbine;
  BOOST_TEST(turbine.title.find("Lee, Hodges and Patil (2002)") != std::string::npos);
  BOOST_TEST(turbine.gravity == 0.0);

  BOOST_TEST(turbine.has_tower);
  BOOST_TEST(turbine.tower.length == 27.0);
  BOOST_TEST(turbine.tower.reference_line.empty());
  BOOST_TEST(turbine.tower.elements == 1);
  BOOST_TEST(turbine.tower.order == 4);
  BOOST_REQUIRE(turbine.tower.sections.size() == 1u);
  const model::SectionDefinition& section = turbine.tower.sections[0];
  BOOST_TEST((section.rigid == std::array<bool, 6>{true, true, true, false, false, false}));
  const Matrix6 stiffness = Vector6(0, 0, 0, 1e9, 1e9, 1e9).asDiagonal();
  BOOST_TEST((section.stiffness == stiffness));
  const Matrix6 mass = Vector6(67.5772, 67.5772, 67.5772, 5, 0.0001, 4.9999).asDiagonal();
  BOOST_TEST((section.mass == mass));
  BOOST_TEST(section.twist == 0.0);
  BOOST_TEST(turbine.tower.damping.isZero(0.0));

  BOOST_TEST(turbine.has_nacelle);
  BOOST_TEST(turbine.nacelle.mass == 6900.0);
  BOOST_TEST((turbine.nacelle.inertia == Vector3(0, 0, 16599)));
  BOOST_TEST((turbine.nacelle.yaw.kind == JointKind::free));
  BOOST_TEST(turbine.shaft.speed == 6.02);
  BOOST_TEST(turbine.shaft.overhang == 2.388);
  BOOST_TEST((turbine.hub.inertia == Vector3(50, 5, 50)));
  BOOST_TEST(turbine.hub.radius == 1.8);
  BOOST_TEST((turbine.hub.teeter.kind == JointKind::free));

  BOOST_TEST(turbine.blades.count == 2);
  BOOST_TEST(turbine.blades.beam.length == 8.42);
  BOOST_TEST(turbine.blades.beam.elements == 1);
  BOOST_TEST(turbine.blades.beam.sections.at(0).stiffness(4, 4) == 1e7);
  BOOST_TEST((turbine.blades.beam.sections.at(0).mass == mass));
  BOOST_TEST(turbine.blades.each.empty());

  BOOST_TEST((result.trim.method == TrimMethod::harmonic_balance));
  BOOST_TEST(result.trim.harmonics == 4);
  BOOST_TEST(!result.trim.automatic);
  BOOST_TEST(result.trim.tolerance == 1e-10);
  BOOST_TEST(result.floquet.steps == 0);  // chosen
  BOOST_TEST((result.floquet.period == FloquetPeriod::automatic));
}

BOOST_AUTO_TEST_CASE(the_other_cases_of_the_paper_differ_in_the_tower_only) {
  const auto rigidity = [](const std::string& name) {
    return read_case(lee2002 + name, {}).turbine.tower.sections.at(0).stiffness(3, 3);
  };
  BOOST_TEST(rigidity("ratio10.yaml") == 1e8);
  BOOST_TEST(rigidity("ratio1000.yaml") == 1e10);
  const Case rigid = read_case(lee2002 + "rigid_tower.yaml", {});
  BOOST_TEST(!rigid.turbine.has_tower);
  BOOST_TEST(rigid.turbine.has_nacelle);
  BOOST_TEST(rigid.turbine.blades.beam.sections.at(0).stiffness(3, 3) == 1e7);
}

BOOST_AUTO_TEST_CASE(what_is_left_out_is_absent) {
  const model::TurbineDefinition turbine = read_text(minimal).turbine;
  BOOST_TEST(!turbine.has_tower);
  BOOST_TEST(!turbine.has_nacelle);
  BOOST_TEST(turbine.gravity == 9.80665);
  BOOST_TEST(turbine.shaft.speed == 0.0);
  BOOST_TEST((turbine.hub.teeter.kind == JointKind::locked));
  BOOST_TEST((turbine.nacelle.yaw.kind == JointKind::locked));
}

BOOST_AUTO_TEST_CASE(a_tower_without_a_nacelle_is_legal) {
  const model::TurbineDefinition turbine = read_text(minimal + tower).turbine;
  BOOST_TEST(turbine.has_tower);
  BOOST_TEST(!turbine.has_nacelle);
}

BOOST_AUTO_TEST_CASE(degrees_and_rpm_become_radians) {
  const model::TurbineDefinition turbine =
      read_text(minimal +
                "  precone_deg: -2.5\n  pitch_deg: 30\nshaft: {speed_rpm: 30, tilt_deg: 5, "
                "azimuth_deg: 90}\n")
          .turbine;
  const auto near = boost::test_tools::tolerance(round_off);
  BOOST_TEST(turbine.shaft.speed == std::numbers::pi, near);
  BOOST_TEST(turbine.shaft.tilt == 5 * degree, near);
  BOOST_TEST(turbine.shaft.azimuth == 90 * degree, near);
  BOOST_TEST(turbine.blades.precone == -2.5 * degree, near);
  BOOST_TEST(turbine.blades.pitch == 30 * degree, near);
}

BOOST_AUTO_TEST_CASE(a_teeter_map_without_a_joint_is_a_free_hinge) {
  const model::HubDefinition hub =
      read_text(minimal + "hub: {teeter: {undersling: 0.3, stiffness: 4, delta3_deg: 30}}\n")
          .turbine.hub;
  BOOST_TEST((hub.teeter.kind == JointKind::free));
  BOOST_TEST(hub.teeter.stiffness == 4.0);
  BOOST_TEST(hub.undersling == 0.3);
  BOOST_TEST(hub.delta3 == 30 * degree, boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(a_drivetrain_has_a_shaft_and_a_generator) {
  const model::ShaftDefinition shaft =
      read_text(minimal +
                "shaft:\n  torsion: {joint: free, stiffness: 8e8, damping: 6e6}\n"
                "  gear_ratio: -97\n"
                "  generator: {joint: free, own_inertia: 534, torque_slope: -3}\n")
          .turbine.shaft;
  BOOST_TEST((shaft.torsion.kind == JointKind::free));
  BOOST_TEST(shaft.torsion.stiffness == 8e8);
  BOOST_TEST(shaft.torsion.damping == 6e6);
  BOOST_TEST((shaft.generator.kind == JointKind::free));
  BOOST_TEST(shaft.generator.inertia == 534.0);
  BOOST_TEST(shaft.gear_ratio == -97.0);
  BOOST_TEST(shaft.generator.law.slope == -3.0);
  BOOST_TEST(shaft.generator.law.torque == 0.0);
}

BOOST_AUTO_TEST_CASE(an_inertia_at_the_speed_of_the_shaft_is_refused_with_the_new_keys) {
  check_error(
      minimal + "shaft:\n  generator: {joint: locked, inertia: 5e6}\n",
      "case.yaml:10:30: shaft.generator.inertia: was counted at the speed of the shaft, "
      "gears included, and is no longer read; hint: own_inertia, of the generator about its "
      "own axis, and shaft.gear_ratio (of an OpenFAST deck GenIner and GBRatio); without "
      "gears own_inertia is the same number");
  check_error(minimal + "shaft:\n  gear_ratio: 0\n",
              "case.yaml:10:3: shaft.gear_ratio: expected a number other than 0");
}

BOOST_AUTO_TEST_CASE(renamed_keys_are_refused_with_the_new_spelling) {
  check_error(minimal + "shaft:\n  inertia: {axial: 3, lateral: 4}\n",
              "case.yaml:10:23: shaft.inertia.lateral: is named transverse; hint: transverse, with "
              "the same number");
  check_error(
      minimal + tower + "  damping: {lateral: 0.01}\n",
      "case.yaml:15:13: tower.damping.lateral: is named side_side; hint: side_side, with the "
      "same number");
}

BOOST_AUTO_TEST_CASE(a_generator_table_reaches_to_the_speed_behind_the_gear) {
  const std::string shaft = minimal +
                            "shaft:\n  speed: 2\n  gear_ratio: -10\n  generator:\n"
                            "    joint: free\n    torque_table: ";
  const model::ShaftDefinition read = read_text(shaft + "[[10, 3], [30, 7]]\n").turbine.shaft;
  BOOST_TEST(read.generator_speed() == 20.0);
  BOOST_TEST(model::build_turbine(read_text(shaft + "[[10, 3], [30, 7]]\n").turbine)
                 .chain.generator_torque.at(20.0)
                 .torque == 5.0);
  check_error(shaft + "[[1, 3], [3, 7]]\n",
              "case.yaml:14:5: shaft.generator.torque_table: the table reaches from 1 to 3 rad/s, "
              "shaft.speed times gear_ratio is 20 rad/s; hint: entries up to there, or torque and "
              "torque_slope at this speed");
}

BOOST_AUTO_TEST_CASE(damping_ratios_become_mu_per_strain) {
  // A slender beam of EI2 = 2e6, EI3 = 3e6: omega^2 ~ EI, so mu = 2 zeta/omega differs by sqrt.
  const model::BeamDefinition beam =
      read_text(minimal + "  elements: 20\n  damping: {flap: 0.02, lead_lag: 0.02}\n")
          .turbine.blades.beam;
  BOOST_TEST(beam.modal_damping[0].value() == 0.02);
  BOOST_TEST(!beam.modal_damping[2]);
  // (1.8751/l)^2 sqrt(EI/m), rotary inertia 0.5/(5 l^2) left out.
  const double omega = 1.8751 * 1.8751 / 100.0 * std::sqrt(2e6 / 5.0);
  BOOST_TEST(std::abs(beam.damping(4) * omega - 0.04) < 0.04 * 0.02);
  BOOST_TEST(std::abs(beam.damping(5) / beam.damping(4) - std::sqrt(2.0 / 3.0)) < 1e-9);
  BOOST_TEST(beam.damping(2) == beam.damping(4));
  BOOST_TEST(beam.damping(1) == beam.damping(5));
  BOOST_TEST(beam.damping(3) == 0.0);
  BOOST_TEST(beam.damping(0) == 0.0);
}

BOOST_AUTO_TEST_CASE(damping_ratios_need_modes) {
  const std::string rigid = replace(minimal, "GJ: 1e6", "GJ: rigid");
  check_error(rigid + "  damping: {flap: 0.02, torsion: 0.01}\n",
              "case.yaml:9:3: blades.damping: the beam has no mode of torsion: its strain is "
              "rigid; hint: leave this ratio out");
  check_error(minimal + "  damping: {flap: 2}\n",
              "case.yaml:9:13: blades.damping.flap: expected a number from 0 to 1, got 2");
  check_error(minimal + "  damping: {fore_aft: 0.01}\n",
              "case.yaml:9:13: unknown key \"fore_aft\" in blades.damping; known keys: "
              "flap, lead_lag, torsion");
}

BOOST_AUTO_TEST_CASE(a_hub_carries_masses_off_its_axis) {
  const model::HubDefinition hub =
      read_text(minimal +
                "hub:\n  point_masses:\n    - {mass: 5, center: [0, 0.1, -2], inertia: "
                "[1, 2, 3]}\n    - {mass: 2}\n")
          .turbine.hub;
  BOOST_REQUIRE(hub.point_masses.size() == 2u);
  BOOST_TEST(hub.point_masses[0].mass == 5.0);
  BOOST_TEST((hub.point_masses[0].center == Vector3(0, 0.1, -2)));
  BOOST_TEST((hub.point_masses[0].inertia == Vector3(1, 2, 3)));
  BOOST_TEST((hub.point_masses[1].center == Vector3::Zero()));
  check_error(minimal + "hub:\n  point_masses: 5\n",
              "case.yaml:10:3: hub.point_masses: expected a list of point masses (each starts with "
              "\"- \"), got 5");
  check_error(minimal + "hub:\n  point_masses:\n    - {center: [0, 0, 1]}\n",
              "case.yaml:11:7: hub.point_masses[0]: missing key \"mass\"");
}

BOOST_AUTO_TEST_CASE(torque_laws_are_lines_or_tables) {
  const model::ShaftDefinition shaft =
      read_text(minimal +
                "shaft:\n  rotor: {torque: 90, torque_slope: -1.5}\n  speed: 2\n"
                "  generator: {joint: free, torque_table: [[1, 10], [2, 30], [4, 50]]}\n")
          .turbine.shaft;
  BOOST_TEST(shaft.rotor.at(2.0).torque == 90.0);
  BOOST_TEST(shaft.rotor.at(2.0).slope == -1.5);
  BOOST_REQUIRE(shaft.generator.law.table.size() == 3u);
  const auto torque = [&](double speed) { return shaft.generator.law.at(speed).torque; };
  const auto slope = [&](double speed) { return shaft.generator.law.at(speed).slope; };
  BOOST_TEST(torque(1.0) == 10.0);
  BOOST_TEST(torque(1.25) == 15.0);
  BOOST_TEST(torque(2.0) == 30.0);
  BOOST_TEST(torque(3.0) == 40.0);
  BOOST_TEST(torque(4.0) == 50.0);
  BOOST_TEST(slope(1.0) == 20.0);
  BOOST_TEST(slope(1.9) == 20.0);
  BOOST_TEST(slope(2.0) == 15.0);
  BOOST_TEST(slope(2.1) == 10.0);
  BOOST_TEST(slope(4.0) == 10.0);
}

BOOST_AUTO_TEST_CASE(a_torque_table_must_rise_and_reach_to_the_speed) {
  const auto check = [](const std::string& table, const std::string& message) {
    check_error(minimal + "shaft:\n  speed: 2\n  rotor:\n    torque_table: " + table + "\n",
                "case.yaml:12:" + message);
  };
  check("[[1, 2], [1, 3]]",
        "28: shaft.rotor.torque_table[1]: speed must be more than in the entry before");
  check("[[2, 3]]", "5: shaft.rotor.torque_table: expected at least 2 entries [speed, torque]");
  check("5", "5: shaft.rotor.torque_table: expected a list of [speed, torque], got 5");
  check("[[3, 1], [4, 1]]",
        "5: shaft.rotor.torque_table: the table reaches from 3 to 4 rad/s, shaft.speed is 2 rad/s; "
        "hint: entries up to there, or torque and torque_slope at this speed");
  check_error(minimal +
                  "shaft:\n  generator:\n    joint: free\n    torque: 3\n"
                  "    torque_table: [[0, 1], [4, 1]]\n",
              "case.yaml:12:5: shaft.generator.torque: given together with torque_table; leave one "
              "of them out");
}

BOOST_AUTO_TEST_CASE(a_torque_law_without_effect_is_noted) {
  const std::string law = "torque_table: [[1, 10], [4, 50]]";
  const auto text_of = [&](const std::string& joint, const std::string& speed) {
    return minimal + "shaft:\n  speed: " + speed + "\n  generator:\n    joint: " + joint +
           "\n    " + law + "\n  rotor:\n    " + law + "\n";
  };
  const auto read = [](const std::string& text) { return parse_case("case.yaml", text, {}); };
  using Notes = std::vector<std::string>;
  const std::string generator = "case.yaml:13:5: shaft.generator.torque_table: note: ";
  const std::string rotor = "case.yaml:15:5: shaft.rotor.torque_table: note: ";
  const std::string parked = "the table reaches from 1 to 4 rad/s, the rotor is parked: no torque";
  BOOST_TEST(read(text_of("free", "2")).notes.empty());
  BOOST_TEST((read(text_of("locked", "2")).notes ==
              Notes{generator + "without effect, the generator is locked"}));
  const io::Case at_rest = read(text_of("free", "0"));
  BOOST_TEST((at_rest.notes == Notes{generator + parked, rotor + parked}));
  const elements::TorqueLine line = at_rest.turbine.shaft.rotor.at(0.0);
  BOOST_TEST(line.torque == 0.0);
  BOOST_TEST(line.slope == 0.0);
  // The range of a locked generator's table does not matter.
  BOOST_TEST(read(replace(text_of("locked", "9"), "rotor:\n    " + law, "rotor: {torque: 1}"))
                 .notes.size() == 1u);
}

BOOST_AUTO_TEST_CASE(point_masses_are_sorted_by_their_place) {
  const model::BeamDefinition beam =
      read_text(minimal +
                "  point_masses:\n    - {at: 1, mass: 5}\n"
                "    - {at: 0.25, mass: 2, center: [0, 0.1, -0.2], inertia: [1, 2, 3]}\n")
          .turbine.blades.beam;
  BOOST_REQUIRE(beam.point_masses.size() == 2u);
  BOOST_TEST(beam.point_masses[0].at == 0.25);
  BOOST_TEST(beam.point_masses[0].mass == 2.0);
  BOOST_TEST((beam.point_masses[0].center == Vector3(0, 0.1, -0.2)));
  BOOST_TEST((beam.point_masses[0].inertia == Vector3(1, 2, 3)));
  BOOST_TEST(beam.point_masses[1].at == 1.0);
  BOOST_TEST((beam.point_masses[1].center == Vector3::Zero()));
}

BOOST_AUTO_TEST_CASE(supports_are_words_or_springs) {
  using Six = std::array<bool, 6>;
  const auto beam = [](const std::string& keys) {
    return read_text(minimal + keys).turbine.blades.beam;
  };
  BOOST_TEST(beam("").support.is_clamp());
  BOOST_TEST(beam("").end_support.is_none());
  BOOST_TEST(beam("  support: clamped\n  end_support: free\n").end_support.is_none());
  const model::BeamDefinition pinned = beam("  support: pinned\n  end_support: pinned\n");
  for (const model::SupportDefinition& support : {pinned.support, pinned.end_support}) {
    BOOST_TEST((support.rigid == Six{true, true, true, false, false, false}));
    BOOST_TEST((support.free == Six{false, false, false, true, true, true}));
  }
  const model::SupportDefinition springs =
      beam(
          "  end_support: pinned\n"
          "  support:\n    stiffness: {u1: 3, theta2: 7, theta3: free}\n    mass: 2\n"
          "    center: [1, 2, 3]\n    inertia: [4, 5, 6]\n    damping: 0.1\n"
          "    added_mass: {u2: 8, theta3: 9}\n")
          .support;
  BOOST_TEST((springs.rigid == Six{false, true, true, true, false, false}));
  BOOST_TEST((springs.free == Six{false, false, false, false, false, true}));
  BOOST_TEST((Vector6(springs.stiffness.diagonal()) == Vector6(3, 0, 0, 0, 7, 0)));
  BOOST_TEST(springs.mass == 2.0);
  BOOST_TEST((springs.center == Vector3(1, 2, 3)));
  BOOST_TEST((springs.inertia == Vector3(4, 5, 6)));
  BOOST_TEST((springs.damping == Vector6::Constant(0.1)));
  BOOST_TEST((springs.added_mass == Vector6(0, 8, 0, 0, 0, 9)));
  BOOST_TEST(
      (beam("  support: {stiffness: {u1: 3}, damping: [1, 2, 3, 4, 5, 6]}\n").support.damping ==
       Vector6(1, 2, 3, 4, 5, 6)));
  const model::SupportDefinition matrix =
      beam(
          "  end_support:\n    stiffness_matrix:\n"
          "      - [2, 1, 0, 0, 0, 0]\n      - [1, 3, 0, 0, 0, 0]\n      - [0, 0, 4, 0, 0, 0]\n"
          "      - [0, 0, 0, rigid, 0, 0]\n      - [0, 0, 0, 0, 5, 0]\n      - [0, 0, 0, 0, 0, "
          "6]\n")
          .end_support;
  BOOST_TEST((matrix.rigid == Six{false, false, false, true, false, false}));
  BOOST_TEST(matrix.stiffness(0, 1) == 1.0);
  BOOST_TEST(matrix.stiffness(5, 5) == 6.0);
}

BOOST_AUTO_TEST_CASE(supports_are_checked) {
  check_error(minimal + "  support: loose\n",
              "case.yaml:9:3: blades.support: expected clamped, pinned or springs, got \"loose\"");
  check_error(
      minimal + "  support: pinned\n",
      "case.yaml:9:3: blades.support: the root of a blade can be free only on hinges; hint: "
      "replace the support by hinges: [{axis: flap, joint: free}], axis pitch for theta1, "
      "flap for theta2, lag for theta3");
  check_error(minimal + "  end_support: pinned\n  hinges: [{axis: lag, joint: free}]\n",
              "case.yaml:9:3: blades.end_support: holds the end in axes that blades.hinges turn; "
              "hint: a beam between two supports has support: pinned or stiffness: {theta2: free, "
              "...} instead of hinges");
  check_error(minimal + "  support: {mass: 3}\n",
              "case.yaml:9:3: blades.support: missing key \"stiffness\" (or \"stiffness_matrix\")");
  check_error(
      minimal + "  support: {stiffness: {u1: -3}}\n",
      "case.yaml:9:25: blades.support.stiffness.u1: expected a number > 0, rigid or free, got "
      "-3");
  check_error(minimal + "  end_support: {stiffness: {u1: 3}, mass: 1}\n",
              "case.yaml:9:37: unknown key \"mass\" in blades.end_support; known keys: stiffness, "
              "stiffness_matrix");
}

BOOST_AUTO_TEST_CASE(a_mass_center_couples_forces_and_rotations) {
  const double m = 5, c2 = 0.1, c3 = -0.2;
  const Matrix6 mass =
      read_text(replace(minimal, "mass: 5", "mass: 5\n      mass_center: [0.1, -0.2]"))
          .turbine.blades.beam.sections.at(0)
          .mass;
  // P = m (V + Omega x c): Omega about b1 moves c by (0, -c3, c2), about b2 by (c3, 0, 0).
  Matrix6 expected = Vector6(m, m, m, 1, 0.5, 0.5).asDiagonal();
  expected(1, 3) = expected(3, 1) = -m * c3;
  expected(2, 3) = expected(3, 2) = m * c2;
  expected(0, 4) = expected(4, 0) = m * c3;
  expected(0, 5) = expected(5, 0) = -m * c2;
  BOOST_TEST((mass - expected).norm() <= round_off * expected.norm());
}

BOOST_AUTO_TEST_CASE(matrices_may_be_rigid_on_the_diagonal) {
  const std::string text = R"(samara: 1
blades:
  length: 10
  sections:
    - stiffness_matrix:
        - [rigid, 0, 0, 0, 0, 0]
        - [0, rigid, 0, 0, 0, 0]
        - [0, 0, 8, 0, 0, 0]
        - [0, 0, 0, 4, 1, 0]
        - [0, 0, 0, 1, 5, 0]
        - [0, 0, 0, 0, 0, 6]
      mass_matrix: [[2, 0, 0, 0, 0, 0], [0, 2, 0, 0, 0, 0], [0, 0, 2, 0, 0, 0],
                    [0, 0, 0, 3, 0, 0], [0, 0, 0, 0, 1, 0.1], [0, 0, 0, 0, 0.1, 2]]
      twist_deg: 10
)";
  const model::SectionDefinition section = read_text(text).turbine.blades.beam.sections.at(0);
  BOOST_TEST((section.rigid == std::array<bool, 6>{true, true, false, false, false, false}));
  BOOST_TEST(section.stiffness(3, 4) == 1.0);
  BOOST_TEST(section.stiffness(0, 0) == 0.0);
  BOOST_TEST(section.mass(4, 5) == 0.1);
  BOOST_TEST(section.twist == 10 * degree, boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(sections_damping_and_single_blades_are_read) {
  const std::string text = R"(samara: 1
blades:
  count: 3
  length: 10
  damping: [0, 0, 0, 0.1, 0.2, 0.3]
  sections:
    - &root
      at: 0
      mass: 5
      inertia: [1, 0.5, 0.5]
      stiffness: {EA: 1, GA2: 1, GA3: 1, GJ: 1, EI2: 1, EI3: 1}
    - {<<: *root, at: 1, mass: 2}
  each:
    2: {pitch_deg: 0.5, mass_factor: 1.01}
tower:
  length: 30
  damping: 0.01
  sections: [*root]
)";
  const model::TurbineDefinition turbine = read_text(text).turbine;
  const model::BeamDefinition& blade = turbine.blades.beam;
  BOOST_REQUIRE(blade.sections.size() == 2u);
  BOOST_TEST(blade.sections[1].at == 1.0);
  BOOST_TEST(blade.sections[1].mass(0, 0) == 2.0);
  BOOST_TEST(blade.sections[1].mass(3, 3) == 1.0);
  BOOST_TEST((blade.damping == Vector6(0, 0, 0, 0.1, 0.2, 0.3)));
  BOOST_TEST((turbine.tower.damping == Vector6::Constant(0.01)));
  BOOST_REQUIRE(turbine.blades.each.size() == 1u);
  BOOST_TEST(turbine.blades.each.at(2).mass_factor == 1.01);
  BOOST_TEST(turbine.blades.each.at(2).stiffness_factor == 1.0);
  BOOST_TEST(turbine.blades.each.at(2).pitch == 0.5 * degree,
             boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(options_of_the_analyses_are_read) {
  const Case result = read_text(minimal +
                                "trim: {method: shooting, harmonics: auto, tolerance: 1e-8, steps: "
                                "50}\nfloquet: {steps: 100, period: blade, time_order: 2}\n");
  BOOST_TEST((result.trim.method == TrimMethod::shooting));
  BOOST_TEST(result.trim.automatic);
  BOOST_TEST(result.trim.tolerance == 1e-8);
  BOOST_TEST(result.trim.steps == 50);
  BOOST_TEST(result.floquet.steps == 100);
  BOOST_TEST((result.floquet.period == FloquetPeriod::blade));
}

BOOST_AUTO_TEST_CASE(options_of_static_are_read) {
  const Case result = read_text(
      minimal + "static: {steps: 20, method: arc_length, tolerance: 1e-7, max_steps: 300}\n");
  BOOST_TEST(result.statics.steps == 20);
  BOOST_TEST((result.statics.method == analysis::StaticMethod::arc_length));
  BOOST_TEST(result.statics.tolerance == 1e-7);
  BOOST_TEST(result.statics.most_steps == 300);
}

BOOST_AUTO_TEST_CASE(loads_are_read) {
  const Case result = read_text(minimal + tower + "shaft: {speed: 2}\n" + R"(loads:
  - {beam: blades, at: 1, force: [1, 2, 3]}
  - beam: blade 2
    from: 0.25
    to: 0.5
    moment: [4, 5, 6]
    follower: true
    harmonic: {per_rev: 3, amplitude: 0.5, mean: 1.5, phase_deg: 90}
  - {beam: tower, at: 0.5, force: [0, 0, 7], moment: [8, 0, 0], harmonic: {frequency: 4}}
  - {beam: tower, at: 0, force: [0, 0, 9], table: [[0, 1], [2.5, -1]], follower: false}
)");
  const std::vector<model::LoadDefinition>& loads = result.turbine.loads;
  BOOST_REQUIRE(loads.size() == 4u);
  BOOST_TEST(!loads[0].on_tower);
  BOOST_TEST(loads[0].blade == 0);
  BOOST_TEST(loads[0].from == 1.0);
  BOOST_TEST(loads[0].to == 1.0);
  BOOST_TEST((loads[0].force == Vector3(1, 2, 3)));
  BOOST_TEST(loads[0].moment.isZero(0.0));
  BOOST_TEST(!loads[0].follower);
  BOOST_TEST(loads[0].variation.is_constant());
  BOOST_TEST(loads[1].blade == 2);
  BOOST_TEST(loads[1].from == 0.25);
  BOOST_TEST(loads[1].to == 0.5);
  BOOST_TEST((loads[1].moment == Vector3(4, 5, 6)));
  BOOST_TEST(loads[1].follower);
  BOOST_TEST(loads[1].variation.per_rev == 3);
  BOOST_TEST(loads[1].variation.amplitude == 0.5);
  BOOST_TEST(loads[1].variation.mean == 1.5);
  BOOST_TEST(std::abs(loads[1].variation.phase - 90.0 * degree) < round_off);
  BOOST_TEST(loads[2].on_tower);
  BOOST_TEST(loads[2].variation.frequency == 4.0);
  BOOST_TEST(loads[2].variation.amplitude == 1.0);
  BOOST_TEST(loads[2].variation.mean == 0.0);
  BOOST_TEST(loads[3].from == 0.0);
  BOOST_TEST((loads[3].variation.table ==
              std::vector<std::pair<double, double>>{{0.0, 1.0}, {2.5, -1.0}}));
  BOOST_TEST(simulation::highest_harmonic(result.turbine) == 3);
}

BOOST_AUTO_TEST_CASE(a_tower_line_is_stated_in_n1_n2_n3_and_kept_in_the_beams_axes) {
  const model::BeamDefinition beam =
      read_text(minimal +
                replace(tower, "length: 30", "reference_line: [[0, 0, 0], [1, 2, 10], [2, 4, 20]]"))
          .turbine.tower;
  BOOST_REQUIRE(beam.reference_line.size() == 3u);
  BOOST_TEST((beam.reference_line[1] == Vector3(10, 1, 2)));  // a = (n3, n1, n2)
  BOOST_TEST(beam.length == std::sqrt(420.0), boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(a_blade_line_is_stated_in_blade_axes) {
  const model::BeamDefinition beam =
      read_text(replace(minimal, "length: 10",
                        "length: 10\n  reference_line: [[0, 0, 0], [5, 0, 0], [10, 0, 0]]"))
          .turbine.blades.beam;
  BOOST_TEST((beam.reference_line.at(1) == Vector3(5, 0, 0)));
  BOOST_TEST(beam.length == 10.0, boost::test_tools::tolerance(round_off));
}

BOOST_AUTO_TEST_CASE(byte_order_mark_and_windows_line_ends_are_accepted) {
  std::string text = "\xef\xbb\xbf" + minimal;
  for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) {
    text.replace(i, 1, "\r\n");
  }
  BOOST_TEST(read_text(text).turbine.blades.count == 2);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(files)

BOOST_AUTO_TEST_CASE(a_path_that_holds_no_case_is_named) {
  const Folder folder;
  const std::string missing = folder.path / "missing.yaml";
  BOOST_TEST(read_path_error(missing) == missing + ": no such file");
  BOOST_TEST(read_path_error(folder.path) ==
             folder.path.string() + ": a directory, expected a case file");
  const std::string file = folder.write("case.yaml", minimal);
  const std::string stem = file.substr(0, file.size() - 5);
  BOOST_TEST(read_path_error(stem) == stem + ": no such file; did you mean \"" + file + "\"?");
}

BOOST_AUTO_TEST_CASE(a_file_without_keys_is_refused) {
  for (const char* text : {"", "\n\n", "# only a comment\n", "---\n", "~\n"}) {
    check_error_start(text, "case.yaml: the file is empty");
  }
  check_error("just words\n", "case.yaml:1:1: expected keys with values, got \"just words\"");
  check_error("- 1\n- 2\n", "case.yaml:1:1: expected keys with values, got a list of 2");
}

BOOST_AUTO_TEST_CASE(bytes_that_are_no_text_are_refused_at_their_place) {
  check_error("samara: 1\ntitle: \x8a\xff\n",
              "case.yaml:2:8: a byte that is not UTF-8: this is not a text file");
  check_error(std::string("samara: 1\nab\0c: 1\n", 18),
              "case.yaml:2:3: a control character: this is not a text file");
  // 0x04 ends the file for yaml-cpp: what follows would be lost silently.
  check_error(minimal + "\x04gravity: wrong\n",
              "case.yaml:9:1: a control character: this is not a text file");
}

BOOST_AUTO_TEST_CASE(yaml_errors_have_their_place) {
  check_error_start(minimal + "title: a: b\n", "case.yaml:9:9: not valid YAML: illegal map value");
  check_error_start(minimal + "hub: {radius: 1\n", "case.yaml:10:1: not valid YAML:");
  check_error_start(minimal + "title: *nothing\n", "case.yaml:9:8: not valid YAML:");
  check_error_start("samara: 1\nblades:\n\tcount: 2\n", "case.yaml:3:7: not valid YAML:");
  check_error(minimal + "? [1, 2]\n: 3\n", "case.yaml:9:3: a key must be a plain word");
  check_error(minimal + "---\n" + minimal,
              "case.yaml: more than one YAML document (\"---\") in the file");
}

BOOST_AUTO_TEST_CASE(hostile_yaml_is_refused_without_harm) {
  for (const char* opening : {"[", "{a: ", "- ", "? "}) {
    std::string text;
    for (int i = 0; i < 20000; ++i) text += opening;
    check_error_start(text, "case.yaml:");
  }
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 30; ++i) {
    const std::string n = std::to_string(i);
    const std::string alias = "*a" + std::to_string(i - 1);
    bomb += "a" + n + ": &a" + n + " [" + alias + ", " + alias + ", " + alias + "]\n";
  }
  check_error_start(bomb, "case.yaml:10:15: the aliases expand to too many values");
  check_error(minimal + "hub: &hub {radius: *hub}\n",
              "case.yaml:9:20: an alias that refers to itself");
}

BOOST_AUTO_TEST_CASE(the_version_is_compulsory_and_checked) {
  check_error(replace(minimal, "samara: 1\n", ""),
              "case.yaml:1:1: missing key \"samara\" (the version of the case file: write `samara: "
              "1`)");
  check_error(replace(minimal, "samara: 1", "samara: one"),
              "case.yaml:1:1: samara: expected the version of the case file, 1, got \"one\"");
  check_error(replace(minimal, "samara: 1", "samara: 0"),
              "case.yaml:1:1: samara: expected the version of the case file, 1, got 0");
}

BOOST_AUTO_TEST_CASE(a_newer_version_hides_the_errors_that_follow_from_it) {
  check_error(replace(minimal, "samara: 1", "new_key: 3\nsamara: 2"),
              "case.yaml:2:1: samara: version 2 of the case file is newer than this program, which "
              "reads 1; use a newer samara");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(keys)

BOOST_AUTO_TEST_CASE(all_errors_come_at_once_in_the_order_of_the_file) {
  check_errors(minimal + "shaft:\n  speed: fast\n  tilt_deg: 95\ngravity: -1\nbaldes: 2\n", {},
               {"case.yaml:10:3: shaft.speed: expected a number >= 0, got \"fast\"",
                "case.yaml:11:3: shaft.tilt_deg: expected an angle between -90 and 90 degrees, got "
                "95",
                "case.yaml:12:1: gravity: expected a number >= 0, got -1",
                "case.yaml:13:1: unknown key \"baldes\"; did you mean \"blades\"?"});
}

BOOST_AUTO_TEST_CASE(unknown_keys_come_with_a_suggestion) {
  check_error(replace(minimal, "mass: 5", "mass: 5\n      twsit_deg: 3"),
              "case.yaml:7:7: unknown key \"twsit_deg\" in blades.sections[0]; did you mean "
              "\"twist_deg\"?");
  check_error(minimal + "shaft: {tilt: 3}\n",
              "case.yaml:9:9: unknown key \"tilt\" in shaft; did you mean \"tilt_deg\"?");
  check_error(replace(minimal, "EA: rigid", "ea: rigid"),
              "case.yaml:8:19: unknown key \"ea\" in blades.sections[0].stiffness; did you mean "
              "\"EA\"?");
  check_error_start(minimal + "hub: {colour: 1}\n",
                    "case.yaml:9:7: unknown key \"colour\" in hub; known keys: mass, ");
}

BOOST_AUTO_TEST_CASE(duplicate_keys_are_refused_where_they_stand) {
  check_error(minimal + "shaft:\n  speed: 6\n  overhang: 1\n  speed: 7\n",
              "case.yaml:12:3: duplicate key \"speed\" in shaft, first given in line 10");
  check_error(minimal + "gravity: 0\n\"gravity\": 0\n",
              "case.yaml:10:1: duplicate key \"gravity\", first given in line 9");
}

BOOST_AUTO_TEST_CASE(two_spellings_of_one_thing_are_refused) {
  check_error(minimal + "shaft:\n  speed_rpm: 60\n  speed: 6\n",
              "case.yaml:10:3: shaft.speed_rpm: given together with speed; leave one of them out");
  const std::string matrix =
      "      mass_matrix: [[5, 0, 0, 0, 0, 0], [0, 5, 0, 0, 0, 0], [0, 0, 5, 0, 0, 0],\n"
      "                    [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]]\n";
  check_errors(
      minimal + matrix, {},
      {"case.yaml:6:7: blades.sections[0].mass: given together with mass_matrix; leave one "
       "of them out",
       "case.yaml:7:7: blades.sections[0].inertia: given together with mass_matrix; leave "
       "one of them out"});
  check_error(minimal + "      stiffness_matrix: []\n",
              "case.yaml:9:7: blades.sections[0].stiffness_matrix: given together with stiffness; "
              "leave one of them out");
}

BOOST_AUTO_TEST_CASE(missing_keys_are_named) {
  check_error("samara: 1\n", "case.yaml:1:1: missing key \"blades\"");
  check_errors("samara: 1\nblades:\n  count: 2\n", {},
               {"case.yaml:2:1: blades: missing key \"length\" (or \"reference_line\")",
                "case.yaml:2:1: blades: missing key \"sections\" (a list; one entry is a uniform "
                "beam)"});
  check_error(replace(minimal, ", EI3: 3e6", ""),
              "case.yaml:8:7: blades.sections[0].stiffness: missing key \"EI3\" (a number > 0 or "
              "rigid)");
  check_error(replace(minimal, "      inertia: [1, 0.5, 0.5]\n", ""),
              "case.yaml:6:7: blades.sections[0]: missing key \"inertia\" (per length, or "
              "\"mass_matrix\")");
  check_error(replace(minimal,
                      "      stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: 1e6, EI2: "
                      "2e6, EI3: 3e6}\n",
                      ""),
              "case.yaml:6:7: blades.sections[0]: missing key \"stiffness\" (or "
              "\"stiffness_matrix\")");
}

BOOST_AUTO_TEST_CASE(blocks_need_keys) {
  check_error(
      minimal + "nacelle:\n",
      "case.yaml:9:1: nacelle: expected keys with values, got nothing; leave the key out, or "
      "write {}");
  check_error(minimal + "hub: 3\n", "case.yaml:9:1: hub: expected keys with values, got 3");
  check_error(minimal + "hub: [1, 2]\n",
              "case.yaml:9:1: hub: expected keys with values, got a list of 2");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(values)

BOOST_AUTO_TEST_CASE(numbers_must_be_finite_numbers) {
  const std::string place = "case.yaml:9:9: shaft.overhang: expected a finite number, got ";
  const auto check = [&](const std::string& value, const std::string& shown) {
    check_error(minimal + "shaft: {overhang: " + value + "}\n", place + shown);
  };
  check(".nan", ".nan");
  check("nan", "nan");
  check("-.inf", "-.inf");
  check("1e999", "1e999");
  check("true", "\"true\"");
  check("[1]", "a list of 1");
  check("{}", "a mapping");
  check("", "nothing");
  check("~", "nothing");
  check("0x10", "\"0x10\"");
  check("+-1", "\"+-1\"");
  check("\"2.4\"", "\"2.4\" in quotes; leave the quotes out");
  check("1d3", "\"1d3\"; did you mean 1e3?");
  check_error(minimal + "gravity: 9,81\n",
              "case.yaml:9:1: gravity: expected a number >= 0, got \"9,81\"; did you mean 9.81?");
}

BOOST_AUTO_TEST_CASE(numbers_may_be_written_as_yaml_writes_them) {
  for (const char* text : {"2.5", "+2.5", "25e-1", "2.5E0", "0.25e+1", "02.50"}) {
    BOOST_TEST(read_text(minimal + "shaft: {overhang: " + text + "}\n").turbine.shaft.overhang ==
               2.5);
  }
  BOOST_TEST(read_text(minimal + "shaft: {overhang: -.5}\n").turbine.shaft.overhang == -0.5);
}

BOOST_AUTO_TEST_CASE(integers_must_be_integers_in_their_range) {
  for (const char* value : {"4.5", "0", "-3", "99999999999"}) {
    check_error(replace(minimal, "length: 10", std::string("length: 10\n  elements: ") + value),
                std::string("case.yaml:5:3: blades.elements: expected an integer from 1 to 100000, "
                            "got ") +
                    value);
  }
  for (const char* value : {"4 elements", "true", "four"}) {
    check_error(replace(minimal, "length: 10", std::string("length: 10\n  elements: ") + value),
                std::string("case.yaml:5:3: blades.elements: expected an integer from 1 to 100000, "
                            "got \"") +
                    value + "\"");
  }
  check_error(replace(minimal, "count: 2", "count: 0"),
              "case.yaml:3:3: blades.count: expected an integer from 1 to 100, got 0");
  check_error(replace(minimal, "count: 2", "count: -1"),
              "case.yaml:3:3: blades.count: expected an integer from 1 to 100, got -1");
  check_error(replace(minimal, "count: 2", "order: 7"),
              "case.yaml:3:3: blades.order: expected an integer from 1 to 6, got 7");
  check_error(minimal + "floquet: {steps: 3}\n",
              "case.yaml:9:11: floquet.steps: expected an integer from 4 to 10000000, got 3");
  check_error(minimal + "trim: {harmonics: 201}\n",
              "case.yaml:9:8: trim.harmonics: expected an integer from 0 to 200 or auto, got 201");
}

BOOST_AUTO_TEST_CASE(lists_must_have_their_length) {
  check_error(minimal + "hub:\n  inertia: [1, 2]\n",
              "case.yaml:10:3: hub.inertia: expected a list of 3 numbers, got a list of 2");
  check_error(minimal + "hub:\n  inertia: 5\n",
              "case.yaml:10:3: hub.inertia: expected a list of 3 numbers, got 5");
  check_error(minimal + "hub:\n  inertia: [1,\n    two,\n    3]\n",
              "case.yaml:11:5: hub.inertia[1]: expected a number >= 0, got \"two\"");
  check_error(replace(minimal, "length: 10", "length: 10\n  damping: [0, 0, 0]"),
              "case.yaml:5:3: blades.damping: expected a list of 6 numbers, got a list of 3");
}

BOOST_AUTO_TEST_CASE(what_cannot_be_negative_is_refused) {
  const auto check = [](const std::string& block, const std::string& where,
                        const std::string& rule) {
    const Strings errors = read_errors(minimal + block);
    BOOST_REQUIRE(errors.size() == 1u);
    BOOST_TEST(errors[0].find(where + ": expected a number " + rule + ", got -1") !=
               std::string::npos);
  };
  check("nacelle: {mass: -1}\n", "nacelle.mass", ">= 0");
  check("nacelle: {inertia: [0, 0, -1]}\n", "nacelle.inertia[2]", ">= 0");
  check("nacelle: {yaw: {joint: free, damping: -1}}\n", "nacelle.yaw.damping", ">= 0");
  check("shaft: {speed: -1}\n", "shaft.speed", ">= 0");
  check("shaft: {speed_rpm: -1}\n", "shaft.speed_rpm", ">= 0");
  check("shaft: {inertia: {axial: -1}}\n", "shaft.inertia.axial", ">= 0");
  check("hub: {radius: -1}\n", "hub.radius", ">= 0");
  check("hub: {teeter: {stiffness: -1}}\n", "hub.teeter.stiffness", ">= 0");
  check("  tip_mass: -1\n", "blades.tip_mass", ">= 0");
  check("  damping: -1\n", "blades.damping", ">= 0, a list of 6 or damping ratios");
  check("  each: {1: {mass_factor: -1}}\n", "blades.each.1.mass_factor", "> 0");
  check("trim: {tolerance: -1}\n", "trim.tolerance", "from 1e-14 to 1e-3");
  check_error(replace(minimal, "length: 10", "length: 0"),
              "case.yaml:4:3: blades.length: expected a number > 0, got 0");
}

BOOST_AUTO_TEST_CASE(words_must_be_known) {
  check_error(minimal + "trim: {method: harmonic-balance}\n",
              "case.yaml:9:8: trim.method: expected harmonic_balance or shooting, got "
              "\"harmonic-balance\"; did you mean \"harmonic_balance\"?");
  check_error(minimal + "floquet: {period: half}\n",
              "case.yaml:9:11: floquet.period: expected auto, full or blade, got \"half\"");
  check_error(minimal + "title: [a, b]\n",
              "case.yaml:9:1: title: expected a text, got a list of 2");
}

BOOST_AUTO_TEST_CASE(what_is_not_available_yet_says_so) {
  check_error(minimal + "shaft:\n  torsion: {joint: prescribed, stiffness: 3}\n",
              "case.yaml:10:13: shaft.torsion.joint: expected free or locked, got \"prescribed\"");
  check_error(minimal + "shaft:\n  torsion: {joint: free}\n",
              "case.yaml:10:13: shaft.torsion.joint: a shaft that may twist needs a stiffness > 0");
  check_error(minimal +
                  "shaft:\n  torsion: {joint: free, stiffness: 1}\n"
                  "  generator: {joint: free}\n",
              "case.yaml:11:3: shaft.generator: a free generator behind a shaft that may twist "
              "needs an inertia > 0");
  check_error(minimal + "floquet:\n  time_order: 3\n",
              "case.yaml:10:3: floquet.time_order: expected 2, 4 or 6, got 3");
  check_error(minimal + "floquet:\n  accuracy: 0\n",
              "case.yaml:10:3: floquet.accuracy: expected a number from 1e-10 to 0.1, got 0");
}

BOOST_AUTO_TEST_CASE(a_yaw_block_must_state_its_joint) {
  check_error(minimal + "nacelle:\n  yaw: {stiffness: 3}\n",
              "case.yaml:10:3: nacelle.yaw: missing key \"joint\" (free, locked or prescribed)");
  check_error_start(minimal + "nacelle:\n  yaw: {joint: open}\n",
                    "case.yaml:10:9: nacelle.yaw.joint: expected free, locked or prescribed");
}

BOOST_AUTO_TEST_CASE(prescribed_angles_are_constant_or_harmonic) {
  const model::TurbineDefinition turbine =
      read_text(minimal +
                "nacelle:\n  yaw: {joint: prescribed, angle_deg: 8}\n"
                "hub:\n  teeter:\n    joint: prescribed\n"
                "    harmonic: {per_rev: 3, amplitude_deg: 2, phase_deg: 30}\n"
                "shaft: {speed: 2}\n")
          .turbine;
  BOOST_TEST((turbine.nacelle.yaw.kind == JointKind::prescribed));
  BOOST_TEST((turbine.hub.teeter.kind == JointKind::prescribed));
  const elements::JointMotion yaw = turbine.nacelle.yaw.motion.at(0.3, 2.0);
  BOOST_TEST(std::abs(yaw.angle - 8.0 * degree) < round_off);
  BOOST_TEST(yaw.rate == 0.0);
  const elements::JointMotion teeter = turbine.hub.teeter.motion.at(0.3, 2.0);
  const double turned = 3.0 * 2.0 * 0.3 + 30.0 * degree;
  BOOST_TEST(std::abs(teeter.angle - 2.0 * degree * std::cos(turned)) < round_off);
  BOOST_TEST(std::abs(teeter.rate + 6.0 * 2.0 * degree * std::sin(turned)) < round_off);
  BOOST_TEST(std::abs(teeter.acceleration + 36.0 * teeter.angle) < round_off);
  const Case many = read_text(minimal +
                              "nacelle: {yaw: {joint: prescribed, harmonic: {per_rev: 7, "
                              "amplitude_deg: 2}}}\nshaft: {speed: 2}\n");
  BOOST_TEST(simulation::highest_harmonic(many.turbine) == 7);
}

BOOST_AUTO_TEST_CASE(a_prescribed_angle_must_be_stated_and_only_there) {
  check_error(minimal + "nacelle:\n  yaw: {joint: prescribed}\n",
              "case.yaml:10:3: nacelle.yaw: missing key \"angle_deg\" (of a prescribed joint, or "
              "\"harmonic\")");
  check_error(minimal + "nacelle:\n  yaw: {joint: prescribed, angle_deg: 8, stiffness: 4}\n",
              "case.yaml:10:42: nacelle.yaw.stiffness: springs and dampers have no effect on "
              "a prescribed joint");
  check_error(minimal + "nacelle:\n  yaw: {joint: locked, angle_deg: 8}\n",
              "case.yaml:10:24: nacelle.yaw.angle_deg: only a joint: prescribed has a motion");
  check_error(minimal + "hub:\n  teeter: {harmonic: {per_rev: 1}}\n",
              "case.yaml:10:12: hub.teeter.harmonic: only a joint: prescribed has a motion");
  check_error(minimal + "nacelle:\n  yaw: {joint: prescribed, harmonic: {per_rev: 1}}\n",
              "case.yaml:10:28: nacelle.yaw.harmonic: missing key \"amplitude_deg\"");
  check_error(minimal +
                  "nacelle:\n  yaw: {joint: prescribed, harmonic: {per_rev: 1, frequency: 2, "
                  "amplitude_deg: 1}}\n",
              "case.yaml:10:51: nacelle.yaw.harmonic.frequency: given together with per_rev; "
              "leave one of them out");
  check_error(
      replace(minimal, "count: 2", "count: 3") +
          "hub:\n  teeter: {joint: prescribed, angle_deg: 1}\n",
      "case.yaml:10:12: hub.teeter.joint: a teeter hinge carries two blades, blades.count is 3; "
      "use joint: locked, or leave teeter out");
}

BOOST_AUTO_TEST_CASE(a_teeter_hinge_is_for_two_blades) {
  const std::string three = replace(minimal, "count: 2", "count: 3");
  check_error(
      three + "hub:\n  teeter: {joint: free}\n",
      "case.yaml:10:12: hub.teeter.joint: a teeter hinge carries two blades, blades.count is 3; "
      "use joint: locked, or leave teeter out");
  BOOST_TEST(read_text(three + "hub: {teeter: {joint: locked}}\n").turbine.blades.count == 3);
  const std::string one = replace(minimal, "count: 2", "count: 1");
  BOOST_TEST(read_text(one + "hub: {teeter: {joint: free}}\n").turbine.blades.count == 1);
}

BOOST_AUTO_TEST_CASE(only_blades_that_exist_can_differ) {
  check_error(minimal + "  each:\n    3: {pitch_deg: 1}\n",
              "case.yaml:10:5: blades.each: expected a blade number from 1 to 2, got \"3\"");
  check_error(
      minimal + "  each:\n    1: {pitch: 1}\n",
      "case.yaml:10:9: unknown key \"pitch\" in blades.each.1; did you mean \"pitch_deg\"?");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(sections)

namespace {
const std::string end_sections = R"(samara: 1
blades:
  length: 10
  sections:
    - {at: 0, mass: 5, inertia: [1, 1, 1],
       stiffness: {EA: 1, GA2: 1, GA3: 1, GJ: 1, EI2: 1, EI3: 1}}
    - {at: 1, mass: 5, inertia: [1, 1, 1],
       stiffness: {EA: 1, GA2: 1, GA3: 1, GJ: 1, EI2: 1, EI3: 1}}
)";
}

BOOST_AUTO_TEST_CASE(mass_per_length_must_be_positive) {
  for (const char* mass : {"0", "-1", "rigid"}) {
    const Strings errors = read_errors(replace(minimal, "mass: 5", std::string("mass: ") + mass));
    BOOST_REQUIRE(errors.size() == 1u);
    BOOST_TEST(errors[0].starts_with(
        "case.yaml:6:7: blades.sections[0].mass: expected a number > 0, got "));
  }
}

BOOST_AUTO_TEST_CASE(stiffness_must_be_positive_or_rigid) {
  check_error(
      replace(minimal, "GJ: 1e6", "GJ: 0"),
      "case.yaml:8:54: blades.sections[0].stiffness.GJ: expected a number > 0 or rigid, got "
      "0");
  check_error(
      replace(minimal, "GJ: 1e6", "GJ: stiff"),
      "case.yaml:8:54: blades.sections[0].stiffness.GJ: expected a number > 0 or rigid, got "
      "\"stiff\"");
}

BOOST_AUTO_TEST_CASE(a_faulty_section_is_reported_at_its_line) {
  check_error(
      replace(minimal, "inertia: [1, 0.5, 0.5]", "inertia: [0, 0, 0]"),
      "case.yaml:6:7: blades.sections[0]: the section has no inertia about b1: give it one, "
      "or make GJ rigid");
  const std::string stiffness =
      minimal.substr(0, minimal.find("      stiffness")) +
      "      stiffness_matrix: [[1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0],\n"
      "                         [0, 0, 0, 1, 2, 0], [0, 0, 0, 2, 1, 0], [0, 0, 0, 0, 0, 1]]\n";
  check_error(
      stiffness,
      "case.yaml:6:7: blades.sections[0]: the stiffness matrix is not positive definite: its "
      "coupling terms are too large for its diagonal");
  check_error(
      replace(stiffness, "[0, 0, 0, 1, 2, 0]", "[0, 0, 0, 1, 0, 0]"),
      "case.yaml:6:7: blades.sections[0]: the stiffness matrix is not symmetric: entries (5, "
      "4) and (4, 5) differ");
  check_error(
      replace(stiffness, "[0, 0, 0, 1, 2, 0]", "[0, 0, 0, rigid, 2, 0]"),
      "case.yaml:6:7: blades.sections[0]: the row and column of a rigid strain must be 0 in "
      "the stiffness matrix (row 4)");
  check_error(
      replace(stiffness, "[0, 0, 0, 1, 2, 0]", "[0, 0, 0, 1, rigid, 0]"),
      "case.yaml:9:39: blades.sections[0].stiffness_matrix[3][4]: expected a finite number, "
      "got \"rigid\"");
  check_error(
      replace(stiffness, "[0, 0, 0, 1, 2, 0]", "[0, 0, 0, 1, 2]"),
      "case.yaml:9:26: blades.sections[0].stiffness_matrix[3]: expected a list of 6 numbers, "
      "got a list of 5");
}

BOOST_AUTO_TEST_CASE(an_inertia_too_small_for_its_mass_center_is_refused) {
  check_error(
      replace(minimal, "mass: 5", "mass: 5\n      mass_center: [1, 0]"),
      "case.yaml:6:7: blades.sections[0]: the mass matrix is not positive semi-definite: the "
      "inertia about the reference line is too small for the offset of the mass centre");
}

BOOST_AUTO_TEST_CASE(stations_must_rise_from_0_to_1) {
  BOOST_TEST(read_text(end_sections).turbine.blades.beam.sections.size() == 2u);
  check_error(
      replace(end_sections, "at: 1", "at: 0"),
      "case.yaml:7:8: blades.sections[1].at: expected more than the section before has, got "
      "0");
  check_error(replace(end_sections, "at: 1", "at: 1.1"),
              "case.yaml:7:8: blades.sections[1].at: expected a number from 0 to 1, got 1.1");
  check_error(replace(end_sections, "at: 1, ", ""),
              "case.yaml:7:7: blades.sections[1]: missing key \"at\" (the fraction of the length, "
              "from 0 to 1)");
}

BOOST_AUTO_TEST_CASE(a_strain_is_rigid_everywhere_or_nowhere) {
  check_error(replace(end_sections, "EA: 1", "EA: rigid"),
              "case.yaml:7:7: blades.sections[1]: a strain that is rigid in one section must be "
              "rigid in all sections of the beam");
}

BOOST_AUTO_TEST_CASE(sections_must_be_a_list_that_is_not_empty) {
  const std::string start = "samara: 1\nblades:\n  length: 10\n  sections: ";
  check_error(start + "[]\n",
              "case.yaml:4:3: blades.sections: expected a list of sections (each starts with \"- "
              "\"), got a list of 0");
  check_error(start + "{mass: 3}\n",
              "case.yaml:4:3: blades.sections: expected a list of sections (each starts with \"- "
              "\"), got a mapping");
}

BOOST_AUTO_TEST_CASE(loads_are_checked) {
  const auto refuse = [](const std::string& load, const Strings& expected) {
    check_errors(minimal + "loads:\n  - " + load + "\n", {}, expected);
  };
  check_error(minimal + "loads: {beam: tower}\n",
              "case.yaml:9:1: loads: expected a list of loads (each starts with \"- \"), got a "
              "mapping");
  refuse("{beam: tower, at: 1, force: [0, 0, 1]}",
         {"case.yaml:10:6: loads[0].beam: there is no tower"});
  refuse("{beam: blade 3, at: 1, force: [0, 0, 1]}",
         {"case.yaml:10:6: loads[0].beam: expected tower, blades or a blade from 1 to 2 (blade 1), "
          "got \"blade 3\""});
  refuse("{at: 1, force: [0, 0, 1]}", {"case.yaml:10:5: loads[0]: missing key \"beam\" (tower, "
                                       "blades or one of them: blade 1)"});
  refuse("{beam: blades, at: 1}",
         {"case.yaml:10:5: loads[0]: missing key \"force\" (or \"moment\", or both)"});
  refuse("{beam: blades, force: [0, 0, 1]}", {"case.yaml:10:5: loads[0]: missing key \"at\" (a "
                                              "point load, or \"from\" and \"to\")"});
  refuse("{beam: blades, from: 0.5, force: [0, 0, 1]}",
         {"case.yaml:10:5: loads[0]: missing key \"to\" (beside \"from\")"});
  refuse("{beam: blades, from: 0.5, to: 0.5, force: [0, 0, 1]}",
         {"case.yaml:10:31: loads[0].to: expected more than from, got 0.5"});
  refuse("{beam: blades, at: 0.5, from: 0, to: 1.2, force: [0, 0, 1]}",
         {"case.yaml:10:29: loads[0].from: given together with at; leave one of them out",
          "case.yaml:10:38: loads[0].to: given together with at; leave one of them out"});
  refuse("{beam: blades, at: 1, force: [0, 0, 1], follower: maybe, harmonic: {}, table: [[0, 1]]}",
         {"case.yaml:10:45: loads[0].follower: expected true or false, got \"maybe\"",
          "case.yaml:10:62: loads[0].harmonic: missing key \"per_rev\" (or \"frequency\")",
          "case.yaml:10:76: loads[0].table: given together with harmonic; leave one of them out"});
  refuse("{beam: blades, at: 1, force: [0, 0, 1], harmonic: {amplitude: 2}}",
         {"case.yaml:10:45: loads[0].harmonic: missing key \"per_rev\" (or \"frequency\")"});
  refuse("{beam: blades, at: 1, force: [0, 0, 1], table: [[0, 1], [0, 2]]}",
         {"case.yaml:10:61: loads[0].table[1]: t must be more than in the entry before"});
}

BOOST_AUTO_TEST_CASE(point_masses_are_checked) {
  const std::string masses = minimal + "  point_masses:\n    - ";
  const std::string where = "blades.point_masses[0]";
  check_error(masses + "{at: 0, mass: 1}\n",
              "case.yaml:10:8: " + where + ".at: expected a number above 0, to 1, got 0");
  check_error(masses + "{at: 0.5, mass: 0}\n",
              "case.yaml:10:17: " + where + ".mass: expected a number > 0, got 0");
  check_error(masses + "{mass: 1}\n", "case.yaml:10:7: " + where + ": missing key \"at\"");
  check_error(masses + "{at: 0.5, mass: 1, inertia: [1, -1, 0]}\n",
              "case.yaml:10:39: " + where + ".inertia[1]: expected a number >= 0, got -1");
}

BOOST_AUTO_TEST_CASE(reference_lines_are_checked) {
  const auto check = [](const std::string& line, const std::string& expected) {
    check_error(replace(minimal, "length: 10", "reference_line: " + line), expected);
  };
  const std::string where = "blades.reference_line";
  check("[[0, 0, 0]]", "case.yaml:4:3: " + where +
                           ": expected a list of at least 2 points of 3 numbers, got a list of 1");
  check("[[0, 0, 0], [1, 0]]",
        "case.yaml:4:31: " + where + "[1]: expected a list of 3 numbers, got a list of 2");
  check(
      "[[1, 0, 0], [2, 0, 0]]",
      "case.yaml:4:20: " + where + "[0]: the first point must be [0, 0, 0], the root of the beam");
  check("[[0, 0, 0], [2, 0, 0], [2, 0, 0]]",
        "case.yaml:4:42: " + where + "[2]: the same point as the one before");
  check("[[0, 0, 0], [9, 0, 0]]\n  length: 10",
        "case.yaml:5:3: blades.length: the arc length of reference_line is 9.000000, got 10; leave "
        "length out");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(settings)

BOOST_AUTO_TEST_CASE(settings_replace_and_add_keys) {
  const Case result = read_text(
      minimal, {"blades.elements=8", "blades.sections.0.mass=10", "blades.each.2.pitch_deg=90",
                "shaft.speed=3", "hub.inertia=[1, 2, 3]", "hub.inertia.1=7",
                "hub.teeter={joint: locked}", "blades.elements=9", "title=a = b"});
  BOOST_TEST(result.turbine.blades.beam.elements == 9);
  BOOST_TEST(result.turbine.blades.beam.sections.at(0).mass(0, 0) == 10.0);
  BOOST_TEST(result.turbine.blades.each.at(2).pitch == 90 * degree,
             boost::test_tools::tolerance(round_off));
  BOOST_TEST(result.turbine.shaft.speed == 3.0);
  BOOST_TEST((result.turbine.hub.inertia == Vector3(1, 7, 3)));
  BOOST_TEST((result.turbine.hub.teeter.kind == JointKind::locked));
  BOOST_TEST(result.turbine.title == "a = b");
}

BOOST_AUTO_TEST_CASE(a_setting_replaces_the_other_spelling) {
  const std::string text = minimal + "shaft: {speed: 6}\n";
  BOOST_TEST(read_text(text, {"shaft.speed_rpm=30"}).turbine.shaft.speed == std::numbers::pi,
             boost::test_tools::tolerance(round_off));
  const std::string matrix =
      "[[rigid,0,0,0,0,0],[0,rigid,0,0,0,0],[0,0,rigid,0,0,0],[0,0,0,1,0,0],[0,0,0,0,2,0],"
      "[0,0,0,0,0,3]]";
  const Case result = read_text(text, {"blades.sections.0.stiffness_matrix=" + matrix});
  BOOST_TEST(result.turbine.blades.beam.sections.at(0).stiffness(5, 5) == 3.0);
}

BOOST_AUTO_TEST_CASE(the_text_of_a_case_states_its_settings_above_the_file) {
  const Strings settings = {"blades.elements=8", "gravity=0"};
  const Case result = read_text(minimal, settings);
  BOOST_TEST(result.text == "# --set blades.elements=8\n# --set gravity=0\n" + minimal);
  BOOST_TEST(result.settings == settings, boost::test_tools::per_element());
  BOOST_TEST(read_text(minimal).text == minimal);
}

BOOST_AUTO_TEST_CASE(errors_of_settings_name_the_setting) {
  check_setting_error("shaft.speed=fast", "expected a number >= 0, got \"fast\"");
  check_setting_error("blades.elments=8", "unknown key \"elments\"; did you mean \"elements\"?");
  check_setting_error("blads.elements=8", "unknown key \"blads\"; did you mean \"blades\"?");
  check_setting_error("hub.inertia=[1, 2, three]",
                      "hub.inertia[2]: expected a number >= 0, got \"three\"");
  check_setting_error("blades.sections.0.mass=-1", "expected a number > 0, got -1");
  check_setting_error("gravity=", "expected a number >= 0, got nothing");
  check_setting_error("gravity=[1",
                      "not valid YAML: end of sequence flow not found (a \"[\" is not "
                      "closed, or a comma is missing)");
}

BOOST_AUTO_TEST_CASE(a_setting_that_makes_a_section_faulty_is_blamed) {
  check_setting_error(
      "blades.sections.0.inertia.0=0",
      "blades.sections[0]: the section has no inertia about b1: give it one, or make "
      "GJ rigid");
  check_errors(
      minimal + "hub: {teeter: {}}\n", {"blades.count=3"},
      {"--set blades.count=3: hub.teeter.joint: a teeter hinge carries two blades, blades.count "
       "is 3; use joint: locked, or leave teeter out"});
}

BOOST_AUTO_TEST_CASE(malformed_settings_are_refused) {
  const std::string form = "expected key=value in one line, e.g. blades.elements=8";
  for (const char* setting :
       {"blades.elements", "=8", "blades..elements=8", ".gravity=1", "gravity.=1", ""}) {
    check_setting_error(setting, form);
  }
  // A line break would let a setting leave its comment line in the text of the case.
  BOOST_TEST(!read_errors(minimal, {"title=a\nsamara: 1"}).empty());
}

BOOST_AUTO_TEST_CASE(settings_cannot_enter_what_has_no_such_item) {
  check_setting_error("blades.sections.1.mass=1",
                      "blades.sections is a list with items 0 to 0, it has no item \"1\"");
  check_setting_error("blades.sections.mass=1",
                      "blades.sections is a list with items 0 to 0, it has no item \"mass\"");
  check_setting_error("blades.count.x=1", "blades.count is a value, it has no key \"x\"");
}

BOOST_AUTO_TEST_CASE(errors_of_the_file_and_of_settings_come_together) {
  check_errors(minimal + "gravity: down\n", {"nonsense", "shaft.speed=fast"},
               {"case.yaml:9:1: gravity: expected a number >= 0, got \"down\"",
                "--set nonsense: expected key=value in one line, e.g. blades.elements=8",
                "--set shaft.speed=fast: expected a number >= 0, got \"fast\""});
}

BOOST_AUTO_TEST_SUITE_END()
