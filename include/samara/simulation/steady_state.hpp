// The periodic steady state of a scenario, and its accuracy.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "samara/analysis/trim.hpp"
#include "samara/simulation/scenario.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// Like analysis::find_trim; `system`: of the scenario's turbine; `comm`: ranks that share a large
/// mesh; `near`: a steady state nearby.
/// @throws ConvergenceError like find_trim; with the limit in the message if a controller needs a
/// pitch beyond the limits of its actuators
analysis::Trim solve_trim(const Scenario& scenario, const turbine::TurbineSystem& system,
                          const analysis::TrimOptions& options, analysis::Observer& observer,
                          MPI_Comm comm = MPI_COMM_SELF, const analysis::Trim* near = nullptr);

/// @throws ConvergenceError where a steady state is outside the range of the finite-state wake:
/// a rotor that nearly stops the wind, or reverses it
void require_wake_range(const turbine::TurbineSystem& system, const analysis::Trim& trim);

/// solve_trim with the scenario's options, within the range of the models. Adds a note if the
/// result is rough.
analysis::Trim find_trim(const Scenario& scenario, const turbine::TurbineSystem& system,
                         analysis::Observer& observer, MPI_Comm comm = MPI_COMM_SELF);

/// Number of equally spaced instants whose mean integrates products of two harmonics of a steady
/// state exactly over a revolution: 6 H + 1 with H harmonics.
int instants_of_means(const analysis::Trim& trim);

/// Visits the steady state at these instants.
void visit_instants(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                    const std::function<void(double t, Vec z, Vec z_dot)>& visit);

/// Means of channels over a revolution, each in the unit of its channel.
std::vector<double> mean_channels(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                                  const std::vector<std::string>& names);

/// Note on a rough steady state, with the way to a better one; empty if it is not rough.
std::string roughness(const analysis::Trim& trim);

/// Smallest load that holds an unconstrained coordinate: a smaller one is an error of the steady
/// state [N, N m].
double least_held_load(const analysis::Trim& trim);

/// Passes notes on a steady state to the observer: that it is rough, and which coordinates it holds
/// by a load that is not there in the turbine (the generator's torque is). `source`: its origin.
void note_doubts(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                 analysis::Observer& observer, const std::string& source = "trim");

}  // namespace samara::simulation
