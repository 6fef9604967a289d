// Equilibrium at rest under loads that grow (docs/theory.md, section 4.3).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "samara/analysis/observer.hpp"
#include "samara/analysis/options.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

struct StaticState {
  double factor = 0.0;  ///< of gravity and prescribed loads
  Eigen::VectorXd z;
  int newton_steps = 0;
  double residual = 0.0;  ///< largest balance row [N, N m]
};

struct StaticPath {
  StaticMethod method = StaticMethod::load;
  std::vector<StaticState> states;   ///< from factor 0 to 1
  std::vector<double> limit_points;  ///< factors next to which the factor turned
  int cuts = 0;                      ///< steps that were tried again, shorter
  double load_level = 0.0;           ///< largest internal load of the last state
  std::vector<HeldCoordinate> held;  ///< of the last state
};

/// Follows r(0, z, 0) = 0 from the reference state, which carries nothing, to the whole loads.
/// Serial: every rank computes the same. Options prefix `static_`.
/// Supports that are free and that loads alone restore are held up to the first step and set free
/// there: between the states at 0 and there the path may jump.
/// @throws ConvergenceError or DomainError with the factor reached, the reason and a hint.
/// @throws InputError where something may move that nothing restores, or is held twice.
StaticPath find_static_path(const system::PeriodicSystem& system, const StaticOptions& options,
                            Observer& observer);

}  // namespace samara::analysis
