// The drivetrain: rotor, shaft and generator as two rigid bodies on a spring, and what the torque
// that holds the mean speed does to the tower.
#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

constexpr double stiffness = 400.0;
constexpr double generator_inertia = 3.0;
constexpr double blade_mass = 2.0;
constexpr double blade_length = 1.5;

/// Two rigid blades on a rigid hub without a tower.
model::TurbineDefinition rotor(double speed, bool free_torsion, bool free_generator) {
  BeamCase beam;
  beam.length = blade_length;
  beam.speed = speed;
  beam.mass = blade_mass;
  beam.inertia = Vector3(0.05, 0.02, 0.03);
  beam.stiffness.setZero();  // rigid
  beam.elements = 2;
  beam.order = 2;
  model::TurbineDefinition definition = definition_of(beam);
  definition.blades.count = 2;
  definition.hub.inertia = Vector3(0.3, 0.9, 0.2);
  definition.shaft.inertia_axial = 0.4;
  if (free_torsion) definition.shaft.torsion = {model::JointKind::free, stiffness, 0.0};
  definition.shaft.generator.inertia = generator_inertia;
  if (free_generator) definition.shaft.generator.kind = model::JointKind::free;
  return definition;
}

/// About the shaft.
double rotor_inertia() {
  const double l = blade_length;
  return 0.4 + 0.9 + 2.0 * (blade_mass * l * l * l / 3.0 + 0.03 * l);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_rotor_on_a_shaft_held_at_the_generator_is_a_torsion_pendulum) {
  const double omega = std::sqrt(stiffness / rotor_inertia());
  for (const double speed : {0.0, 5.0}) {
    const std::vector<double> found =
        frequencies(constant_modes_of(rotor(speed, true, false)), "shaft torsion");
    BOOST_REQUIRE(found.size() == 1u);
    BOOST_TEST(found.front() == omega, tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_CASE(a_free_generator_swings_against_the_rotor) {
  const double reduced =
      rotor_inertia() * generator_inertia / (rotor_inertia() + generator_inertia);
  for (const double speed : {0.0, 5.0}) {
    const analysis::ModeSet set = constant_modes_of(rotor(speed, true, true));
    BOOST_TEST(set.degrees_of_freedom == 2);
    const std::vector<double> found = frequencies(set, "shaft torsion");
    BOOST_REQUIRE(found.size() == 1u);
    BOOST_TEST(found.front() == std::sqrt(stiffness / reduced), tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_CASE(the_slope_of_the_torque_brings_the_speed_back) {
  // d/dt of the deviation: - slope / (rotor + generator), a real exponent; the angle itself is
  // neutral.
  model::TurbineDefinition definition = rotor(5.0, false, true);
  definition.shaft.generator.torque_slope = 2.5;
  const analysis::ModeSet set = constant_modes_of(definition);
  BOOST_TEST(set.degrees_of_freedom == 1);
  const double rate = -2.5 / (rotor_inertia() + generator_inertia);
  double nearest_rate = 1e9;
  for (const analysis::Mode& mode : set.modes)
    if (std::abs(mode.exponent.real() - rate) < std::abs(nearest_rate - rate))
      nearest_rate = mode.exponent.real();
  BOOST_TEST(nearest_rate == rate, tolerance(1e-8));
}

BOOST_AUTO_TEST_CASE(floquet_finds_the_drivetrain_beside_the_turning_rotor) {
  // Gravity and one heavier blade: periodic coefficients, and a trim whose mean torque holds speed.
  model::TurbineDefinition definition = rotor(5.0, true, true);
  definition.gravity = 9.81;
  const analysis::Floquet floquet = floquet_of(definition, 2000);
  const double reduced =
      rotor_inertia() * generator_inertia / (rotor_inertia() + generator_inertia);
  const std::vector<double> found = frequencies(floquet.set, "shaft torsion");
  BOOST_REQUIRE(found.size() == 1u);
  const double dt = floquet.step;
  const double unwarped = 2.0 / dt * std::tan(0.5 * found.front() * dt);
  BOOST_TEST(unwarped == std::sqrt(stiffness / reduced), tolerance(1e-7));
}

BOOST_AUTO_TEST_CASE(an_unbalanced_rotor_under_gravity_is_held_by_its_generator_on_the_mean) {
  // One blade of mass m l whose centre is at l/2 swings the speed of a free generator: to first
  // order J q'' = - m l g (l/2) sin-like torque at 1 per revolution, amplitude m l^2 g/(2 J
  // Omega^2), about a mean torque of zero.
  constexpr double speed = 30.0;
  BeamCase beam;
  beam.length = blade_length;
  beam.speed = speed;
  beam.mass = blade_mass;
  beam.inertia = Vector3(0.05, 0.02, 0.03);
  beam.stiffness.setZero();
  beam.elements = 2;
  beam.order = 2;
  model::TurbineDefinition definition = definition_of(beam);
  definition.gravity = 1e-3;
  definition.shaft.generator = {model::JointKind::free, generator_inertia, 0.0};
  const system::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  const double l = blade_length;
  const double inertia = generator_inertia + blade_mass * l * l * l / 3.0 + 0.03 * l;
  const double amplitude = 1e-3 * blade_mass * l * l / (2.0 * inertia * speed * speed);
  double largest = 0.0;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  for (int k = 0; k < 360; ++k) {
    trim.solution.evaluate(system.period() * k / 360, z.get(), z_dot.get());
    const petsc::ReadView view(z.get());
    largest = std::max(largest, std::abs(view[system.layout().generator()]));
  }
  BOOST_TEST(largest == amplitude, tolerance(1e-4));
  BOOST_REQUIRE(trim.held.size() == 1u);
  BOOST_TEST(std::abs(trim.held.front().load) < 1e-6 * 1e-3 * blade_mass * l * l);
}
