// Meshes that are large enough for a distribution, and checks on all ranks.
#pragma once

#include <petscsys.h>

#include "turbines.hpp"

namespace samara::test {

inline bool on_all_ranks(bool value) {
  int all = value ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  return all != 0;
}

inline int ranks() {
  int count = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &count);
  return count;
}

inline model::TurbineDefinition single_blade(int elements) {
  model::TurbineDefinition definition = lee_turbine({}, 9.81);
  definition.has_tower = false;
  definition.has_nacelle = false;
  definition.nacelle = {};
  definition.hub = {};
  definition.shaft.overhang = 0.0;
  definition.blades.count = 1;
  definition.blades.beam.elements = elements;
  return definition;
}

}  // namespace samara::test
