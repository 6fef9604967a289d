// Modes of a system whose tangents do not depend on time: a parked rotor, or a balanced one in its
// own axes (docs/theory.md, section 5).
#pragma once

#include "samara/analysis/mode.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// All modes about the constant `solution`; options prefix `modes_`. Serial: every rank of a run
/// computes the same. Mode::multiplier and participation stay empty, shapes have one sample.
/// @throws InputError where the tangents depend on time (hint: samara floquet)
ModeSet find_constant_modes(const system::PeriodicSystem& system, const PeriodicSolution& solution);

}  // namespace samara::analysis
