// A transient with an observer: the generator of a rigid rotor is lost, and a brake stops the
// rotor. This program starts PETSc itself, like a program that uses PETSc for other work as well.
#include <cstdio>
#include <numbers>

#include <petscsys.h>
#include <samara/model/masses.hpp>
#include <samara/petsc/session.hpp>
#include <samara/simulation/transient_simulation.hpp>

using namespace samara;

namespace {

simulation::Scenario rotor() {
  simulation::Scenario scenario;
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.gravity = 0.0;
  turbine.shaft.speed = 6.0;
  turbine.shaft.generator.kind = model::JointKind::free;
  turbine.shaft.generator.law.torque = 80.0;
  turbine.shaft.rotor.torque = 80.0;
  turbine.hub.mass = 20.0;
  turbine.hub.inertia = Vector3(2.0, 5.0, 2.0);
  turbine.hub.radius = 0.5;
  turbine.blades.count = 2;
  turbine.blades.beam.length = 4.0;
  model::SectionDefinition section;
  section.rigid = {true, true, true, true, true, true};
  section.mass.diagonal() << 1.0, 1.0, 1.0, 1e-3, 1e-3, 1e-3;
  turbine.blades.beam.sections = {section};

  simulation::TransientSetup& transient = scenario.transient;
  transient.options.duration = 2.0;
  transient.options.step = 0.01;
  transient.output_steps = 10;
  transient.channels = {"RotSpeed", "GenTq"};
  turbine::TurbineEvent loss;
  loss.trigger.time = 0.5;
  loss.generator_off = true;
  turbine::TurbineEvent brake;
  brake.trigger.channel = "RotSpeed";
  brake.trigger.level = 6.3 * 30.0 / std::numbers::pi;
  brake.brake = 300.0;
  transient.events = {loss, brake};
  return scenario;
}

class Printer final : public simulation::TransientOutput {
 public:
  void row(double t, std::span<const double> values) override {
    std::printf("%5.2f s  %9.5f rpm  %8.4f kN m\n", t, values[0], values[1]);
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (PetscInitialize(&argc, &argv, nullptr, nullptr) != 0) return 1;
  {
    const petsc::Session session({});  // uses the PETSc session that runs already
    simulation::TransientSimulation simulation(rotor());
    const double inertia =
        model::compute_masses(simulation.scenario().turbine, simulation.turbine())
            .meshed_rotor.inertia(1, 1);
    std::printf("J %.10g kg m^2\n", inertia);
    Printer printer;
    simulation.start(printer);
    const simulation::TransientSummary done = simulation.run(printer);
    std::printf("brake at %.6f s; %ld steps\n", done.end.events[1], done.run.steps);
  }
  PetscBool runs = PETSC_FALSE;
  PetscInitialized(&runs);
  std::printf("PETSc %s\n", runs != PETSC_FALSE ? "runs on" : "was ended");
  return PetscFinalize() == 0 && runs != PETSC_FALSE ? 0 : 1;
}
