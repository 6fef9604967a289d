#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "harness.hpp"

namespace samara::fuzz {
namespace {

namespace fs = std::filesystem;

}  // namespace

Folder::Folder() {
  path_ = (fs::temp_directory_path() / ("samara_fuzz_" + std::to_string(::getpid()))).string();
  clear();
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void Folder::clear() const {
  fs::remove_all(path_);
  fs::create_directories(path_);
}

void Folder::write(const std::string& name, std::string_view content) const {
  const fs::path place = (fs::path(path_) / name).lexically_normal();
  if (!place.string().starts_with(path_ + "/") || !place.has_filename()) return;
  std::error_code error;
  fs::create_directories(place.parent_path(), error);
  std::ofstream(place, std::ios::binary)
      .write(content.data(), static_cast<std::streamsize>(content.size()));
}

}  // namespace samara::fuzz
