#include "new_file.hpp"

#include <filesystem>
#include <system_error>

#include <unistd.h>

#include "samara/base/error.hpp"

namespace samara::io {

namespace fs = std::filesystem;

NewFile::NewFile(const std::string& path) : path_(path) {
  const fs::path target(path);
  const std::string name = "." + target.filename().string() + "." + std::to_string(::getpid());
  temporary_ = (target.parent_path() / (name + ".tmp")).string();
}

NewFile::~NewFile() {
  if (published_) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void NewFile::publish() {
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) throw InternalError(path_ + ": cannot be written: " + error.message());
  published_ = true;
}

}  // namespace samara::io
