// The periodic steady state of a scenario, and how accurate it is.
#pragma once

#include <string>

#include "samara/analysis/trim.hpp"
#include "samara/simulation/scenario.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// As analysis::find_trim; `system`: of the scenario's turbine.
/// @throws ConvergenceError as that; one that names the limit where a controller needs a pitch
/// beyond the limits of its actuators
analysis::Trim solve_trim(const Scenario& scenario, const turbine::TurbineSystem& system,
                          const analysis::TrimOptions& options, analysis::Observer& observer);

/// The same with the scenario's options. Notes where the result is rough.
analysis::Trim find_trim(const Scenario& scenario, const turbine::TurbineSystem& system,
                         analysis::Observer& observer);

/// Note on a rough steady state, with the way to a better one; empty where it is not rough.
std::string roughness(const analysis::Trim& trim);

/// Notes the same where there is something to note. `source`: where the steady state comes from.
void note_roughness(const analysis::Trim& trim, analysis::Observer& observer,
                    const std::string& source = "trim");

}  // namespace samara::simulation
