#include "run_apart.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "samara/base/error.hpp"

namespace samara::io {
namespace {

/// Most bytes that are received from a child.
constexpr std::size_t most_bytes = std::size_t{1} << 30;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool limits_memory = false;  // the sanitizer's own map is 16 TB
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool limits_memory = false;
#else
constexpr bool limits_memory = true;
#endif
#else
constexpr bool limits_memory = true;
#endif

/// Sets a limit to `value`, or to the hard limit if that is lower.
void limit(int resource, rlim_t value) {
  rlimit both{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &both);
  both.rlim_cur = std::min(both.rlim_max, value);
  ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

rlim_t own_memory() {
  std::array<char, 64> text{};
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  const ssize_t length = file < 0 ? 0 : ::read(file, text.data(), text.size() - 1);
  if (file >= 0) ::close(file);
  return length > 0
             ? std::strtoul(text.data(), nullptr, 10) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE))
             : 0;
}

/// The child ends with its parent. It ignores signals of the terminal; the parent handles them.
[[noreturn]] void run_child(std::size_t memory, std::size_t seconds,
                            const std::function<bool(int)>& work, int output,
                            const sigset_t& signals) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_IGN);
  for (const int signal : {SIGPIPE, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU})
    ::signal(signal, SIG_DFL);
  ::sigprocmask(SIG_SETMASK, &signals, nullptr);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, seconds);
  if (const rlim_t own = own_memory(); limits_memory && own > 0) limit(RLIMIT_AS, own + memory);
  bool is_well = false;
  try {
    is_well = work(output);
  } catch (...) {  // only the parent may continue
  }
  ::_exit(is_well ? 0 : 1);
}

/// All bytes from the child until it ends.
std::string receive(int file) {
  std::string bytes;
  std::array<char, 65536> piece{};
  for (;;) {
    const ssize_t count = ::read(file, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0 || bytes.size() > most_bytes) return bytes;
    bytes.append(piece.data(), static_cast<std::size_t>(count));
  }
}

std::string words_of(int status) {
  if (!WIFSIGNALED(status)) return "it cannot be read completely";
  if (WTERMSIG(status) == SIGXCPU) return "reading it took too long";
  return std::string("the process that read it was ended by a signal (") +
         ::strsignal(WTERMSIG(status)) + ")";
}

}  // namespace

Apart run_apart(std::size_t memory, std::size_t seconds, const std::function<bool(int)>& work) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw InternalError(std::string("no pipe can be created: ") + std::strerror(errno));
  sigset_t all;
  sigset_t before;
  ::sigfillset(&all);
  ::sigprocmask(SIG_SETMASK, &all, &before);  // the child must not run this process's handlers
  const pid_t child = ::fork();
  const int error = errno;
  if (child == 0) run_child(memory, seconds, work, ends[1], before);
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  ::close(ends[1]);
  Apart apart;
  if (child > 0) apart.bytes = receive(ends[0]);
  ::close(ends[0]);
  if (child < 0)
    throw InternalError(std::string("no process can be started: ") + std::strerror(error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  apart.is_done = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!apart.is_done) apart.ending = words_of(status);
  return apart;
}

bool write_all(int file, const std::string& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = ::write(file, bytes.data() + sent, bytes.size() - sent);
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

}  // namespace samara::io
