// Shooting: the initial state that a revolution of time steps brings back to itself.
#pragma once

#include "samara/analysis/trim.hpp"

namespace samara::analysis {

/// The periodic steady state of the nonlinear step that belongs to (19), an independent check of
/// harmonic balance: the two differ by O(dt^2). The result is the Fourier series of the steps.
/// @throws ConvergenceError
Trim solve_shooting(const system::PeriodicSystem& system, int steps, double tolerance,
                    Observer& observer);

}  // namespace samara::analysis
