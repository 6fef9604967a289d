// Files that are there as a whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>

namespace samara::io {

/// True where both paths lead to the same file, or will once there is one.
bool is_same_file(const std::string& a, const std::string& b);

/// Where a file goes that is written at `path`: the target of a symbolic link, which stays.
std::string resolved_path(const std::string& path);

/// The folder that holds `path`; "." for a bare name.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// Bytes that a name in a folder may have.
std::size_t longest_name_in(const std::filesystem::path& folder);

/// A file that is written piece by piece: one without a name in the folder of `path` (a temporary
/// file where the file system has none), which takes that name in the end, when all of it is on the
/// disk (fsync). Where anything fails it is removed, and what was at `path` stays.
class WholeFile {
 public:
  /// @throws InternalError as all members do
  explicit WholeFile(const std::string& path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(std::span<const char> piece);
  /// Gives the file its name. Call it last.
  void publish();

 private:
  void fail(const std::error_code& error) const;

  std::string path_;
  std::string target_;
  std::filesystem::path temporary_;  ///< its name meanwhile, or empty
  int file_ = -1;
};

/// The same at once.
/// @throws InternalError
void write_whole_file(const std::string& path, std::span<const char> content);

/// The bytes of a file of at most `megabytes`; `kind` ("case file") names it in messages.
/// @throws InputError where there is no such file or it cannot be read
std::string read_whole_file(const std::string& path, std::size_t megabytes,
                            const std::string& kind);

/// @throws InputError where there is no plain file, or no permission to read it; a pipe would hang
void require_readable(const std::string& path, const std::string& kind);

/// False: nothing is at `path` yet.
/// @throws InputError where no file can be written there, whatever it holds
bool require_writable(const std::string& path);

}  // namespace samara::io
