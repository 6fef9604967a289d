// A one-bladed rotor and its counterweight: what the tower feels once per revolution.
#include <boost/test/unit_test.hpp>

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
constexpr double static_moment = 0.5 * blade_mass * blade_length * blade_length;

/// One blade on a hub, a nacelle and a tower; all rigid where `stiffness` is zero.
model::TurbineDefinition one_bladed(double stiffness) {
  BeamCase beam;
  beam.length = blade_length;
  beam.speed = speed;
  beam.mass = blade_mass;
  beam.inertia = Vector3(0.05, 0.02, 0.03);
  beam.stiffness << 0.0, 0.0, 0.0, stiffness, stiffness, stiffness;
  beam.elements = 2;
  beam.order = 2;
  model::TurbineDefinition definition = definition_of(beam);
  definition.hub.inertia = Vector3(0.3, 0.9, 0.3);
  definition.shaft.overhang = overhang;
  definition.has_nacelle = true;
  definition.nacelle.mass = 7.0;
  definition.nacelle.inertia = Vector3(0.4, 0.5, 0.6);
  definition.has_tower = true;
  definition.tower = definition.blades.beam;
  definition.tower.length = tower_length;
  definition.tower.sections.front().stiffness *= 200.0;
  return definition;
}

/// Mean and amplitude of every harmonic of the tower root's six loads, along n3, n1, n2.
Eigen::MatrixXd root_harmonics(const model::TurbineDefinition& definition) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  BOOST_TEST(system.symmetry().sectors == 1);
  BOOST_TEST(system.symmetry().broken_by.empty());
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  const int harmonics = trim.solution.harmonics();
  Eigen::MatrixXd amplitudes(6, harmonics + 1);
  for (int i = 0; i < 6; ++i) {
    const Eigen::RowVectorXd row =
        trim.solution.coefficients().row(system.layout().tower_root() + i);
    amplitudes(i, 0) = std::abs(row(0));
    for (int k = 1; k <= harmonics; ++k) amplitudes(i, k) = std::hypot(row(2 * k - 1), row(2 * k));
  }
  return amplitudes;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_unbalanced_blade_shakes_the_tower_with_its_centrifugal_force) {
  const Eigen::MatrixXd load = root_harmonics(one_bladed(0.0));
  const double force = static_moment * speed * speed;  // m r Omega^2, turning in the plane n3 n1
  BOOST_TEST(load(0, 1) == force, tolerance(1e-9));
  BOOST_TEST(load(1, 1) == force, tolerance(1e-9));
  BOOST_TEST(load(2, 1) < 1e-9 * force);
  // About the foot: n1 has the vertical force at the overhang, n2 the lateral one at the height.
  BOOST_TEST(load(3, 1) == force * overhang, tolerance(1e-9));
  BOOST_TEST(load(4, 1) == force * overhang, tolerance(1e-9));
  BOOST_TEST(load(5, 1) == force * tower_length, tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(a_counterweight_takes_the_shaking_away) {
  const double force = static_moment * speed * speed;
  for (const double arm : {0.4, 0.9}) {
    model::TurbineDefinition definition = one_bladed(0.0);
    definition.hub.point_masses = {
        {static_moment / arm, Vector3(0.0, 0.0, -arm), Vector3(0.1, 0.2, 0.3)}};
    const Eigen::MatrixXd load = root_harmonics(definition);
    if (load.cols() > 1) BOOST_TEST(load.col(1).maxCoeff() < 1e-9 * force);
  }
}

BOOST_AUTO_TEST_CASE(a_counterweight_beside_the_rotor_plane_leaves_a_couple) {
  // Static balance, but the two forces are `apart` along the shaft.
  constexpr double apart = 0.25;
  model::TurbineDefinition definition = one_bladed(0.0);
  definition.hub.point_masses = {{static_moment / 0.5, Vector3(0.0, apart, -0.5), Vector3::Zero()}};
  const Eigen::MatrixXd load = root_harmonics(definition);
  const double force = static_moment * speed * speed;
  BOOST_TEST(load.col(1).head<3>().maxCoeff() < 1e-9 * force);
  BOOST_TEST(load(3, 1) == force * apart, tolerance(1e-9));
  BOOST_TEST(load(4, 1) == force * apart, tolerance(1e-9));
  BOOST_TEST(load(5, 1) < 1e-9 * force);
}

BOOST_AUTO_TEST_CASE(a_soft_one_bladed_turbine_with_teeter_runs_through_trim_and_floquet) {
  model::TurbineDefinition definition = one_bladed(400.0);
  definition.gravity = 9.81;
  definition.hub.teeter = {model::JointKind::free, 50.0, 1.0, {}};
  definition.hub.point_masses = {
      {static_moment / 0.5, Vector3(0.0, 0.0, -0.5), Vector3(0.1, 0.1, 0.1)}};
  analysis::TrimOptions options;
  options.harmonics = 6;
  const analysis::Floquet floquet =
      floquet_of(definition, 300, analysis::FloquetPeriod::automatic, options);
  BOOST_TEST(floquet.sectors == 1);
  BOOST_TEST(floquet.set.degrees_of_freedom == 2 * 3 * 4 + 1);
}
