#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <set>

#include <Eigen/Geometry>

#include "samara/model/reference_line.hpp"

#include "import_test.hpp"

namespace {

using namespace samara;
using namespace samara::test;
using decks::Import;
using decks::import_hawc2;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double round_off = 1e-12;
const std::string main_file = "htc/turbine.htc";
const std::string bodies = "parts/bodies.htc";
const std::string places = "parts/orientation.htc";

bool is_near(double a, double b, double tolerance = round_off) {
  return std::abs(a - b) <= tolerance * std::max(1.0, std::abs(b));
}

Import import_folder(const DeckFolder& folder, const decks::ImportOptions& options = {}) {
  return import_hawc2(folder / main_file, options);
}

model::TurbineDefinition read_folder(const DeckFolder& folder,
                                     const decks::ImportOptions& options = {}) {
  return parse(import_folder(folder, options)).turbine;
}

model::TurbineDefinition read_deck() {
  const DeckFolder folder("htc");
  return read_folder(folder);
}

std::string refusal(const DeckFolder& folder, const decks::ImportOptions& options = {}) {
  return message_of([&] { import_folder(folder, options); });
}

std::string all_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

void replace_all(const DeckFolder& folder, const std::string& file, const std::string& from,
                 const std::string& to) {
  std::string content = folder.text(file);
  std::size_t count = 0;
  for (std::size_t at = content.find(from); at != std::string::npos;
       at = content.find(from, at + to.size()), ++count)
    content.replace(at, from.size(), to);
  BOOST_REQUIRE_MESSAGE(count > 0, from);
  folder.write(file, content);
}

/// A straight blade with one twist and the second set of its table, the same section everywhere.
void make_straight(const DeckFolder& folder, const std::string& twist) {
  folder.replace(bodies, "FPM 0 ;\n      set 1 1", "FPM 0 ;\n      set 2 1");
  folder.replace(bodies, "0.05 -0.02  0.0 -12.0", "0 0 0 " + twist);
  folder.replace(bodies, "-0.20  0.10  6.0  -8.0", "0 0 6 " + twist);
  folder.replace(bodies, "-0.30 -0.20 13.0  -3.0", "0 0 13 " + twist);
  folder.replace(bodies, "-0.15 -0.90 20.0   0.5", "0 0 20 " + twist);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(import_hawc2_suite)

BOOST_AUTO_TEST_CASE(an_upwind_rotor_stands_where_the_deck_has_it) {
  const model::TurbineDefinition t = read_deck();
  // The tower top is at 42 m, the shaft passes the yaw axis 1.5 m above it and runs 3.2 m upwind
  // along an axis that rises by 5 degrees; the hubs lean by 2.5 degrees and are 1 m long.
  BOOST_TEST(t.tower.length == 40.0);
  BOOST_TEST(is_near(t.shaft.height, 1.5));
  BOOST_TEST(is_near(t.shaft.overhang, -3.2));
  BOOST_TEST(is_near(t.shaft.tilt, -5.0 * degree));
  BOOST_TEST(is_near(t.blades.precone, -2.5 * degree));
  BOOST_TEST(is_near(t.hub.radius, 1.0));
  BOOST_TEST(t.shaft.azimuth == 0.0);
  BOOST_TEST(t.blades.pitch == 0.0);
  BOOST_TEST(t.blades.count == 3);
  BOOST_TEST(is_near(t.shaft.speed, 1.9));
  BOOST_TEST(t.gravity == 9.81);
  BOOST_TEST(t.blades.each.empty());
}

BOOST_AUTO_TEST_CASE(a_turned_shaft_and_pitched_blades_are_angles_of_the_case) {
  const DeckFolder folder("htc");
  // The shaft turns about its z, which is upwind: the sense of the rotor is against it.
  folder.replace(places, "mbdy2_eulerang 5.0 0.0 0.0 ;   tilt",
                 "mbdy2_eulerang 5.0 0.0 0.0 ;\n mbdy2_eulerang 0.0 0.0 -30.0 ;");
  // Against z of the blade: the leading edge moves upwind, to feather.
  folder.replace(places, "mbdy2  blade1 1 ;\n      mbdy2_eulerang 0.0 0.0 0.0",
                 "mbdy2  blade1 1 ;\n      mbdy2_eulerang 0.0 0.0 -4.0");
  const model::TurbineDefinition t = read_folder(folder);
  BOOST_TEST(is_near(t.shaft.azimuth, 30.0 * degree));
  BOOST_TEST(is_near(t.blades.pitch, 4.0 * degree));
  // The others are not pitched.
  BOOST_REQUIRE(t.blades.each.size() == 2u);
  BOOST_TEST(is_near(t.blades.each.at(2).pitch, -4.0 * degree));
  BOOST_TEST(is_near(t.blades.each.at(3).pitch, -4.0 * degree));
}

BOOST_AUTO_TEST_CASE(other_forms_of_a_rotation_are_the_same) {
  const model::TurbineDefinition known = read_deck();
  const DeckFolder folder("htc");
  folder.replace(places, "mbdy2_eulerang 90.0 0.0 0.0", "mbdy2_axisangle 2.0 0.0 0.0 90.0");
  // 5 degrees about x: cos and sin of the half angle.
  folder.replace(places, "mbdy2_eulerang 5.0 0.0 0.0",
                 "mbdy2_eulerpar 0.9990482215818578 0.04361938736533600 0.0 0.0");
  replace_all(folder, places, "mbdy1", "body1");
  replace_all(folder, places, "mbdy2", "body2");
  const model::TurbineDefinition t = read_folder(folder);
  BOOST_TEST(is_near(t.shaft.tilt, known.shaft.tilt));
  BOOST_TEST(is_near(t.shaft.overhang, known.shaft.overhang));
  BOOST_TEST(is_near(t.blades.precone, known.blades.precone));
}

BOOST_AUTO_TEST_CASE(a_turned_nacelle_turns_the_wind) {
  const DeckFolder folder("htc");
  // About z of the tower top, which is down: clockwise as seen from above.
  folder.replace(places, "mbdy2  towertop 1 ;\n      mbdy2_eulerang 0.0 0.0 0.0",
                 "mbdy2  towertop 1 ;\n      mbdy2_eulerang 0.0 0.0 10.0");
  const model::TurbineDefinition known = read_deck();
  const model::TurbineDefinition t = read_folder(folder);
  BOOST_TEST(is_near(t.shaft.overhang, known.shaft.overhang));
  BOOST_TEST(is_near(t.shaft.tilt, known.shaft.tilt));
  BOOST_TEST((t.nacelle.center_of_mass - known.nacelle.center_of_mass).norm() < 1e-9);
  BOOST_TEST((t.nacelle.inertia - known.nacelle.inertia).norm() < 1e-6);
  BOOST_TEST(is_near(t.wind->direction, known.wind->direction + 10.0 * degree));
}

BOOST_AUTO_TEST_CASE(bodies_keep_their_masses_and_moments) {
  const model::TurbineDefinition t = read_deck();
  BOOST_TEST(t.tower.tip_mass == 450.0);
  // The nacelle is 0.2 m to the left, 0.6 m upwind and 0.75 m above the tower top; the rod of 1
  // kg/m below the shaft has 1.5 kg.
  BOOST_TEST(is_near(t.nacelle.mass, 9001.5));
  const Vector3 first = 9000.0 * Vector3(-0.2, -0.6, 0.75) + 1.5 * Vector3(0.0, 0.0, 0.75);
  BOOST_TEST((t.nacelle.mass * t.nacelle.center_of_mass - first).norm() <= 1e-9);
  // About the tower top: y1 to the right, y2 downwind, y3 up; a rod has m L^2/3 about its end, and
  // its section's own inertia of m 0.2^2 about each axis across it, twice that along it.
  const Vector3& c = t.nacelle.center_of_mass;
  const Vector3 about_top = t.nacelle.inertia + t.nacelle.mass * Vector3(c(1) * c(1) + c(2) * c(2),
                                                                         c(0) * c(0) + c(2) * c(2),
                                                                         c(0) * c(0) + c(1) * c(1));
  const double rod = 1.5 * (1.5 * 1.5 / 3.0 + 0.04);
  BOOST_TEST(is_near(about_top(0), 20000.0 + 9000.0 * (0.36 + 0.5625) + rod));
  BOOST_TEST(is_near(about_top(1), 8000.0 + 9000.0 * (0.04 + 0.5625) + rod));
  BOOST_TEST(is_near(about_top(2), 18000.0 + 9000.0 * (0.04 + 0.36) + 1.5 * 0.08));
  // The shaft: 10 kg/m over 3.2 m; its torsion GK/L and Kz times it.
  BOOST_TEST(is_near(t.shaft.mass, 32.0));
  BOOST_TEST(is_near(t.shaft.center_of_mass, -1.6));
  BOOST_TEST(is_near(t.shaft.inertia_axial, 32.0 * 0.08, 1e-9));
  BOOST_TEST(is_near(t.shaft.inertia_transverse, 32.0 * (3.2 * 3.2 / 12.0 + 0.04), 1e-9));
  BOOST_TEST((t.shaft.torsion.kind == model::JointKind::free));
  BOOST_TEST(is_near(t.shaft.torsion.stiffness, 8e10 * 4e-3 / 3.2));
  BOOST_TEST(is_near(t.shaft.torsion.damping, 2e-3 * t.shaft.torsion.stiffness));
  BOOST_TEST(is_near(t.shaft.generator.inertia, 5400.0));
  // The hub: 2500 kg 0.3 m upwind of the apex, and three rods of 1 kg that lean upwind.
  BOOST_TEST(is_near(t.hub.mass, 2503.0));
  const double lean = 0.5 * std::sin(2.5 * degree);
  BOOST_TEST(is_near(t.hub.mass * t.hub.center_of_mass, -2500.0 * 0.3 - 3.0 * lean, 1e-9));
  BOOST_TEST(t.hub.point_masses.empty());
  const double tilted = std::pow(std::cos(2.5 * degree), 2);
  BOOST_TEST(
      is_near(t.hub.inertia(1), 1900.0 + 3.0 * (tilted / 3.0 + 0.04 * (2.0 - tilted)), 1e-9));
}

BOOST_AUTO_TEST_CASE(a_mass_beside_the_shaft_is_a_mass_on_the_hub) {
  const DeckFolder folder("htc");
  // x of the shaft is to the left, y down, z upwind: h1 is to the right, h3 up.
  folder.replace(bodies, "concentrated_mass 2  0.0 0.0 0.3 2500.0 700.0 700.0 1900.0",
                 "concentrated_mass 2  0.4 -0.2 0.3 2500.0 700.0 750.0 1900.0");
  const model::TurbineDefinition t = read_folder(folder);
  BOOST_TEST(t.hub.mass == 0.0);
  BOOST_REQUIRE(t.hub.point_masses.size() == 1u);
  const model::HubMassDefinition& mass = t.hub.point_masses[0];
  BOOST_TEST(is_near(mass.mass * mass.center(0), -2500.0 * 0.4, 1e-9));
  BOOST_TEST(is_near(mass.mass * mass.center(2), 2500.0 * 0.2, 1e-9));
}

BOOST_AUTO_TEST_CASE(a_mass_on_the_tower_is_in_its_axes) {
  const model::TurbineDefinition t = read_deck();
  BOOST_REQUIRE(t.tower.point_masses.size() == 1u);
  const model::PointMassDefinition& mass = t.tower.point_masses[0];
  BOOST_TEST(is_near(mass.at, 0.5));
  BOOST_TEST(mass.mass == 300.0);
  // x of the tower is to the left, b2 to the right.
  BOOST_TEST((mass.center - Vector3(0.0, -0.5, 0.0)).norm() <= 1e-12);
  // The wall jumps there.
  BOOST_REQUIRE(t.tower.sections.size() == 4u);
  BOOST_TEST(t.tower.sections[0].twist == 0.0);
  require_same(integrate(t.tower, 0, 0),
               integrate({0.0, 0.5, 0.5, 1.0}, {1708.3, 1421.5, 907.5, 725.0}, 40.0));
  Vector6 damping;
  // Kx = 3e-3 is that of bending along x, side-side, about b3; Ky = 4e-3 fore-aft.
  damping << 3.5e-3, 5e-4, 5e-4, 5e-4, 4e-3, 3e-3;
  BOOST_TEST(t.tower.damping == damping);
}

BOOST_AUTO_TEST_CASE(the_mesh_has_room_for_the_masses) {
  const DeckFolder folder("htc");
  BOOST_TEST(read_folder(folder).tower.elements == 2);  // one in the middle
  folder.replace(main_file, "node_distribution     c2_def ;\n    damping_posdef   0.0",
                 "node_distribution     uniform 201 ;\n    damping_posdef   0.0");
  folder.replace(
      main_file, "concentrated_mass 3 0.5 0.0 0.0 300.0 0.0 0.0 0.0 ;",
      "concentrated_mass 61 0.5 0 0 300 0 0 0 ;\n concentrated_mass 91 0 0 0 20 0 0 0 ;\n"
      "concentrated_mass 92 0 0 0 30 1 1 1 ;\n concentrated_mass 200 0 0 0 40 0 0 0 ;\n"
      "concentrated_mass 201 0 1 0 50 0 0 0 ;\n");
  const model::BeamDefinition tower = read_folder(folder).tower;
  // Those 0.5 % of the length apart are one.
  BOOST_REQUIRE(tower.point_masses.size() == 3u);
  BOOST_TEST(is_near(tower.point_masses[0].at, 0.3));
  BOOST_TEST(is_near(tower.point_masses[1].at, 0.45));
  BOOST_TEST(tower.point_masses[1].mass == 50.0);
  BOOST_TEST(tower.point_masses[2].at == 1.0);
  BOOST_TEST(is_near(tower.point_masses[2].mass, 90.0));
  BOOST_TEST(is_near(tower.point_masses[2].center(2), 5.0 / 9.0));
}

BOOST_AUTO_TEST_CASE(an_offset_of_the_tower_is_turned_to_its_axes) {
  // A tower runs against z of its body, so its sections look from above: x of the section is that
  // of the body, to the left, y is upwind. Case: b2 to the right, b3 downwind.
  const DeckFolder folder("htc");
  folder.replace("data/tower.st", "1708.3 0 0 ", "1708.3 0.1 0.2 ");
  const model::SectionDefinition foot = read_folder(folder).tower.sections[0];
  BOOST_TEST(foot.twist == 0.0);
  BOOST_TEST(is_near(foot.mass(0, 5), 1708.3 * 0.1));   // -m b2, b2 = -0.1
  BOOST_TEST(is_near(foot.mass(0, 4), -1708.3 * 0.2));  // m b3, b3 = -0.2
  BOOST_TEST(foot.stiffness.isApprox(read_deck().tower.sections[0].stiffness));
}

BOOST_AUTO_TEST_CASE(a_section_has_the_matrices_of_its_centres) {
  // Section: m = 80 with centre (0.4, 0.05), radii 0.6 and 0.9, shear centre (0.2, -0.05), elastic
  // centre (0.3, 0.1), E = 1e10, G = 4e9, I = 0.02 and 0.05, K = 0.03, k = 0.5 and 0.6, A = 0.2.
  // Its principal axes are turned by 90 degrees: x_e is y of the section, y_e is -x.
  // Case: b1 = z, b2 = x, b3 = y. A point (b2, b3) has the strains
  //   axial: e + k2 b3 - k3 b2, shear 2: g2 - k1 b3, shear 3: g3 + k1 b2.
  const DeckFolder folder("htc");
  make_straight(folder, "-10");
  const model::BeamDefinition blade = read_folder(folder).blades.beam;
  BOOST_TEST(blade.length == 20.0);
  BOOST_TEST(blade.reference_line.empty());
  for (const model::SectionDefinition& section : blade.sections)
    BOOST_TEST(is_near(section.twist, 10.0 * degree));
  const Matrix6& s = blade.sections[0].stiffness;
  const double ea = 1e10 * 0.2;
  const double ga2 = 0.6 * 4e9 * 0.2;  // k_y is along y_e = -x
  const double ga3 = 0.5 * 4e9 * 0.2;  // k_x is along x_e = y
  const double x_e = 0.3, y_e = 0.1, x_s = 0.2, y_s = -0.05;
  const auto is_entry = [&](Eigen::Index i, Eigen::Index j, double value) {
    BOOST_TEST(s(i, j) == s(j, i));
    return std::abs(s(i, j) - value) <= 1e-12 * std::sqrt(s(i, i) * s(j, j));
  };
  BOOST_TEST(is_entry(0, 0, ea));
  BOOST_TEST(is_entry(0, 4, ea * y_e));
  BOOST_TEST(is_entry(0, 5, -ea * x_e));
  BOOST_TEST(is_entry(4, 4, 1e10 * 0.05 + ea * y_e * y_e));  // about x = -y_e: I_y
  BOOST_TEST(is_entry(5, 5, 1e10 * 0.02 + ea * x_e * x_e));  // about y = x_e: I_x
  BOOST_TEST(is_entry(4, 5, -ea * x_e * y_e));
  BOOST_TEST(is_entry(1, 1, ga2));
  BOOST_TEST(is_entry(2, 2, ga3));
  BOOST_TEST(is_entry(1, 2, 0.0));
  BOOST_TEST(is_entry(1, 3, -ga2 * y_s));
  BOOST_TEST(is_entry(2, 3, ga3 * x_s));
  BOOST_TEST(is_entry(3, 3, 4e9 * 0.03 + ga2 * y_s * y_s + ga3 * x_s * x_s));
  for (const Eigen::Index i : {0, 4, 5})
    for (const Eigen::Index j : {1, 2, 3}) BOOST_TEST(is_entry(i, j, 0.0));
  // The radii count from the elastic centre, about x_e = y and y_e = -x:
  // integral of (x - x_e)^2 = m 0.6^2, of (y - y_e)^2 = m 0.9^2, of their product 0.
  const Matrix6& m = blade.sections[0].mass;
  const double x_g = 0.4, y_g = 0.05;
  const double xx = 0.36 + 2.0 * x_e * x_g - x_e * x_e;
  const double yy = 0.81 + 2.0 * y_e * y_g - y_e * y_e;
  const double xy = x_e * y_g + y_e * x_g - x_e * y_e;
  BOOST_TEST(is_near(m(0, 0), 80.0));
  BOOST_TEST(is_near(m(0, 4), 80.0 * y_g));
  BOOST_TEST(is_near(m(0, 5), -80.0 * x_g));
  BOOST_TEST(is_near(m(1, 3), -80.0 * y_g));
  BOOST_TEST(is_near(m(2, 3), 80.0 * x_g));
  BOOST_TEST(is_near(m(4, 4), 80.0 * yy));
  BOOST_TEST(is_near(m(5, 5), 80.0 * xx));
  BOOST_TEST(is_near(m(4, 5), -80.0 * xy));
  BOOST_TEST(is_near(m(3, 3), 80.0 * (xx + yy)));
}

BOOST_AUTO_TEST_CASE(full_matrices_are_the_same_section) {
  const model::BeamDefinition known = read_deck().blades.beam;
  const DeckFolder folder("htc");
  folder.replace(bodies, "./data/blade.st", "./data/blade_full.st");
  folder.replace(bodies, "FPM 0", "FPM 1");
  const model::BeamDefinition blade = read_folder(folder).blades.beam;
  BOOST_REQUIRE(blade.sections.size() == known.sections.size());
  for (std::size_t i = 0; i < blade.sections.size(); ++i) {
    const Vector6 scale = known.sections[i].stiffness.diagonal().cwiseSqrt();
    const Matrix6 difference = blade.sections[i].stiffness - known.sections[i].stiffness;
    BOOST_TEST((scale.cwiseInverse().asDiagonal() * difference * scale.cwiseInverse().asDiagonal())
                   .cwiseAbs()
                   .maxCoeff() < 1e-12);
    BOOST_TEST(blade.sections[i].mass.isApprox(known.sections[i].mass));
  }
}

BOOST_AUTO_TEST_CASE(the_line_and_the_chord_of_a_blade_are_those_of_the_deck) {
  // Points x (to the leading edge), y (to the suction side, downwind), z and the twist about z.
  const std::array<std::array<double, 4>, 4> points{{{0.05, -0.02, 0.0, -12.0},
                                                     {-0.20, 0.10, 6.0, -8.0},
                                                     {-0.30, -0.20, 13.0, -3.0},
                                                     {-0.15, -0.90, 20.0, 0.5}}};
  const model::BeamDefinition blade = read_deck().blades.beam;
  BOOST_REQUIRE(blade.reference_line.size() == points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 known(points[i][2], points[i][0] - 0.05, points[i][1] + 0.02);
    BOOST_TEST((blade.reference_line[i] - known).norm() <= 1e-14);
  }
  const model::ReferenceLine line("blades", blade);
  std::size_t found = 0;
  for (const model::SectionDefinition& section : blade.sections)
    for (std::size_t i = 0; i < points.size(); ++i) {
      const model::ReferenceLine::Station station = line.at(section.at, section.twist);
      if ((station.x - blade.reference_line[i]).norm() > 1e-9) continue;
      ++found;
      // The chord, seen along z of the blade, has the twist about z: from x to y.
      const Vector3 chord = station.C_ab.col(1);
      BOOST_TEST(is_near(std::atan2(chord(2), chord(1)), points[i][3] * degree, 1e-10));
    }
  BOOST_TEST(found == points.size());
  Vector6 damping;
  damping << 1.75e-3, 1e-4, 1e-4, 1e-4, 2e-3, 1.5e-3;
  BOOST_TEST(blade.damping == damping);
}

BOOST_AUTO_TEST_CASE(factors_of_damping_go_by_axes_or_directions) {
  // damping_aniso has those of bending about x (flap) and y, damping_posdef those along x and y.
  const DeckFolder folder("htc");
  folder.replace(bodies, "damping_aniso", "damping_posdef");
  Vector6 damping;
  damping << 1.75e-3, 1e-4, 1e-4, 1e-4, 1.5e-3, 2e-3;
  BOOST_TEST(read_folder(folder).blades.beam.damping == damping);
}

BOOST_AUTO_TEST_CASE(a_mass_on_a_blade_is_at_its_node) {
  const model::BeamDefinition blade = read_deck().blades.beam;
  BOOST_REQUIRE(blade.point_masses.size() == 1u);
  const model::PointMassDefinition& mass = blade.point_masses[0];
  const model::ReferenceLine line("blades", blade);
  const double twist = model::interpolate_section(blade, mass.at).twist;
  const model::ReferenceLine::Station station = line.at(mass.at, twist);
  // Node 3 at (-0.3, -0.2, 13), the mass at (-0.1, 0.05, 0) from it, in axes of the body.
  const Vector3 place = station.x + station.C_ab * mass.center;
  BOOST_TEST((place - Vector3(13.0, -0.45, -0.13)).norm() <= 1e-9);
  BOOST_TEST(is_near(mass.inertia.sum(), 6.0));
}

BOOST_AUTO_TEST_CASE(masses_of_a_blade_survive) {
  const model::BeamDefinition blade = read_deck().blades.beam;
  const double length = blade.length;
  const double end = 60.0 + (14.0 - 60.0) * (length - 14.0) / (20.2 - 14.0);
  const std::vector<double> at{0.0, 7.0 / length, 14.0 / length, 1.0};
  require_same(integrate(blade, 0, 0), integrate(at, {190.0, 120.0, 60.0, end}, length));
}

BOOST_AUTO_TEST_CASE(the_air_is_that_of_the_deck) {
  const model::TurbineDefinition t = read_deck();
  BOOST_REQUIRE(t.wind.has_value());
  BOOST_TEST(t.wind->speed == 9.0);
  BOOST_TEST(t.wind->density == 1.21);
  // The wind comes from the right of one who looks upwind and blows to the right of one who looks
  // downwind: clockwise from above.
  BOOST_TEST(is_near(t.wind->direction, -8.0 * degree));
  BOOST_TEST(t.wind->exponent == 0.15);
  BOOST_TEST(t.wind->height == 41.0);  // above the foot at 2 m
  BOOST_REQUIRE(t.wind->tower.has_value());
  BOOST_TEST(t.wind->tower->heights == (std::vector<double>{0.0, 40.0}));
  BOOST_TEST(t.wind->tower->diameters == (std::vector<double>{3.0, 2.0}));
  BOOST_TEST(t.wind->tower->drags == (std::vector<double>{0.7, 0.5}));
  BOOST_TEST((t.wind->tower->potential == model::TowerFlowDefinition::Potential::plain));
  BOOST_REQUIRE(t.aero.has_value());
  BOOST_TEST((t.aero->thrust == model::ThrustLaw::madsen));
  BOOST_TEST((t.aero->dynamics == model::AirfoilDynamics::hgm));
  BOOST_TEST(t.aero->tip_loss);
  BOOST_TEST(!t.aero->hub_loss);
  BOOST_TEST((t.aero->wake == model::WakeConstants{0.16, 0.34, 0.05, 0.31}));
  BOOST_TEST(t.aero->pressure_lag == 1.6);
  BOOST_TEST(t.aero->separation_lag == 2.9);
  BOOST_TEST(t.blades.airfoils.size() == 3u);
  std::set<double> thickness;
  for (const auto& [name, airfoil] : t.blades.airfoils) thickness.insert(*airfoil.thickness);
  BOOST_TEST(thickness == (std::set<double>{0.18, 0.3, 1.0}));
}

BOOST_AUTO_TEST_CASE(aerodynamic_sections_are_a_quarter_of_the_chord_before_the_line) {
  const model::TurbineDefinition t = read_deck();
  const double length = t.blades.beam.length;
  const auto& sections = t.blades.aero_sections;
  const auto at = [&](double r) {
    const auto found = std::ranges::find_if(
        sections, [&](const auto& section) { return std::abs(section.at * length - r) < 1e-9; });
    BOOST_REQUIRE(found != sections.end());
    return *found;
  };
  const model::AeroSectionDefinition middle = at(8.0);
  BOOST_TEST(is_near(middle.chord, 1.4));
  BOOST_TEST(is_near(*middle.thickness, 0.3));
  BOOST_TEST(is_near(middle.center[0], 0.35));
  BOOST_TEST(middle.center[1] == 0.0);
  BOOST_TEST(is_near(middle.twist, model::interpolate_section(t.blades.beam, middle.at).twist));
  BOOST_TEST(is_near(at(0.0).thickness.value(), 1.0));
  // The layout ends behind the line.
  BOOST_TEST(sections.back().at == 1.0);
  BOOST_TEST(is_near(sections.back().chord, 0.9 - 0.6 * (length - 15.0) / 5.2));
}

BOOST_AUTO_TEST_CASE(sections_of_two_sets_of_polars_have_mixed_airfoils) {
  const DeckFolder folder("htc");
  std::string polars = folder.text("data/polars.pc");
  const std::string head = "1 number of sets\n";
  BOOST_REQUIRE(polars.starts_with(head));
  polars = polars.substr(head.size());
  folder.write("data/polars.pc", "2 sets\n" + polars + polars);
  folder.replace("data/layout.ae", "15 0.9 20 1", "15 0.9 20 2");
  const model::TurbineDefinition t = read_folder(folder);
  for (const model::AeroSectionDefinition& section : t.blades.aero_sections) {
    BOOST_TEST(!section.thickness.has_value());
    const bool is_second = section.at * t.blades.beam.length > 15.0 - 1e-9 && section.at < 0.99;
    if (is_second) BOOST_TEST(section.airfoil.starts_with("set 2"));
  }
}

BOOST_AUTO_TEST_CASE(models_are_chosen_by_their_numbers) {
  const DeckFolder folder("htc");
  folder.replace(main_file, "dynstall_method    2", "dynstall_method    1");
  folder.replace(main_file, "induction_method   1", "induction_method   0");
  folder.replace(main_file, "tiploss_method     1", "tiploss_method     0");
  model::TurbineDefinition t = read_folder(folder);
  BOOST_TEST((t.aero->dynamics == model::AirfoilDynamics::oye));
  BOOST_TEST((t.aero->induction == model::Induction::none));
  BOOST_TEST(!t.aero->tip_loss);
  folder.replace(main_file, "aerocalc_method    1", "aerocalc_method    0");
  t = read_folder(folder);
  BOOST_TEST(!t.aero.has_value());
  BOOST_TEST(t.wind.has_value());
}

BOOST_AUTO_TEST_CASE(what_is_left_out_is_named) {
  const DeckFolder folder("htc");
  folder.replace(main_file, "begin dll ;",
                 "begin hydro ;\n  gravity 9.8 ;\nend hydro ;\nbegin dll ;");
  folder.replace(main_file, "end wind ;", "  colour red ;\nend wind ;");
  folder.replace(bodies, "name        towertop ;", "name        towertop ;\n    shape round ;");
  folder.replace(main_file, "tower_shadow_method     3", "tower_shadow_method     2");
  const Import import = import_folder(folder);
  const std::string warnings = all_of(import.warnings);
  for (const char* word : {"controller", "begin hydro", "colour", "shape", "turb_format",
                           "tower_shadow_method", "Tower.st", "--rotor-speed-rpm"})
    BOOST_TEST(holds(warnings, word), word);
  std::set<std::string> keys;
  for (const decks::ImportLine& line : import.report)
    if (line.fate == decks::Fate::ignored) keys.insert(line.key);
  for (const char* key : {"dll.controller", "hydro", "wind.colour", "wind.mann", "simulation",
                          "output", "new_htc_structure.main_body.shape"})
    BOOST_TEST(keys.contains(key), key);
}

BOOST_AUTO_TEST_CASE(the_speed_can_be_stated) {
  const DeckFolder folder("htc");
  const model::TurbineDefinition t = read_folder(folder, {.stated = {{"shaft.speed_rpm", {12.0}}}});
  BOOST_TEST(is_near(t.shaft.speed, 0.4 * std::numbers::pi));
}

BOOST_AUTO_TEST_CASE(a_body_below_the_tower_is_refused_or_left_out) {
  const DeckFolder folder("htc");
  folder.replace(main_file, "begin orientation ;",
                 "begin main_body ;\n name pile ;\n copy_main_body hub1 ;\nend main_body ;\n"
                 "begin orientation ;");
  folder.replace(main_file, "mbdy   tower ;\n      inipos        0.0 0.0 -2.0",
                 "mbdy   pile ;\n      inipos        0.0 0.0 -2.0");
  folder.replace(main_file, "continue_in_file ./parts/orientation.htc ;",
                 "begin relative ;\n mbdy1 pile 1 ;\n mbdy2 tower 1 ;\n end relative ;\n"
                 "continue_in_file ./parts/orientation.htc ;");
  BOOST_TEST(holds(refusal(folder), "--tower-only"));
  const model::TurbineDefinition t = read_folder(folder, {.tower_only = true});
  BOOST_TEST(t.tower.length == 40.0);
}

BOOST_AUTO_TEST_CASE(a_free_bearing_below_the_nacelle_is_a_free_yaw) {
  const DeckFolder folder("htc");
  folder.replace(
      main_file, "begin fix1 ;\n      mbdy1 tower last ;\n      mbdy2 towertop 1 ;\n    end fix1 ;",
      "begin bearing1 ;\n      name yaw ;\n      mbdy1 tower last ;\n      mbdy2 towertop "
      "1 ;\n      bearing_vector 2 0 0 1 ;\n    end bearing1 ;");
  const model::TurbineDefinition t = read_folder(folder);
  BOOST_TEST((t.nacelle.yaw.kind == model::JointKind::free));
  BOOST_TEST(is_near(t.shaft.overhang, -3.2));
}

BOOST_AUTO_TEST_CASE(paths_start_at_the_folder_of_the_deck_or_above) {
  const DeckFolder folder("htc");
  fs::rename(folder.path / "data", folder.path / "htc/data");
  const Import import = import_folder(folder);
  bool is_named = false;
  for (const decks::ImportLine& line : import.report)
    is_named =
        is_named || (holds(line.key, "blade.st") && holds(line.words, "the folder of the deck"));
  BOOST_TEST(is_named);
  fs::rename(folder.path / "htc/data", folder.path / "elsewhere");
  BOOST_TEST(holds(refusal(folder), "no such file"));
}

BOOST_AUTO_TEST_CASE(line_ends_tabs_and_case_do_not_matter) {
  const DeckFolder folder("htc");
  const std::string known = import_folder(folder).text;
  for (const std::string& file : {main_file, bodies, places}) {
    std::string text;
    for (const char c : folder.text(file))
      text += c == '\n' ? std::string("\r\n") : c == ' ' ? std::string("\t ") : std::string(1, c);
    folder.write(file, text);
  }
  replace_all(folder, bodies, "begin\t main_body", "BEGIN\t Main_Body");
  BOOST_TEST(import_folder(folder).text == known);
}

BOOST_AUTO_TEST_CASE(faults_are_refused_at_their_places) {
  struct Fault {
    std::string file, from, to, place, words;
  };
  const std::vector<Fault> faults{
      {main_file, "nblades  3", "nblades  4", "turbine.htc", "no link of blade 4"},
      {main_file, "link 3 mbdy_c2_def blade3", "link 3 mbdy_c2_def blade9", "turbine.htc",
       "blade9"},
      {main_file, "hub_vec shaft -3", "hub_vec shaft 3", "turbine.htc:", "counter-clockwise"},
      {places, "0.0 0.0 -1.0 1.9", "0.0 0.0 1.0 1.9", "orientation.htc:", "counter-clockwise"},
      {main_file, "nsec 5", "nsec 6", "turbine.htc:", "there are 5 sections"},
      {main_file, "type        timoschenko", "type        ring", "turbine.htc:13", "timoschenko"},
      {bodies, "copy_main_body hub1", "copy_main_body nave", "bodies.htc:", "nave"},
      {bodies, "set 1 2", "set 1 7", "stiff.st", "no subset"},
      {bodies, "FPM 0", "FPM 1", "blade.st:", "30 numbers"},
      {places, "mbdy2_eulerang 0.0 60.0 0.0", "mbdy2_eulerang 0.0 50.0 0.0",
       "orientation.htc:", "evenly spread"},
      {places, "mbdy2_eulerang 0.0 -60.0 0.0", "mbdy2_eulerang 0.0 sixty 0.0",
       "orientation.htc:", "\"sixty\""},
      {places, "mbdy1  shaft last ;\n      mbdy2  hub1 1",
       "mbdy1  hub1 last ;\n      mbdy2  hub1 1", "orientation.htc:", "on itself"},
      {main_file, "end wind", "end wnd", "turbine.htc:", "the open block is wind"},
      {main_file, "./parts/bodies.htc", "./htc/turbine.htc", "turbine.htc:", "continues in itself"},
      {"data/blade.st", "7 120 ", "7 -120 ", "blade.st", "mass"},
      {"data/blade.st", "14 60 ", "4 60 ", "blade.st:", "do not decrease"},
      {"data/blade.st", "7 120 ", "7 12o ", "blade.st:", "\"12o\""},
      {"data/layout.ae", "8 1.4", "8 -1.4", "layout.ae:", "chord"},
      {"data/layout.ae", "8 1.4 30 1", "8 1.4 30 3", "polars.pc", "no set 3"},
      {"data/layout.ae", "1 5 r", "1 9 r", "layout.ae", "row 6 of 9"},
      {"data/polars.pc", "2 37 30", "2 37 12", "polars.pc:", "must rise"},
      {"data/polars.pc", "2 37 30", "2 36 30", "polars.pc:", "polar"},
      {main_file, "ae_sets            1 1 1", "ae_sets            1 1 2",
       "turbine.htc:", "different sets"},
      {main_file, "ae_sets            1 1 1", "ae_sets            2 2 2", "layout.ae", "no set 2"}};
  for (const Fault& fault : faults) {
    const DeckFolder folder("htc");
    folder.replace(fault.file, fault.from, fault.to);
    const std::string words = refusal(folder);
    BOOST_TEST(holds(words, fault.words), fault.to + ": " + words);
    BOOST_TEST(holds(words, fault.place), fault.to + ": " + words);
  }
}

BOOST_AUTO_TEST_CASE(truncated_files_are_refused_or_named) {
  // Either an error, or a note about the end of the file, or the same case: the cut was behind all
  // that is read.
  const DeckFolder folder("htc");
  const Import whole = import_folder(folder);
  constexpr std::size_t steps = 60;
  for (const std::string& file : {main_file, bodies, places, std::string("data/tower.st"),
                                  std::string("data/stiff.st"), std::string("data/blade.st"),
                                  std::string("data/layout.ae"), std::string("data/polars.pc")}) {
    const std::string text = folder.text(file);
    for (std::size_t i = 0; i < steps; ++i) {
      const std::size_t length = i * text.size() / steps + i % 7;
      folder.write(file, text.substr(0, std::min(length, text.size() - 2)));
      try {
        const Import cut = import_folder(folder);
        const std::string warnings = all_of(cut.warnings);
        const bool is_named = holds(warnings, "without exit") || holds(warnings, "cut off");
        BOOST_TEST((is_named || cut.text == whole.text), file + " " + std::to_string(length));
      } catch (const InputError&) {
      }
    }
    folder.write(file, text);
  }
}

BOOST_AUTO_TEST_CASE(garbage_is_refused) {
  std::uint32_t state = 12345;
  const auto next = [&] {
    state = state * 1664525U + 1013904223U;
    return state >> 8U;
  };
  constexpr int trials = 300;
  const std::array<std::string, 6> files{main_file,       bodies,           places,
                                         "data/blade.st", "data/layout.ae", "data/polars.pc"};
  for (int trial = 0; trial < trials; ++trial) {
    const DeckFolder folder("htc");
    const std::string& file = files[next() % files.size()];
    std::string text = folder.text(file);
    const std::size_t changes = 1 + next() % 4;
    for (std::size_t i = 0; i < changes; ++i) {
      const std::size_t at = next() % text.size();
      if (next() % 3 == 0)
        text.erase(at, next() % 60);
      else
        text[at] = static_cast<char>(next() % 256);
    }
    folder.write(file, text);
    try {
      parse(import_folder(folder));
    } catch (const InputError&) {
    } catch (const DomainError&) {
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
