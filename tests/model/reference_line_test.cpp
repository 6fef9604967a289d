#include "samara/model/reference_line.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/model/beam.hpp"

namespace {

using namespace samara;
using namespace samara::model;

constexpr double round_off = 1e-13;

BeamDefinition beam_along(const std::vector<Vector3>& line) {
  BeamDefinition beam;
  beam.reference_line = line;
  beam.length = line.empty() ? 4.0 : compute_arc_length(line);
  SectionDefinition section;
  section.stiffness = Vector6(1e9, 1e8, 1e8, 1e6, 2e6, 3e6).asDiagonal();
  section.mass = Vector6(10, 10, 10, 3, 1, 2).asDiagonal();
  beam.sections = {section};
  return beam;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(reference_line)

BOOST_AUTO_TEST_CASE(a_straight_beam_has_the_axes_of_its_root) {
  const ReferenceLine line("blade", beam_along({}));
  BOOST_TEST((line.at(0.25).x - Vector3(1.0, 0.0, 0.0)).norm() < round_off);
  BOOST_TEST((line.at(0.25).C_ab - Matrix3::Identity()).norm() < round_off);
}

BOOST_AUTO_TEST_CASE(positive_twist_turns_the_leading_edge_upwind) {
  const ReferenceLine line("blade", beam_along({}));
  const Vector3 b2 = line.at(0.5, 0.1).C_ab.col(1);  // b3 points downwind
  BOOST_TEST((b2 - Vector3(0.0, std::cos(0.1), -std::sin(0.1))).norm() < round_off);
}

BOOST_AUTO_TEST_CASE(prebend_tips_the_section_about_b2_and_sweep_about_b3) {
  const double a = 0.3;
  const ReferenceLine prebent(
      "blade", beam_along({Vector3::Zero(), 5.0 * Vector3(std::cos(a), 0.0, std::sin(a))}));
  const Matrix3 tipped = Eigen::AngleAxisd(-a, Vector3::UnitY()).toRotationMatrix();
  BOOST_TEST((prebent.at(0.7).C_ab - tipped).norm() < round_off);
  BOOST_TEST((prebent.at(0.6).x - 3.0 * Vector3(std::cos(a), 0.0, std::sin(a))).norm() < round_off);
  const ReferenceLine swept(
      "blade", beam_along({Vector3::Zero(), 5.0 * Vector3(std::cos(a), std::sin(a), 0.0)}));
  BOOST_TEST(
      (swept.at(0.7).C_ab - Eigen::AngleAxisd(a, Vector3::UnitZ()).toRotationMatrix()).norm() <
      round_off);
}

BOOST_AUTO_TEST_CASE(twist_is_about_the_tangent) {
  const Vector3 tangent = Vector3(2.0, -0.5, 0.8).normalized();
  const ReferenceLine line("blade", beam_along({Vector3::Zero(), 6.0 * tangent}));
  const Matrix3 plain = line.at(0.4).C_ab;
  const Matrix3 expected = Eigen::AngleAxisd(-0.2, tangent).toRotationMatrix() * plain;
  BOOST_TEST((plain.col(0) - tangent).norm() < round_off);
  BOOST_TEST((line.at(0.4, 0.2).C_ab - expected).norm() < round_off);
}

BOOST_AUTO_TEST_CASE(a_line_that_turns_back_is_refused) {
  BOOST_CHECK_THROW(ReferenceLine("blade", beam_along({Vector3::Zero(), Vector3(-1.0, 0.01, 0.0)})),
                    InputError);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(point_masses)

BOOST_AUTO_TEST_CASE(the_nearest_end_of_an_element_is_drawn_to_a_mass) {
  BeamDefinition definition = beam_along({});
  definition.elements = 4;
  definition.point_masses = {{0.3, 1.0}, {0.3, 2.0}, {0.6, 3.0}, {1.0, 5.0}};
  const Beam beam = build_beam("blade 1", definition);
  const std::vector<double> expected{0.0, 0.3, 0.6, 0.75, 1.0};
  BOOST_TEST(beam.ends == expected, boost::test_tools::per_element());
  BOOST_REQUIRE(beam.mass_nodes.size() == 2u);
  BOOST_TEST(beam.mass_nodes[0].end == 1);
  BOOST_TEST(beam.mass_nodes[0].mass(0, 0) == 3.0);
  BOOST_TEST((beam.mass_nodes[0].x - Vector3(1.2, 0.0, 0.0)).norm() < round_off);
  BOOST_TEST(beam.mass_nodes[1].end == 2);
  BOOST_TEST(beam.tip_mass(0, 0) == 5.0);
  double length = 0.0;
  for (int p = 0; p < beam.point_count(); ++p) length += beam.point_length(p);
  BOOST_TEST(std::abs(length - 4.0) < round_off);
}

BOOST_AUTO_TEST_CASE(a_mesh_too_coarse_for_its_masses_is_refused) {
  BeamDefinition definition = beam_along({});
  definition.elements = 4;
  definition.point_masses = {{0.5, 1.0}, {0.51, 1.0}};
  BOOST_CHECK_THROW(build_beam("blade 1", definition), InputError);
  definition.elements = 1;
  definition.point_masses = {{0.5, 1.0}};
  BOOST_CHECK_THROW(build_beam("blade 1", definition), InputError);
  definition.elements = 4;
  definition.point_masses = {{0.01, 1.0}};
  BOOST_CHECK_THROW(build_beam("blade 1", definition), InputError);
}

BOOST_AUTO_TEST_CASE(rigid_mass_gives_the_momenta_of_a_body) {
  const Vector3 center(0.1, -0.2, 0.3);
  const Matrix3 inertia = Vector3(1.0, 2.0, 3.0).asDiagonal();
  const Matrix6 mass = rigid_mass(4.0, center, inertia);
  const Vector3 V(1.0, 2.0, -1.0);
  const Vector3 omega(0.5, -0.3, 0.2);
  Vector6 velocity;
  velocity << V, omega;
  const Vector3 P = 4.0 * (V + omega.cross(center));
  Vector6 expected;
  expected << P, inertia * omega + center.cross(P);
  BOOST_TEST((mass * velocity - expected).norm() < round_off);
}

BOOST_AUTO_TEST_SUITE_END()
