// The keys that make the model: tower, nacelle, shaft, hub, blades and what stands on them.
#pragma once

#include <vector>

#include "samara/base/fault.hpp"
#include "samara/fields/visitor.hpp"
#include "samara/model/definition.hpp"
#include "samara/model/operating_points.hpp"

namespace samara::fields {

inline constexpr int most_harmonics = 200;  ///< of the rotor speed, of loads and of a trim

/// All keys of a turbine, at the top of a case.
void declare(Visitor& fields, model::TurbineDefinition& turbine);

/// The block `operation`.
void declare_operating_points(Visitor& fields, model::OperatingPointsDefinition& operation);

/// Numbers out of their range, not finite, or of a size that no case may have.
std::vector<Fault> find_range_faults(const model::TurbineDefinition& turbine);

}  // namespace samara::fields
