// The --set arguments of the command line: `key.path=value`.
#pragma once

#include <string>
#include <vector>

#include "samara/io/yaml_tree.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// Replaces or adds keys in the tree, in the order given. Paths have dots; items of lists are
/// numbered from 0. Keys that exclude the new key are removed (`speed_rpm` replaces `speed`).
void apply_settings(const std::vector<std::string>& settings, YamlNode& root, ErrorList& errors);

}  // namespace samara::io
