#include "controller_process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"

namespace samara::io {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Time between two looks at a process that does not answer.
constexpr int look_milliseconds = 50;
/// Time that a process has to end after its connection has closed.
constexpr Seconds patience{2.0};
/// Files that are passed on must not have the numbers that they get there.
constexpr int least_file = 10;

[[noreturn]] void fail(const std::string& what, int error) {
  throw InternalError("transient.controller: " + what + ": " + std::strerror(error));
}

/// The same file under a number of at least `least_file`.
int moved_up(int file) {
  const int moved = ::fcntl(file, F_DUPFD_CLOEXEC, least_file);
  const int error = errno;
  ::close(file);
  if (moved < 0) fail("a file cannot be opened", error);
  return moved;
}

/// Words on a process that has ended.
std::string words_of(int status) {
  if (WIFSIGNALED(status)) return std::string("crashed (") + ::strsignal(WTERMSIG(status)) + ")";
  return "ended its process (exit code " + std::to_string(WEXITSTATUS(status)) + ")";
}

}  // namespace

ControllerProcess::ControllerProcess() {
  const int file = ::memfd_create("samara-controller", MFD_CLOEXEC);
  if (file < 0) fail("no shared memory", errno);
  memory_file_ = moved_up(file);
  void* memory = MAP_FAILED;
  if (::ftruncate(memory_file_, sizeof(ControllerMemory)) == 0)
    memory = ::mmap(nullptr, sizeof(ControllerMemory), PROT_READ | PROT_WRITE, MAP_SHARED,
                    memory_file_, 0);
  if (memory == MAP_FAILED) {
    const int error = errno;
    ::close(memory_file_);
    fail("no shared memory", error);
  }
  memory_ = static_cast<ControllerMemory*>(memory);  // zeros
}

ControllerProcess::~ControllerProcess() {
  if (wire_ >= 0) ::close(wire_);
  stop();
  ::munmap(memory_, sizeof(ControllerMemory));
  ::close(memory_file_);
}

/// Signals of the terminal are for the run. Standard output belongs to the tables of the run.
void ControllerProcess::start(const std::string& helper) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    fail("no connection to the helper process", errno);
  wire_ = ends[0];
  const int far_end = moved_up(ends[1]);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, memory_file_, controller_memory_file);
  posix_spawn_file_actions_adddup2(&files, far_end, controller_wire_file);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, STDERR_FILENO, STDOUT_FILENO);
  posix_spawnattr_t settings;
  posix_spawnattr_init(&settings);
  sigset_t of_terminal;
  sigemptyset(&of_terminal);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&of_terminal, signal);
  posix_spawnattr_setsigmask(&settings, &of_terminal);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  posix_spawnattr_setsigdefault(&settings, &usual);
  posix_spawnattr_setflags(&settings, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string name = helper;
  std::string parent = std::to_string(::getpid());
  std::array<char*, 3> arguments{name.data(), parent.data(), nullptr};
  const int error =
      ::posix_spawn(&child_, helper.c_str(), &files, &settings, arguments.data(), environ);
  posix_spawnattr_destroy(&settings);
  posix_spawn_file_actions_destroy(&files);
  ::close(far_end);
  if (error != 0) {
    child_ = -1;
    fail("the program " + helper + " does not start", error);
  }
}

void ControllerProcess::ask() {
  const char byte = 1;
  [[maybe_unused]] const ssize_t sent = ::send(wire_, &byte, 1, MSG_NOSIGNAL);
}

std::string ControllerProcess::wait(double seconds) {
  const Clock::time_point begin = Clock::now();
  for (;;) {
    pollfd entry{wire_, POLLIN, 0};
    const int ready = ::poll(&entry, 1, look_milliseconds);
    if (ready > 0) {
      char byte = 0;
      const ssize_t count = ::recv(wire_, &byte, 1, 0);
      if (count == 1) return "";
      if (count < 0 && errno == EINTR) continue;
      return reap(true);
    }
    if (const std::string words = reap(false); !words.empty()) return words;
    if (Seconds(Clock::now() - begin).count() < seconds) continue;
    ::kill(child_, SIGKILL);
    reap(true);
    return "did not return within " + general(seconds, 6) + " s";
  }
}

/// Words on the process if it has ended. One that must end is waited for, and killed.
std::string ControllerProcess::reap(bool must_end) {
  if (child_ < 0) return "has ended its process";
  const Clock::time_point begin = Clock::now();
  for (;;) {
    int status = 0;
    const pid_t ended = ::waitpid(child_, &status, WNOHANG);
    if (ended == child_) {
      child_ = -1;
      return words_of(status);
    }
    if (ended < 0 && errno != EINTR) {
      child_ = -1;
      return "ended its process";
    }
    if (!must_end) return "";
    if (Clock::now() - begin > patience) ::kill(child_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

void ControllerProcess::stop() {
  if (child_ > 0) reap(true);
}

}  // namespace samara::io
