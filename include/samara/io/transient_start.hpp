// Starts a transient from the result of another run.
#pragma once

#include <string>

#include "samara/io/case.hpp"
#include "samara/simulation/transient_simulation.hpp"

namespace samara::io {

/// Continues from the last checkpoint of the result in `path`.
/// @throws InputError if the result has none, or has another model, other steps or other events
void restart_from(const std::string& path, const Case& input,
                  simulation::TransientSimulation& simulation, analysis::Observer& observer);

/// Starts from the end of a transient, or from the steady state of another analysis.
/// @throws InputError if the result has no state, or has another model; only the loads and motions
/// that act on the turbine may differ
void start_from(const std::string& path, const Case& input,
                simulation::TransientSimulation& simulation, analysis::Observer& observer);

}  // namespace samara::io
