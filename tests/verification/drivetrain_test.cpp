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

/// The same on a rigid tower whose foot may roll about the shaft's direction on a spring.
constexpr double foot_stiffness = 3e4;
constexpr double foot_inertia = 40.0;
constexpr double tower_length = 0.5;
constexpr double tower_mass = 6.0;   // per length
constexpr double tower_polar = 0.7;  // per length
constexpr double nacelle_inertia = 25.0;

model::TurbineDefinition rolling(double speed, double ratio, double inertia, bool free_generator) {
  model::TurbineDefinition definition = rotor(speed, true, free_generator);
  definition.blades.count = 3;
  definition.shaft.generator.inertia = inertia;
  definition.shaft.gear_ratio = ratio;
  definition.has_tower = definition.has_nacelle = true;
  definition.tower = definition.blades.beam;  // rigid
  definition.tower.length = tower_length;
  definition.tower.sections.front().mass.diagonal() << tower_mass, tower_mass, tower_mass, 1.0, 0.3,
      tower_polar;
  model::SupportDefinition& foot = definition.tower.support;
  foot.rigid.fill(true);
  foot.rigid[5] = false;  // about b3 = n2
  foot.stiffness(5, 5) = foot_stiffness;
  foot.mass = 1.0;
  foot.inertia = Vector3(1.0, 1.0, foot_inertia);
  definition.nacelle.inertia = Vector3(2.0, nacelle_inertia, 3.0);
  return definition;
}

/// Roll p of the nacelle, rotor q and low-speed end g of the gear against it, n the gear ratio:
/// T = I_N p'^2/2 + I_r (p' + q')^2/2 + J_g (p' + n g')^2/2, V = k p^2/2 + k_s (q - g)^2/2.
std::vector<double> rolling_frequencies(double ratio, double inertia, bool free_generator) {
  const double l = blade_length;
  const double h = tower_length;
  const double turning = 0.4 + 0.9 + 3.0 * (blade_mass * l * l * l / 3.0 + 0.03 * l);
  const double rolling = foot_inertia + nacelle_inertia + tower_mass * h * h * h / 3.0 +
                         tower_polar * h + 3.0 * blade_mass * l * h * h;
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  M(0, 0) = rolling;
  const auto add = [&M](double body, const Eigen::Vector3d& rate) {
    M += body * rate * rate.transpose();
  };
  add(turning, {1.0, 1.0, 0.0});
  add(inertia, {1.0, 0.0, ratio});
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  K(0, 0) = foot_stiffness;
  K.bottomRightCorner<2, 2>() << stiffness, -stiffness, -stiffness, stiffness;
  const Eigen::Index n = free_generator ? 3 : 2;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> pairs(
      Eigen::MatrixXd(K.topLeftCorner(n, n)), Eigen::MatrixXd(M.topLeftCorner(n, n)));
  std::vector<double> found;
  for (Eigen::Index i = free_generator ? 1 : 0; i < n; ++i)  // g and q together are neutral
    found.push_back(std::sqrt(pairs.eigenvalues()(i)));
  return found;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_generator_behind_a_gear_rolls_once_with_the_nacelle_and_turns_n_times) {
  for (const double ratio : {97.0, -97.0, 1.0, -1.0})
    for (const bool free_generator : {true, false}) {
      const double inertia = std::abs(ratio) > 1.0 ? 0.05 : generator_inertia;
      const analysis::ModeSet set = constant_modes_of(rolling(0.0, ratio, inertia, free_generator));
      BOOST_TEST(set.degrees_of_freedom == (free_generator ? 3 : 2));
      const std::vector<double> all = frequencies(set);
      for (const double omega : rolling_frequencies(ratio, inertia, free_generator))
        BOOST_TEST(nearest(all, omega) == omega, tolerance(1e-8));
    }
  // Differences to detect: the sense of the generator's rotation, and inertia times n^2 at n = 1.
  const double plus = rolling_frequencies(97.0, 0.05, true).front();
  BOOST_TEST(std::abs(rolling_frequencies(-97.0, 0.05, true).front() / plus - 1.0) > 1e-4);
  const double locked = rolling_frequencies(97.0, 0.05, false).front();
  BOOST_TEST(std::abs(rolling_frequencies(1.0, 0.05 * 97.0 * 97.0, false).front() / locked - 1.0) >
             1e-2);
}

BOOST_AUTO_TEST_CASE(a_generator_behind_a_gear_rolls_so_while_the_rotor_turns) {
  for (const double ratio : {97.0, -97.0}) {
    const analysis::Floquet floquet = floquet_of(rolling(5.0, ratio, 0.05, true), 1500);
    const std::vector<double> all = frequencies(floquet.set);
    for (const double omega : rolling_frequencies(ratio, 0.05, true))
      BOOST_TEST(nearest(all, omega) == omega, tolerance(1e-7));
    int resting = 0;  // rotor and generator turned together, twice: angle and speed
    for (const analysis::Mode& mode : floquet.set.modes)
      if (mode.resolved && std::abs(mode.exponent) < 1e-6) ++resting;
    BOOST_TEST(resting == 2);
  }
}

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
  // unconstrained.
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
  BOOST_TEST(found.front() == std::sqrt(stiffness / reduced), tolerance(1e-7));
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
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
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
      const double found = mode.exponent.real();
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
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
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
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  BOOST_TEST(trim.solution.coefficients()(system.layout().shaft_torsion(), 0) == 90.0 / stiffness,
             tolerance(1e-12));
}
