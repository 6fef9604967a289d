#include "samara/io/whole_file.hpp"

#include <array>
#include <cerrno>

#include <unistd.h>

#include "samara/base/error.hpp"

namespace samara::io {

namespace fs = std::filesystem;

namespace {

/// The folder that will hold `path`; "." for a bare name.
fs::path folder_of(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  return parent.empty() ? fs::path(".") : parent;
}

}  // namespace

WholeFile::WholeFile(const std::string& path) : path_(path) {
  const fs::path target(path);
  const std::string name = "." + target.filename().string() + "." + std::to_string(::getpid());
  temporary_ = target.parent_path() / (name + ".tmp");
  errno = 0;
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_) fail(std::error_code(errno, std::generic_category()));
}

WholeFile::~WholeFile() {
  stream_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void WholeFile::write(std::span<const char> piece) {
  errno = 0;
  stream_.write(piece.data(), static_cast<std::streamsize>(piece.size()));
  if (!stream_) fail(std::error_code(errno, std::generic_category()));
}

void WholeFile::publish() {
  errno = 0;
  stream_.close();
  if (!stream_) fail(std::error_code(errno, std::generic_category()));
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) fail(error);
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
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status))
    throw InputError(path + ": a folder; hint: give the name of a file in it");
  if (!fs::exists(status)) return false;
  if (!fs::is_regular_file(status)) throw InputError(path + ": not a plain file");
  if (::access(path.c_str(), W_OK) != 0)
    throw InputError(path + ": write-protected; hint: give another name");
  return true;
}

std::string read_whole_file(const std::string& path, std::size_t megabytes,
                            const std::string& kind) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw InputError(path + ": no such file");
  if (fs::is_directory(status)) throw InputError(path + ": a directory, expected a " + kind);
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
