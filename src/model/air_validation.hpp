// Faults of the wind and of the air of a turbine that involve more than one field.
#pragma once

#include <vector>

#include "samara/base/fault.hpp"
#include "samara/model/definition.hpp"

namespace samara::model {

std::vector<Fault> find_air_faults(const TurbineDefinition& turbine);

/// Values without effect that are not faults.
std::vector<Fault> find_air_notes(const TurbineDefinition& turbine);

}  // namespace samara::model
