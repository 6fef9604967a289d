// The time series of r(t, z, z_dot) = 0 from a given state (docs/theory.md, section 9).
//
// PETSc's TS integrates the system as it is, fully implicit, with the exact tangents K + shift M:
// BDF2 (second order, damps what a step does not resolve) or the implicit midpoint rule (second
// order, damps nothing). Unknowns and rows are scaled by powers of two, so that norms mean
// something and no digit is lost on the way there and back.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/observer.hpp"
#include "samara/analysis/options.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Where a time series begins, or goes on.
struct TransientStart {
  double time = 0.0;                 ///< of z [s]
  long step = 0;                     ///< steps done since `origin`
  double origin = 0.0;               ///< from which the steps are counted [s]
  Eigen::VectorXd z;                 ///< consistent: constraints and kinematic rows hold
  Eigen::VectorXd z_dot;             ///< empty: not known
  std::vector<HeldCoordinate> held;  ///< constant loads that act beside those of the system
  /// The observer sees it. False: its internal loads and rates are not those of the system.
  bool is_row = true;
};

/// The equations hold at t with z and z_dot: at the end of a step, for the midpoint rule in its
/// middle.
struct TransientSample {
  double t = 0.0;
  Vec z = nullptr;
  Vec z_dot = nullptr;
  long step = 0;        ///< steps of the grid since the origin, this one included
  bool on_grid = true;  ///< false: part of a step that was cut
};

/// Takes what a time series gives, while it runs.
class TransientObserver : public Observer {
 public:
  /// After each step, and before the first one of a run that does not go on with another.
  /// @returns false to end the run after this step
  virtual bool sample(const TransientSample& sample) = 0;
  /// The integrator starts anew here: from `point` another run goes on as this one does.
  virtual void checkpoint(const TransientStart& point) { (void)point; }
};

enum class TransientEnd {
  complete,  ///< options.duration is over
  stopped,   ///< at options.stop_at
  observer,  ///< the observer ended it
};

struct TransientRun {
  TransientStart end;     ///< the last state
  TransientStart before;  ///< the one a step before
  TransientEnd reason = TransientEnd::complete;
  std::string method;  ///< TS's type in words
  long steps = 0;
  long newton_steps = 0;
  long factorizations = 0;
  long cuts = 0;  ///< steps that were tried again, shorter
};

/// Follows the system for options.duration from the start's origin. Serial: every rank computes the
/// same. Options prefix `transient_`.
/// @throws ConvergenceError with the time and the unknown that is worst off.
TransientRun run_transient(const system::PeriodicSystem& system, const TransientStart& start,
                           const TransientOptions& options, TransientObserver& observer);

/// The undeformed system in its prescribed motion at time t.
TransientStart start_undeformed(const system::PeriodicSystem& system, double t);

/// On the periodic steady state at time t.
TransientStart start_on(const system::PeriodicSystem& system, const Trim& trim, double t);

}  // namespace samara::analysis
