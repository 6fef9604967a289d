// The part of a case that defines the model, as text.
#pragma once

#include <string>

#include "samara/io/yaml_tree.hpp"

namespace samara::io {

/// The keys that define the model, one per line in the order of their names: `blades.length: 8.42`.
/// Equal numbers have the same text. A row of the table of a polar is one line. Comments and the
/// keys of the analyses are left out.
std::string model_text_of(const YamlNode& root);

}  // namespace samara::io
