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
  definition.shaft.generator.law.slope = 2.5;
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
  definition.shaft.generator = {model::JointKind::free, generator_inertia, {}};
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

BOOST_AUTO_TEST_CASE(slopes_of_rotor_and_generator_give_the_exponent_of_the_speed) {
  // J d(omega)/dt = (Q_rotor' - Q_generator') omega: growing where the rotor's torque rises more.
  for (const double rotor_slope : {-1.7, 4.0}) {
    model::TurbineDefinition definition = rotor(5.0, false, true);
    definition.shaft.generator.law = {120.0, 2.5, {}};
    definition.shaft.rotor.table = {{4.0, 90.0 - rotor_slope}, {6.0, 90.0 + rotor_slope}};
    const double rate = (rotor_slope - 2.5) / (rotor_inertia() + generator_inertia);
    const analysis::Floquet floquet = floquet_of(definition, 500);
    double nearest_rate = 1e9;
    for (const analysis::Mode& mode : floquet.set.modes) {
      // The step maps an exponent l to (1 + l dt/2)/(1 - l dt/2).
      const double stepped = std::exp(mode.exponent.real() * floquet.step);
      const double found = 2.0 / floquet.step * (stepped - 1.0) / (stepped + 1.0);
      if (std::abs(found - rate) < std::abs(nearest_rate - rate)) nearest_rate = found;
    }
    BOOST_TEST(nearest_rate == rate, tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_CASE(the_generator_takes_the_power_that_the_rotor_gives) {
  // One heavier blade under gravity swings the speed; over a revolution gravity gives nothing.
  model::TurbineDefinition definition = rotor(5.0, false, true);
  definition.gravity = 9.81;
  definition.blades.each[2].mass_factor = 1.4;
  definition.shaft.generator.law = {120.0, 2.5, {}};
  definition.shaft.rotor = {90.0, -1.7, {}};
  const system::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::TrimOptions options;
  options.harmonics = 24;
  options.tolerance = 1e-13;
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, options, observer);
  BOOST_REQUIRE(trim.held.size() == 1u);
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  double given = 0.0;
  double taken = 0.0;
  double swing = 0.0;
  constexpr int samples = 400;
  for (int k = 0; k < samples; ++k) {
    trim.solution.evaluate(system.period() * k / samples, z.get(), z_dot.get());
    const petsc::ReadView view(z.get());
    const double omega = view[system.layout().generator() + 1];
    swing = std::max(swing, std::abs(omega - 5.0));
    given += (90.0 - 1.7 * (omega - 5.0)) * omega / samples;
    taken += (120.0 + 2.5 * (omega - 5.0) - trim.held.front().load) * omega / samples;
  }
  BOOST_TEST(swing > 0.1);
  BOOST_TEST(taken == given, tolerance(1e-9));
  BOOST_TEST(trim.held.front().load == 30.0, tolerance(0.05));  // what the law gives too much
}

BOOST_AUTO_TEST_CASE(a_rotor_torque_twists_the_shaft_of_a_locked_generator) {
  model::TurbineDefinition definition = rotor(5.0, true, false);
  definition.shaft.rotor = {90.0, -1.7, {}};
  const system::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  BOOST_TEST(trim.solution.coefficients()(system.layout().shaft_torsion(), 0) == 90.0 / stiffness,
             tolerance(1e-12));
}
