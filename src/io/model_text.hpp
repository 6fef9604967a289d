// The part of a case that makes the model, as text.
#pragma once

#include <string>

#include "samara/io/yaml_tree.hpp"

namespace samara::io {

/// The keys that make the model, one a line in the order of their names: `blades.length: 8.42`.
/// Numbers are spelled one way, comments and the keys of the analyses are not in it.
std::string model_text_of(const YamlNode& root);

}  // namespace samara::io
