// Reads an HDF5 file: as much of the C API as results need.
#pragma once

#include <string>
#include <vector>

#include "hdf5_file.hpp"

namespace samara::io {

class Hdf5Reader {
 public:
  /// @throws InputError where the file cannot be opened
  explicit Hdf5Reader(const std::string& path);

  bool has(const std::string& name) const;

  /// Extents of a dataset.
  std::vector<hsize_t> shape(const std::string& name) const;

  /// All of a dataset. @throws InputError as all members do
  std::vector<double> numbers(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;
  std::string text(const std::string& name) const;

  /// Entries first to first + count along the first axis.
  std::vector<double> slice(const std::string& name, std::size_t first, std::size_t count) const;

  bool has_attribute(const std::string& object, const std::string& name) const;
  double number_attribute(const std::string& object, const std::string& name) const;
  std::string text_attribute(const std::string& object, const std::string& name) const;

 private:
  Hdf5Id open(const std::string& name) const;
  hid_t check(hid_t id, const std::string& name) const;

  std::string path_;
  Hdf5Id file_;
};

}  // namespace samara::io
