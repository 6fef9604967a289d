// samara plot: pictures of a result, by the Python package samara.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include "samara/base/error.hpp"

#include "commands.hpp"
#include "installation.hpp"

namespace samara::drivers {
namespace {

constexpr char interpreter[] = "/usr/bin/python3";

}  // namespace

void run_plot(const std::vector<std::string>& arguments) {
  if (const std::filesystem::path package = find_installed("python"); !package.empty()) {
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
