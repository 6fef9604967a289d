// Shooting: finds the initial state to which a revolution of time steps returns.
#pragma once

#include "samara/analysis/trim.hpp"

namespace samara::analysis {

/// Periodic steady state of the nonlinear step that corresponds to (19). It is an independent check
/// of harmonic balance; the two solutions differ by O(dt^2). The result is the Fourier series of
/// the values at the steps.
/// @throws ConvergenceError
Trim solve_shooting(const system::PeriodicSystem& system, int steps, double tolerance,
                    Observer& observer);

}  // namespace samara::analysis
