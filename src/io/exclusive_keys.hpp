// Keys that exclude each other in a mapping.
#pragma once

#include <set>
#include <string>
#include <utility>

namespace samara::io {

using ExclusiveKeys = std::set<std::pair<std::string, std::string>>;

/// The pairs of all mappings of a case, each in both orders.
ExclusiveKeys find_exclusive_keys();

}  // namespace samara::io
