// The parts that own the first-order states of a system, and the modes of these states.
#pragma once

#include <vector>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// First-order states by part; those of all blades belong to one part.
struct StateParts {
  std::vector<system::Owner> owners;  ///< first owner of each part
  std::vector<std::size_t> part_of;   ///< of each state, in the order of the unknowns
};
StateParts find_state_parts(const system::PeriodicSystem& system);

/// For each eigenpair of a map of (eta, eta_dot, xi): the place in `parts.owners` of the part whose
/// states have the largest participation factor in it; -1 where that of the motion is larger.
/// `motion`: number of entries of eta and eta_dot. A participation factor is the sum of left times
/// right eigenvector over the entries (Perez-Arriaga, Verghese & Schweppe 1982, IEEE Trans.
/// PAS-101): it does not depend on the units of the entries.
std::vector<int> leading_states(const Eigenpairs& pairs, Eigen::Index motion,
                                const StateParts& parts);

}  // namespace samara::analysis
