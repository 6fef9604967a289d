// Faults of a scenario for the analysis that it is used for.
#pragma once

#include <string>
#include <vector>

#include "samara/base/fault.hpp"
#include "samara/simulation/scenario.hpp"

namespace samara::simulation {

enum class Analysis {
  check,
  statics,
  modes,
  trim,
  floquet,
  transient,
  linearize,
  operate,
  campbell
};

/// All faults: faults of the turbine (model::find_faults) and settings that the analysis does not
/// accept.
std::vector<Fault> validate(const Scenario& scenario, Analysis analysis);

/// Notes about a scenario without faults: kinks of prescribed motions, few steps per revolution.
std::vector<std::string> transient_notes(const Scenario& scenario);

/// Steps per cycle that follow a motion well: the error in frequency is 0.8 % for the midpoint rule
/// and 3 % for BDF2.
inline constexpr double steps_a_cycle = 20.0;

}  // namespace samara::simulation
