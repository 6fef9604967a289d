#include "hdf5_file.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <hdf5_hl.h>

#include "samara/base/error.hpp"

#include "axes.hpp"

namespace samara::io {
namespace {

/// Increment by which the memory of the file grows [bytes].
constexpr std::size_t memory_increment = std::size_t{1} << 20;

/// The innermost record of HDF5's error stack: nearest to the cause.
std::string reason() {
  std::string text;
  const auto take = [](unsigned, const H5E_error2_t* error, void* target) -> herr_t {
    if (error->desc != nullptr) *static_cast<std::string*>(target) = error->desc;
    return 1;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &text);
  return text.empty() ? "unknown reason" : text;
}

template <class Code>
Code check(Code id) {
  if (id < 0) throw InternalError("HDF5: " + reason());
  return id;
}

/// Access to a file in memory: nothing goes to the disk.
Hdf5Id memory_access() {
  Hdf5Id access(check(H5Pcreate(H5P_FILE_ACCESS)), H5Pclose);
  check(H5Pset_fapl_core(access.get(), memory_increment, 0));
  return access;
}

/// Detaches the scale of an axis from this dataset.
void detach_axis(const Hdf5Id& dataset, unsigned axis) {
  if (check(H5DSget_num_scales(dataset.get(), axis)) == 0) return;
  Hdf5Id scale;
  const auto take = [](hid_t, unsigned, hid_t found, void* target) -> herr_t {
    if (H5Iinc_ref(found) < 0) return -1;
    *static_cast<Hdf5Id*>(target) = {found, H5Dclose};
    return 1;
  };
  check(H5DSiterate_scales(dataset.get(), axis, nullptr, take, &scale));
  check(H5DSdetach_scale(dataset.get(), scale.get(), axis));
}

/// The description, with the axes if there are several.
std::string describe(const Meaning& meaning) {
  if (meaning.axes.size() < 2) return meaning.description;
  std::string axes;
  for (const std::string& axis : meaning.axes) axes += (axes.empty() ? "[" : ", ") + axis;
  return meaning.description + (meaning.description.empty() ? "" : "; ") + axes + "]";
}

}  // namespace

void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

bool is_standard_number(const Hdf5Id& type) {
  const hid_t standard[] = {H5T_STD_I8LE,   H5T_STD_I16LE,  H5T_STD_I32LE,  H5T_STD_I64LE,
                            H5T_STD_U8LE,   H5T_STD_U16LE,  H5T_STD_U32LE,  H5T_STD_U64LE,
                            H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_STD_I8BE,   H5T_STD_I16BE,
                            H5T_STD_I32BE,  H5T_STD_I64BE,  H5T_STD_U8BE,   H5T_STD_U16BE,
                            H5T_STD_U32BE,  H5T_STD_U64BE,  H5T_IEEE_F32BE, H5T_IEEE_F64BE};
  return std::ranges::any_of(standard, [&](hid_t one) { return H5Tequal(type.get(), one) > 0; });
}

Hdf5File::Hdf5File() {
  silence_hdf5();
  file_ = {check(H5Fcreate("samara", H5F_ACC_TRUNC, H5P_DEFAULT, memory_access().get())), H5Fclose};
  make_types();
}

Hdf5File::Hdf5File(const std::vector<char>& image) {
  silence_hdf5();
  const Hdf5Id access = memory_access();
  std::vector<char> copy = image;  // HDF5 requires a writable image, and copies it
  check(H5Pset_file_image(access.get(), copy.data(), copy.size()));
  // With an image HDF5 refuses the name of an existing file; no file is below a device.
  file_ = {check(H5Fopen("/dev/null/samara", H5F_ACC_RDWR, access.get())), H5Fclose};
  make_types();
}

void Hdf5File::make_types() {
  text_type_ = {check(H5Tcopy(H5T_C_S1)), H5Tclose};
  check(H5Tset_size(text_type_.get(), H5T_VARIABLE));
  check(H5Tset_cset(text_type_.get(), H5T_CSET_UTF8));
  scalar_space_ = {check(H5Screate(H5S_SCALAR)), H5Sclose};
  link_ = {check(H5Pcreate(H5P_LINK_CREATE)), H5Pclose};
  check(H5Pset_create_intermediate_group(link_.get(), 1));
}

Hdf5Id Hdf5File::make_dataset(const std::string& name, hid_t type, const Shape& shape,
                              const Meaning& meaning, hid_t creation) {
  Hdf5Id own_space;
  if (!shape.empty())
    own_space = {check(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr)),
                 H5Sclose};
  const hid_t space = shape.empty() ? scalar_space_.get() : own_space.get();
  if (H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0)
    throw InternalError(name + ": written twice, or after a dataset that has it as its axis");
  Hdf5Id dataset(
      check(H5Dcreate2(file_.get(), name.c_str(), type, space, link_.get(), creation, H5P_DEFAULT)),
      H5Dclose);
  set_text(dataset.get(), "unit", meaning.unit);
  set_text(dataset.get(), "frame", meaning.frame);
  set_text(dataset.get(), "description", describe(meaning));
  attach_axes(dataset, name, shape, meaning);
  return dataset;
}

void Hdf5File::attach_axes(const Hdf5Id& dataset, const std::string& name, const Shape& shape,
                           const Meaning& meaning) {
  if (meaning.axes.size() != shape.size())
    throw InternalError(name + ": has " + std::to_string(shape.size()) + " axes, of which " +
                        std::to_string(meaning.axes.size()) + " have a name");
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const std::string& axis = meaning.axes[i];
    if (name.ends_with("/" + axis)) {
      check(H5DSset_scale(dataset.get(), axis.c_str()));
      continue;
    }
    const Hdf5Id scale = find_axis(name, axis, shape[i]);
    check(H5DSattach_scale(dataset.get(), scale.get(), static_cast<unsigned>(i)));
  }
}

/// The axis of dataset `name`, from its group or a group above; if there is none, a new one in its
/// group.
Hdf5Id Hdf5File::find_axis(const std::string& name, const std::string& axis, hsize_t length) {
  for (std::string group = name; !group.empty();) {
    group.resize(group.rfind('/'));
    const std::string place = group + "/" + axis;
    if (H5Lexists(file_.get(), place.c_str(), H5P_DEFAULT) > 0) {
      Hdf5Id scale(check(H5Oopen(file_.get(), place.c_str(), H5P_DEFAULT)), H5Oclose);
      if (H5Iget_type(scale.get()) == H5I_GROUP) continue;
      if (H5DSis_scale(scale.get()) == 0)  // written by a version without scales
        check(H5DSset_scale(scale.get(), axis.c_str()));
      const Hdf5Id space(check(H5Dget_space(scale.get())), H5Sclose);
      if (static_cast<hsize_t>(check(H5Sget_simple_extent_npoints(space.get()))) == length)
        return scale;
    }
  }
  const std::string place = name.substr(0, name.rfind('/') + 1) + axis;
  if (const std::vector<std::string> words = words_of_axis(axis); !words.empty()) {
    write(place, words, {"", "none", "entries of this axis", {axis}});
  } else {
    std::vector<int> numbers(length);
    std::iota(numbers.begin(), numbers.end(), 1);
    write(place, numbers, {"1", "none", "entries of this axis by number", {axis}});
  }
  return find_axis(name, axis, length);
}

void Hdf5File::write(const std::string& name, std::span<const double> values, const Shape& shape,
                     const Meaning& meaning) {
  const Hdf5Id dataset = make_dataset(name, H5T_IEEE_F64LE, shape, meaning);
  if (values.empty()) return;
  check(H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

void Hdf5File::write(const std::string& name, std::span<const int> values, const Meaning& meaning) {
  const Hdf5Id dataset = make_dataset(name, H5T_STD_I32LE, {values.size()}, meaning);
  if (values.empty()) return;
  check(H5Dwrite(dataset.get(), H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

void Hdf5File::write(const std::string& name, const std::vector<std::string>& values,
                     const Meaning& meaning) {
  const Hdf5Id dataset = make_dataset(name, text_type_.get(), {values.size()}, meaning);
  if (values.empty()) return;
  std::vector<const char*> words;
  for (const std::string& value : values) words.push_back(value.c_str());
  check(H5Dwrite(dataset.get(), text_type_.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, words.data()));
}

void Hdf5File::write(const std::string& name, const std::string& text, const Meaning& meaning) {
  const Hdf5Id dataset = make_dataset(name, text_type_.get(), {}, meaning);
  const char* data = text.c_str();
  check(H5Dwrite(dataset.get(), text_type_.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &data));
}

Hdf5Id Hdf5File::make_slices(const std::string& name, const Shape& shape, const Meaning& meaning) {
  const Hdf5Id creation(check(H5Pcreate(H5P_DATASET_CREATE)), H5Pclose);
  Shape slice = shape;
  slice.front() = 1;
  check(H5Pset_chunk(creation.get(), static_cast<int>(slice.size()), slice.data()));
  const float unwritten = std::numeric_limits<float>::quiet_NaN();
  check(H5Pset_fill_value(creation.get(), H5T_NATIVE_FLOAT, &unwritten));
  return make_dataset(name, H5T_IEEE_F32LE, shape, meaning, creation.get());
}

void Hdf5File::write_part(const Hdf5Id& dataset, hsize_t first, hsize_t count, hid_t type,
                          const void* values) {
  const Hdf5Id space(check(H5Dget_space(dataset.get())), H5Sclose);
  Shape extents(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space.get()))));
  check(H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr));
  Shape start(extents.size(), 0);
  start.front() = first;
  extents.front() = count;
  check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, extents.data(),
                            nullptr));
  const Hdf5Id memory(
      check(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr)), H5Sclose);
  check(H5Dwrite(dataset.get(), type, memory.get(), space.get(), H5P_DEFAULT, values));
}

void Hdf5File::write_slice(const Hdf5Id& dataset, hsize_t slice, std::span<const float> values) {
  write_part(dataset, slice, 1, H5T_NATIVE_FLOAT, values.data());
}

Hdf5Id Hdf5File::make_rows(const std::string& name, const Shape& shape, const Meaning& meaning) {
  return make_dataset(name, H5T_IEEE_F64LE, shape, meaning);
}

void Hdf5File::write_rows(const Hdf5Id& dataset, hsize_t first, hsize_t count,
                          std::span<const double> values) {
  write_part(dataset, first, count, H5T_NATIVE_DOUBLE, values.data());
}

void Hdf5File::remove(const std::string& name) {
  const Hdf5Id object(check(H5Oopen(file_.get(), name.c_str(), H5P_DEFAULT)), H5Oclose);
  if (H5Iget_type(object.get()) == H5I_DATASET && H5DSis_scale(object.get()) == 0) {
    const Hdf5Id space(check(H5Dget_space(object.get())), H5Sclose);
    const int rank = check(H5Sget_simple_extent_ndims(space.get()));
    for (int i = 0; i < rank; ++i) detach_axis(object, static_cast<unsigned>(i));
  }
  check(H5Ldelete(file_.get(), name.c_str(), H5P_DEFAULT));
}

void Hdf5File::write_joined(const std::string& name, const std::vector<std::string>& files,
                            const std::vector<std::size_t>& rows, const Shape& shape,
                            const Meaning& meaning) {
  const Hdf5Id creation(check(H5Pcreate(H5P_DATASET_CREATE)), H5Pclose);
  const double missing = std::numeric_limits<double>::quiet_NaN();
  check(H5Pset_fill_value(creation.get(), H5T_NATIVE_DOUBLE, &missing));
  const int rank = static_cast<int>(shape.size());
  Shape start(shape.size(), 0);
  Shape count = shape;
  for (std::size_t i = 0; i < files.size(); ++i) {
    count[0] = rows[i];
    const Hdf5Id part(check(H5Screate_simple(rank, count.data(), nullptr)), H5Sclose);
    const Hdf5Id whole(check(H5Screate_simple(rank, shape.data(), nullptr)), H5Sclose);
    check(H5Sselect_hyperslab(whole.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                              nullptr));
    check(H5Pset_virtual(creation.get(), whole.get(), files[i].c_str(), name.c_str(), part.get()));
    start[0] += rows[i];
  }
  make_dataset(name, H5T_IEEE_F64LE, shape, meaning, creation.get());
}

void Hdf5File::set_text(hid_t object, const std::string& name, const std::string& text) {
  const Hdf5Id attribute(check(H5Acreate2(object, name.c_str(), text_type_.get(),
                                          scalar_space_.get(), H5P_DEFAULT, H5P_DEFAULT)),
                         H5Aclose);
  const char* data = text.c_str();
  check(H5Awrite(attribute.get(), text_type_.get(), &data));
}

void Hdf5File::set_attribute(const std::string& object, const std::string& name,
                             const std::string& text) {
  const Hdf5Id target(check(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT)), H5Oclose);
  set_text(target.get(), name, text);
}

void Hdf5File::set_number(const std::string& object, const std::string& name, hid_t type,
                          const void* value) {
  const Hdf5Id target(check(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT)), H5Oclose);
  const Hdf5Id attribute(check(H5Acreate2(target.get(), name.c_str(), type, scalar_space_.get(),
                                          H5P_DEFAULT, H5P_DEFAULT)),
                         H5Aclose);
  check(H5Awrite(attribute.get(), type, value));
}

void Hdf5File::set_attribute(const std::string& object, const std::string& name, double value) {
  set_number(object, name, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5File::set_attribute(const std::string& object, const std::string& name, int value) {
  set_number(object, name, H5T_NATIVE_INT, &value);
}

std::vector<char> Hdf5File::image() const {
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL));
  const auto size = static_cast<std::size_t>(check(H5Fget_file_image(file_.get(), nullptr, 0)));
  std::vector<char> bytes(size);
  check(H5Fget_file_image(file_.get(), bytes.data(), bytes.size()));
  return bytes;
}

}  // namespace samara::io
