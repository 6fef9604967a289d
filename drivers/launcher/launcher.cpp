// The program `samara` as users start it. It holds signals back and becomes `samara-program`, which
// does the work: the libraries of that program need 40 ms and more to load, and a signal in this
// time would end it without a word (drivers/interruption.hpp). It links the C library alone and
// stands in a millisecond.
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>

#include <unistd.h>

#include "held_signals.hpp"

namespace {

void say(const char* text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
}

}  // namespace

int main(int /*count*/, char** arguments) {
  samara::drivers::change_held_signals(SIG_BLOCK);
  constexpr char ending[] = "-program";
  char path[PATH_MAX + sizeof ending];
  const ssize_t length = ::readlink("/proc/self/exe", path, PATH_MAX);
  if (length > 0) {
    std::memcpy(path + length, ending, sizeof ending);
    ::execv(path, arguments);
  }
  say("samara: ");
  say(length > 0 ? path : "/proc/self/exe");
  say(": ");
  say(std::strerror(errno));
  say("; hint: the program is installed beside samara\n");
  return 1;
}
