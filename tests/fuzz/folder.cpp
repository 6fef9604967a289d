#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "harness.hpp"

namespace samara::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mark = "==== ";

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

std::string write_deck(const Folder& folder, std::string_view text) {
  std::string first;
  while (text.starts_with(mark)) {
    const std::size_t line = std::min(text.find('\n'), text.size());
    const std::string name(text.substr(mark.size(), line - mark.size()));
    text.remove_prefix(std::min(line + 1, text.size()));
    const std::size_t next = text.starts_with(mark) ? 0 : text.find("\n" + std::string(mark));
    const std::size_t end = next == 0 ? 0 : next == std::string_view::npos ? text.size() : next + 1;
    if (name.size() < 100 && name.find('\0') == std::string::npos) {
      folder.write(name, text.substr(0, end));
      if (first.empty()) first = name;
    }
    text.remove_prefix(end);
  }
  return first;
}

}  // namespace samara::fuzz
