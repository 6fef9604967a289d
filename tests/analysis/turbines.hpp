// The turbine of Lee, Hodges and Patil (2002), Table I, as its definition, without a case file.
#pragma once

#include "samara/model/turbine.hpp"

namespace samara::test {

/// A uniform section that neither stretches nor shears.
inline model::SectionDefinition stiff_section(double rigidity) {
  model::SectionDefinition section;
  section.rigid = {true, true, true, false, false, false};
  section.stiffness.diagonal() << 0.0, 0.0, 0.0, rigidity, rigidity, rigidity;
  section.mass.diagonal() << 67.5772, 67.5772, 67.5772, 5.0, 0.0001, 4.9999;
  return section;
}

struct Mesh {
  int tower_elements = 4;
  int tower_order = 1;
  int blade_elements = 4;
  int blade_order = 1;
};

inline model::TurbineDefinition lee_turbine(const Mesh& mesh, double gravity = 0.0) {
  model::TurbineDefinition definition;
  definition.gravity = gravity;
  definition.has_tower = true;
  definition.tower.length = 27.0;
  definition.tower.elements = mesh.tower_elements;
  definition.tower.order = mesh.tower_order;
  definition.tower.sections = {stiff_section(1e9)};
  definition.has_nacelle = true;
  definition.nacelle.mass = 6900.0;
  definition.nacelle.inertia = Vector3(0.0, 0.0, 16599.0);
  definition.nacelle.yaw.kind = model::JointKind::free;
  definition.shaft.speed = 6.02;
  definition.shaft.overhang = 2.388;
  definition.hub.inertia = Vector3(50.0, 5.0, 50.0);
  definition.hub.radius = 1.8;
  definition.hub.teeter.kind = model::JointKind::free;
  definition.blades.count = 2;
  definition.blades.beam.length = 8.42;
  definition.blades.beam.elements = mesh.blade_elements;
  definition.blades.beam.order = mesh.blade_order;
  definition.blades.beam.sections = {stiff_section(1e7)};
  return definition;
}

}  // namespace samara::test
