// Some Floquet modes of a large system by Hill's method (docs/theory.md, section 5.10).
#pragma once

#include "samara/analysis/floquet.hpp"

namespace samara::analysis {

/// Whether the structure of a system serves Hill's method: chains of nodes with a small border.
bool has_hill_structure(const system::PeriodicSystem& system);

/// The `options.modes` slowest modes, or those nearest to `options.near`. Every rank computes the
/// same.
/// @throws ConvergenceError where modes are missing, or their residuals do not become small
Floquet find_hill_modes(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                        const FloquetOptions& options, Observer& observer);

}  // namespace samara::analysis
