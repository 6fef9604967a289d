// Starts of a transient from the result of another run.
#pragma once

#include <string>

#include "samara/io/case.hpp"
#include "samara/simulation/transient_simulation.hpp"

namespace samara::io {

/// Goes on from the last checkpoint of the result in `path`.
/// @throws InputError where the result has none, or is of another model, other steps or events
void restart_from(const std::string& path, const Case& input,
                  simulation::TransientSimulation& simulation, analysis::Observer& observer);

/// Starts where a transient ended, or on the steady state of another analysis.
/// @throws InputError where the result has no state, or is of another model, but for what acts on
/// the turbine
void start_from(const std::string& path, const Case& input,
                simulation::TransientSimulation& simulation, analysis::Observer& observer);

}  // namespace samara::io
