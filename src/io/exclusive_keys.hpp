// Keys of which a mapping has one or the other.
#pragma once

#include <set>
#include <string>
#include <utility>

namespace samara::io {

using ExclusiveKeys = std::set<std::pair<std::string, std::string>>;

/// Both ways round, of all mappings of a case.
ExclusiveKeys find_exclusive_keys();

}  // namespace samara::io
