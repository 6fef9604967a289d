// The part whose first-order states a mode by Hill's method belongs to (docs/theory.md, section
// 5.10).
#pragma once

#include "samara/system/periodic_system.hpp"

#include "hill_pencil.hpp"
#include "hill_search.hpp"
#include "state_parts.hpp"

namespace samara::analysis {

/// The place in `parts.owners` of the part whose states have the largest participation factor in an
/// eigenpair; -1 where that of the motion is larger, as leading_states() has it. The factor of some
/// states is -d lambda/d epsilon where their rates d/dt become d/dt + epsilon: one solution of the
/// bordered problem takes the place of a left eigenvector (docs/theory.md, section 5.10).
/// @throws ConvergenceError
int leading_part(HillPencil& pencil, const system::PeriodicSystem& system, const StateParts& parts,
                 const HillPair& pair);

}  // namespace samara::analysis
