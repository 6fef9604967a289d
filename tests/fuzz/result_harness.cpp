// HDF5 results: what restart, loads, export and start from a result read of them.
//
// Seeds are trim.h5, time_series.h5, and segments.h5 with its folder of parts.
//
// Changes are of bytes, and of items: a dataset or attribute of a seed gets another type, shape,
// content or goes, as another program or an attacker may leave it.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <vector>

#include <hdf5.h>

#include "samara/base/error.hpp"
#include "samara/io/result_file.hpp"
#include "samara/io/result_reader.hpp"
#include "samara/io/time_series_file.hpp"
#include "samara/io/whole_file.hpp"

#include "harness.hpp"

namespace {

namespace fs = std::filesystem;
namespace io = samara::io;

constexpr char corpus[] = SAMARA_SOURCE_DIR "/tests/fuzz/corpus/result";
constexpr std::size_t most_rows = 100000;

template <class Work>
void attempt(const Work& work) {
  try {
    work();
  } catch (const samara::InputError&) {
  } catch (const samara::DomainError&) {
  }
}

void read_series(const std::string& path) {
  const io::TimeSeriesReader series(path);
  const std::size_t rows = std::min(series.rows(), most_rows);
  series.read_time(0, rows);
  series.read_values(0, rows);
}

// ---- changes of items
// ----------------------------------------------------------------------------

using Random = std::mt19937;

std::size_t below(Random& random, std::size_t end) {
  return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

std::vector<std::uint8_t> read_bytes(const fs::path& path) {
  const std::string text = io::read_whole_file(path.string(), 100, "seed");
  return {text.begin(), text.end()};
}

const std::vector<std::vector<std::uint8_t>>& seeds() {
  static const std::vector<std::vector<std::uint8_t>> all = [] {
    std::vector<fs::path> paths;
    for (const fs::directory_entry& entry : fs::directory_iterator(corpus))
      if (entry.is_regular_file()) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::vector<std::uint8_t>> files;
    for (const fs::path& path : paths) files.push_back(read_bytes(path));
    return files;
  }();
  return all;
}

std::vector<std::string> dataset_names(hid_t file) {
  std::vector<std::string> names;
  const auto take = [](hid_t, const char* name, const H5O_info_t* info, void* target) -> herr_t {
    if (info->type == H5O_TYPE_DATASET)
      static_cast<std::vector<std::string>*>(target)->emplace_back(name);
    return 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, take, &names, H5O_INFO_BASIC);
  return names;
}

hid_t some_type(Random& random) {
  const hid_t types[] = {H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_STD_I8LE,   H5T_STD_U64BE,
                         H5T_STD_I32LE,  H5T_C_S1,       H5T_STD_REF_OBJ};
  const std::size_t which = below(random, std::size(types) + 3);
  if (which < std::size(types)) return H5Tcopy(types[which]);
  if (which == std::size(types)) return H5Tvlen_create(H5T_NATIVE_DOUBLE);
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, which == std::size(types) + 1 ? H5T_VARIABLE : 1 + below(random, 300));
  if (below(random, 2) == 0) H5Tset_cset(text, H5T_CSET_UTF8);
  return text;
}

hid_t some_space(Random& random) {
  const std::size_t which = below(random, 8);
  if (which == 0) return H5Screate(H5S_SCALAR);
  if (which == 1) return H5Screate(H5S_NULL);
  hsize_t sizes[4];
  const int rank = 1 + static_cast<int>(below(random, 3));
  for (int i = 0; i < rank; ++i)
    sizes[i] = which == 2 ? hsize_t{1} << below(random, 40) : below(random, 9);
  return H5Screate_simple(rank, sizes, nullptr);
}

/// Fills what is there of small numeric datasets with other numbers.
void change_values(Random& random, hid_t file, const std::string& name) {
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  const auto count =
      static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space)));
  if (count > 0 && count < 100000) {
    std::vector<double> values(count);
    H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    const double odd[] = {0.0, -1.0, 1e308, -1e-308, 1e18, 4294967296.0, std::nan(""), 0.5};
    for (std::size_t i = 0; i < 1 + count / 10; ++i)
      values[below(random, count)] = odd[below(random, std::size(odd))];
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  H5Sclose(space);
  H5Dclose(dataset);
}

void change_attribute(Random& random, hid_t file, const std::string& name) {
  const std::size_t slash = name.rfind('/');
  const std::string owner =
      below(random, 2) == 0 || slash == std::string::npos ? name : name.substr(0, slash);
  const hid_t object = H5Oopen(file, below(random, 8) == 0 ? "/" : owner.c_str(), H5P_DEFAULT);
  H5O_info_t info;
  H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS);
  if (info.num_attrs > 0) {
    char word[256] = "";
    H5Aget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, below(random, info.num_attrs), word,
                       sizeof word, H5P_DEFAULT);
    H5Adelete(object, word);
    if (below(random, 4) != 0) {
      const hid_t type = some_type(random);
      const hid_t space = some_space(random);
      const hid_t attribute = H5Acreate2(object, word, type, space, H5P_DEFAULT, H5P_DEFAULT);
      if (attribute >= 0) H5Aclose(attribute);
      H5Sclose(space);
      H5Tclose(type);
    }
  }
  H5Oclose(object);
}

void change_item(Random& random, hid_t file) {
  const std::vector<std::string> names = dataset_names(file);
  if (names.empty()) return;
  const std::string& name = names[below(random, names.size())];
  switch (below(random, 6)) {
    case 0:
      H5Ldelete(file, name.c_str(), H5P_DEFAULT);
      return;
    case 1:
      H5Ldelete(file, name.c_str(), H5P_DEFAULT);
      H5Lcreate_soft(("/" + names[below(random, names.size())]).c_str(), file, name.c_str(),
                     H5P_DEFAULT, H5P_DEFAULT);
      return;
    case 2:
      change_values(random, file, name);
      return;
    case 3:
      change_attribute(random, file, name);
      return;
    default: {
      H5Ldelete(file, name.c_str(), H5P_DEFAULT);
      const hid_t type = some_type(random);
      const hid_t space = some_space(random);
      const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
      const hid_t dataset =
          H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
      if (dataset >= 0) H5Dclose(dataset);
      H5Pclose(creation);
      H5Sclose(space);
      H5Tclose(type);
    }
  }
}

std::size_t changed_seed(std::uint8_t* data, std::size_t most, Random& random) {
  std::vector<std::uint8_t> bytes = seeds()[below(random, seeds().size())];
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, 65536, 0);
  H5Pset_file_image(access, bytes.data(), bytes.size());
  const hid_t file = H5Fopen("/dev/null/seed", H5F_ACC_RDWR, access);
  H5Pclose(access);
  if (file < 0) return 0;
  for (std::size_t i = 1 + below(random, 3); i > 0; --i) change_item(random, file);
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  std::size_t taken = 0;
  if (size > 0 && static_cast<std::size_t>(size) <= most) {
    H5Fget_file_image(file, data, most);
    taken = static_cast<std::size_t>(size);
  }
  H5Fclose(file);
  return taken;
}

}  // namespace

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned seed) {
  Random random(seed);
  if (below(random, 2) == 0)
    if (const std::size_t changed = changed_seed(data, most, random); changed > 0) return changed;
  return LLVMFuzzerMutate(data, size, most);
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const samara::fuzz::Folder folder;
  static const bool has_parts = [] {
    fs::copy(fs::path(corpus) / "segments.h5.parts", folder / "segments.h5.parts",
             fs::copy_options::recursive);
    return true;
  }();
  if (!has_parts) return 0;
  folder.write("run.h5", samara::fuzz::text_of(data, size));
  const std::string path = folder / "run.h5";
  attempt([&] { io::find_result_kind(path); });
  attempt([&] { io::read_result_case(path); });
  attempt([&] { io::read_result_trim(path); });
  attempt([&] { read_series(path); });
  attempt([&] { io::require_result_path(path); });
  return 0;
}
