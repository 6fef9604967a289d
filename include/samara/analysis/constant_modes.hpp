// Modes of a system whose tangents do not depend on time: a parked rotor, or a balanced one in its
// own axes (docs/theory.md, section 5).
#pragma once

#include <vector>

#include <mpi.h>

#include "samara/analysis/mode.hpp"
#include "samara/analysis/observer.hpp"
#include "samara/analysis/options.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// All modes about the constant `solution`; options prefix `modes_`. Serial: every rank of a run
/// computes the same. Mode::multiplier and participation stay empty, shapes have one sample.
/// @throws InputError where the tangents depend on time (hint: samara floquet)
ModeSet find_constant_modes(const system::PeriodicSystem& system, const PeriodicSolution& solution);

/// With `options.modes` or `options.least_damped` some of the modes by Hill's method (hill.hpp),
/// which the ranks of `comm` share, and of which the first one has the shapes; else, and where the
/// mesh is too coarse for it, all of them as above.
/// @throws InputError where the tangents depend on time, ConvergenceError
ModeSet find_constant_modes(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                            const FloquetOptions& options, MPI_Comm comm, Observer& observer);

/// The smallest moduli of the exponents that the tangents at t = 0 have, ascending [rad/s], at
/// least `count` if there are; without those that count as zero. A guide to the frequencies of a
/// periodic system, in rotor axes.
std::vector<double> find_moduli_at_start(const system::PeriodicSystem& system,
                                         const PeriodicSolution& solution, int count);

}  // namespace samara::analysis
