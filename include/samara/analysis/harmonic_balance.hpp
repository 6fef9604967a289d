// Harmonic balance by alternating frequency and time (docs/theory.md, section 4).
#pragma once

#include "samara/analysis/trim.hpp"

namespace samara::analysis {

/// Residuals of a steady state beside the equations that are solved.
enum class Residuals { none, all };

/// Solves with exactly `harmonics` harmonics, from `start` where it is not null (its harmonics
/// may be fewer). Options prefix `trim_`. `comm`: ranks that share a large mesh; all of them have
/// the same system and get the same solution.
/// @throws ConvergenceError
Trim solve_harmonic_balance(const system::PeriodicSystem& system, int harmonics, double tolerance,
                            const PeriodicSolution* start, MPI_Comm comm = MPI_COMM_SELF,
                            Residuals residuals = Residuals::all);

/// The largest balance row of the residual of `solution`, midway between the samples of harmonic
/// balance (`shift` 0.5) or at them (0). The constant `loads` hold unconstrained coordinates. The
/// ranks of `comm` share the samples.
double balance_residual(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                        const std::vector<HeldCoordinate>& loads, double shift,
                        MPI_Comm comm = MPI_COMM_SELF);

/// Residuals of evolution and definition rows, relative to their terms.
struct StateResidual {
  double of_medium = 0.0;
  double of_others = 0.0;
};

/// Largest residuals of the evolution and definition rows over a period under these loads, each
/// relative to the largest sum of the moduli of its terms. In these terms states and auxiliaries
/// are at least a thousandth of their Unknown::scale, a tenth in a medium. The result is 0 without
/// such rows.
StateResidual state_residual(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                             const std::vector<HeldCoordinate>& loads,
                             MPI_Comm comm = MPI_COMM_SELF);

/// Fills in the residuals and the load level of a solved trim.
void finish_trim(const system::PeriodicSystem& system, Trim& trim, MPI_Comm comm = MPI_COMM_SELF);

}  // namespace samara::analysis
