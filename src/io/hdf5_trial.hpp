// HDF5 files whose bytes are damaged: the library (1.10.8) follows what they say, reads and writes
// beyond its memory, or asks for gigabytes; worst where texts have variable length. So a file is
// first read in a process of its own, and texts of variable length nowhere else.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace samara::io {

/// How reading a file in a child process went.
struct Hdf5Trial {
  bool is_passed = false;
  /// Texts of variable length by place: `/group/dataset`, `/group:attribute`.
  std::map<std::string, std::vector<std::string>> texts;
};

/// Reads in a child process, in bounded memory and time, all metadata, texts and chunks of the file
/// at `path`. Not passed where the child does not get to the end. The last file is not tried again
/// until it changes. @throws InternalError where no process can be started
std::shared_ptr<const Hdf5Trial> try_hdf5_file(const std::string& path);

}  // namespace samara::io
