// A start for the equilibrium of a system at rest in a medium (docs/theory.md, section 4.3).
#pragma once

#include <optional>

#include <Eigen/Core>

#include "samara/analysis/harmonic_balance.hpp"

namespace samara::analysis {

/// Newton's method for r(0, z, 0) = 0 from `start`, in which the medium takes its steady values
/// after every change of the motion: states of airfoils beyond stall change so fast with the
/// motion that steps of all unknowns together may not converge. Unconstrained coordinates are held.
/// The result still has a residual: it is a start of solve_harmonic_balance. None where the method
/// does not converge.
std::optional<PeriodicSolution> find_settled_start(const system::PeriodicSystem& system,
                                                   Eigen::VectorXd start);

}  // namespace samara::analysis
