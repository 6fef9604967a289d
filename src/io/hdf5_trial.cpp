#include "hdf5_trial.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "samara/base/error.hpp"

#include "hdf5_file.hpp"

namespace samara::io {
namespace {

/// Larger numeric data are not read whole in one piece by anyone.
constexpr std::size_t most_bytes = std::size_t{64} << 20;

/// Processor time of the child; a whole file of 10 MB takes some hundredths of it.
rlim_t most_seconds(off_t file_size) {
  return 1 + std::min<rlim_t>(static_cast<rlim_t>(file_size) / 10'000'000, 60);
}

/// Memory of the child beyond what the process has at the fork: metadata have no more bytes than
/// their file, whatever they say of their size.
rlim_t most_memory(off_t file_size) {
  return 3 * most_bytes + 8 * std::min<rlim_t>(static_cast<rlim_t>(file_size), 2 * most_bytes);
}

#if defined(__SANITIZE_ADDRESS__)
constexpr bool limits_memory = false;  // the sanitizer's own map is 16 TB
#else
constexpr bool limits_memory = true;
#endif

std::size_t bytes_of(const Hdf5Id& space, const Hdf5Id& type) {
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  const std::size_t width = H5Tget_size(type.get());
  if (count <= 0 || width == 0) return 0;
  if (static_cast<std::size_t>(count) > most_bytes / width) return most_bytes + 1;
  return static_cast<std::size_t>(count) * width;
}

/// What the child says: for each text its place, the number of entries and these, each with its
/// length before it; a number at the end that tells that all is there.
class Report {
 public:
  void add(const std::string& place, const std::vector<char*>& words) {
    add_word(place.data(), place.size());
    add_number(words.size());
    for (const char* word : words) add_word(word, word == nullptr ? 0 : std::strlen(word));
  }
  bool is_too_large() const { return bytes_.size() > most_bytes; }

  bool send(int file) {
    add_number(end_mark);
    for (std::size_t sent = 0; sent < bytes_.size();) {
      const ssize_t count = ::write(file, bytes_.data() + sent, bytes_.size() - sent);
      if (count <= 0) return false;
      sent += static_cast<std::size_t>(count);
    }
    return true;
  }

  /// False where it is not whole.
  static bool parse(std::string_view bytes, Hdf5Trial& trial) {
    for (;;) {
      std::uint64_t length = 0;
      std::uint64_t count = 0;
      if (!take_number(bytes, length)) return false;
      if (length == end_mark) return bytes.empty();
      std::string place;
      if (!take_word(bytes, length, place) || !take_number(bytes, count) || count > most_bytes)
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

/// Reads by `read` what has this type and space; of other classes than numbers and texts nothing,
/// for nobody reads them.
template <class Read>
bool read_all(const Hdf5Id& type, const Hdf5Id& space, const std::string& place, Report& report,
              const Read& read) {
  if (!type || !space) return false;
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind != H5T_INTEGER && kind != H5T_FLOAT && kind != H5T_STRING) return true;
  const bool is_variable = H5Tis_variable_str(type.get()) > 0;
  const std::size_t size = bytes_of(space, type);
  if (size > most_bytes) return !is_variable;
  if (!is_variable) {
    std::vector<std::byte> values(size);
    return size == 0 || read(values.data()) >= 0;
  }
  std::vector<char*> words(size / sizeof(char*), nullptr);
  if (size > 0 && read(words.data()) < 0) return false;
  report.add(place, words);
  return !report.is_too_large();
}

/// An object of the file and what is told of it.
struct Visit {
  std::string place;
  Report& report;
};

herr_t try_attribute(hid_t object, const char* name, const H5A_info_t*, void* target) {
  const Visit& visit = *static_cast<const Visit*>(target);
  const Hdf5Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute) return -1;
  const Hdf5Id type(H5Aget_type(attribute.get()), H5Tclose);
  const Hdf5Id space(H5Aget_space(attribute.get()), H5Sclose);
  const auto read = [&](void* values) { return H5Aread(attribute.get(), type.get(), values); };
  return read_all(type, space, visit.place + ":" + name, visit.report, read) ? 0 : -1;
}

/// Numbers that lie in one piece are bytes whatever they are, and those of other files have their
/// own trial: both are left.
bool is_plain(const Hdf5Id& dataset, const Hdf5Id& type) {
  const Hdf5Id creation(H5Dget_create_plist(dataset.get()), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  const H5T_class_t kind = H5Tget_class(type.get());
  return (layout == H5D_CONTIGUOUS || layout == H5D_VIRTUAL) &&
         (kind == H5T_INTEGER || kind == H5T_FLOAT);
}

bool try_dataset(const Hdf5Id& dataset, const Visit& visit) {
  const Hdf5Id type(H5Dget_type(dataset.get()), H5Tclose);
  const Hdf5Id space(H5Dget_space(dataset.get()), H5Sclose);
  if (type && space && is_plain(dataset, type)) return true;
  return read_all(type, space, visit.place, visit.report, [&](void* values) {
    return H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  });
}

bool try_object(const Hdf5Id& object, Visit visit) {
  hsize_t first = 0;
  if (H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_NATIVE, &first, try_attribute, &visit) < 0)
    return false;
  return H5Iget_type(object.get()) != H5I_DATASET || try_dataset(object, visit);
}

/// Whatever a name leads to, in this file or another; a soft link may lead nowhere.
herr_t try_link(hid_t file, const char* name, const H5L_info_t* link, void* report) {
  const Hdf5Id object(H5Oopen(file, name, H5P_DEFAULT), H5Oclose);
  if (!object) return link->type == H5L_TYPE_HARD ? -1 : 0;
  return try_object(object, {std::string("/") + name, *static_cast<Report*>(report)}) ? 0 : -1;
}

bool read_file(const std::string& path, Report& report) {
  silence_hdf5();
  const Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) return false;
  const Hdf5Id root(H5Oopen(file.get(), "/", H5P_DEFAULT), H5Oclose);
  return root && try_object(root, {"/", report}) &&
         H5Lvisit(file.get(), H5_INDEX_NAME, H5_ITER_NATIVE, try_link, &report) >= 0;
}

void limit(int resource, rlim_t value) {
  const rlimit both{value, value};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

rlim_t own_memory() {
  std::array<char, 64> text{};
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  const ssize_t length = file < 0 ? 0 : ::read(file, text.data(), text.size() - 1);
  if (file >= 0) ::close(file);
  return length > 0
             ? std::strtoul(text.data(), nullptr, 10) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE))
             : 0;
}

[[noreturn]] void run_child(const std::string& path, off_t size, int output,
                            const sigset_t& signals) {
  for (const int signal :
       {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU})
    ::signal(signal, SIG_DFL);
  ::sigprocmask(SIG_SETMASK, &signals, nullptr);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, most_seconds(size));
  if (const rlim_t own = own_memory(); limits_memory && own > 0)
    limit(RLIMIT_AS, own + most_memory(size));
  Report report;
  ::_exit(read_file(path, report) && report.send(output) ? 0 : 1);
}

/// What tells one state of a file from another.
struct Version {
  dev_t device = 0;
  ino_t node = 0;
  off_t size = -1;
  timespec changed{};

  explicit Version(const struct stat& info)
      : device(info.st_dev), node(info.st_ino), size(info.st_size), changed(info.st_ctim) {}
  bool operator==(const Version& other) const {
    return device == other.device && node == other.node && size == other.size &&
           changed.tv_sec == other.changed.tv_sec && changed.tv_nsec == other.changed.tv_nsec;
  }
};

/// All that comes from the child until it ends.
std::string receive(int file) {
  std::string bytes;
  std::array<char, 65536> piece{};
  for (;;) {
    const ssize_t count = ::read(file, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0 || bytes.size() > 2 * most_bytes) return bytes;
    bytes.append(piece.data(), static_cast<std::size_t>(count));
  }
}

Hdf5Trial run_trial(const std::string& path, off_t size) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw InternalError("no pipe can be made to try " + path);
  sigset_t all;
  sigset_t before;
  ::sigfillset(&all);
  ::sigprocmask(SIG_SETMASK, &all, &before);  // or a signal would run this process's handler twice
  const pid_t child = ::fork();
  if (child == 0) run_child(path, size, ends[1], before);
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  ::close(ends[1]);
  const std::string bytes = child < 0 ? "" : receive(ends[0]);
  ::close(ends[0]);
  if (child < 0) throw InternalError("no process can be started to try " + path);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  Hdf5Trial trial;
  trial.is_passed = WIFEXITED(status) && WEXITSTATUS(status) == 0 && Report::parse(bytes, trial);
  return trial;
}

}  // namespace

std::shared_ptr<const Hdf5Trial> try_hdf5_file(const std::string& path) {
  static Version version{{}};
  static auto trial = std::make_shared<const Hdf5Trial>();
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return std::make_shared<const Hdf5Trial>();
  if (Version(info) == version) return trial;
  trial = std::make_shared<const Hdf5Trial>(run_trial(path, info.st_size));
  version = Version(info);
  return trial;
}

}  // namespace samara::io
