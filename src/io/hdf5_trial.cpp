#include "hdf5_trial.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include "run_apart.hpp"

namespace samara::io {
namespace {

/// Limit of one dataset or attribute that is read at once.
constexpr std::size_t most_bytes = std::size_t{64} << 20;

/// Limit of the child's processor time [s]; an undamaged file takes some hundredths of it. With a
/// damaged file the library may never end.
std::size_t most_seconds(std::size_t file_size) {
  return 1 + std::min<std::size_t>(file_size / 5'000'000, 120);
}

/// Limit of the child's memory: metadata have no more bytes than their file, whatever size they
/// state.
std::size_t most_memory(std::size_t file_size) {
  return 3 * most_bytes + 8 * std::min(file_size, 2 * most_bytes);
}

std::size_t size_of(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return error ? 0 : static_cast<std::size_t>(size);
}

std::string words_of(const struct stat& info) {
  std::string words;
  for (const auto part :
       {static_cast<long long>(info.st_dev), static_cast<long long>(info.st_ino),
        static_cast<long long>(info.st_size), static_cast<long long>(info.st_mtim.tv_sec),
        static_cast<long long>(info.st_mtim.tv_nsec)})
    words += std::to_string(part) + " ";
  return words;
}

std::size_t bytes_of(const Hdf5Id& space, const Hdf5Id& type) {
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  const std::size_t width = H5Tget_size(type.get());
  if (count <= 0 || width == 0) return 0;
  if (static_cast<std::size_t>(count) > most_bytes / width) return most_bytes + 1;
  return static_cast<std::size_t>(count) * width;
}

/// Message of the child: for each text its place, the number of entries and the entries, each after
/// its length. A number at the end shows that the message is complete.
class Report {
 public:
  void add(const std::string& place, const std::vector<char*>& words) {
    add_word(place.data(), place.size());
    add_number(words.size());
    for (const char* word : words) add_word(word, word == nullptr ? 0 : std::strlen(word));
  }

  bool send(int file) {
    add_number(end_mark);
    return write_all(file, bytes_);
  }

  /// Returns false if the message is incomplete.
  static bool parse(std::string_view bytes, Hdf5Trial& trial) {
    std::uint64_t length = 0;
    std::uint64_t count = 0;
    for (;;) {
      if (!take_number(bytes, length)) return false;
      if (length == end_mark) return bytes.empty();
      std::string place;
      if (!take_word(bytes, length, place) || !take_number(bytes, count) ||
          count > bytes.size() / sizeof count)
        return false;
      std::vector<std::string> words(count);
      for (std::string& word : words)
        if (!take_number(bytes, length) || !take_word(bytes, length, word)) return false;
      trial.texts[place] = std::move(words);
    }
  }

 private:
  static constexpr std::uint64_t end_mark = ~std::uint64_t{0};

  void add_number(std::uint64_t number) {
    std::array<char, sizeof number> bytes{};
    std::memcpy(bytes.data(), &number, sizeof number);
    bytes_.append(bytes.data(), bytes.size());
  }
  void add_word(const char* word, std::size_t length) {
    add_number(length);
    if (length > 0) bytes_.append(word, length);
  }
  static bool take_number(std::string_view& bytes, std::uint64_t& number) {
    if (bytes.size() < sizeof number) return false;
    std::memcpy(&number, bytes.data(), sizeof number);
    bytes.remove_prefix(sizeof number);
    return true;
  }
  static bool take_word(std::string_view& bytes, std::uint64_t length, std::string& word) {
    if (bytes.size() < length) return false;
    word = bytes.substr(0, length);
    bytes.remove_prefix(length);
    return true;
  }

  std::string bytes_;
};

/// Visits the objects of a file one after the other and reports their texts.
class Visitor {
 public:
  Visitor(const Hdf5Id& file, Report& report) : file_(file), report_(report) {}

  /// Returns false if data that the program needs from a result cannot be read.
  bool visit() {
    const Hdf5Id root(H5Oopen(file_.get(), "/", H5P_DEFAULT), H5Oclose);
    return root && try_object(root, true) &&
           H5Lvisit(file_.get(), H5_INDEX_NAME, H5_ITER_NATIVE, try_link, this) >= 0;
  }

 private:
  /// Tries the object that a name leads to. A soft link may lead to no object.
  static herr_t try_link(hid_t file, const char* name, const H5L_info_t* link, void* target) {
    const std::string_view top = std::string_view(name).substr(0, std::strcspn(name, "/"));
    const bool is_read = top == "case" || top == "model" || top == "trim" || top == "transient";
    const Hdf5Id object(H5Oopen(file, name, H5P_DEFAULT), H5Oclose);
    if (!object) return link->type == H5L_TYPE_HARD && is_read ? -1 : 0;
    return static_cast<Visitor*>(target)->try_object(object, is_read) || !is_read ? 0 : -1;
  }

  bool try_object(const Hdf5Id& object, bool is_read) {
    object_ = object.get();
    hsize_t first = 0;
    if (H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_NATIVE, &first, try_attribute, this) < 0)
      return false;
    return H5Iget_type(object.get()) != H5I_DATASET || try_dataset(object, is_read);
  }

  static herr_t try_attribute(hid_t object, const char* name, const H5A_info_t*, void* target) {
    const Hdf5Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    if (!attribute) return -1;
    const Hdf5Id type(H5Aget_type(attribute.get()), H5Tclose);
    const Hdf5Id space(H5Aget_space(attribute.get()), H5Sclose);
    const auto read = [&](void* values) { return H5Aread(attribute.get(), type.get(), values); };
    return static_cast<Visitor*>(target)->read_all(type, space, name, read) ? 0 : -1;
  }

  bool try_dataset(const Hdf5Id& dataset, bool is_read) {
    const Hdf5Id type(H5Dget_type(dataset.get()), H5Tclose);
    const Hdf5Id space(H5Dget_space(dataset.get()), H5Sclose);
    if (!type || !space) return false;
    const bool is_text = H5Tget_class(type.get()) == H5T_STRING;
    if (!is_text && (!is_read || is_plain(dataset))) return true;
    return read_all(type, space, {}, [&](void* values) {
      return H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    });
  }

  /// True for numbers that need no trial: contiguous ones are valid for any bytes, and those of
  /// other files have their own trial.
  static bool is_plain(const Hdf5Id& dataset) {
    const Hdf5Id creation(H5Dget_create_plist(dataset.get()), H5Pclose);
    const H5D_layout_t layout = H5Pget_layout(creation.get());
    return layout == H5D_CONTIGUOUS || layout == H5D_VIRTUAL;
  }

  /// Reads values of this type and space by `read`. Values that are neither numbers nor texts, or
  /// too large, are skipped, because the program never reads them.
  template <class Read>
  bool read_all(const Hdf5Id& type, const Hdf5Id& space, const std::string& attribute,
                const Read& read) {
    if (!type || !space) return false;
    const H5T_class_t kind = H5Tget_class(type.get());
    if (kind != H5T_INTEGER && kind != H5T_FLOAT && kind != H5T_STRING) return true;
    const std::size_t size = bytes_of(space, type);
    if (size > most_bytes) return true;
    if (H5Tis_variable_str(type.get()) <= 0) {
      std::vector<std::byte> values(size);
      return size == 0 || read(values.data()) >= 0;
    }
    std::vector<char*> words(size / sizeof(char*), nullptr);
    if (size > 0 && read(words.data()) < 0) return false;
    if (const std::string place = place_of(file_, object_, attribute); !place.empty())
      report_.add(place, words);
    return true;
  }

  const Hdf5Id& file_;
  Report& report_;
  hid_t object_ = H5I_INVALID_HID;  ///< its attributes and values are read
};

/// Opens with the stdio driver: the default driver looks for the file at the path behind a symbolic
/// link.
Hdf5Id open_descriptor(const std::string& name) {
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_stdio(access.get());
  return {H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose};
}

bool read_file(const std::string& path, int output) {
  silence_hdf5();
  const Hdf5Id file = open_descriptor(path);
  if (!file) return false;
  Report report;
  return Visitor(file, report).visit() && report.send(output);
}

Hdf5Trial run_trial(const std::string& path) {
  const std::size_t size = size_of(path);
  const Apart apart = run_apart(most_memory(size), most_seconds(size),
                                [&path](int output) { return read_file(path, output); });
  Hdf5Trial trial;
  trial.is_passed = apart.is_done && Report::parse(apart.bytes, trial);
  trial.ending = apart.ending;
  return trial;
}

/// The last file is not tried again until it changes.
std::shared_ptr<const Hdf5Trial> try_file(const std::string& path, const struct stat& info) {
  static std::string version;
  static auto trial = std::make_shared<const Hdf5Trial>();
  const std::string now = words_of(info);
  if (now != version) trial = std::make_shared<const Hdf5Trial>(run_trial(path));
  version = now;
  return trial;
}

bool is_whole(const ExpectedFile& expected) {
  const Hdf5Id file(H5Fopen(expected.path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) return false;
  for (const auto& [name, shape] : expected.shapes) {
    const Hdf5Id dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Id space(dataset ? H5Dget_space(dataset.get()) : H5I_INVALID_HID, H5Sclose);
    if (!space || H5Sget_simple_extent_ndims(space.get()) != static_cast<int>(shape.size()))
      return false;
    std::vector<hsize_t> extents(shape.size());
    H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
    if (extents != shape) return false;
    if (!is_standard_number({H5Dget_type(dataset.get()), H5Tclose})) return false;
  }
  return true;
}

}  // namespace

std::string place_of(const Hdf5Id& file, hid_t object, const std::string& attribute) {
  H5O_info_t own{};
  H5O_info_t root{};
  if (H5Oget_info2(object, &own, H5O_INFO_BASIC) < 0 ||
      H5Oget_info2(file.get(), &root, H5O_INFO_BASIC) < 0 || own.fileno != root.fileno)
    return {};
  return std::to_string(own.addr) + ":" + attribute;
}

OpenHdf5 open_for_reading(const std::string& path) {
  silence_hdf5();
  OpenHdf5 open{{}, std::make_shared<const Hdf5Trial>()};
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat info {};
  if (descriptor >= 0 && ::fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode)) {
    // By this name child and parent open the same file, even if another replaces it at the path.
    const std::string name = "/proc/self/fd/" + std::to_string(descriptor);
    open.trial = try_file(name, info);
    if (open.trial->is_passed) open.file = open_descriptor(name);
  }
  if (descriptor >= 0) ::close(descriptor);
  return open;
}

std::vector<bool> find_whole(const std::vector<ExpectedFile>& files) {
  std::vector<bool> whole;
  while (whole.size() < files.size()) {  // restarts after the file that ended the child
    std::size_t largest = 0;
    for (std::size_t i = whole.size(); i < files.size(); ++i)
      largest = std::max(largest, size_of(files[i].path));
    const Apart apart = run_apart(most_memory(largest), most_seconds(largest) + files.size() / 100,
                                  [&files, first = whole.size()](int output) {
                                    silence_hdf5();
                                    for (std::size_t i = first; i < files.size(); ++i)
                                      if (!write_all(output, is_whole(files[i]) ? "1" : "0"))
                                        return false;
                                    return true;
                                  });
    for (const char found : apart.bytes) whole.push_back(found == '1');
    if (!apart.is_done) whole.push_back(false);
    whole.resize(std::min(whole.size(), files.size()));
  }
  return whole;
}

}  // namespace samara::io
