// The block `linearize` of a case file.
#pragma once

#include "samara/io/case.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

void read_linearize(const YamlNode& node, LinearizeCase& linearize, ErrorList& errors);

}  // namespace samara::io
