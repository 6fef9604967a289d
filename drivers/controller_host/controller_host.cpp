// The helper of `samara transient` in which a controller library runs. It uses the C library alone,
// so that a library gets the versions of all others that it was built with.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "samara/io/controller_memory.hpp"

namespace {

using samara::io::controller_memory_file;
using samara::io::controller_wire_file;
using samara::io::ControllerMemory;

using Procedure = void (*)(float* records, int* fail, char* input, char* output, char* message);

constexpr int wrong_use = 2;

/// The helper ends with its parent. Signals of the terminal are for the parent.
bool settle(const char* parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != std::strtol(parent, nullptr, 10)) return false;  // it has ended already
  sigset_t none;
  sigemptyset(&none);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const rlimit no_dump{0, 0};
  setrlimit(RLIMIT_CORE, &no_dump);
  for (const int file : {controller_memory_file, controller_wire_file})
    fcntl(file, F_SETFD, FD_CLOEXEC);
  setvbuf(stdout, nullptr, _IOLBF, 0);
  return true;
}

/// The procedure; null: the memory says why not.
Procedure load(ControllerMemory& memory) {
  void* library = dlopen(memory.library, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* error = dlerror();
    // Messages begin with the path, which the run names itself.
    const std::size_t length = std::strlen(memory.library);
    if (std::strncmp(error, memory.library, length) == 0 && error[length] == ':')
      error += length + 1;
    std::snprintf(
        memory.fault, sizeof memory.fault,
        "cannot be loaded:%s%s; hint: a shared library for this machine, with all that it "
        "needs (ldd)",
        *error == ' ' ? "" : " ", error);
    return nullptr;
  }
  void* found = dlsym(library, memory.procedure);
  if (found == nullptr) {
    std::snprintf(memory.fault, sizeof memory.fault,
                  "has no procedure \"%s\"; hint: transient.controller.procedure, and nm -D lists "
                  "those of a library",
                  memory.procedure);
    return nullptr;
  }
  Procedure procedure = nullptr;
  static_assert(sizeof procedure == sizeof found);
  std::memcpy(&procedure, &found, sizeof procedure);
  return procedure;
}

bool answer() {
  const char byte = 1;
  return send(controller_wire_file, &byte, 1, MSG_NOSIGNAL) == 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || fcntl(controller_memory_file, F_GETFD) < 0) {
    std::fputs("samara-controller-host: only samara transient starts this program\n", stderr);
    return wrong_use;
  }
  if (!settle(argv[1])) return 1;
  void* shared = mmap(nullptr, sizeof(ControllerMemory), PROT_READ | PROT_WRITE, MAP_SHARED,
                      controller_memory_file, 0);
  if (shared == MAP_FAILED) return 1;
  close(controller_memory_file);
  auto& memory = *static_cast<ControllerMemory*>(shared);
  const Procedure procedure = load(memory);
  if (!answer() || procedure == nullptr) return 1;
  char byte = 0;
  while (recv(controller_wire_file, &byte, 1, 0) == 1) {
    procedure(memory.records, &memory.fail, memory.input, memory.output, memory.message);
    std::fflush(stdout);
    if (!answer()) return 1;
  }
  return 0;
}
