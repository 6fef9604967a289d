// Files that are written completely or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>

namespace samara::io {

/// True if both paths lead to the same file, or will do so once it exists.
bool is_same_file(const std::string& a, const std::string& b);

/// The path at which a file for `path` is written: the target of a symbolic link; the link stays.
std::string resolved_path(const std::string& path);

/// The folder that holds `path`; "." for a bare name.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// Largest number of bytes in a name in the folder.
std::size_t longest_name_in(const std::filesystem::path& folder);

/// A file that is written piece by piece, at first without a name in the folder of `path` (as a
/// temporary file if the file system has no files without names). It takes the name `path` at the
/// end, when all of it is on the disk (fsync). If anything fails, it is removed, and a previous
/// file at `path` stays.
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
  std::filesystem::path temporary_;  ///< its temporary name, or empty
  int file_ = -1;
};

/// Writes a whole file at once.
/// @throws InternalError
void write_whole_file(const std::string& path, std::span<const char> content);

/// The bytes of a file of at most `megabytes`; `kind` ("case file") names it in messages.
/// @throws InputError if there is no such file or it cannot be read
std::string read_whole_file(const std::string& path, std::size_t megabytes,
                            const std::string& kind);

/// @throws InputError if there is no plain file, or no permission to read it. (A pipe would block.)
void require_readable(const std::string& path, const std::string& kind);

/// Returns false if nothing is at `path` yet. The content of an existing file is not checked.
/// @throws InputError if no file can be written there
bool require_writable(const std::string& path);

}  // namespace samara::io
