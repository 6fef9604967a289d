// Whose the first-order states of a system are, and the modes that are theirs.
#pragma once

#include <vector>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// States of one part, of all blades say, together.
struct StateParts {
  std::vector<system::Owner> owners;  ///< the first of each part
  std::vector<std::size_t> part_of;   ///< of each state, in the order of the unknowns
};
StateParts find_state_parts(const system::PeriodicSystem& system);

/// For each eigenpair of a map of (eta, eta_dot, xi), `motion` entries of the first two: the place
/// in `parts.owners` of the states that have a larger participation factor in it than all other
/// states and the motion have; -1 where the motion has. A participation factor is the sum of left
/// times right eigenvector over the entries (Perez-Arriaga, Verghese & Schweppe 1982, IEEE Trans.
/// PAS-101): it does not depend on the units of the entries.
std::vector<int> leading_states(const Eigenpairs& pairs, Eigen::Index motion,
                                const StateParts& parts);

}  // namespace samara::analysis
