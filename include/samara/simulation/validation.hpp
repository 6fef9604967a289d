// Faults of a scenario, for the analysis that it is meant for.
#pragma once

#include <string>
#include <vector>

#include "samara/base/fault.hpp"
#include "samara/simulation/scenario.hpp"

namespace samara::simulation {

enum class Analysis { check, statics, modes, trim, floquet, transient, linearize };

/// All faults: those of the turbine (model::find_faults) and what the analysis cannot take of it.
std::vector<Fault> validate(const Scenario& scenario, Analysis analysis);

/// Notes about a scenario without faults: kinks of prescribed motions, few steps a revolution.
std::vector<std::string> transient_notes(const Scenario& scenario);

/// Steps a cycle with which a motion is followed well: the midpoint rule errs by 0.8 % in
/// frequency, BDF2 by 3 %.
inline constexpr double steps_a_cycle = 20.0;

}  // namespace samara::simulation
