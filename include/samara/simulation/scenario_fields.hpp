// The keys of the analyses, and the list of all keys of a case.
#pragma once

#include <vector>

#include "samara/base/fault.hpp"
#include "samara/fields/turbine_fields.hpp"
#include "samara/simulation/scenario.hpp"

namespace samara::simulation {

/// All keys of a case except its version.
void declare(fields::Visitor& fields, Scenario& scenario);

/// Faults of numbers of the turbine and the analyses that are out of their range.
std::vector<Fault> find_range_faults(const Scenario& scenario);

}  // namespace samara::simulation
