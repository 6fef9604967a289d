// Ends of beams on springs in the assembled turbine.
#include <boost/test/unit_test.hpp>

#include "sample_turbine.hpp"

using namespace samara;

namespace {

/// Springs in all directions, coupled.
model::SupportDefinition springs(double lateral, double rotation) {
  model::SupportDefinition support;
  support.rigid = {};
  support.stiffness = sample::section_stiffness(
      (Vector6() << lateral, lateral, 2.0 * lateral, rotation, 2.0 * rotation, rotation).finished(),
      0.2);
  support.mass = 1.3;
  support.center = Vector3(0.1, -0.2, 0.3);
  support.inertia = Vector3(0.3, 0.4, 0.5);
  support.damping << 0.02, 0.01, 0.03, 0.02, 0.05, 0.01;
  return support;
}

std::vector<model::TurbineDefinition> supported_turbines() {
  std::vector<model::TurbineDefinition> all;
  for (const sample::Choice& choice : sample::choices()) {
    model::TurbineDefinition d = sample::turbine_definition(choice);
    d.tower.support = springs(3e3, 5e3);
    d.blades.beam.support = springs(4e3, 2e3);
    d.tower.mass_damping = Vector3(0.1, 0.3, 0.2);
    d.blades.beam.mass_damping = Vector3(0.4, 0.2, 0.3);
    if (choice.full) {  // a hinge, and an end that is held
      d.blades.beam.support.stiffness.row(4).setZero();
      d.blades.beam.support.stiffness.col(4).setZero();
      d.blades.beam.support.free[4] = true;
      d.blades.beam.end_support.rigid[1] = true;
      d.blades.beam.end_support.free[1] = false;
    }
    d.blades.beam.end_support.free[2] = false;
    d.blades.beam.end_support.stiffness(2, 2) = 90.0;
    d.blades.beam.end_support.free[4] = false;
    d.blades.beam.end_support.stiffness(4, 4) = 70.0;
    all.push_back(d);
  }
  return all;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(supports)

BOOST_AUTO_TEST_CASE(tangents_are_the_complex_step) {
  for (const model::TurbineDefinition& definition : supported_turbines()) {
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    BOOST_TEST(sample::tangent_error(system, 0.9, sample::random_state(system, 4)) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(tangents_are_the_complex_step_after_large_rotations) {
  for (const model::TurbineDefinition& definition : supported_turbines()) {
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    Eigen::VectorXd z = sample::random_state(system, 5).z;
    for (Eigen::Index i = 0; i < z.size(); ++i)
      if (system.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::position)
        z(i) *= 4.0;
    const petsc::Handle<Vec> state = sample::to_petsc(system, z);
    const std::unique_ptr<system::PeriodicSystem> counted = system.counted_from(state.get());
    BOOST_TEST_REQUIRE(bool(counted));
    const auto& turned = dynamic_cast<const turbine::TurbineSystem&>(*counted);
    BOOST_TEST(sample::tangent_error(turned, 0.9, sample::random_state(system, 4)) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(identical_blades_on_springs_repeat) {
  bool found = false;
  for (const model::TurbineDefinition& definition : supported_turbines()) {
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    const int blades = definition.blades.count;
    const system::RotorSymmetry& symmetry = system.symmetry();
    model::TurbineDefinition clamped = definition;
    clamped.tower.support = clamped.blades.beam.support = model::SupportDefinition();
    const turbine::TurbineSystem other(model::build_turbine(clamped), PETSC_COMM_SELF);
    BOOST_TEST(symmetry.sectors == other.symmetry().sectors);
    found = found || symmetry.sectors > 1;
    if (symmetry.sectors < 2) continue;
    const sample::RandomState state = sample::random_state(system, 3);
    const auto renamed = [&](const Eigen::VectorXd& z) {
      Eigen::VectorXd result(z.size());
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        result(i) = symmetry.sign[at] * z(symmetry.source[at]);
      }
      return result;
    };
    const Eigen::VectorXd later = sample::residual_of(
        system, 0.37 + system.period() / symmetry.sectors, state.z, state.z_dot);
    const Eigen::VectorXd now =
        sample::residual_of(system, 0.37, renamed(state.z), renamed(state.z_dot));
    Eigen::VectorXd difference = now - renamed(later);
    // The speed of a locked teeter, which nothing else uses, is about an axis of the rotor's.
    if (blades > 2) difference(system.layout().teeter() + 1) = 0.0;
    BOOST_TEST(difference.cwiseAbs().maxCoeff() < 1e-11 * now.cwiseAbs().maxCoeff());
  }
  BOOST_TEST(found);
}

BOOST_AUTO_TEST_SUITE_END()
