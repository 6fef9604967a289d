// Some Floquet modes of a large system by Hill's method (docs/theory.md, section 5.10).
#pragma once

#include <optional>

#include "samara/analysis/floquet.hpp"

namespace samara::analysis {

/// The `options.modes` slowest modes, those nearest to `options.near_hz`, or the
/// `options.least_damped` ones of slowest decay, the same on every rank of `comm`; only the first
/// one has the shapes. Modes of a medium alone are left out. The ranks share a large mesh, else the
/// refinement and the count of eigenvalues. Empty where the structure of the system does not serve:
/// chains of nodes with a small border.
/// @throws ConvergenceError
std::optional<Floquet> find_hill_modes(const system::PeriodicSystem& system,
                                       const PeriodicSolution& solution,
                                       const FloquetOptions& options, MPI_Comm comm);

/// The same of constant tangents, which are Hill's eigenproblem without harmonics: the slowest
/// decays, too, are all in a region that is searched. Mode::multiplier and participation stay
/// empty.
/// @throws ConvergenceError
std::optional<ModeSet> find_hill_constant_modes(const system::PeriodicSystem& system,
                                                const PeriodicSolution& solution,
                                                const FloquetOptions& options, MPI_Comm comm);

}  // namespace samara::analysis
