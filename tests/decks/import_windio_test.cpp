#include <algorithm>
#include <cmath>
#include <numbers>

#include "import_test.hpp"

namespace {

using namespace samara;
using namespace samara::test;
using decks::Import;
using decks::import_windio;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double round_off = 1e-13;
const decks::ImportOptions tower_only{true};

bool is_near(double a, double b) {
  return std::abs(a - b) <= round_off * std::max(1.0, std::abs(b));
}

model::TurbineDefinition read_second() {
  const DeckFolder folder("windio");
  return parse(import_windio(folder / "second.yaml", tower_only)).turbine;
}

const std::vector<double> blade_at = {0.0, 0.3, 0.7, 1.0};

double ring_area(double outer, double wall) { return std::numbers::pi * wall * (outer - wall); }

}  // namespace

BOOST_AUTO_TEST_SUITE(import_windio_suite)

BOOST_AUTO_TEST_CASE(an_upwind_rotor_has_negative_overhang_tilt_and_precone) {
  const model::TurbineDefinition t = read_second();
  BOOST_TEST(is_near(t.shaft.tilt, -5.0 * degree));
  BOOST_TEST(is_near(t.blades.precone, -2.5 * degree));
  // The hub stands 3.2 m upwind of the yaw axis and 1.5 m above the tower top.
  const double tilt = t.shaft.tilt;
  BOOST_TEST(is_near(t.shaft.overhang * std::cos(tilt), -3.2));
  BOOST_TEST(is_near(t.shaft.height + t.shaft.overhang * std::sin(tilt), 1.5));
  BOOST_TEST(is_near(t.shaft.speed, 18.5 * std::numbers::pi / 30.0));
  BOOST_TEST(t.hub.center_of_mass == 0.15);
}

BOOST_AUTO_TEST_CASE(a_downwind_rotor_has_positive_ones) {
  const DeckFolder folder("windio");
  folder.replace("second.yaml", "rotor_orientation: Upwind", "rotor_orientation: Downwind");
  const model::TurbineDefinition t =
      parse(import_windio(folder / "second.yaml", tower_only)).turbine;
  BOOST_TEST(is_near(t.shaft.tilt, 5.0 * degree));
  BOOST_TEST(is_near(t.blades.precone, 2.5 * degree));
  BOOST_TEST(is_near(t.shaft.overhang * std::cos(t.shaft.tilt), 3.2));
  BOOST_TEST(is_near(t.shaft.height + t.shaft.overhang * std::sin(t.shaft.tilt), 1.5));
  BOOST_TEST(t.hub.center_of_mass == -0.15);
}

BOOST_AUTO_TEST_CASE(bodies_keep_their_masses_and_moments) {
  const model::TurbineDefinition t = read_second();
  BOOST_TEST(t.nacelle.mass == 9000.0);
  BOOST_TEST(t.nacelle.center_of_mass == Vector3(-0.2, -0.6, 0.75));
  BOOST_TEST(t.nacelle.inertia == Vector3(20000.0, 8000.0, 18000.0));
  BOOST_TEST(t.tower.tip_mass == 450.0);
  BOOST_TEST(t.hub.mass == 2500.0);
  BOOST_TEST(t.hub.radius == 1.5);
  // About the apex, as the deck has it.
  const double shift = 2500.0 * 0.15 * 0.15;
  BOOST_TEST(is_near(t.hub.inertia(0) + shift, 1500.0));
  BOOST_TEST(is_near(t.hub.inertia(1), 1900.0));
  BOOST_TEST(is_near(t.hub.inertia(2) + shift, 1450.0));
  BOOST_TEST(is_near(t.shaft.generator.inertia, 14.25));
  BOOST_TEST(t.shaft.gear_ratio == 22.0);
}

BOOST_AUTO_TEST_CASE(masses_of_a_blade_survive) {
  const model::BeamDefinition blade = read_second().blades.beam;
  BOOST_TEST(blade.length == 20.0);
  require_same(integrate(blade, 0, 0), integrate(blade_at, {180.0, 110.0, 60.0, 14.0}, 20.0));
  require_same(integrate(blade, 0, 4), integrate(blade_at, {3.6, 3.3, 1.2, 0.14}, 20.0));
  require_same(integrate(blade, 0, 5), integrate(blade_at, {-5.4, 11.0, 5.4, 0.56}, 20.0));
  require_same(integrate(blade, 3, 3), integrate(blade_at, {75.0, 36.0, 11.0, 1.5}, 20.0));
  require_same(integrate(blade, 4, 4), integrate(blade_at, {35.0, 11.0, 3.0, 0.3}, 20.0));
  require_same(integrate(blade, 5, 5), integrate(blade_at, {40.0, 25.0, 8.0, 1.2}, 20.0));
  // icp is the integral of x y; with b2 = -y and b3 = x the entry of b2 and b3 is + icp.
  require_same(integrate(blade, 4, 5), integrate(blade_at, {1.5, -1.0, 0.4, 0.05}, 20.0));
}

BOOST_AUTO_TEST_CASE(blade_axes_are_turned) {
  const model::BeamDefinition blade = read_second().blades.beam;
  const model::SectionDefinition& root = blade.sections[0];
  BOOST_TEST(root.stiffness(0, 0) == 5e9);    // K33
  BOOST_TEST(root.stiffness(4, 4) == 6.1e8);  // K55, flap
  BOOST_TEST(root.stiffness(5, 5) == 7.2e8);  // K44, edge
  BOOST_TEST(root.stiffness(0, 5) == 5e7);    // K34: z with x
  BOOST_TEST(root.stiffness(0, 4) == 6e7);    // K35 = -6e7: z with -y
  BOOST_TEST(root.stiffness(1, 2) == -2e7);   // K12: -y with x
  BOOST_TEST(root.stiffness(2, 3) == -3e6);   // K16: x with z
  BOOST_TEST(root.stiffness(1, 3) == -4e6);   // K26: -y with z
  BOOST_TEST(root.stiffness(4, 5) == -7e6);   // K45: -y with x
  BOOST_TEST(is_near(root.twist, 12.5 * degree));
  Vector6 damping;
  damping << 3e-3, 2e-3, 1e-3, 6e-3, 5e-3, 4e-3;
  BOOST_TEST(blade.damping == damping);
}

BOOST_AUTO_TEST_CASE(the_tower_is_made_of_exact_rings) {
  const model::BeamDefinition tower = read_second().tower;
  BOOST_TEST(tower.length == 40.0);
  // The wall jumps at half height.
  const std::vector<double> mass = {
      ring_area(3.0, 0.02) * 7800.0 * 1.07, ring_area(2.5, 0.02) * 7800.0 * 1.07,
      ring_area(2.5, 0.012) * 7800.0 * 1.07, ring_area(2.0, 0.012) * 7800.0 * 1.07};
  const auto behind = std::find_if(tower.sections.begin(), tower.sections.end(),
                                   [](const auto& section) { return section.at >= 0.5; }) +
                      1;
  const auto half = static_cast<std::size_t>(behind - tower.sections.begin());
  BOOST_REQUIRE(std::abs(behind->at - 0.5) < 1e-9);
  BOOST_TEST(is_near(tower.sections[0].mass(0, 0), mass[0]));
  BOOST_TEST(is_near(tower.sections[half - 1].mass(0, 0), mass[1]));
  BOOST_TEST(is_near(tower.sections[half].mass(0, 0), mass[2]));
  BOOST_TEST(is_near(tower.sections.back().mass(0, 0), mass[3]));
  require_same(integrate(tower, 0, 0), integrate({0.0, 0.5, 0.5, 1.0}, mass, 40.0));
  // The stiffness, which is not linear between the stations of the deck, is that of the ring.
  for (std::size_t i = 1; i < tower.sections.size(); ++i) {
    const model::SectionDefinition& a = tower.sections[i - 1];
    const model::SectionDefinition& b = tower.sections[i];
    const double outer = 3.0 - 0.5 * (a.at + b.at);
    const double inner = outer - 2.0 * (i < half ? 0.02 : 0.012);
    const double ring = 2e11 * std::numbers::pi / 64.0 * (std::pow(outer, 4) - std::pow(inner, 4));
    if (i != half)
      BOOST_TEST(std::abs(0.5 * (a.stiffness(4, 4) + b.stiffness(4, 4)) / ring - 1.0) < 1e-3);
  }
  const model::SectionDefinition& foot = tower.sections[0];
  const double second = std::numbers::pi / 64.0 * (std::pow(3.0, 4) - std::pow(2.96, 4));
  BOOST_TEST(is_near(foot.stiffness(4, 4), 2e11 * second));
  BOOST_TEST(is_near(foot.stiffness(5, 5), 2e11 * second));
  BOOST_TEST(is_near(foot.stiffness(3, 3), 2.0 * 79.3e9 * second));
  BOOST_TEST(is_near(foot.stiffness(0, 0), 2e11 * ring_area(3.0, 0.02)));
  BOOST_TEST(is_near(foot.mass(4, 4), 7800.0 * 1.07 * second));
  BOOST_TEST(is_near(foot.mass(3, 3), 2.0 * 7800.0 * 1.07 * second));
  // A thin ring carries half of its area in shear, a little more for a positive Poisson ratio.
  const double share = foot.stiffness(1, 1) / (79.3e9 * ring_area(3.0, 0.02));
  BOOST_TEST((share > 0.5 && share < 0.56));
}

BOOST_AUTO_TEST_CASE(the_greatest_tip_speed_limits_the_rotor_speed) {
  const DeckFolder folder("windio");
  const auto speed = [&] {
    return parse(import_windio(folder / "first.yaml", tower_only)).turbine.shaft.speed;
  };
  const double before = speed();
  folder.replace("first.yaml", "  torque:\n    VS_maxspd: 1.9373154697137058",
                 "  supervisory: {maxTS: 20}\n  torque:\n    VS_maxspd: 1.9373154697137058");
  const std::string text = folder.text("first.yaml");
  const std::size_t assembly = text.find("assembly:");
  BOOST_REQUIRE(assembly != std::string::npos);
  const std::size_t line = text.find('\n', assembly) + 1;
  std::string other = text;
  folder.write("first.yaml", other.insert(line, "  rotor_diameter: 40\n"));
  BOOST_TEST(before > 1.0);
  BOOST_TEST(is_near(speed(), 1.0));
  folder.replace("first.yaml", "maxTS: 20", "maxTS: 200");
  BOOST_TEST(is_near(speed(), before));
}

BOOST_AUTO_TEST_CASE(both_versions_give_the_same_turbine) {
  const DeckFolder folder("windio");
  const model::TurbineDefinition a =
      parse(import_windio(folder / "first.yaml", tower_only)).turbine;
  const model::TurbineDefinition b = read_second();
  BOOST_TEST(is_near(a.shaft.tilt, b.shaft.tilt));
  BOOST_TEST(is_near(a.shaft.overhang, b.shaft.overhang));
  BOOST_TEST(is_near(a.shaft.height, b.shaft.height));
  BOOST_TEST(is_near(a.shaft.speed, b.shaft.speed));
  BOOST_TEST(is_near(a.shaft.generator.inertia, b.shaft.generator.inertia));
  BOOST_TEST(a.shaft.gear_ratio == b.shaft.gear_ratio);
  BOOST_TEST(is_near(a.blades.precone, b.blades.precone));
  BOOST_TEST(a.nacelle.center_of_mass == b.nacelle.center_of_mass);
  BOOST_TEST(a.nacelle.inertia == b.nacelle.inertia);
  BOOST_TEST(a.hub.inertia == b.hub.inertia);
  BOOST_TEST(a.tower.tip_mass == b.tower.tip_mass);
  BOOST_REQUIRE(a.blades.beam.sections.size() == b.blades.beam.sections.size());
  for (std::size_t i = 0; i < a.blades.beam.sections.size(); ++i) {
    const model::SectionDefinition& p = a.blades.beam.sections[i];
    const model::SectionDefinition& q = b.blades.beam.sections[i];
    BOOST_TEST((p.mass - q.mass).norm() <= round_off * q.mass.norm());
    BOOST_TEST((p.stiffness - q.stiffness).norm() <= round_off * q.stiffness.norm());
    BOOST_TEST(is_near(p.twist, q.twist));
  }
}

BOOST_AUTO_TEST_CASE(a_curved_axis_makes_a_line) {
  const DeckFolder folder("windio");
  folder.replace("second.yaml", "x: {grid: [0.0, 1.0], values: [0.0, 0.0]}",
                 "x: {grid: [0.0, 0.5, 1.0], values: [0.0, -0.2, -1.0]}");
  folder.replace("second.yaml", "y: {grid: [0.0, 1.0], values: [0.0, 0.0]}",
                 "y: {grid: [0.0, 1.0], values: [0.0, 0.5]}");
  const model::BeamDefinition blade =
      parse(import_windio(folder / "second.yaml", tower_only)).turbine.blades.beam;
  BOOST_REQUIRE(blade.reference_line.size() == 3u);
  BOOST_TEST(blade.reference_line[1] == Vector3(10.0, -0.25, -0.2));
  BOOST_TEST(blade.reference_line[2] == Vector3(20.0, -0.5, -1.0));
}

BOOST_AUTO_TEST_CASE(an_implausible_monopile_is_refused_by_name_with_what_to_do) {
  const DeckFolder folder("windio");
  const std::string message = message_of([&] { import_windio(folder / "second.yaml", {}); });
  BOOST_TEST(holds(message, "second.yaml:"));
  BOOST_TEST(holds(message, "components.monopile: "));
  BOOST_TEST(holds(message, "2.5e+09 kg/m is implausible"));
  BOOST_TEST(!holds(message, "\n"));
  BOOST_TEST(holds(message, "--tower-only"));
}

BOOST_AUTO_TEST_CASE(an_implausible_tower_is_refused) {
  const DeckFolder folder("windio");
  folder.replace("second.yaml", "values: [0.02, 0.02, 0.012, 0.012]",
                 "values: [20.0, 20.0, 12.0, 12.0]");
  BOOST_TEST(holds(message_of([&] { import_windio(folder / "second.yaml", tower_only); }),
                   "does not fit"));
  folder.replace("second.yaml", "values: [20.0, 20.0, 12.0, 12.0]",
                 "values: [0.02, 0.02, 0.012, 0.012]");
  folder.replace("second.yaml", "rho: 7800", "rho: 7800000");
  BOOST_TEST(
      holds(message_of([&] { import_windio(folder / "second.yaml", tower_only); }), "implausible"));
}

BOOST_AUTO_TEST_CASE(degrees_taken_for_radians_are_refused) {
  const DeckFolder folder("windio");
  folder.replace("second.yaml", "windIO_version: \"2.0\"\n", "");
  BOOST_TEST(
      holds(message_of([&] { import_windio(folder / "second.yaml", tower_only); }), "implausible"));
}

BOOST_AUTO_TEST_CASE(missing_and_wrong_values_come_at_once_with_their_lines) {
  const DeckFolder folder("windio");
  folder.replace("second.yaml", "  hub:\n    diameter: 3.0", "  hub:\n    diametre: 3.0");
  folder.replace("second.yaml", "uptilt: 5.0", "uptilt: steep");
  folder.replace("second.yaml", "z: {grid: [0.0, 0.5, 1.0], values: [0.0, 10.0, 20.0]}",
                 "z: {grid: [0.0, 0.5, 1.0], values: [0.0, 10.0]}");
  const std::string message =
      message_of([&] { import_windio(folder / "second.yaml", tower_only); });
  BOOST_TEST(holds(message, "second.yaml: missing key \"components.hub.diameter\""));
  BOOST_TEST(holds(message, "uptilt: expected a number, got \"steep\""));
  BOOST_TEST(holds(message, "components.blade.reference_axis.z: grid has 3 places, values 2"));
}

BOOST_AUTO_TEST_CASE(what_a_deck_leaves_out_is_said) {
  const DeckFolder folder("windio");
  folder.replace("second.yaml", "control:\n  rated_rotor_speed: 18.5\n", "");
  const Import import = import_windio(folder / "second.yaml", tower_only);
  BOOST_TEST(parse(import).turbine.shaft.speed == 0.0);
  BOOST_TEST(std::any_of(import.report.begin(), import.report.end(), [](const auto& line) {
    return holds(line.words, "shaft.speed_rpm is 0");
  }));
}

BOOST_AUTO_TEST_CASE(line_ends_do_not_matter) {
  const DeckFolder folder("windio");
  const std::string expected = import_windio(folder / "second.yaml", tower_only).text;
  std::string text;
  for (const char c : folder.text("second.yaml")) text += c == '\n' ? "\r\n" : std::string(1, c);
  folder.write("second.yaml", "\xef\xbb\xbf" + text);
  BOOST_TEST(import_windio(folder / "second.yaml", tower_only).text == expected);
}

BOOST_AUTO_TEST_CASE(a_key_given_twice_is_refused) {
  const DeckFolder folder("windio");
  folder.replace("second.yaml", "  yaw:\n", "  yaw:\n  yaw:\n");
  BOOST_TEST(holds(message_of([&] { import_windio(folder / "second.yaml", tower_only); }),
                   "components.yaw: given twice"));
}

// A deck may lack what is said to be 0; without any other line it is refused.
BOOST_AUTO_TEST_CASE(a_missing_line_gives_no_wrong_number) {
  const DeckFolder folder("windio");
  const std::string text = folder.text("second.yaml");
  const std::string expected = import_windio(folder / "second.yaml", tower_only).text;
  std::size_t start = text.find('\n') + 1;
  while (start < text.size()) {
    const std::size_t end = text.find('\n', start) + 1;
    const std::string line = text.substr(start, end - start);
    folder.write("second.yaml", text.substr(0, start) + text.substr(end));
    try {
      const Import import = import_windio(folder / "second.yaml", tower_only);
      const bool is_said =
          std::any_of(import.report.begin(), import.report.end(),
                      [](const auto& entry) { return holds(entry.words, "not in the deck"); }) ||
          std::any_of(import.warnings.begin(), import.warnings.end(), [](const auto& words) {
            return holds(words, "not in the deck") || holds(words, "shear is rigid");
          });
      BOOST_TEST((import.text == expected || is_said || holds(line, "name:")), line);
    } catch (const InputError&) {
    }
    start = end;
  }
}

// Cut off before its last lines it is refused; it may lack only what is said to be missing: the
// rotor speed stands last.
BOOST_AUTO_TEST_CASE(a_truncated_deck_gives_no_wrong_number) {
  const DeckFolder folder("windio");
  const std::string text = folder.text("second.yaml");
  const std::string expected = import_windio(folder / "second.yaml", tower_only).text;
  constexpr std::size_t stride = 17;
  for (std::size_t size = 0; size < text.rfind("elastic_properties:"); size += stride) {
    folder.write("second.yaml", text.substr(0, size));
    if (size > 0 && text[size - 1] == '\n') continue;
    BOOST_CHECK_THROW(import_windio(folder / "second.yaml", tower_only), InputError);
  }
  std::size_t end = text.rfind("control:");
  for (std::size_t line = 0; line < end; line = text.find('\n', line) + 1) {
    folder.write("second.yaml", text.substr(0, line));
    try {
      const std::string result = import_windio(folder / "second.yaml", tower_only).text;
      BOOST_TEST(holds(result, "speed_rpm: 0"));
      BOOST_TEST(result.substr(result.find("\nblades:")) ==
                 expected.substr(expected.find("\nblades:")));
    } catch (const InputError&) {
    }
  }
}

BOOST_AUTO_TEST_CASE(other_files_are_refused) {
  const DeckFolder folder("windio");
  folder.write("other.yaml", "samara: 1\n");
  BOOST_TEST(holds(message_of([&] { import_windio(folder / "other.yaml", {}); }),
                   "not a turbine of windIO"));
  folder.write("other.yaml", "a: [1, 2\n");
  BOOST_TEST(holds(message_of([&] { import_windio(folder / "other.yaml", {}); }), "other.yaml:"));
  BOOST_TEST(
      holds(message_of([&] { import_windio(folder / "missing.yaml", {}); }), "no such file"));
}

BOOST_AUTO_TEST_SUITE_END()
