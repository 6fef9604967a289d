// Faults of a turbine's definition that involve more than one field.
#pragma once

#include <vector>

#include "samara/base/fault.hpp"
#include "samara/model/definition.hpp"

namespace samara::model {

/// All faults; fields are keys of a case file (docs/case_file.md).
std::vector<Fault> find_faults(const TurbineDefinition& turbine);

/// Values without effect that are not faults.
std::vector<Fault> find_notes(const TurbineDefinition& turbine);

}  // namespace samara::model
