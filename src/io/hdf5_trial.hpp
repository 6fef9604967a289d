// HDF5 files whose bytes are damaged: the library (1.10.8) follows what they say, reads and writes
// beyond its memory, or asks for gigabytes; worst where texts have variable length. So a file is
// first read in a process of its own, and texts of variable length nowhere else.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hdf5_file.hpp"

namespace samara::io {

/// How reading a file in a child process went.
struct Hdf5Trial {
  bool is_passed = false;
  std::string ending;  ///< if it did not pass, why, in words
  /// Texts of variable length by place, see `place_of`.
  std::map<std::string, std::vector<std::string>> texts;
};

/// The place of a dataset, or of its attribute, in Hdf5Trial::texts: whatever name leads there.
/// Empty for one in another file.
std::string place_of(const Hdf5Id& file, hid_t object, const std::string& attribute = {});

/// A file that is open to be read, and what was found before.
struct OpenHdf5 {
  Hdf5Id file;
  std::shared_ptr<const Hdf5Trial> trial;
};

/// Opens a file for reading, after a child process has read, in bounded memory and time, its
/// metadata, its texts of up to 64 MB, and up to that size the numbers of /case, /model, /trim and
/// /transient that do not lie in one piece. Holds no file where none can be opened, or the child
/// did not get to its end. HDF5 does not know the file's folder then: Hdf5Reader tells it.
/// @throws InternalError where no process can be started
OpenHdf5 open_for_reading(const std::string& path);

/// A file and the shapes that its datasets should have.
struct ExpectedFile {
  std::string path;
  std::map<std::string, std::vector<hsize_t>> shapes;
};

/// Whether each file can be opened and has what is expected, found out in a child process.
std::vector<bool> find_whole(const std::vector<ExpectedFile>& files);

}  // namespace samara::io
