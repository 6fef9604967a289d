// Keeps two runs from writing one result at the same time.
#pragma once

#include <string>

namespace samara::io {

/// Holds the result at `path` for this process, from the constructor to the destructor, by a lock
/// (flock) on a file .NAME.lock beside it. The operating system gives the lock up when the process
/// ends in any way: a lock file that is left over locks nothing and is used again. On a network
/// folder the lock holds as far as the file system carries it; where it has none, `is_held` is
/// false and nothing is locked.
class FileLock {
 public:
  /// @throws InputError where another process holds it, or its file cannot be made
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool is_held() const { return file_ >= 0; }
  /// Path of the lock file; empty where no lock is held.
  std::string path() const { return is_held() ? lock_path_ : ""; }

 private:
  std::string lock_path_;
  int file_ = -1;
};

}  // namespace samara::io
