// Work that may crash or hang, for libraries do so on damaged files: in a process of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace samara::io {

/// How the work went.
struct Apart {
  std::string bytes;     ///< that it wrote
  bool is_done = false;  ///< it came to its end, and said that all is well
  std::string ending;    ///< if not, in words
};

/// Does `work` in a child process, which may take `memory` bytes beyond what this one has, and
/// `seconds` of processor time. `work` gets a file to write to, and tells whether all is well.
/// @throws InternalError where no process can be started
Apart run_apart(std::size_t memory, std::size_t seconds, const std::function<bool(int)>& work);

/// Writes all to a file. False where that fails.
bool write_all(int file, const std::string& bytes);

}  // namespace samara::io
