#include "interruption.hpp"

#include <array>
#include <atomic>
#include <climits>
#include <csignal>
#include <cstring>
#include <string_view>

#include <sys/prctl.h>
#include <unistd.h>

#include "held_signals.hpp"

namespace samara::drivers {
namespace {

constexpr std::array<int, 4> handled_signals{SIGINT, SIGTERM, SIGHUP, SIGPIPE};

// A signal may arrive on any thread.
std::atomic<const char*> noting = nullptr;  // the words for the first signal
std::atomic<int> noted_signal = 0;
std::atomic<int> has_file = 0;
std::atomic<int> is_paused = 0;
std::atomic<int> waiting_signal = 0;
std::atomic<int> is_silent = 0;
std::array<char, PATH_MAX> file_at_end{};

// Only functions that a signal handler may call.

void say(const char* words) {
  [[maybe_unused]] const ssize_t written =
      is_silent != 0 ? 0 : ::write(STDERR_FILENO, words, std::strlen(words));
}

[[noreturn]] void leave(int number) {
  if (has_file != 0) ::unlink(file_at_end.data());
  say("samara: interrupted\n");
  ::_exit(128 + number);
}

/// If the reader of a pipe ends first (samara ... | head), SIGPIPE ends the process, as usual.
void take_broken_pipe(int number) {
  if (is_paused != 0) {
    waiting_signal = number;
    return;
  }
  if (has_file != 0) ::unlink(file_at_end.data());
  std::signal(number, SIG_DFL);
  std::raise(number);
}

void take_signal(int number) {
  if (is_paused != 0) {
    waiting_signal = number;
    return;
  }
  const char* words = noting;
  if (words == nullptr || noted_signal != 0) leave(number);
  noted_signal = number;
  say(words);
}

/// Whether the environment says that this is another rank than the first one. When a rank ends with
/// an error, mpiexec ends the others by a signal: they have nothing to say.
[[gnu::no_sanitize_address, gnu::no_sanitize_undefined]] bool is_other_rank(char** environment) {
  constexpr std::string_view key = "OMPI_COMM_WORLD_RANK=";
  for (; environment != nullptr && *environment != nullptr; ++environment) {
    std::size_t same = 0;
    while (same < key.size() && (*environment)[same] == key[same]) ++same;
    if (same == key.size()) return (*environment)[same] != '0';
  }
  return false;
}

/// Called before the libraries start, including a sanitizer's: MPI, PETSc and HDF5 need
/// milliseconds to start. Signals that the parent process ignores stay ignored. Those that the
/// launcher has held back arrive at the end. Lists of processes have the launcher's name.
[[gnu::no_sanitize_address, gnu::no_sanitize_undefined]] void prepare(int /*count*/,
                                                                      char** /*arguments*/,
                                                                      char** environment) {
  is_silent = is_other_rank(environment) ? 1 : 0;
  for (const int number : handled_signals) {
    struct sigaction action {};
    if (::sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = number == SIGPIPE ? take_broken_pipe : take_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaddset(&action.sa_mask, SIGINT);
    sigaddset(&action.sa_mask, SIGTERM);
    ::sigaction(number, &action, nullptr);
  }
  ::prctl(PR_SET_NAME, "samara");
  change_held_signals(SIG_UNBLOCK);
}

[[gnu::used, gnu::section(".preinit_array")]] void (*const early)(int, char**, char**) = prepare;

}  // namespace

Interruption::Interruption(const char* words) { noting = words; }

Interruption::~Interruption() { noting = nullptr; }

int Interruption::noted() { return noted_signal == 0 ? 0 : 128 + noted_signal; }

SignalPause::SignalPause() { is_paused = 1; }

SignalPause::~SignalPause() {
  is_paused = 0;
  if (const int number = waiting_signal.exchange(0); number != 0) std::raise(number);
}

void Interruption::hold() { change_held_signals(SIG_BLOCK); }

void Interruption::release() { change_held_signals(SIG_UNBLOCK); }

void Interruption::silence() { is_silent = 1; }

void Interruption::remove_at_end(const std::string& path) {
  has_file = 0;
  if (path.empty() || path.size() >= file_at_end.size()) return;
  std::memcpy(file_at_end.data(), path.c_str(), path.size() + 1);
  has_file = 1;
}

}  // namespace samara::drivers
