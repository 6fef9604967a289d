// Runs work that may crash or hang, as libraries do on damaged files, in a process of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace samara::io {

/// Outcome of the work.
struct Apart {
  std::string bytes;     ///< output of the work
  bool is_done = false;  ///< it ended and returned true
  std::string ending;    ///< the reason if it is not done
};

/// Runs `work` in a child process. It may use `memory` bytes more than this process has, and
/// `seconds` of processor time. `work` gets a file to write to, and returns true on success.
/// @throws InternalError where no process can be started
Apart run_apart(std::size_t memory, std::size_t seconds, const std::function<bool(int)>& work);

/// Writes all bytes to a file. Returns false on failure.
bool write_all(int file, const std::string& bytes);

}  // namespace samara::io
