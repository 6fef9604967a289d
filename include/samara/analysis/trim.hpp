// The periodic steady state of r(t, z, z_dot) = 0 (docs/theory.md, section 4; eq. (15)).
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "samara/analysis/observer.hpp"
#include "samara/analysis/options.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Unconstrained coordinate, whose mean was set to zero.
struct HeldCoordinate {
  std::string name;
  std::string unit;
  double load = 0.0;      ///< constant load that holds the mean; not small: no equilibrium
  PetscInt unknown = -1;  ///< of the system; -1: none
};

/// Adds the loads of `held` to a residual.
void add_held_loads(const system::PeriodicSystem& system, const std::vector<HeldCoordinate>& held,
                    Vec r);

struct Trim {
  PeriodicSolution solution;
  TrimMethod method = TrimMethod::harmonic_balance;
  int newton_steps = 0;
  std::string convergence = {};   ///< PETSc's reason in words
  double residual = 0.0;          ///< largest balance row at the samples [N, N m]
  double residual_between = 0.0;  ///< largest balance row between the samples [N, N m]
  double load_level = 0.0;        ///< largest internal load of the solution [N, N m]
  std::vector<HeldCoordinate> held = {};
  /// The larger of both residuals, relative to the largest load (at least 1 N, 1 N m), or
  /// state_residual if that is larger.
  double imbalance() const {
    return std::max(std::max(residual, residual_between) / std::max(load_level, 1.0),
                    state_residual);
  }
  /// Numbers of harmonics that were tried, each with its residual between the samples (several:
  /// auto).
  std::vector<std::pair<int, double>> attempts = {};
  /// Largest evolution or definition row, at the samples and between them, relative to its terms,
  /// without those of a medium.
  double state_residual = 0.0;
  /// The same of the rows of a medium. Curves of airfoils have kinks in their second derivatives,
  /// which few harmonics do not follow.
  double medium_residual = 0.0;
  /// Harmonic balance only: largest of those harmonics of the balance rows that the solve makes
  /// zero [N, N m]. A larger residual at the samples comes from harmonics that were left out. Not a
  /// number: not known.
  double harmonic_residual = 0.0;
  std::string linear_solver = {};  ///< of harmonic balance, in words
};

/// Largest number of harmonics that `harmonics: auto` tries.
inline constexpr int auto_harmonics = 60;

/// A larger Trim::medium_residual is rough.
inline constexpr double rough_medium = 0.01;

/// Number of harmonics of the series from shooting with `steps` steps per revolution.
int shooting_harmonics(int steps);

/// Solves for the periodic steady state from the undeformed system in its prescribed motion.
/// `near`: a steady state of a system with the same unknowns, which is tried first as the start;
/// null: none. `comm`: ranks that share a large mesh in harmonic balance; all of them have the same
/// system and get the same solution.
/// @throws ConvergenceError with PETSc's reason and a hint.
/// @throws InputError at rest where a coordinate may move that nothing restores, or where a part is
/// held twice.
Trim find_trim(const system::PeriodicSystem& system, const TrimOptions& options, Observer& observer,
               MPI_Comm comm = MPI_COMM_SELF, const Trim* near = nullptr);

}  // namespace samara::analysis
