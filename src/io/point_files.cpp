#include "samara/io/point_files.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"

#include "hdf5_file.hpp"
#include "hdf5_reader.hpp"

namespace samara::io {
namespace {

namespace fs = std::filesystem;

constexpr char origin_name[] = "/point/origin";

}  // namespace

PointFiles::PointFiles(const std::string& result_path, std::vector<std::string> origins)
    : folder_(resolved_path(result_path) + ".points"), origins_(std::move(origins)) {}

std::string PointFiles::path_of(std::size_t point) const {
  // FNV-1a, 64 bits: the same name for the same origin in every run.
  std::uint64_t hash = 14695981039346656037U;
  for (const char letter : origins_[point]) {
    hash ^= static_cast<unsigned char>(letter);
    hash *= 1099511628211U;
  }
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "/%016llx.h5", static_cast<unsigned long long>(hash));
  return folder_ + name.data();
}

std::unique_ptr<Hdf5Reader> PointFiles::open(std::size_t point) const {
  const std::string path = path_of(point);
  std::error_code error;
  if (!fs::exists(path, error) && !error) return nullptr;
  auto file = std::make_unique<Hdf5Reader>(path);
  if (!file->has(origin_name))
    throw InputError(path +
                     ": is not a point of a sweep; hint: another name for the result, or remove "
                     "the file");
  if (file->text(origin_name) != origins_[point]) return nullptr;
  return file;
}

bool PointFiles::has(std::size_t point) const { return open(point) != nullptr; }

void PointFiles::save(std::size_t point, Hdf5File& file) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  file.write(origin_name, origins_[point], {"1", "none", "internal", {}});
  write_whole_file(path_of(point), file.image());
}

void PointFiles::refuse(std::size_t point) const {
  throw InputError(path_of(point) + ": is damaged; hint: remove the file");
}

void PointFiles::remove() const {
  std::error_code error;
  std::vector<fs::path> points;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error))
    if (entry.path().extension() == ".h5") points.push_back(entry.path());
  for (const fs::path& path : points) {
    try {
      if (Hdf5Reader(path.string()).has(origin_name)) fs::remove(path, error);
    } catch (const InputError&) {  // not a file of this program
    }
  }
  fs::remove(folder_, error);  // only if it is empty
}

}  // namespace samara::io
