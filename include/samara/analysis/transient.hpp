// Simulation in time of r(t, z, z_dot) = 0 from a given state (docs/theory.md, section 9).
//
// PETSc's TS integrates the system fully implicitly with the exact tangents K + shift M, by BDF2
// (second order, damps motions that a step does not resolve) or by the implicit midpoint rule
// (second order, no numerical damping). Unknowns and rows are scaled by powers of two: norms are
// meaningful, and the scaling causes no round-off.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/observer.hpp"
#include "samara/analysis/options.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// State from which a simulation starts or continues.
struct TransientStart {
  double time = 0.0;                 ///< of z [s]
  long step = 0;                     ///< steps done since `origin`
  double origin = 0.0;               ///< time from which the steps are counted [s]
  Eigen::VectorXd z;                 ///< consistent: constraints and kinematic rows hold
  Eigen::VectorXd z_dot;             ///< empty: unknown
  std::vector<HeldCoordinate> held;  ///< constant loads in addition to those of the system
  /// The observer gets this state as a row. False: its internal loads and rates are not those of
  /// the system.
  bool is_row = true;
};

/// The equations are satisfied at t with z and z_dot: at the end of a step or, for the midpoint
/// rule, at its middle.
struct TransientSample {
  double t = 0.0;
  Vec z = nullptr;
  Vec z_dot = nullptr;
  long step = 0;        ///< steps of the grid since the origin, this one included
  bool on_grid = true;  ///< false: part of a step that was cut
};

/// Receives the samples of a running simulation.
class TransientObserver : public Observer {
 public:
  /// Called after each step, and before the first step of a run that does not continue another run.
  /// @returns false to end the run after this step
  virtual bool sample(const TransientSample& sample) = 0;
  /// Called where the integrator starts anew: a run from `point` continues as this one does.
  virtual void checkpoint(const TransientStart& point) { (void)point; }
};

enum class TransientEnd {
  complete,  ///< options.duration is reached
  stopped,   ///< at options.stop_at
  observer,  ///< the observer ended it
};

struct TransientRun {
  TransientStart end;     ///< the last state
  TransientStart before;  ///< the state one step earlier
  TransientEnd reason = TransientEnd::complete;
  std::string method;  ///< type of TS, as text
  int ranks = 1;       ///< over which the mesh was distributed
  long steps = 0;
  long newton_steps = 0;
  long factorizations = 0;
  long cuts = 0;  ///< steps that were repeated with a shorter length
};

/// Whether run_transient() distributes the mesh over the ranks of `comm`: with BDF2, a large mesh
/// and none of PETSc's options for another solver.
bool is_distributed(const system::PeriodicSystem& system, const TransientOptions& options,
                    MPI_Comm comm);

/// Integrates the system over options.duration from the origin of `start`. Options prefix
/// `transient_`. `system`: whole, the same on every rank of `comm`. Collective: where the mesh is
/// distributed, each rank integrates its part (docs/theory.md, section 9.1), and the observers of
/// all ranks get the same samples, of all unknowns; the run ends where one of them ends it or
/// fails. Else every rank computes the same.
/// @throws ConvergenceError with the time and the unknown that changes most.
TransientRun run_transient(const system::PeriodicSystem& system, const TransientStart& start,
                           const TransientOptions& options, TransientObserver& observer,
                           MPI_Comm comm = PETSC_COMM_SELF);

/// Start from the undeformed system in its prescribed motion at time t.
TransientStart start_undeformed(const system::PeriodicSystem& system, double t);

/// Start from the periodic steady state at time t.
TransientStart start_on(const system::PeriodicSystem& system, const Trim& trim, double t);

}  // namespace samara::analysis
