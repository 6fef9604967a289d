// samara plot, report, and export to ParaView, by the Python package samara.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include "samara/base/error.hpp"

#include "commands.hpp"
#include "installation.hpp"
#include "interruption.hpp"

namespace samara::drivers {
namespace {

constexpr char interpreter[] = "/usr/bin/python3";
/// As "-m samara", but a signal ends with its code also while the interpreter starts, when it is
/// held back, and while modules are loaded: a module in C may turn it into an error of its own.
constexpr char start[] =
    "import sys\n"
    "asked = []\n"
    "def stop(number, _):\n"
    "    asked.append(number)\n"
    "    raise KeyboardInterrupt\n"
    "def unless_asked(show):\n"  // where it ends a callback, the interpreter shows and forgets it
    "    return lambda *error: None if asked else show(*error)\n"
    "sys.excepthook = unless_asked(sys.excepthook)\n"
    "sys.unraisablehook = unless_asked(sys.unraisablehook)\n"
    "try:\n"
    "    import signal\n"
    "    held = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)\n"
    "    for number in held:\n"
    "        if signal.getsignal(number) != signal.SIG_IGN:\n"
    "            signal.signal(number, stop)\n"
    "    signal.pthread_sigmask(signal.SIG_UNBLOCK, held)\n"
    "    import runpy\n"
    "    runpy.run_module('samara', run_name='__main__', alter_sys=True)\n"
    "except BaseException as error:\n"
    "    if isinstance(error, ModuleNotFoundError) and not asked:\n"
    "        sys.stderr.write(f'samara: the Python module {error.name} is not installed; '\n"
    "                         f'hint: apt install python3-{error.name}\\n')\n"
    "        sys.exit(2)\n"
    "    is_said = isinstance(error, SystemExit) and error.code == 130\n"
    "    if not (is_said or asked or isinstance(error, KeyboardInterrupt)):\n"
    "        raise\n"
    "    if not is_said:\n"
    "        sys.stderr.write('samara: interrupted\\n')\n"
    "    sys.exit(128 + (asked[0] if asked else signal.SIGINT))\n"
    "finally:\n"  // the work is done, and the interpreter has no handlers while it ends
    "    signal.pthread_sigmask(signal.SIG_BLOCK, held)\n";

/// Replaces the process by the Python package's command line.
void run_python(const std::string& command, const std::vector<std::string>& arguments) {
  if (const std::filesystem::path package = find_installed("python"); !package.empty()) {
    const char* before = std::getenv("PYTHONPATH");
    const std::string path =
        package.string() + (before != nullptr ? std::string(":") + before : "");
    ::setenv("PYTHONPATH", path.c_str(), 1);
  }
  const char* named = std::getenv("SAMARA_PYTHON");
  std::vector<std::string> words{named != nullptr ? named : interpreter, "-c", start, command};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  Interruption::hold();
  ::execvp(pointers.front(), pointers.data());
  Interruption::release();
  throw InputError(words.front() +
                   " cannot be started; hint: apt install python3, or SAMARA_PYTHON "
                   "names another interpreter");
}

constexpr char vtk_ending[] = ".pvd";
constexpr char format_option[] = "--format";
constexpr char vtk_format[] = "vtk";

}  // namespace

void run_plot(const std::vector<std::string>& arguments) { run_python("plot", arguments); }

void run_report(const std::vector<std::string>& arguments) { run_python("report", arguments); }

bool asks_for_vtk(const std::vector<std::string>& arguments) {
  return std::ranges::any_of(arguments, [](const std::string& argument) {
    return argument == format_option || argument.ends_with(vtk_ending);
  });
}

void run_vtk(const std::vector<std::string>& arguments) {
  std::vector<std::string> rest;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] != format_option) {
      rest.push_back(arguments[i]);
      continue;
    }
    const std::string format = ++i < arguments.size() ? arguments[i] : "";
    if (format != vtk_format)
      throw InputError(std::string(format_option) + ": expected " + vtk_format + ", got \"" +
                       format + "\"; hint: the ending of -o selects all other formats");
  }
  run_python("vtk", rest);
}

}  // namespace samara::drivers
