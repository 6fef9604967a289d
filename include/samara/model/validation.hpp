// What is wrong with a turbine's definition where each field by itself may be right.
#pragma once

#include <vector>

#include "samara/base/fault.hpp"
#include "samara/model/definition.hpp"

namespace samara::model {

/// All faults, fields by the keys of a case file (docs/case_file.md).
std::vector<Fault> find_faults(const TurbineDefinition& turbine);

/// What is no fault, but has not the effect that it seems to have.
std::vector<Fault> find_notes(const TurbineDefinition& turbine);

}  // namespace samara::model
