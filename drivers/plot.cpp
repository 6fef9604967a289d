// samara plot: pictures of a result, by the Python package samara.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "samara/base/error.hpp"

#include "commands.hpp"

namespace samara::drivers {
namespace {

namespace fs = std::filesystem;

constexpr char interpreter[] = "/usr/bin/python3";

/// The folder of the package: beside the folder of the program, in a checkout or installed.
fs::path find_package() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
  for (const char* place : {"python", "share/samara/python"})
    if (fs::exists(folder / place / "samara" / "plot.py", error)) return folder / place;
  return {};
}

}  // namespace

void run_plot(const std::vector<std::string>& arguments) {
  if (const fs::path package = find_package(); !package.empty()) {
    const char* before = std::getenv("PYTHONPATH");
    const std::string path =
        package.string() + (before != nullptr ? std::string(":") + before : "");
    ::setenv("PYTHONPATH", path.c_str(), 1);
  }
  const char* named = std::getenv("SAMARA_PYTHON");
  std::vector<std::string> words{named != nullptr ? named : interpreter, "-m", "samara", "plot"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execvp(pointers.front(), pointers.data());
  throw InputError(words.front() +
                   " cannot be started; hint: apt install python3, or SAMARA_PYTHON "
                   "names another interpreter");
}

}  // namespace samara::drivers
