// A new HDF5 file: a wrapper of the part of the C API that results need.
//
// The file is built in memory and returned as bytes, because HDF5 fails on a full disk (H5Fclose
// fails, and the library crashes when MPI ends).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "samara/io/result_file.hpp"

namespace samara::io {

/// Sole owner of an HDF5 identifier.
class Hdf5Id {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Id() = default;
  Hdf5Id(hid_t id, Close closer) : id_(id), close_(closer) {}
  Hdf5Id(Hdf5Id&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Hdf5Id(const Hdf5Id&) = delete;
  Hdf5Id& operator=(const Hdf5Id&) = delete;
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }

  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Makes HDF5 return error codes and print nothing on stderr. Call it before any other HDF5
/// function.
void silence_hdf5();

/// True for integers of 1, 2, 4 or 8 bytes and IEEE numbers of 4 or 8 bytes, of either byte order.
/// HDF5 1.10.8 does not check other types before it converts values: a precision beyond the size of
/// the type makes it write beyond its memory.
bool is_standard_number(const Hdf5Id& type);

class Hdf5File {
 public:
  using Shape = std::vector<hsize_t>;

  /// @throws InternalError as all members do
  Hdf5File();
  /// Starts with the content of an existing file; the file itself does not change.
  explicit Hdf5File(const std::vector<char>& image);

  void write(const std::string& name, std::span<const double> values, const Shape& shape,
             const Meaning& meaning);
  void write(const std::string& name, std::span<const int> values, const Meaning& meaning);
  void write(const std::string& name, const std::vector<std::string>& values,
             const Meaning& meaning);
  void write(const std::string& name, const std::string& text, const Meaning& meaning);

  /// Makes a dataset of single precision, to be filled slice by slice along its first axis. Slices
  /// that are never written take no space and read as not-a-number.
  Hdf5Id make_slices(const std::string& name, const Shape& shape, const Meaning& meaning);
  void write_slice(const Hdf5Id& dataset, hsize_t slice, std::span<const float> values);

  /// Makes a dataset to be filled in blocks of entries of its first axis.
  Hdf5Id make_rows(const std::string& name, const Shape& shape, const Meaning& meaning);
  void write_rows(const Hdf5Id& dataset, hsize_t first, hsize_t count,
                  std::span<const double> values);

  /// Removes a group or dataset. A dataset must be removed before its axes.
  void remove(const std::string& name);

  /// Makes a dataset that shows the datasets `name` of other files one after the other along the
  /// first axis. `shape` is that of the whole; `rows` are the rows of each file; paths are relative
  /// to this file's folder.
  void write_joined(const std::string& name, const std::vector<std::string>& files,
                    const std::vector<std::size_t>& rows, const Shape& shape,
                    const Meaning& meaning);

  /// Sets an attribute of an existing group or dataset ("/" is the root).
  void set_attribute(const std::string& object, const std::string& name, const std::string& text);
  void set_attribute(const std::string& object, const std::string& name, double value);
  void set_attribute(const std::string& object, const std::string& name, int value);

  /// The content of the file.
  std::vector<char> image() const;

 private:
  Hdf5Id make_dataset(const std::string& name, hid_t type, const Shape& shape,
                      const Meaning& meaning, hid_t creation = H5P_DEFAULT);
  void attach_axes(const Hdf5Id& dataset, const std::string& name, const Shape& shape,
                   const Meaning& meaning);
  Hdf5Id find_axis(const std::string& name, const std::string& axis, hsize_t length);
  void write_part(const Hdf5Id& dataset, hsize_t first, hsize_t count, hid_t type,
                  const void* values);
  void set_text(hid_t object, const std::string& name, const std::string& text);
  void set_number(const std::string& object, const std::string& name, hid_t type,
                  const void* value);

  void make_types();

  Hdf5Id file_;
  Hdf5Id text_type_;  ///< of any length
  Hdf5Id scalar_space_;
  Hdf5Id link_;  ///< properties that create the missing groups of a name
};

}  // namespace samara::io
