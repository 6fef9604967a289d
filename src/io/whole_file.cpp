#include "whole_file.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <unistd.h>

#include "samara/base/error.hpp"

namespace samara::io {

namespace fs = std::filesystem;

void write_whole_file(const std::string& path, std::span<const char> content) {
  const fs::path target(path);
  const std::string name = "." + target.filename().string() + "." + std::to_string(::getpid());
  const fs::path temporary = target.parent_path() / (name + ".tmp");
  errno = 0;
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  std::error_code error;
  if (stream)
    fs::rename(temporary, target, error);
  else
    error = std::error_code(errno, std::generic_category());
  if (stream && !error) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  throw InternalError(path + ": cannot be written: " + error.message());
}

}  // namespace samara::io
