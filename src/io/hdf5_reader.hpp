// Reads an HDF5 file: a wrapper of the part of the C API that results need.
//
// A file may have been changed by other programs. So class, rank and size of a dataset or attribute
// are compared with the expected ones before it is read.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hdf5_file.hpp"
#include "hdf5_trial.hpp"

namespace samara::io {

class Hdf5Reader {
 public:
  /// @throws InputError where the file cannot be opened
  explicit Hdf5Reader(const std::string& path);

  bool has(const std::string& name) const;

  /// Extents of a dataset. @throws InputError as all members do
  std::vector<hsize_t> shape(const std::string& name) const;

  /// A list of numbers.
  std::vector<double> numbers(const std::string& name) const;
  /// The only number of a dataset.
  double number(const std::string& name) const;
  /// Numbers in `rows` and `columns`, row by row.
  std::vector<double> table(const std::string& name, hsize_t& rows, hsize_t& columns) const;
  /// A list of counts.
  std::vector<std::size_t> counts(const std::string& name) const;
  /// A list of texts, of fixed or variable length.
  std::vector<std::string> texts(const std::string& name) const;
  /// The only text of a dataset.
  std::string text(const std::string& name) const;

  /// The files whose content a dataset shows; empty: it has its own content.
  std::vector<std::string> sources(const std::string& name) const;

  /// Reads `count` entries of the first axis from entry `first` on, of a list or of rows of `width`
  /// numbers.
  std::vector<double> slice(const std::string& name, std::size_t first, std::size_t count) const;
  std::vector<double> slice(const std::string& name, std::size_t first, std::size_t count,
                            std::size_t width) const;

  bool has_attribute(const std::string& object, const std::string& name) const;
  double number_attribute(const std::string& object, const std::string& name) const;
  std::size_t count_attribute(const std::string& object, const std::string& name) const;
  std::string text_attribute(const std::string& object, const std::string& name) const;

 private:
  /// Item to read: a dataset or an attribute.
  struct Item {
    Hdf5Id id;
    bool is_attribute = false;
    std::string place;       ///< name for messages
    std::string text_place;  ///< key in Hdf5Trial::texts
  };

  Item open(const std::string& name) const;
  Item open_attribute(const std::string& object, const std::string& name) const;
  std::vector<hsize_t> extents_of(const Item& item) const;
  Hdf5Id type_of(const Item& item) const;
  void require_numbers(const Item& item) const;
  std::size_t size_of(const Item& item, const std::vector<hsize_t>& extents) const;
  std::vector<double> read_numbers(const Item& item, std::size_t count) const;
  std::vector<std::string> read_texts(const Item& item, std::size_t count) const;
  std::vector<double> read_slice(const std::string& name, std::vector<hsize_t> extents,
                                 std::size_t first, std::size_t count) const;
  std::size_t to_count(double value, const std::string& place) const;
  [[noreturn]] void refuse(const std::string& place, const std::string& why) const;
  hid_t check(hid_t id, const std::string& place) const;

  std::string path_;
  Hdf5Id file_;
  std::shared_ptr<const Hdf5Trial> trial_;
  Hdf5Id access_;  ///< access to datasets, with the folder of the segments
};

}  // namespace samara::io
