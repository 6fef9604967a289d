// The keys of the analyses, and with them all keys of a case.
#pragma once

#include <vector>

#include "samara/base/fault.hpp"
#include "samara/fields/turbine_fields.hpp"
#include "samara/simulation/scenario.hpp"

namespace samara::simulation {

/// All keys of a case but its version.
void declare(fields::Visitor& fields, Scenario& scenario);

/// Numbers of turbine and analyses that are out of their range.
std::vector<Fault> find_range_faults(const Scenario& scenario);

}  // namespace samara::simulation
