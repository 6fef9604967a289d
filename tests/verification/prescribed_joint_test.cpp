// Joints that move as prescribed: closed forms of rigid bodies, and what does not depend on where a
// joint is held.
#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "samara/analysis/harmonic_balance.hpp"
#include "samara/analysis/shooting.hpp"

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

constexpr double tower_length = 6.0;
constexpr double overhang = 1.3;
constexpr double speed = 4.0;
constexpr double blade_mass = 2.0;  ///< per length
constexpr double blade_length = 1.5;
const Vector3 section_inertia(0.05, 0.02, 0.03);

/// Three rigid blades on a rigid hub, a nacelle and a rigid tower.
model::TurbineDefinition rigid_turbine() {
  BeamCase beam;
  beam.length = blade_length;
  beam.speed = speed;
  beam.mass = blade_mass;
  beam.inertia = section_inertia;
  beam.stiffness.setZero();  // rigid
  beam.elements = 1;
  beam.order = 2;
  model::TurbineDefinition definition = definition_of(beam);
  definition.blades.count = 3;
  definition.hub.mass = 5.0;
  definition.hub.inertia = Vector3(0.3, 0.9, 0.3);
  definition.shaft.overhang = overhang;
  definition.has_nacelle = true;
  definition.nacelle.mass = 7.0;
  definition.nacelle.inertia = Vector3(0.4, 0.5, 0.6);
  definition.nacelle.yaw.kind = model::JointKind::prescribed;
  definition.has_tower = true;
  definition.tower = definition.blades.beam;
  definition.tower.length = tower_length;
  return definition;
}

double rotor_mass() { return 5.0 + 3.0 * blade_mass * blade_length; }

double axial_inertia() {
  const double l = blade_length;
  return 0.9 + 3.0 * (blade_mass * l * l * l / 3.0 + section_inertia(2) * l);
}

/// About any axis of the rotor plane through the hub.
double lateral_inertia() {
  const double l = blade_length;
  return 0.3 + 1.5 * (blade_mass * l * l * l / 3.0 + (section_inertia(0) + section_inertia(1)) * l);
}

/// Force and moment of the turbine on the ground in n1 n2 n3.
Vector6 ground_load(const turbine::TurbineSystem& system, const analysis::Trim& trim, double t) {
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  trim.solution.evaluate(t, z.get(), z_dot.get());
  const petsc::ReadView view(z.get());
  const int root = system.layout().tower_root();  // along n3, n1, n2
  Vector6 load;
  load << view[root + 1], view[root + 2], view[root], view[root + 4], view[root + 5],
      view[root + 3];
  return load;
}

analysis::Trim trim_of(const turbine::TurbineSystem& system, int harmonics) {
  analysis::TrimOptions options;
  options.harmonics = harmonics;
  options.tolerance = 1e-13;
  analysis::Observer observer;
  return analysis::find_trim(system, options, observer);
}

/// Elastic blades on an elastic round tower, all small.
model::TurbineDefinition elastic_turbine() {
  model::TurbineDefinition definition = rigid_turbine();
  for (model::BeamDefinition* beam : {&definition.blades.beam, &definition.tower}) {
    model::SectionDefinition& section = beam->sections.front();
    section.rigid = {true, true, true, false, false, false};
    section.stiffness.diagonal() << 0.0, 0.0, 0.0, 300.0, 500.0, 900.0;
  }
  definition.tower.sections.front().stiffness.diagonal() << 0.0, 0.0, 0.0, 4e4, 6e4, 6e4;
  definition.tower.sections.front().mass.diagonal() << 4.0, 4.0, 4.0, 0.2, 0.1, 0.1;
  return definition;
}

}  // namespace

BOOST_AUTO_TEST_CASE(weights_act_where_a_held_yaw_puts_them) {
  // Parked, tilted: nacelle and rotor stand 30 degrees round, their weight has the moment r x W.
  model::TurbineDefinition definition = rigid_turbine();
  definition.gravity = 9.81;
  definition.shaft.speed = 0.0;
  definition.shaft.tilt = 0.2;
  definition.shaft.height = 0.4;
  definition.nacelle.center_of_mass = Vector3(0.1, -0.3, 0.2);
  definition.nacelle.yaw.motion.angle = pi / 6.0;
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const Vector6 load = ground_load(system, trim_of(system, 0), 0.0);
  // Counter-clockwise from above: n1 toward n2.
  const auto turned = [](const Vector3& y) {
    const double c = std::cos(pi / 6.0);
    const double s = std::sin(pi / 6.0);
    return Vector3(c * y(0) - s * y(1), s * y(0) + c * y(1), y(2));
  };
  const Vector3 top(0.0, 0.0, tower_length);
  const Vector3 nacelle = top + turned(definition.nacelle.center_of_mass);
  const Vector3 hub =
      top + turned(Vector3(0.0, overhang * std::cos(0.2), 0.4 + overhang * std::sin(0.2)));
  const Vector3 down(0.0, 0.0, -9.81);
  const double weight = 9.81 * (7.0 + rotor_mass() + blade_mass * tower_length);
  const Vector3 moment =
      nacelle.cross(Vector3(7.0 * down)) + hub.cross(Vector3(rotor_mass() * down));
  BOOST_TEST((load.head<3>() - Vector3(0.0, 0.0, -weight)).norm() < 1e-11 * weight);
  BOOST_TEST((load.tail<3>() - moment).norm() < 1e-11 * moment.norm());
}

BOOST_AUTO_TEST_CASE(a_yaw_that_swings_meets_the_gyroscopic_moment_of_the_rotor) {
  // Momentum p = m v and moment of momentum H = r x m v + A Omega s2 + B q_dot n3 (+ nacelle) about
  // the foot, s2 = (-sin q, cos q, 0): the ground takes -p_dot and -H_dot.
  for (const int per_rev : {1, 3}) {
    model::TurbineDefinition definition = rigid_turbine();
    definition.nacelle.yaw.motion = {0.5, 0.3, per_rev, 0.0, 0.7};
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    const analysis::Trim trim = trim_of(system, 12 * per_rev);
    double gyroscopic = 0.0;
    for (int k = 0; k < 7; ++k) {
      const double t = system.period() * k / 7.0;
      const double rate = per_rev * speed;
      const double q = 0.5 + 0.3 * std::cos(rate * t + 0.7);
      const double q_dot = -0.3 * rate * std::sin(rate * t + 0.7);
      const double q_ddot = -0.3 * rate * rate * std::cos(rate * t + 0.7);
      const Vector3 s2(-std::sin(q), std::cos(q), 0.0);
      const Vector3 across(-std::cos(q), -std::sin(q), 0.0);  // d s2/dq
      const Vector3 n3 = Vector3::UnitZ();
      const Vector3 place = tower_length * n3 + overhang * s2;
      const Vector3 acceleration = overhang * (q_ddot * across - q_dot * q_dot * s2);
      const Vector3 force = -rotor_mass() * acceleration;
      const Vector3 moment = place.cross(force) - axial_inertia() * speed * q_dot * across -
                             (lateral_inertia() + 0.6) * q_ddot * n3;
      gyroscopic = std::max(gyroscopic, axial_inertia() * speed * std::abs(q_dot));
      const Vector6 load = ground_load(system, trim, t);
      const double size = rotor_mass() * overhang * 0.3 * rate * rate;
      BOOST_TEST((load.head<3>() - force).norm() < 1e-9 * size);
      BOOST_TEST((load.tail<3>() - moment).norm() < 1e-9 * size * tower_length);
    }
    BOOST_TEST(gyroscopic > 1.0);
  }
}

BOOST_AUTO_TEST_CASE(a_round_tower_has_the_same_modes_wherever_the_yaw_is_held) {
  model::TurbineDefinition definition = elastic_turbine();
  definition.shaft.tilt = 0.1;
  definition.nacelle.center_of_mass = Vector3(0.0, -0.3, 0.2);
  definition.shaft.speed = 0.0;
  definition.nacelle.yaw.kind = model::JointKind::locked;
  const std::vector<double> locked = frequencies(constant_modes_of(definition));
  definition.nacelle.yaw.kind = model::JointKind::prescribed;
  definition.nacelle.yaw.motion.angle = 0.9;
  const std::vector<double> held = frequencies(constant_modes_of(definition));
  BOOST_TEST_REQUIRE(held.size() == locked.size());
  BOOST_TEST_REQUIRE(held.size() > 5u);
  for (std::size_t i = 0; i < held.size(); ++i) BOOST_TEST(held[i] == locked[i], tolerance(1e-7));
}

BOOST_AUTO_TEST_CASE(a_blade_passage_is_enough_where_the_yaw_repeats_in_it) {
  model::TurbineDefinition definition = elastic_turbine();
  definition.gravity = 9.81;
  definition.nacelle.yaw.motion = {0.2, 0.05, 3, 0.0, 0.7};
  analysis::TrimOptions options;
  options.harmonics = 7;
  const analysis::Floquet full =
      floquet_of(definition, 600, analysis::FloquetPeriod::full, options);
  const analysis::Floquet blade =
      floquet_of(definition, 600, analysis::FloquetPeriod::blade, options);
  BOOST_TEST(blade.sectors == 3);
  std::vector<Complex> others;
  for (const analysis::Mode& mode : full.set.modes) others.push_back(mode.multiplier);
  int compared = 0;
  for (const analysis::Mode& mode : blade.set.modes) {
    if (!mode.resolved) continue;
    double distance = 1.0;
    for (const Complex& other : others)
      distance = std::min({distance, std::abs(other - mode.multiplier),
                           std::abs(std::conj(other) - mode.multiplier)});
    BOOST_TEST(distance < 1e-6, mode.label << ": " << distance);
    ++compared;
  }
  BOOST_TEST(compared > 5);
}

BOOST_AUTO_TEST_CASE(shooting_finds_the_same_motion_to_the_order_of_its_step) {
  model::TurbineDefinition definition = elastic_turbine();
  definition.blades.count = 2;
  definition.blades.beam.damping.setConstant(0.01);
  definition.tower.damping.setConstant(0.01);
  definition.hub.teeter.kind = model::JointKind::prescribed;
  definition.hub.teeter.motion = {0.05, 0.1, 1, 0.0, 0.3};
  definition.nacelle.yaw.motion = {0.2, 0.05, 1, 0.0, 0.7};
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const analysis::Trim reference = trim_of(system, 8);
  analysis::Observer observer;
  const auto difference = [&](int steps) {
    const analysis::Trim trim = analysis::solve_shooting(system, steps, 1e-10, observer);
    double largest = 0.0;
    for (Eigen::Index i = 0; i < reference.solution.coefficients().rows(); ++i)
      if (system.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::position)
        largest = std::max(largest, (trim.solution.coefficients().row(i).head(9) -
                                     reference.solution.coefficients().row(i).head(9))
                                        .cwiseAbs()
                                        .maxCoeff());
    return largest;
  };
  const double coarse = difference(200);
  const double fine = difference(400);
  BOOST_TEST(fine < 1e-4);
  BOOST_TEST(std::log2(coarse / fine) == 2.0, tolerance(0.1));
}
