// Blades of the case file, their hinges and what differs between them (docs/case_file.md).
#pragma once

#include "samara/model/definition.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// Reads `blades`.
void read_blades(const YamlNode& node, model::BladesDefinition& blades, ErrorList& errors);

}  // namespace samara::io
