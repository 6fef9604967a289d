// Curved beams, masses on beams and the skewed teeter hinge, each against a closed form.
#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

/// Points on a quarter circle from the root along b1, bending toward b3.
std::vector<Vector3> quarter_circle(double radius, int intervals) {
  std::vector<Vector3> points;
  for (int i = 0; i <= intervals; ++i) {
    const double angle = 0.5 * pi * i / intervals;
    points.emplace_back(radius * std::sin(angle), 0.0, radius * (1.0 - std::cos(angle)));
  }
  return points;
}

model::TurbineDefinition curved_beam(const std::vector<Vector3>& line, int elements, int order) {
  BeamCase beam;
  beam.mass = 1e-9;
  beam.inertia = Vector3(2e-9, 1e-9, 1e-9);
  beam.stiffness << 0.0, 0.0, 0.0, 1e3, 1e3, 1e3;
  beam.elements = elements;
  beam.order = order;
  model::TurbineDefinition definition = definition_of(beam);
  definition.blades.beam.reference_line = line;
  definition.blades.beam.length = model::compute_arc_length(line);
  return definition;
}

Vector3 tip_deflection(const model::TurbineDefinition& definition) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  trim.solution.evaluate(0.0, z.get(), z_dot.get());
  const petsc::ReadView view(z.get());
  const int tip = system.layout().blade_tip(0);
  return {view[tip], view[tip + 1], view[tip + 2]};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_quarter_circle_bends_in_its_plane_as_castigliano_says) {
  // Weight P of a tip mass along -b1 (a blade that points up): P R^3 pi / (4 EI) down, and
  // P R^3 / (2 EI) along b3. Deflections of 1e-6 R: the linear theory's own error.
  constexpr double radius = 2.0;
  model::TurbineDefinition definition = curved_beam(quarter_circle(radius, 256), 4, 3);
  definition.gravity = 1e-3;
  definition.blades.beam.tip_mass = 1.0;
  const double scale = 1e-3 * std::pow(radius, 3) / 1e3;
  const Vector3 found = tip_deflection(definition);
  BOOST_TEST(found(0) == -0.25 * pi * scale, tolerance(2e-5));
  BOOST_TEST(found(2) == 0.5 * scale, tolerance(2e-5));
  BOOST_TEST(std::abs(found(1)) < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_quarter_circle_bends_out_of_its_plane_with_twice_the_order_of_its_elements) {
  // Blade horizontal (azimuth 90 degrees: b2 points down): out of plane, with torsion. Bending
  // moment P R sin(a), torsion P R (1 - cos(a)) at the angle a from the tip:
  // u = P R^3 [ pi/(4 EI) + (3 pi/4 - 2)/GJ ].
  constexpr double radius = 2.0;
  const double exact = 1e-3 * std::pow(radius, 3) / 1e3 * (0.25 * pi + 0.75 * pi - 2.0);
  for (int order : {1, 2}) {
    std::vector<double> errors;
    for (const int elements : {2, 4}) {
      model::TurbineDefinition definition =
          curved_beam(quarter_circle(radius, 256), elements, order);
      definition.gravity = 1e-3;
      definition.blades.beam.tip_mass = 1.0;
      definition.shaft.azimuth = 0.5 * pi;
      errors.push_back(std::abs(tip_deflection(definition)(1) / exact - 1.0));
    }
    const double slope = std::log2(errors[0] / errors[1]);
    BOOST_TEST(slope == 2.0 * order, tolerance(0.1));
  }
}

BOOST_AUTO_TEST_CASE(a_leaning_blade_is_a_pitched_coned_and_swept_one) {
  // A straight line at an angle to b1 is a blade with precone: the same modes when it turns.
  constexpr double lean = 0.2;
  BeamCase beam;
  beam.length = 3.0;
  beam.speed = 4.0;
  beam.inertia = Vector3(2e-3, 1e-3, 1e-3);
  beam.stiffness << 0.0, 0.0, 0.0, 2.0, 5.0, 8.0;
  beam.elements = 3;
  model::TurbineDefinition coned = definition_of(beam);
  coned.blades.precone = lean;
  model::TurbineDefinition leaning = definition_of(beam);
  leaning.blades.beam.reference_line = {Vector3::Zero(),
                                        1.3 * Vector3(std::cos(lean), 0.0, std::sin(lean)),
                                        3.0 * Vector3(std::cos(lean), 0.0, std::sin(lean))};
  const std::vector<double> expected = frequencies(constant_modes_of(coned));
  const std::vector<double> found = frequencies(constant_modes_of(leaning));
  BOOST_REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < 6; ++i) BOOST_TEST(found[i] == expected[i], tolerance(1e-8));
}

BOOST_AUTO_TEST_CASE(a_light_beam_with_a_mass_on_it_has_the_frequencies_of_its_flexibility) {
  // At the place a of a body (m, J): flexibility [a^3/3, a^2/2; a^2/2, a]/EI in flap and lead-lag.
  // The beam itself is light: 2e-6 of the mass, which slows it by as much.
  BeamCase beam;
  beam.length = 2.0;
  beam.mass = 1.5e-6;
  beam.inertia = Vector3::Zero();
  beam.stiffness << 0.0, 0.0, 0.0, 0.0, 50.0, 80.0;
  beam.elements = 3;
  beam.order = 2;
  for (const double at : {0.3, 0.55, 1.0}) {
    model::TurbineDefinition definition = definition_of(beam);
    const double m = 1.5;
    const double J = 0.4;
    definition.blades.beam.point_masses = {{at, m, Vector3::Zero(), Vector3(0.1, J, J)}};
    const std::vector<double> found = frequencies(constant_modes_of(definition));
    const double a = at * beam.length;
    for (const double EI : {50.0, 80.0}) {
      Eigen::Matrix2d flexibility;
      flexibility << a * a * a / 3.0, a * a / 2.0, a * a / 2.0, a;
      const Eigen::Matrix2d mass = Eigen::Vector2d(m, J).asDiagonal();
      const Eigen::Vector2cd values = (flexibility / EI * mass).eigenvalues();
      for (int i = 0; i < 2; ++i) {
        const double omega = 1.0 / std::sqrt(values(i).real());
        BOOST_TEST(nearest(found, omega) == omega, tolerance(4e-6));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_mass_beside_the_line_twists_a_light_beam) {
  // Torsion alone is elastic: a mass at the distance c from the line on a shaft of length a has
  // omega^2 = GJ / (a (I1 + m c^2)).
  BeamCase beam;
  beam.length = 2.0;
  beam.mass = 1e-6;
  beam.inertia = Vector3(1e-6, 0.0, 0.0);
  beam.stiffness << 0.0, 0.0, 0.0, 30.0, 0.0, 0.0;
  beam.elements = 4;
  beam.order = 1;
  model::TurbineDefinition definition = definition_of(beam);
  definition.blades.beam.point_masses = {
      {0.7, 2.0, Vector3(0.2, 0.3, -0.4), Vector3(0.5, 0.0, 0.0)}};
  const double inertia = 0.5 + 2.0 * (0.3 * 0.3 + 0.4 * 0.4);
  const double omega = std::sqrt(30.0 / (0.7 * beam.length * inertia));
  BOOST_TEST(frequencies(constant_modes_of(definition)).front() == omega, tolerance(2e-6));
}

BOOST_AUTO_TEST_CASE(a_skewed_teeter_hinge_has_the_frequency_of_a_turning_rigid_body) {
  // A rigid rotor with inertias J1, J2, J3 about h1, h2, h3 that turns about h2 and rocks about
  // e = (cos d, 0, sin d): linearized about steady rotation,
  // omega^2 (J1 cos^2 d + J3 sin^2 d) = Omega^2 (J2 - J1 sin^2 d - J3 cos^2 d) + k.
  constexpr double speed = 5.0;
  constexpr double k = 40.0;
  for (const double delta3 : {0.0, 0.4, -0.7}) {
    BeamCase beam;
    beam.length = 1.5;
    beam.speed = speed;
    beam.mass = 2.0;
    beam.stiffness.setZero();  // rigid
    beam.inertia = Vector3(0.05, 0.02, 0.03);
    beam.elements = 2;
    beam.order = 2;
    model::TurbineDefinition definition = definition_of(beam);
    definition.blades.count = 2;
    definition.hub.inertia = Vector3(0.3, 0.9, 0.2);
    definition.hub.teeter = {model::JointKind::free, k, 0.0};
    definition.hub.delta3 = delta3;
    const double l = beam.length;
    const double flap = 2.0 * (beam.mass * l * l * l / 3.0 + 0.02 * l);
    const double lag = 2.0 * (beam.mass * l * l * l / 3.0 + 0.03 * l);
    const double J1 = 0.3 + flap;  // b2 = h1
    const double J2 = 0.9 + lag;   // b3 = h2
    const double J3 = 0.2 + 2.0 * 0.05 * l;
    const double c = std::cos(delta3) * std::cos(delta3);
    const double s = 1.0 - c;
    const double omega =
        std::sqrt((speed * speed * (J2 - J1 * s - J3 * c) + k) / (J1 * c + J3 * s));
    const std::vector<double> found = frequencies(constant_modes_of(definition));
    BOOST_REQUIRE(found.size() == 1u);
    BOOST_TEST(found.front() == omega, tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_CASE(a_coned_rotor_flattens_by_its_centrifugal_load) {
  // Small cone b, stiff blade: the load m Omega^2 r b at r toward the plane of rotation bends a
  // cantilever by b m Omega^2 11 L^5 / (120 EI) at the tip, and pulls 11/120 out of the quintic.
  constexpr double cone = 1e-3;
  BeamCase beam;
  beam.length = 2.0;
  beam.speed = 1e-2;
  beam.mass = 3.0;
  beam.stiffness << 0.0, 0.0, 0.0, 0.0, 70.0, 90.0;
  beam.elements = 4;
  beam.order = 3;
  model::TurbineDefinition definition = definition_of(beam);
  definition.blades.precone = cone;
  const double exact = -cone * 3.0 * 1e-4 * 11.0 * std::pow(beam.length, 5) / (120.0 * 70.0);
  BOOST_TEST(tip_deflection(definition)(2) == exact, tolerance(1e-5));
}
