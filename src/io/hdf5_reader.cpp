#include "hdf5_reader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::io {
namespace {

/// Most values of a dataset that stores none: all equal its fill value, and reading them only costs
/// memory and time.
constexpr std::size_t most_unstored = 1000000;

/// Most bytes of one read (2 GB); larger data are read slice by slice.
constexpr std::size_t most_bytes = std::size_t{1} << 31;
/// Most bytes of texts, which are smaller than numbers in all results.
constexpr std::size_t most_text_bytes = std::size_t{64} << 20;

constexpr unsigned most_rank = 32;

std::string words_of(const std::vector<hsize_t>& extents) {
  if (extents.empty()) return "a scalar";
  std::string text;
  for (const hsize_t extent : extents) text += (text.empty() ? "" : " x ") + std::to_string(extent);
  return text + " entries";
}

}  // namespace

Hdf5Reader::Hdf5Reader(const std::string& path) : path_(path) {
  OpenHdf5 open = open_for_reading(path);
  file_ = std::move(open.file);
  trial_ = std::move(open.trial);
  access_ = {H5Pcreate(H5P_DATASET_ACCESS), H5Pclose};
  const std::filesystem::path folder = folder_of(resolved_path(path));
  H5Pset_virtual_prefix(access_.get(), std::filesystem::absolute(folder).c_str());
  if (!file_)
    throw InputError(path + ": cannot be opened as HDF5" +
                     (trial_->ending.empty() ? "" : ": " + trial_->ending));
}

void Hdf5Reader::refuse(const std::string& place, const std::string& why) const {
  throw InputError(path_ + ": " + place + " " + why);
}

hid_t Hdf5Reader::check(hid_t id, const std::string& place) const {
  if (id < 0) refuse(place, "is missing or cannot be read");
  return id;
}

bool Hdf5Reader::has(const std::string& name) const {
  // All groups of the path must exist before the last link may be checked.
  for (std::size_t end = name.find('/', 1); end != std::string::npos; end = name.find('/', end + 1))
    if (H5Lexists(file_.get(), name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

Hdf5Reader::Item Hdf5Reader::open(const std::string& name) const {
  Hdf5Id id(check(H5Dopen2(file_.get(), name.c_str(), access_.get()), name), H5Dclose);
  std::string text_place = place_of(file_, id.get());
  return {std::move(id), false, name, std::move(text_place)};
}

Hdf5Reader::Item Hdf5Reader::open_attribute(const std::string& object,
                                            const std::string& name) const {
  const std::string place = object + ":" + name;
  const Hdf5Id owner(check(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), object), H5Oclose);
  Hdf5Id id(check(H5Aopen(owner.get(), name.c_str(), H5P_DEFAULT), place), H5Aclose);
  return {std::move(id), true, place, place_of(file_, owner.get(), name)};
}

Hdf5Id Hdf5Reader::type_of(const Item& item) const {
  const hid_t id = item.id.get();
  return {check(item.is_attribute ? H5Aget_type(id) : H5Dget_type(id), item.place), H5Tclose};
}

std::vector<hsize_t> Hdf5Reader::extents_of(const Item& item) const {
  const hid_t id = item.id.get();
  const Hdf5Id space(check(item.is_attribute ? H5Aget_space(id) : H5Dget_space(id), item.place),
                     H5Sclose);
  if (H5Sget_simple_extent_type(space.get()) == H5S_NULL) refuse(item.place, "is empty");
  const auto rank =
      static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space.get()), item.place));
  if (rank > most_rank) refuse(item.place, "has too many dimensions");
  std::vector<hsize_t> extents(rank);
  if (rank > 0) check(H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr), item.place);
  return extents;
}

/// Number of entries; refuses more than can be read at once.
std::size_t Hdf5Reader::size_of(const Item& item, const std::vector<hsize_t>& extents) const {
  hsize_t count = 1;
  for (const hsize_t extent : extents) {
    if (extent > most_bytes || count * extent > most_bytes / sizeof(double))
      refuse(item.place, "has " + words_of(extents) + ", more than can be read");
    count *= extent;
  }
  return count;
}

std::vector<std::string> Hdf5Reader::sources(const std::string& name) const {
  const Item item = open(name);
  const Hdf5Id creation(check(H5Dget_create_plist(item.id.get()), name), H5Pclose);
  std::vector<std::string> files;
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  if (layout == H5D_CONTIGUOUS && H5Pget_external_count(creation.get()) != 0)
    refuse(name, "has its values in another file");
  if (layout != H5D_VIRTUAL) return files;
  std::size_t count = 0;
  if (H5Pget_virtual_count(creation.get(), &count) < 0) refuse(name, "cannot be read");
  for (std::size_t i = 0; i < count; ++i) {
    const ssize_t length = H5Pget_virtual_filename(creation.get(), i, nullptr, 0);
    if (length < 0) refuse(name, "cannot be read");
    std::string file(static_cast<std::size_t>(length), '\0');
    H5Pget_virtual_filename(creation.get(), i, file.data(), file.size() + 1);
    files.push_back(file);
  }
  return files;
}

void Hdf5Reader::require_numbers(const Item& item) const {
  const Hdf5Id type = type_of(item);
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) refuse(item.place, "does not hold numbers");
  if (!is_standard_number(type))
    refuse(item.place,
           "has numbers that are neither integers nor IEEE numbers of 1, 2, 4 or 8 bytes");
}

std::vector<double> Hdf5Reader::read_numbers(const Item& item, std::size_t count) const {
  if (!item.is_attribute && count > most_unstored && H5Dget_storage_size(item.id.get()) == 0)
    refuse(item.place, "has " + std::to_string(count) + " values, none of them stored");
  require_numbers(item);
  std::vector<double> values(count);
  if (count == 0) return values;
  const hid_t id = item.id.get();
  check(item.is_attribute
            ? H5Aread(id, H5T_NATIVE_DOUBLE, values.data())
            : H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        item.place);
  return values;
}

std::vector<std::string> Hdf5Reader::read_texts(const Item& item, std::size_t count) const {
  const Hdf5Id type = type_of(item);
  if (H5Tget_class(type.get()) != H5T_STRING) refuse(item.place, "does not hold text");
  if (count == 0) return {};
  if (count > most_text_bytes / sizeof(std::string)) refuse(item.place, "has too many texts");
  const auto read = [&](void* target) {
    const hid_t id = item.id.get();
    check(item.is_attribute ? H5Aread(id, type.get(), target)
                            : H5Dread(id, type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, target),
          item.place);
  };
  if (H5Tis_variable_str(type.get()) > 0) {
    const auto found = trial_->texts.find(item.text_place);
    if (found == trial_->texts.end() || found->second.size() != count)
      refuse(item.place, "cannot be read");
    return found->second;
  }
  const std::size_t width = H5Tget_size(type.get());
  if (width == 0 || width > most_text_bytes / count)
    refuse(item.place, "has texts of too many bytes");
  std::string table(count * width, '\0');
  std::vector<std::string> words(count);
  read(table.data());
  const bool is_padded_by_blanks = H5Tget_strpad(type.get()) == H5T_STR_SPACEPAD;
  for (std::size_t i = 0; i < count; ++i) {
    std::string& word = words[i];
    word = table.substr(i * width, width);
    word.resize(std::min(word.size(), word.find('\0')));
    if (is_padded_by_blanks) word.resize(word.find_last_not_of(' ') + 1);
  }
  return words;
}

std::vector<hsize_t> Hdf5Reader::shape(const std::string& name) const {
  return extents_of(open(name));
}

std::vector<double> Hdf5Reader::numbers(const std::string& name) const {
  const Item item = open(name);
  const std::vector<hsize_t> extents = extents_of(item);
  if (extents.size() != 1) refuse(name, "has " + words_of(extents) + ", expected a list");
  return read_numbers(item, size_of(item, extents));
}

double Hdf5Reader::number(const std::string& name) const {
  const Item item = open(name);
  const std::vector<hsize_t> extents = extents_of(item);
  if (size_of(item, extents) != 1) refuse(name, "has " + words_of(extents) + ", expected one");
  return read_numbers(item, 1).front();
}

std::vector<double> Hdf5Reader::table(const std::string& name, hsize_t& rows,
                                      hsize_t& columns) const {
  const Item item = open(name);
  const std::vector<hsize_t> extents = extents_of(item);
  if (extents.size() != 2) refuse(name, "has " + words_of(extents) + ", expected rows and columns");
  rows = extents[0];
  columns = extents[1];
  return read_numbers(item, size_of(item, extents));
}

std::size_t Hdf5Reader::to_count(double value, const std::string& place) const {
  if (!(value >= 0.0) || value > 9e15 || value != std::floor(value))
    refuse(place, "is not a valid number of entries");
  return static_cast<std::size_t>(value);
}

std::vector<std::size_t> Hdf5Reader::counts(const std::string& name) const {
  std::vector<std::size_t> values;
  for (const double value : numbers(name)) values.push_back(to_count(value, name));
  return values;
}

std::vector<std::string> Hdf5Reader::texts(const std::string& name) const {
  const Item item = open(name);
  const std::vector<hsize_t> extents = extents_of(item);
  if (extents.size() != 1) refuse(name, "has " + words_of(extents) + ", expected a list");
  return read_texts(item, size_of(item, extents));
}

std::string Hdf5Reader::text(const std::string& name) const {
  const Item item = open(name);
  const std::vector<hsize_t> extents = extents_of(item);
  if (size_of(item, extents) != 1) refuse(name, "has " + words_of(extents) + ", expected one text");
  return read_texts(item, 1).front();
}

std::vector<double> Hdf5Reader::slice(const std::string& name, std::size_t first,
                                      std::size_t count) const {
  const std::vector<hsize_t> extents = shape(name);
  if (extents.size() != 1) refuse(name, "has " + words_of(extents) + ", expected a list");
  return read_slice(name, extents, first, count);
}

std::vector<double> Hdf5Reader::slice(const std::string& name, std::size_t first, std::size_t count,
                                      std::size_t width) const {
  const std::vector<hsize_t> extents = shape(name);
  if (extents.size() != 2 || extents[1] != width)
    refuse(name, "has " + words_of(extents) + ", expected rows of " + std::to_string(width));
  return read_slice(name, extents, first, count);
}

std::vector<double> Hdf5Reader::read_slice(const std::string& name, std::vector<hsize_t> extents,
                                           std::size_t first, std::size_t count) const {
  const Item item = open(name);
  require_numbers(item);
  if (first > extents[0] || count > extents[0] - first)
    refuse(name, "has " + words_of(extents) + ", fewer than requested");
  std::vector<hsize_t> start(extents.size(), 0);
  start[0] = first;
  extents[0] = count;
  const hsize_t size = size_of(item, extents);
  std::vector<double> values(size);
  if (size == 0) return values;
  const Hdf5Id space(check(H5Dget_space(item.id.get()), name), H5Sclose);
  check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, extents.data(),
                            nullptr),
        name);
  const Hdf5Id memory(check(H5Screate_simple(1, &size, nullptr), name), H5Sclose);
  check(H5Dread(item.id.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT,
                values.data()),
        name);
  return values;
}

bool Hdf5Reader::has_attribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

double Hdf5Reader::number_attribute(const std::string& object, const std::string& name) const {
  const Item item = open_attribute(object, name);
  const std::vector<hsize_t> extents = extents_of(item);
  if (size_of(item, extents) != 1) refuse(item.place, "is not one number");
  return read_numbers(item, 1).front();
}

std::size_t Hdf5Reader::count_attribute(const std::string& object, const std::string& name) const {
  return to_count(number_attribute(object, name), object + ":" + name);
}

std::string Hdf5Reader::text_attribute(const std::string& object, const std::string& name) const {
  const Item item = open_attribute(object, name);
  const std::vector<hsize_t> extents = extents_of(item);
  if (size_of(item, extents) != 1) refuse(item.place, "is not one text");
  return read_texts(item, 1).front();
}

}  // namespace samara::io
