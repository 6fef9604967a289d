// Faults of a turbine's definition that involve more than one field.
#pragma once

#include <vector>

#include "samara/base/fault.hpp"
#include "samara/model/definition.hpp"

namespace samara::model {

/// All faults, fields by the keys of a case file (docs/case_file.md).
std::vector<Fault> find_faults(const TurbineDefinition& turbine);

/// Values that are no fault, but have no effect.
std::vector<Fault> find_notes(const TurbineDefinition& turbine);

}  // namespace samara::model
