// Pitch actuators and the controller of the case file (docs/case_file.md).
#pragma once

#include "samara/model/definition.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// Reads `pitch_actuator` of the blades.
void read_pitch_actuator(MapReader& blades, model::BladesDefinition& definition);

/// Reads `controller`, after shaft and blades.
void read_controller(MapReader& map, model::TurbineDefinition& turbine);

}  // namespace samara::io
