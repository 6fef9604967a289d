// Prevents two runs from writing the same result at the same time.
#pragma once

#include <string>

namespace samara::io {

/// Locks the result at `path` for this process, from the constructor to the destructor: a lock
/// (flock) on a file .NAME.lock beside it. The operating system releases the lock when the process
/// ends, however it ends. A lock file that is left over locks nothing and is used again. On a
/// network folder the lock reaches as far as the file system supports it. If the file system has no
/// locks, `is_held` is false and nothing is locked.
class FileLock {
 public:
  /// @throws InputError if another process holds the lock, or its file cannot be created
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool is_held() const { return file_ >= 0; }
  /// Path of the lock file; empty if no lock is held.
  std::string path() const { return is_held() ? lock_path_ : ""; }

 private:
  std::string lock_path_;
  int file_ = -1;
};

}  // namespace samara::io
