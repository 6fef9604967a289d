// Blades of the case file, their hinges and what differs between them (docs/case_file.md).
#pragma once

#include "samara/model/definition.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// Reads `blades`.
void read_blades(const YamlNode& node, model::BladesDefinition& blades, ErrorList& errors);

/// Adds an error where the hinges do not stand between the shaft axis and the root. `root`: the
/// whole case, which has been read.
void check_hinges(const YamlNode& root, const model::TurbineDefinition& turbine, ErrorList& errors);

}  // namespace samara::io
