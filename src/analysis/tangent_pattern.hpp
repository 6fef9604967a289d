// Places of the entries of a system's tangents, and its blocks (docs/theory.md, section 4.2).
#pragma once

#include <vector>

#include <Eigen/SparseCore>
#include <petscsystypes.h>

#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Places where K or M may have an entry; its values have no meaning.
using TangentPattern = Eigen::SparseMatrix<double, Eigen::RowMajor, PetscInt>;
using Coordinates = std::vector<system::UnconstrainedCoordinate>;

/// Pattern of the tangents. The load that holds a coordinate stands in the place of its mean.
TangentPattern find_pattern(const system::PeriodicSystem& system, const Coordinates& held);

/// Rows of a block of the system's tangents; 1: no blocks.
PetscInt block_size_of(const system::PeriodicSystem& system);

/// For each node block, whether it belongs to the border of the chains of beam nodes: many other
/// blocks refer to it, or it has a coordinate that is held.
std::vector<char> find_border(const TangentPattern& pattern, PetscInt block_size,
                              const Coordinates& held);

}  // namespace samara::analysis
