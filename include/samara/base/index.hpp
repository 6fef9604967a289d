// Numbers as indices of containers.
#pragma once

#include <cstddef>

namespace samara {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace samara
