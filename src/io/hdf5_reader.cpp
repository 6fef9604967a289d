#include "hdf5_reader.hpp"

#include <algorithm>

#include "samara/base/error.hpp"

namespace samara::io {

Hdf5Reader::Hdf5Reader(const std::string& path) : path_(path) {
  silence_hdf5();
  file_ = {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (!file_) throw InputError(path + ": cannot be opened as HDF5");
}

hid_t Hdf5Reader::check(hid_t id, const std::string& name) const {
  if (id < 0) throw InputError(path_ + ": " + name + " is missing or cannot be read");
  return id;
}

bool Hdf5Reader::has(const std::string& name) const {
  // Every group on the way must be there before the last link may be asked for.
  for (std::size_t end = name.find('/', 1); end != std::string::npos; end = name.find('/', end + 1))
    if (H5Lexists(file_.get(), name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

Hdf5Id Hdf5Reader::open(const std::string& name) const {
  return {check(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), name), H5Dclose};
}

std::vector<hsize_t> Hdf5Reader::shape(const std::string& name) const {
  const Hdf5Id dataset = open(name);
  const Hdf5Id space(check(H5Dget_space(dataset.get()), name), H5Sclose);
  std::vector<hsize_t> extents(
      static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space.get()), name)));
  H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  return extents;
}

std::vector<double> Hdf5Reader::numbers(const std::string& name) const {
  std::size_t count = 1;
  for (const hsize_t extent : shape(name)) count *= extent;
  std::vector<double> values(count);
  if (count == 0) return values;
  const Hdf5Id dataset = open(name);
  check(H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        name);
  return values;
}

std::vector<double> Hdf5Reader::slice(const std::string& name, std::size_t first,
                                      std::size_t count) const {
  std::vector<hsize_t> extents = shape(name);
  std::vector<hsize_t> start(extents.size(), 0);
  start.at(0) = first;
  extents.at(0) = count;
  hsize_t size = 1;
  for (const hsize_t extent : extents) size *= extent;
  std::vector<double> values(size);
  if (size == 0) return values;
  const Hdf5Id dataset = open(name);
  const Hdf5Id space(check(H5Dget_space(dataset.get()), name), H5Sclose);
  check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, extents.data(),
                            nullptr),
        name);
  const Hdf5Id memory(check(H5Screate_simple(1, &size, nullptr), name), H5Sclose);
  check(H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT,
                values.data()),
        name);
  return values;
}

std::vector<std::string> Hdf5Reader::texts(const std::string& name) const {
  const std::vector<hsize_t> extents = shape(name);
  const std::size_t count = extents.empty() ? 1 : extents[0];
  std::vector<std::string> words(count);
  if (count == 0) return words;
  const Hdf5Id dataset = open(name);
  const Hdf5Id type(check(H5Dget_type(dataset.get()), name), H5Tclose);
  const std::size_t width = H5Tget_size(type.get());
  std::string table(count * width, '\0');
  check(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, table.data()), name);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string padded = table.substr(i * width, width);
    words[i] = padded.substr(0, padded.find('\0'));
  }
  return words;
}

std::string Hdf5Reader::text(const std::string& name) const {
  const Hdf5Id dataset = open(name);
  const Hdf5Id type(check(H5Dget_type(dataset.get()), name), H5Tclose);
  if (H5Tis_variable_str(type.get()) <= 0) return texts(name).front();
  char* data = nullptr;
  check(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &data), name);
  const std::string words = data == nullptr ? "" : data;
  H5free_memory(data);
  return words;
}

bool Hdf5Reader::has_attribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

double Hdf5Reader::number_attribute(const std::string& object, const std::string& name) const {
  const std::string place = object + ":" + name;
  const Hdf5Id attribute(
      check(H5Aopen_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
            place),
      H5Aclose);
  double value = 0.0;
  check(H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value), place);
  return value;
}

std::string Hdf5Reader::text_attribute(const std::string& object, const std::string& name) const {
  const std::string place = object + ":" + name;
  const Hdf5Id attribute(
      check(H5Aopen_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
            place),
      H5Aclose);
  const Hdf5Id type(check(H5Aget_type(attribute.get()), place), H5Tclose);
  char* data = nullptr;
  check(H5Aread(attribute.get(), type.get(), &data), place);
  const std::string words = data == nullptr ? "" : data;
  H5free_memory(data);
  return words;
}

}  // namespace samara::io
