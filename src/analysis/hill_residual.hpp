// Residuals of Floquet motions in the time domain (docs/theory.md, section 5.10).
#pragma once

#include <vector>

#include "samara/analysis/periodic_solution.hpp"
#include "samara/analysis/ranks.hpp"
#include "samara/system/periodic_system.hpp"

#include "hill_search.hpp"
#include "mesh_partition.hpp"

namespace samara::analysis {

/// Largest residual of K z + M z_dot of each eigenpair, at instants that are not those of the
/// series, in rows scaled by their roles, relative to the largest inertia load M z_dot, or, where
/// it is less, that of the same motion at the rotor speed. All series have the same number of
/// harmonics. Every rank has the same pairs, calls it and gets the same result. Of a distributed
/// `mesh` (else null), a series has the unknowns that the rank counts, and `ranks` is one rank.
std::vector<double> find_hill_residuals(const system::PeriodicSystem& system,
                                        const PeriodicSolution& solution,
                                        const std::vector<const HillPair*>& pairs,
                                        const Ranks& ranks, const MeshPartition* mesh);

}  // namespace samara::analysis
