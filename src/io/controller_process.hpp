// The helper process in which a controller library runs.
#pragma once

#include <string>

#include <sys/types.h>

#include "samara/io/controller_memory.hpp"

namespace samara::io {

class ControllerProcess {
 public:
  /// @throws InternalError where the memory cannot be made
  ControllerProcess();
  /// Ends the process. It has a moment to close its files.
  ~ControllerProcess();
  ControllerProcess(const ControllerProcess&) = delete;
  ControllerProcess& operator=(const ControllerProcess&) = delete;

  ControllerMemory& memory() { return *memory_; }
  /// Starts the program `helper`, which reads the memory. @throws InternalError
  void start(const std::string& helper);
  /// Asks for the next answer.
  void ask();
  /// Waits for an answer. Otherwise the process has ended, and the words say how; empty: it has
  /// answered.
  std::string wait(double seconds);

 private:
  std::string reap(bool must_end);
  void stop();

  int memory_file_ = -1;
  ControllerMemory* memory_ = nullptr;
  pid_t child_ = -1;
  int wire_ = -1;
};

}  // namespace samara::io
