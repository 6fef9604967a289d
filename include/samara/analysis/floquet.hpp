// The Floquet modes of a linearized periodic system (docs/theory.md, section 5).
#pragma once

#include "samara/analysis/mode.hpp"
#include "samara/analysis/observer.hpp"
#include "samara/analysis/options.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

struct Floquet {
  ModeSet set;
  int steps = 0;      ///< per revolution, as used
  int order = 2;      ///< of the steps
  int sectors = 1;    ///< Q: integrated over T / Q
  double step = 0.0;  ///< dt [s]
  /// Of the shapes over a period where Hill's method has found the modes; no steps then. 0: none.
  int harmonics = 0;
};

/// Finds and identifies the modes about `solution`: all of them by integration of the
/// perturbations, or, with `options.modes`, some by Hill's method (hill.hpp). `system` is a serial
/// copy on every rank of `comm`; the steps, and the signals that identify the modes, are
/// distributed over the ranks. The mode shapes are on rank 0 of `comm` only.
/// @throws InputError where the system has no period, ConvergenceError from the solvers
Floquet find_floquet_modes(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                           const FloquetOptions& options, MPI_Comm comm, Observer& observer);

}  // namespace samara::analysis
