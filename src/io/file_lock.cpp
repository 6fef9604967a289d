#include "samara/io/file_lock.hpp"

#include <array>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::io {
namespace {

namespace fs = std::filesystem;

/// Name of the lock file; a short one if the usual name would be too long.
std::string lock_name(const fs::path& target) {
  const std::string name = target.filename().string();
  const std::string plain = "." + name + ".lock";
  if (plain.size() <= longest_name_in(folder_of(target))) return plain;
  std::ostringstream text;
  text << ".samara-" << std::hex << std::hash<std::string>{}(name) << ".lock";
  return text.str();
}

std::string this_process() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return "process " + std::to_string(::getpid()) + " on " + host.data();
}

/// Text that the holder wrote, in one short line.
std::string holder_of(int file) {
  std::array<char, 300> text{};
  const ssize_t count = ::pread(file, text.data(), text.size() - 1, 0);
  if (count <= 0) return "another process";
  const std::string words(text.data(), static_cast<std::size_t>(count));
  return words.substr(0, words.find('\n'));
}

bool is_at(int file, const std::string& path) {
  struct stat held {};
  struct stat there {};
  return ::fstat(file, &held) == 0 && ::stat(path.c_str(), &there) == 0 &&
         held.st_ino == there.st_ino && held.st_dev == there.st_dev;
}

}  // namespace

FileLock::FileLock(const std::string& path) {
  const fs::path target(resolved_path(path));
  lock_path_ = (target.parent_path() / lock_name(target)).string();
  for (;;) {
    file_ = ::open(lock_path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0)
      throw InputError(lock_path_ +
                       ": cannot be created: " + std::generic_category().message(errno) +
                       "; hint: it is the lock file of " + path);
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      if (error == EINTR) {
        ::close(file_);
        continue;
      }
      const std::string holder = error == EWOULDBLOCK ? holder_of(file_) : "";
      ::close(file_);
      file_ = -1;
      if (error != EWOULDBLOCK) return;  // a file system without locks
      throw InputError(path + ": is being written by " + holder +
                       "; hint: -o gives this run's result another name");
    }
    if (is_at(file_, lock_path_)) break;
    ::close(file_);  // its last holder has just removed it
  }
  const std::string words = this_process() + "\n";
  if (::ftruncate(file_, 0) == 0) {
    // Only for the message of other processes.
    [[maybe_unused]] const ssize_t written = ::pwrite(file_, words.data(), words.size(), 0);
  }
}

FileLock::~FileLock() {
  if (file_ < 0) return;
  ::unlink(lock_path_.c_str());  // while no other process can hold it
  ::close(file_);
}

}  // namespace samara::io
