// The block `linearize` of a case file.
#pragma once

#include "samara/io/case.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// `turbine` has been read.
void read_linearize(const YamlNode& node, const model::TurbineDefinition& turbine,
                    simulation::LinearizeSetup& linearize, std::string& mat_path,
                    ErrorList& errors);

}  // namespace samara::io
