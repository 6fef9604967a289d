// Parked turbines and beams under their weight: global equilibrium by plain geometry, and closed
// forms of beams with the order of convergence.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/math/quadrature.hpp"

#include "bodies.hpp"

namespace {

using namespace samara;

constexpr double pi = std::numbers::pi;

/// Newton stops here, relative to the largest load; its next step would be at round-off.
constexpr double newton_tolerance = 1e-12;

/// Sums over a whole turbine after a solve with a condition of some 1e6.
constexpr double equilibrium_tolerance = 1e-9;

/// z with r(0, z, 0) = 0, from the reference state.
Eigen::VectorXd find_static_state(const system::PeriodicSystem& system) {
  Eigen::VectorXd z = sample::reference_state_of(system, 0.0);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Eigen::VectorXd r = sample::residual_of(system, 0.0, z, zero);
    const Eigen::MatrixXd K = sample::tangents_of(system, 0.0, z, zero).K;
    const Eigen::VectorXd step = Eigen::PartialPivLU<Eigen::MatrixXd>(K).solve(r);
    z -= step;
    if (step.norm() < newton_tolerance * (1.0 + z.norm())) return z;
  }
  BOOST_FAIL("Newton's method did not converge");
  return z;
}

/// A parked turbine whose joints are locked or sprung.
model::TurbineDefinition parked(sample::Choice choice) {
  choice.damped = false;
  model::TurbineDefinition definition = sample::turbine_definition(choice);
  definition.shaft.speed = 0.0;
  definition.shaft.generator.kind = model::JointKind::locked;  // or nothing holds the rotor
  return definition;
}

turbine::TurbineSystem build(const model::TurbineDefinition& definition) {
  return turbine::TurbineSystem(model::build_turbine(definition), PETSC_COMM_SELF);
}

/// Weight and its moment about a place, in N.
struct Weight {
  Vector3 force = Vector3::Zero();
  Vector3 moment = Vector3::Zero();

  void add(const sample::Piece& piece, double gravity, const Vector3& about) {
    const Vector3 weight(0.0, 0.0, -piece.mass * gravity);
    force += weight;
    moment += (piece.center - about).cross(weight);
  }
};

/// One horizontal blade on the ground with its leading edge down, without twist or couplings:
/// gravity along +b2.
model::TurbineDefinition single_blade(double azimuth_deg, int elements, int order) {
  model::TurbineDefinition definition;
  definition.gravity = 1e-5;  // strains of 1e-8: the closed forms are linear
  definition.shaft.azimuth = azimuth_deg * pi / 180.0;
  definition.blades.count = 1;
  definition.blades.beam.length = 3.0;
  definition.blades.beam.elements = elements;
  definition.blades.beam.order = order;
  model::SectionDefinition section;
  section.stiffness = Vector6(4e4, 2e4, 3e4, 1e3, 1.5e3, 2.5e3).asDiagonal();
  section.mass = sample::section_mass(2.0, 0.0, 0.0, Vector3(0.5, 0.2, 0.3));
  definition.blades.beam.sections = {section};
  return definition;
}

Vector6 tip_of(const model::TurbineDefinition& definition) {
  const turbine::TurbineSystem system = build(definition);
  return find_static_state(system).segment<6>(system.layout().blade_tip(0));
}

constexpr double length = 3.0;
constexpr double line_weight = 2.0 * 1e-5;  ///< m g [N/m]

}  // namespace

BOOST_AUTO_TEST_SUITE(equilibrium)

BOOST_AUTO_TEST_CASE(the_tower_root_carries_the_weight_of_the_deformed_turbine) {
  for (const sample::Choice& choice : sample::choices()) {
    if (!choice.tower) continue;
    const model::TurbineDefinition definition = parked(choice);
    const turbine::TurbineSystem system = build(definition);
    const Eigen::VectorXd z = find_static_state(system);
    const sample::Bodies bodies = sample::bodies_at(definition, system, 0.0, z);
    // Far from the undeformed state: the equilibrium is that of the deformed turbine.
    BOOST_TEST((bodies.top - Vector3(0.0, 0.0, definition.tower.length)).norm() > 0.01);
    Weight weight;
    for (const sample::Piece& piece : bodies.pieces)
      weight.add(piece, definition.gravity, Vector3::Zero());
    weight.moment += definition.shaft.rotor.torque * bodies.R_H.col(1);  // the rotor's torque
    // The root loads act on the ground; components along (n3, n1, n2).
    const int root = system.layout().tower_root();
    const Vector3 force(z(root + 1), z(root + 2), z(root));
    const Vector3 moment(z(root + 4), z(root + 5), z(root + 3));
    const double scale = weight.force.norm() * definition.tower.length;
    BOOST_TEST(weight.moment.norm() > 0.01 * scale);
    BOOST_TEST((force - weight.force).norm() < equilibrium_tolerance * weight.force.norm());
    BOOST_TEST((moment - weight.moment).norm() < equilibrium_tolerance * scale);
  }
}

BOOST_AUTO_TEST_CASE(each_blade_root_carries_the_weight_of_its_deformed_blade) {
  for (const sample::Choice& choice : sample::choices()) {
    model::TurbineDefinition definition = parked(choice);
    definition.blades.each[1].pitch = 0.3;
    definition.blades.each[1].mass_factor = 1.2;
    definition.blades.each[1].stiffness_factor = 0.8;
    const turbine::TurbineSystem system = build(definition);
    const Eigen::VectorXd z = find_static_state(system);
    const sample::Bodies bodies = sample::bodies_at(definition, system, 0.0, z);
    for (int k = 0; k < choice.blades; ++k) {
      const auto at = static_cast<std::size_t>(k);
      Weight weight;
      for (const sample::Piece& piece : bodies.pieces)
        if (piece.blade == k) weight.add(piece, definition.gravity, bodies.roots[at]);
      const int root = system.layout().blade_root(k);
      const Vector3 force = bodies.axes[at] * z.segment<3>(root);
      const Vector3 moment = bodies.axes[at] * z.segment<3>(root + 3);
      const double scale = weight.force.norm() * definition.blades.beam.length;
      BOOST_TEST((force - weight.force).norm() < equilibrium_tolerance * weight.force.norm());
      BOOST_TEST((moment - weight.moment).norm() < equilibrium_tolerance * scale);
    }
  }
}

BOOST_AUTO_TEST_CASE(sprung_joints_balance_the_moment_of_the_weight_about_their_axes) {
  const model::TurbineDefinition definition = parked({2, 2, true, true, true, false, false});
  const turbine::TurbineSystem system = build(definition);
  const Eigen::VectorXd z = find_static_state(system);
  const sample::Bodies bodies = sample::bodies_at(definition, system, 0.0, z);
  // The teeter's spring holds hub and blades about h1 through the pin.
  const Vector3 apex = bodies.roots[0] - definition.hub.radius * bodies.axes[0].col(0);
  const Vector3 pin = apex - definition.hub.undersling * bodies.R_H.col(1);
  Weight rotor;
  for (const sample::Piece& piece : bodies.pieces)
    if (piece.blade >= 0) rotor.add(piece, definition.gravity, pin);
  sample::Piece hub;
  hub.mass = definition.hub.mass;
  hub.center = pin + definition.hub.center_of_mass * bodies.R_H.col(1);
  rotor.add(hub, definition.gravity, pin);
  const double asked = definition.hub.teeter.stiffness * z(system.layout().teeter());
  const double scale = rotor.force.norm() * definition.blades.beam.length;
  BOOST_TEST(std::abs(asked) > 1e-3 * scale);
  BOOST_TEST(std::abs(asked - bodies.R_H.col(0).dot(rotor.moment)) < equilibrium_tolerance * scale);

  Weight all;
  for (const sample::Piece& piece : bodies.pieces)
    if (piece.blade >= 0) all.add(piece, definition.gravity, bodies.top);
  for (std::size_t i = 0; i < bodies.pieces.size(); ++i) {
    const sample::Piece& piece = bodies.pieces[i];
    const bool rigid = piece.blade < 0 && piece.strain == 0.0;
    if (rigid) all.add(piece, definition.gravity, bodies.top);
  }
  const double yaw = definition.nacelle.yaw.stiffness * z(system.layout().yaw());
  const Vector3 y3 = bodies.R_T.col(2);
  BOOST_TEST(std::abs(yaw) > 1e-4 * scale);
  BOOST_TEST(std::abs(yaw - y3.dot(all.moment)) < equilibrium_tolerance * scale);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(signs)

BOOST_AUTO_TEST_CASE(blade_axes_are_those_of_the_case_files_page) {
  for (const int count : {1, 2, 3, 4}) {
    model::TurbineDefinition definition = sample::turbine_definition({count});
    definition.blades.each[1].pitch = -0.4;
    const model::Turbine turbine = model::build_turbine(definition);
    for (int k = 0; k < count; ++k) {
      const model::BladeRoot& root = turbine.roots[static_cast<std::size_t>(k)];
      const Matrix3 axes = sample::blade_axes(definition.blades, k);
      BOOST_TEST((root.C_Ha - axes).cwiseAbs().maxCoeff() < 1e-14);
      // The radius is measured along the cone, as in OpenFAST.
      BOOST_TEST((root.position - 0.35 * axes.col(0)).norm() < 1e-14);
    }
  }
}

BOOST_AUTO_TEST_CASE(cone_tips_lean_downwind_and_pitched_leading_edges_upwind) {
  model::TurbineDefinition definition = single_blade(0.0, 1, 1);
  definition.blades.precone = 0.1;
  definition.blades.pitch = 0.2;
  const Matrix3 C_Ha = model::build_turbine(definition).roots[0].C_Ha;
  BOOST_TEST((C_Ha.col(0) - Vector3(0.0, std::sin(0.1), std::cos(0.1))).norm() < 1e-14);
  BOOST_TEST(C_Ha(0, 1) > 0.9);  // b2 toward +h1, in which blade 1 moves
  BOOST_TEST(C_Ha(1, 1) < 0.0);  // and upwind
  BOOST_TEST(C_Ha(1, 2) > 0.9);
}

BOOST_AUTO_TEST_CASE(blade_1_is_up_at_azimuth_zero_and_moves_toward_n1) {
  model::TurbineDefinition definition = single_blade(0.0, 1, 1);
  definition.shaft.speed = 2.0;
  definition.hub.radius = 0.5;
  const turbine::TurbineSystem system = build(definition);
  const Eigen::VectorXd z = sample::reference_state_of(system, 0.0);
  const Vector6 tip = z.segment<6>(system.layout().blade_tip(0) + 6);
  BOOST_TEST((tip.head<3>() - Vector3(0.0, 2.0 * 3.5, 0.0)).norm() < 1e-14);  // b2 = n1
  BOOST_TEST((tip.tail<3>() - Vector3(0.0, 0.0, 2.0)).norm() < 1e-14);        // b3 = s2
}

BOOST_AUTO_TEST_CASE(gravity_pulls_down_at_every_azimuth) {
  // Blade axes at azimuth psi: n3 = b1 cos(psi) - b2 sin(psi); the root carries the weight.
  const double weight = line_weight * length;
  for (const double azimuth_deg : {0.0, 30.0, 90.0, 180.0, 270.0, 300.0}) {
    const model::TurbineDefinition definition = single_blade(azimuth_deg, 2, 1);
    const turbine::TurbineSystem system = build(definition);
    const Eigen::VectorXd z = find_static_state(system);
    const Vector6 root = z.segment<6>(system.layout().blade_root(0));
    const double psi = azimuth_deg * pi / 180.0;
    const Vector3 force(-weight * std::cos(psi), weight * std::sin(psi), 0.0);
    BOOST_TEST((root.head<3>() - force).norm() < equilibrium_tolerance * weight);
    // m g L^2 / 2 about b3 at the root.
    const Vector3 moment(0.0, 0.0, 0.5 * weight * length * std::sin(psi));
    BOOST_TEST((root.tail<3>() - moment).norm() < 1e-6 * weight * length);
  }
}

BOOST_AUTO_TEST_CASE(tilt_raises_the_downwind_end) {
  // Blade 1 up: s2 = b3 points up by the tilt, the weight along it is negative.
  model::TurbineDefinition definition = single_blade(0.0, 2, 1);
  definition.shaft.tilt = 0.2;
  const turbine::TurbineSystem system = build(definition);
  const Eigen::VectorXd z = find_static_state(system);
  const Vector3 force = z.segment<3>(system.layout().blade_root(0));
  const double weight = line_weight * length;
  BOOST_TEST((force - weight * Vector3(-std::cos(0.2), 0.0, -std::sin(0.2))).norm() <
             equilibrium_tolerance * weight);
}

BOOST_AUTO_TEST_CASE(twist_turns_the_leading_edge_upwind_as_pitch_does) {
  // A section twisted by a right angle bends downward with EI2 where it would bend with EI3.
  model::TurbineDefinition definition = single_blade(90.0, 4, 3);
  const double edgewise = tip_of(definition)(1);
  definition.blades.beam.sections[0].twist = 0.5 * pi;
  const double flapwise = tip_of(definition)(1);
  const double bending = line_weight * std::pow(length, 4) / 8.0;
  const double shear = line_weight * length * length / 2.0;
  BOOST_TEST(std::abs(edgewise / (bending / 2.5e3 + shear / 2e4) - 1.0) < 1e-6);
  BOOST_TEST(std::abs(flapwise / (bending / 1.5e3 + shear / 3e4) - 1.0) < 1e-6);
  // Half of it couples the two: down and, as the leading edge is upwind, toward +b3.
  definition.blades.beam.sections[0].twist = 0.25 * pi;
  const Vector6 tip = tip_of(definition);
  const double stiff = bending / 2.5e3 + shear / 2e4;
  const double soft = bending / 1.5e3 + shear / 3e4;
  // Section axes b2' = (b2 - b3) / sqrt 2, b3' = (b2 + b3) / sqrt 2.
  BOOST_TEST(std::abs(tip(1) / (0.5 * (soft + stiff)) - 1.0) < 1e-6);
  BOOST_TEST(std::abs(tip(2) / (0.5 * (soft - stiff)) - 1.0) < 1e-6);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(closed_forms)

BOOST_AUTO_TEST_CASE(a_hanging_blade_lengthens_and_a_standing_one_shortens) {
  const double expected = line_weight * length * length / (2.0 * 4e4);
  BOOST_TEST(std::abs(tip_of(single_blade(180.0, 2, 2))(0) / expected - 1.0) < 1e-6);
  BOOST_TEST(std::abs(tip_of(single_blade(0.0, 2, 2))(0) / expected + 1.0) < 1e-6);
}

BOOST_AUTO_TEST_CASE(a_mass_centre_beside_the_line_twists_a_horizontal_blade) {
  // Gravity along b2 at c3: the moment c3 b3 x m g b2 = -c3 m g b1 per length.
  model::TurbineDefinition definition = single_blade(90.0, 2, 2);
  definition.blades.beam.sections[0].mass =
      sample::section_mass(2.0, 0.0, 0.1, Vector3(0.5, 0.2, 0.3));
  const double expected = -0.1 * line_weight * length * length / (2.0 * 1e3);
  BOOST_TEST(std::abs(tip_of(definition)(3) / expected - 1.0) < 1e-6);
}

BOOST_AUTO_TEST_CASE(a_tip_mass_bends_a_horizontal_blade) {
  model::TurbineDefinition definition = single_blade(90.0, 4, 2);
  const double before = tip_of(definition)(1);
  definition.blades.beam.tip_mass = 1.5;
  const double load = 1.5 * 1e-5;
  const double expected = load * std::pow(length, 3) / (3.0 * 2.5e3) + load * length / 2e4;
  BOOST_TEST(std::abs((tip_of(definition)(1) - before) / expected - 1.0) < 1e-6);
}

BOOST_AUTO_TEST_CASE(factors_of_one_blade_multiply_its_masses_and_stiffnesses) {
  model::TurbineDefinition definition = single_blade(90.0, 4, 2);
  const double before = tip_of(definition)(1);
  definition.blades.each[1].stiffness_factor = 2.0;
  BOOST_TEST(std::abs(tip_of(definition)(1) / before - 0.5) < 1e-6);
  definition.blades.each[1].mass_factor = 3.0;
  BOOST_TEST(std::abs(tip_of(definition)(1) / before - 1.5) < 1e-6);
}

BOOST_AUTO_TEST_CASE(deflection_of_a_tapered_cantilever_converges_with_order_2s) {
  // Stiffness falls linearly to 40 % at the tip. Virtual work: tip = int m g (L-x)^3 / (2 EI) dx +
  // int m g (L-x) / GA dx, by a Gauss rule of 40 points.
  const math::QuadratureRule fine = math::gauss_rule(40);
  double exact = 0.0;
  for (std::size_t j = 0; j < fine.points.size(); ++j) {
    const double fraction = fine.points[j];
    const double factor = 1.0 - 0.6 * fraction;
    const double rest = length * (1.0 - fraction);
    exact += length * fine.weights[j] * line_weight *
             (std::pow(rest, 3) / (2.0 * 2.5e3 * factor) + rest / (2e4 * factor));
  }
  const auto error_of = [exact](int elements, int order) {
    model::TurbineDefinition definition = single_blade(90.0, elements, order);
    model::SectionDefinition end = definition.blades.beam.sections[0];
    end.at = 1.0;
    end.stiffness *= 0.4;
    definition.blades.beam.sections.push_back(end);
    return std::abs(tip_of(definition)(1) / exact - 1.0);
  };
  // Elements from where the asymptote holds.
  const std::vector<int> coarse{8, 4, 4};
  for (int order = 1; order <= 3; ++order) {
    const int elements = coarse[static_cast<std::size_t>(order) - 1];
    const double slope = std::log2(error_of(elements, order) / error_of(2 * elements, order));
    BOOST_TEST(std::abs(slope - 2.0 * order) < 0.3, "order " << order << ": slope " << slope);
  }
}

BOOST_AUTO_TEST_SUITE_END()
