// The memory that a run shares with the helper process in which a controller library runs
// (drivers/controller_host). Only the run and its helper of the same build use it.
#pragma once

#include <cstddef>

namespace samara::io {

inline constexpr std::size_t controller_records = 5000;
inline constexpr std::size_t controller_text = 8192;

/// Files of the helper.
inline constexpr int controller_memory_file = 3;  ///< this memory
inline constexpr int controller_wire_file = 4;    ///< a byte from the run asks, one back answers

struct ControllerMemory {
  // From the run, before the helper starts.
  char library[controller_text];
  char procedure[256];
  // From the helper: why the library cannot be used; empty: it can.
  char fault[controller_text];
  // The arguments of the library. It may write more than it should: what follows is room for that.
  int fail;
  char input[controller_text];
  char output[controller_text];
  char message[controller_text];
  float records[controller_records];
  char room[4096];
};

}  // namespace samara::io
