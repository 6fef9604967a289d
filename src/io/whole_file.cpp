#include "samara/io/whole_file.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <limits>
#include <random>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "samara/base/error.hpp"

namespace samara::io {

namespace fs = std::filesystem;

namespace {

/// A short name of its own: the name of the file itself may already be as long as possible.
std::string temporary_name() {
  std::random_device random;
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), ".samara-%08x%08x.tmp", static_cast<unsigned>(random()),
                static_cast<unsigned>(random()));
  return name.data();
}
constexpr int most_attempts = 8;

/// Permissions of a new file, before the mask of the process removes some.
constexpr mode_t readable_by_all = 0666;

/// Waits until the written data are on the disk. File systems without support are accepted.
bool synchronize(int file) { return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP; }

/// The same for the names in a folder. Without it a crash of the machine may undo a new name; older
/// files are not lost.
void synchronize_folder(const fs::path& folder) {
  const int opened = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return;
  ::fsync(opened);
  ::close(opened);
}

}  // namespace

fs::path folder_of(const fs::path& path) {
  const fs::path parent = path.parent_path();
  return parent.empty() ? fs::path(".") : parent;
}

std::size_t longest_name_in(const fs::path& folder) {
  const long longest = ::pathconf(folder.c_str(), _PC_NAME_MAX);
  return longest > 0 ? static_cast<std::size_t>(longest) : std::numeric_limits<std::size_t>::max();
}

std::string resolved_path(const std::string& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  const fs::path target = fs::canonical(path, error);
  return error ? path : target.string();
}

WholeFile::WholeFile(const std::string& path) : path_(path), target_(resolved_path(path)) {
  const fs::path folder = folder_of(target_);
  // Without a name, so that no file is left behind, however the process ends.
  if (::access("/proc/self/fd", X_OK) == 0)  // needed to name the file later
    file_ = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, readable_by_all);
  for (int attempt = 0; file_ < 0; ++attempt) {
    temporary_ = folder / temporary_name();
    file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, readable_by_all);
    if (file_ >= 0 || (errno == EEXIST && attempt < most_attempts)) continue;
    const std::error_code error(errno, std::generic_category());
    temporary_.clear();
    fail(error);
  }
}

WholeFile::~WholeFile() {
  if (file_ >= 0) ::close(file_);
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void WholeFile::write(std::span<const char> piece) {
  while (!piece.empty()) {
    const ssize_t written = ::write(file_, piece.data(), piece.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(std::error_code(errno, std::generic_category()));
    piece = piece.subspan(static_cast<std::size_t>(written));
  }
}

void WholeFile::publish() {
  const auto require = [this](bool done) {
    if (!done) fail(std::error_code(errno, std::generic_category()));
  };
  require(synchronize(file_));
  if (temporary_.empty()) {
    const std::string unnamed = "/proc/self/fd/" + std::to_string(file_);
    for (int attempt = 0; temporary_.empty(); ++attempt) {
      const fs::path name = folder_of(target_) / temporary_name();
      if (::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0)
        temporary_ = name;
      else
        require(errno == EEXIST && attempt < most_attempts);
    }
  }
  const int closing = std::exchange(file_, -1);
  require(::close(closing) == 0 || errno == EINTR);
  require(::rename(temporary_.c_str(), target_.c_str()) == 0);
  temporary_.clear();
  synchronize_folder(folder_of(target_));
}

void WholeFile::fail(const std::error_code& error) const {
  throw InternalError(path_ + ": cannot be written: " + error.message());
}

void write_whole_file(const std::string& path, std::span<const char> content) {
  WholeFile file(path);
  file.write(content);
  file.publish();
}

bool require_writable(const std::string& path) {
  std::error_code error;
  const fs::path folder = folder_of(path);
  const fs::file_status above = fs::status(folder, error);
  if (above.type() == fs::file_type::not_found)
    throw InputError(path + ": there is no folder " + folder.string() + "; hint: make it first");
  if (!fs::is_directory(above))
    throw InputError(path + ": " + folder.string() + " is not a folder; hint: -o names a file");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(path + ": no permission to write in " + folder.string() +
                     "; hint: -o names another place");
  const std::size_t longest = longest_name_in(folder);
  const std::size_t length = fs::path(path).filename().string().size();
  if (length > longest)
    throw InputError(path + ": the name has " + std::to_string(length) + " bytes, but " +
                     folder.string() + " allows only " + std::to_string(longest) +
                     "; hint: give a shorter name");
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status))
    throw InputError(path + ": is a folder; hint: give the name of a file in it");
  if (!fs::exists(status)) return false;
  if (!fs::is_regular_file(status)) throw InputError(path + ": not a plain file");
  if (::access(path.c_str(), W_OK) != 0)
    throw InputError(path + ": write-protected; hint: give another name");
  return true;
}

void require_readable(const std::string& path, const std::string& kind) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw InputError(path + ": no such file");
  if (fs::is_directory(status)) throw InputError(path + ": a directory, expected a " + kind);
  if (error || ::access(path.c_str(), R_OK) != 0)
    throw InputError(path + ": cannot be opened for reading: " +
                     (error ? error : std::error_code(errno, std::generic_category())).message());
  if (!fs::is_regular_file(status))
    throw InputError(path + ": not a plain file, expected a " + kind);
}

std::string read_whole_file(const std::string& path, std::size_t megabytes,
                            const std::string& kind) {
  require_readable(path, kind);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened for reading");
  std::string text;
  std::array<char, 65536> buffer;
  while (stream.read(buffer.data(), buffer.size()) || stream.gcount() > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.size() > megabytes << 20)
      throw InputError(path + ": more than " + std::to_string(megabytes) + " MB, too large for a " +
                       kind);
  }
  if (stream.bad()) throw InputError(path + ": cannot be read");
  return text;
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const auto place = [&error](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  return place(a) == place(b);
}

}  // namespace samara::io
