#include "samara/io/controller_library.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"

#include "bladed_records.hpp"
#include "controller_process.hpp"

namespace samara::io {
namespace {

namespace fs = std::filesystem;

using simulation::ControlDemand;
using simulation::ControlMeasurement;

/// Longest text of a library in a message.
constexpr std::size_t most_letters = 400;
/// Longest argument MESSAGE. Libraries make texts of this length from record 49.
constexpr std::size_t message_room = 1025;
constexpr const char* helper_name = "samara-controller-host";

std::string helper_path(const ControllerFiles& files) {
  if (!files.helper.empty()) return files.helper;
  std::error_code error;
  const fs::path own = fs::read_symlink("/proc/self/exe", error);
  const std::string path = (own.parent_path() / helper_name).string();
  if (error || ::access(path.c_str(), X_OK) != 0)
    throw InternalError("transient.controller: the helper program " + path +
                        " is missing; hint: it is installed beside samara");
  return path;
}

/// A file that the user names, absolute.
std::string find_file(const std::string& key, const std::string& name, const fs::path& folder) {
  std::error_code error;
  const fs::path path = fs::absolute(folder / name, error);
  const std::string place = "transient.controller." + key + ": " + path.string();
  if (!fs::exists(path, error))
    throw InputError(place +
                     ": no such file; hint: a relative path counts from the folder of the case");
  if (fs::is_directory(path, error)) throw InputError(place + ": is a folder");
  if (::access(path.c_str(), R_OK) != 0) throw InputError(place + ": cannot be read");
  if (path.string().size() >= controller_text) throw InputError(place + ": the name is too long");
  return path.string();
}

template <std::size_t size>
void put(const std::string& text, char (&target)[size]) {
  const std::size_t length = std::min(text.size(), size - 1);
  std::memcpy(target, text.data(), length);
  std::memset(target + length, 0, size - length);
}

/// A text of the helper in one line.
template <std::size_t size>
std::string line_of(const char (&text)[size]) {
  std::string line;
  for (const char letter : std::string_view(text, ::strnlen(text, size))) {
    const bool is_blank = static_cast<unsigned char>(letter) <= ' ' || letter == '\x7f';
    if (!is_blank)
      line += letter;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  if (line.size() > most_letters) line = line.substr(0, most_letters) + " ...";
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

}  // namespace

class ControllerLibrary::Storage {
 public:
  Storage(const simulation::ControllerSetup& setup, const ControllerFiles& files)
      : timeout_(setup.timeout), records_(setup.is_individual), output_(files.output) {
    const std::string path = find_file("library", setup.library, files.folder);
    if (!setup.input.empty()) input_ = find_file("input", setup.input, files.folder);
    name_ = fs::path(path).filename().string();
    ControllerMemory& memory = process_.memory();
    put(path, memory.library);
    put(setup.procedure, memory.procedure);
    process_.start(helper_path(files));
    const std::string ending = process_.wait(timeout_);
    const std::string key = "transient.controller.library: " + path + ": ";
    if (!ending.empty()) throw InputError(key + ending + " while it was loaded");
    if (memory.fault[0] != '\0') throw InputError(key + line_of(memory.fault));
  }

  ControlDemand call(const ControlMeasurement& measured) {
    ControllerMemory& memory = process_.memory();
    memory.fail = 0;
    put(input_, memory.input);
    put(output_, memory.output);
    std::memset(memory.message, 0, sizeof memory.message);
    records_.write(measured,
                   {input_.size(), std::min(output_.size(), controller_text - 1), message_room},
                   memory.records);
    const std::string place = "transient.controller: " + name_ + " ";
    const std::string instant = " at t = " + general(measured.time, 8) + " s";
    process_.ask();
    if (const std::string ending = process_.wait(timeout_); !ending.empty())
      throw ConvergenceError(place + ending + " in its call" + instant);
    const std::string message = line_of(memory.message);
    if (memory.fail < 0)
      throw ConvergenceError(place + "reports a failure" + instant +
                             (message.empty() ? "" : ": " + message));
    try {
      ControlDemand demand = records_.read(memory.records, measured.pitch.size());
      for (std::string& note : demand.notes) note = place + note;
      if (memory.fail > 0 && message != last_message_)
        demand.notes.push_back(place + "warns" + instant + ": " + message);
      if (memory.fail > 0) last_message_ = message;
      return demand;
    } catch (const ConvergenceError& error) {
      throw ConvergenceError(place + error.what() + instant);
    }
  }

 private:
  double timeout_;
  BladedRecords records_;
  std::string name_;
  std::string input_;
  std::string output_;
  std::string last_message_;
  ControllerProcess process_;
};

ControllerLibrary::ControllerLibrary(const simulation::ControllerSetup& setup,
                                     const ControllerFiles& files)
    : storage_(std::make_unique<Storage>(setup, files)) {}

ControllerLibrary::~ControllerLibrary() = default;

ControlDemand ControllerLibrary::call(const ControlMeasurement& measured) {
  return storage_->call(measured);
}

}  // namespace samara::io
