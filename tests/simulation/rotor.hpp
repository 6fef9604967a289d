// A rigid rotor on a shaft with a free generator: its speed has a closed form.
#pragma once

#include "samara/model/masses.hpp"
#include "samara/simulation/scenario.hpp"

namespace samara::test {

inline constexpr double rotor_speed = 6.0;        // [rad/s]
inline constexpr double rotor_torque = 80.0;      // [N m]
inline constexpr double generator_torque = 50.0;  // [N m]

/// Built field by field, without a file: two rigid blades on a stiff shaft.
inline simulation::Scenario rigid_rotor() {
  simulation::Scenario scenario;
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.gravity = 0.0;
  turbine.shaft.speed = rotor_speed;
  turbine.shaft.generator.kind = model::JointKind::free;
  turbine.shaft.generator.inertia = 3.0;
  turbine.shaft.generator.law.torque = generator_torque;
  turbine.shaft.rotor.torque = rotor_torque;
  turbine.hub.mass = 20.0;
  turbine.hub.inertia = Vector3(2.0, 5.0, 2.0);
  turbine.hub.radius = 0.5;
  turbine.blades.count = 2;
  turbine.blades.beam.length = 4.0;
  turbine.blades.beam.elements = 2;
  model::SectionDefinition section;
  section.rigid = {true, true, true, true, true, true};
  section.mass = Matrix6::Identity();
  section.mass.bottomRightCorner<3, 3>() *= 1e-3;
  turbine.blades.beam.sections = {section};
  scenario.transient.options.duration = 1.0;
  scenario.transient.options.step = 0.01;
  scenario.transient.start = simulation::TransientOrigin::undeformed;
  scenario.transient.channels = {"RotSpeed"};
  return scenario;
}

/// Inertia of rotor and generator about the shaft [kg m^2].
inline double total_inertia(const simulation::Scenario& scenario) {
  const model::Turbine turbine = model::build_turbine(scenario.turbine);
  return model::compute_masses(scenario.turbine, turbine).meshed_rotor.inertia(1, 1) +
         scenario.turbine.shaft.generator.inertia;
}

}  // namespace samara::test
