// Tuned mass dampers of the case file (docs/case_file.md).
#pragma once

#include "samara/model/definition.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// Reads the list `tuned_mass_dampers`, after tower, nacelle and blades.
void read_mass_dampers(MapReader& map, model::TurbineDefinition& turbine);

}  // namespace samara::io
