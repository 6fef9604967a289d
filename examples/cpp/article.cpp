// Floquet exponents of the two-bladed teetering turbine of Lee, Hodges and Patil, Wind Energy 5
// (2002), Table I, with a tower 100 times as stiff as the blades.
#include <cstdio>

#include <samara/analysis/floquet.hpp>
#include <samara/petsc/session.hpp>
#include <samara/simulation/stability.hpp>
#include <samara/simulation/steady_state.hpp>

using namespace samara;

namespace {

/// A uniform beam without stretch and shear.
model::BeamDefinition uniform(double length, double rigidity) {
  model::BeamDefinition beam;
  beam.length = length;
  beam.elements = 1;
  beam.order = 4;
  model::SectionDefinition section;
  section.rigid = {true, true, true, false, false, false};
  section.stiffness.diagonal() << 0.0, 0.0, 0.0, rigidity, rigidity, rigidity;
  section.mass.diagonal() << 67.5772, 67.5772, 67.5772, 5.0, 0.0001, 4.9999;
  beam.sections = {section};
  return beam;
}

simulation::Scenario article() {
  simulation::Scenario scenario;
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.title = "Two-bladed teetering turbine of Lee, Hodges and Patil (2002)";
  turbine.gravity = 0.0;
  turbine.has_tower = true;
  turbine.tower = uniform(27.0, 1e9);
  turbine.has_nacelle = true;
  turbine.nacelle.mass = 6900.0;
  turbine.nacelle.inertia = Vector3(0.0, 0.0, 16599.0);
  turbine.nacelle.yaw.kind = model::JointKind::free;
  turbine.shaft.speed = 6.02;
  turbine.shaft.overhang = 2.388;
  turbine.hub.inertia = Vector3(50.0, 5.0, 50.0);
  turbine.hub.radius = 1.8;
  turbine.hub.teeter.kind = model::JointKind::free;
  turbine.blades.count = 2;
  turbine.blades.beam = uniform(8.42, 1e7);
  return scenario;
}

}  // namespace

int main() {
  const petsc::Session session({});
  const simulation::Scenario scenario = article();
  const turbine::TurbineSystem system(model::build_turbine(scenario.turbine), PETSC_COMM_SELF);
  analysis::Observer silent;
  const analysis::Trim trim = simulation::find_trim(scenario, system, silent);
  const analysis::Floquet floquet = analysis::find_floquet_modes(
      system, trim.solution, scenario.floquet, PETSC_COMM_WORLD, silent);
  if (petsc::Session::rank() != 0) return 0;
  for (std::size_t m = 0; m < 10; ++m)
    std::printf("%-18s %9.5f per rev  %+.2e 1/s\n", floquet.set.modes[m].label.c_str(),
                floquet.set.modes[m].exponent.imag() / floquet.set.rotor_speed,
                floquet.set.modes[m].exponent.real());
  const simulation::StabilityAssessment assessment = simulation::assess_stability(floquet.set);
  std::printf("%zu modes grow\n", assessment.growing.size());
  return 0;
}
