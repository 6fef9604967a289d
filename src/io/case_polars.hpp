// Polars that a case takes from files.
#pragma once

#include <string>
#include <vector>

#include "samara/io/yaml_tree.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// Reads the files of `blades.airfoils`, relative to the folder of the case, and replaces each key
/// `file` by `polars`, at the same place. Returns --set arguments that do the same without the
/// files.
std::vector<std::string> embed_polars(const std::string& case_path, YamlNode& root,
                                      ErrorList& errors);

}  // namespace samara::io
