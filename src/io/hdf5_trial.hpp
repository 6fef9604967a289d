// Protection against damaged HDF5 files. The library (1.10.8) trusts damaged bytes: it reads and
// writes beyond its memory, or requests gigabytes. Texts of variable length are the worst case. So
// a file is first read in a process of its own, and texts of variable length are read only there.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hdf5_file.hpp"

namespace samara::io {

/// Outcome of reading a file in a child process.
struct Hdf5Trial {
  bool is_passed = false;
  std::string ending;  ///< the reason if it did not pass
  /// Texts of variable length by place, see `place_of`.
  std::map<std::string, std::vector<std::string>> texts;
};

/// The place of a dataset, or of its attribute, in Hdf5Trial::texts. It is the same for all names
/// of the object, and empty for an object in another file.
std::string place_of(const Hdf5Id& file, hid_t object, const std::string& attribute = {});

/// A file that is open for reading, and the outcome of its trial.
struct OpenHdf5 {
  Hdf5Id file;
  std::shared_ptr<const Hdf5Trial> trial;
};

/// Opens a file for reading. Before that a child process reads, in bounded memory and time, its
/// metadata, its texts of up to 64 MB, and up to that size the numbers of /case, /model, /trim and
/// /transient that are not contiguous. The result has no file if it cannot be opened, or if the
/// child did not finish. HDF5 does not know the folder of a file opened so: Hdf5Reader sets it.
/// @throws InternalError where no process can be started
OpenHdf5 open_for_reading(const std::string& path);

/// A file and the shapes that its datasets of numbers should have.
struct ExpectedFile {
  std::string path;
  std::map<std::string, std::vector<hsize_t>> shapes;
};

/// Checks in a child process whether each file can be opened and has numbers of the expected
/// shapes.
std::vector<bool> find_whole(const std::vector<ExpectedFile>& files);

}  // namespace samara::io
