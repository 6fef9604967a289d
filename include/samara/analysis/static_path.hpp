// Equilibrium at rest under increasing loads (docs/theory.md, section 4.3).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "samara/analysis/observer.hpp"
#include "samara/analysis/options.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

struct StaticState {
  double factor = 0.0;  ///< load factor of gravity and prescribed loads
  Eigen::VectorXd z;
  int newton_steps = 0;
  double residual = 0.0;  ///< largest balance row [N, N m]
};

struct StaticPath {
  StaticMethod method = StaticMethod::load;
  std::vector<StaticState> states;   ///< from factor 0 to 1
  std::vector<double> limit_points;  ///< load factors near which its change reversed
  int cuts = 0;                      ///< steps that were repeated with a shorter length
  double load_level = 0.0;           ///< largest internal load of the last state
  std::vector<HeldCoordinate> held;  ///< of the last state
};

/// Follows r(0, z, 0) = 0 from the unloaded reference state to the full loads. Serial: every rank
/// computes the same. Options prefix `static_`. Free supports that only loads restore are held up
/// to the first step and released there: between load factor 0 and the first step the path may
/// jump.
/// @throws ConvergenceError or DomainError with the factor reached, the reason and a hint.
/// @throws InputError where a coordinate may move that nothing restores, or where a part is held
/// twice.
StaticPath find_static_path(const system::PeriodicSystem& system, const StaticOptions& options,
                            Observer& observer);

}  // namespace samara::analysis
