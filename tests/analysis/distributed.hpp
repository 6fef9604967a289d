// Meshes that are large enough for a distribution, and checks on all ranks.
#pragma once

#include <algorithm>

#include <Eigen/Core>
#include <petscsys.h>

#include "samara/system/periodic_system.hpp"

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

/// Largest difference in the unknowns of a role, relative to the largest value; a row for each
/// unknown.
inline double difference(const system::PeriodicSystem& system, const Eigen::MatrixXd& a,
                         const Eigen::MatrixXd& b, system::UnknownRole role) {
  double largest = 0.0;
  double size = 0.0;
  for (Eigen::Index i = 0; i < system.size(); ++i) {
    if (system.unknowns()[static_cast<std::size_t>(i)].role != role) continue;
    size = std::max(size, a.row(i).cwiseAbs().maxCoeff());
    largest = std::max(largest, (a.row(i) - b.row(i)).cwiseAbs().maxCoeff());
  }
  return size > 0.0 ? largest / size : largest;
}

}  // namespace samara::test
