// The version of the case files that this program reads.
#pragma once

namespace samara::io {

inline constexpr int case_version = 1;

}  // namespace samara::io
