// SIGINT, SIGTERM and SIGHUP end the program in good order, from its first instruction on. While
// its libraries are loaded, the launcher (drivers/launcher) has held them back.
//
// A signal ends the process at once with exit code 128 + its number (130, 143, 129). All files are
// complete at any moment, so no file is left half written. During a time series the first signal is
// only noted: the time series ends and its rows are written. The second signal ends the process at
// once.
#pragma once

#include <string>

namespace samara::drivers {

/// While an object exists, the first signal is only noted, and `words` are written to the standard
/// error: they outlive the object.
class Interruption {
 public:
  explicit Interruption(const char* words);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The exit code for the noted signal; 0: no signal.
  static int noted();
  static bool is_asked() { return noted() != 0; }

  /// Holds signals back for the program that takes the place of this one, until it releases them.
  static void hold();
  static void release();

  /// From here on a signal ends the process without a message.
  static void silence();

  /// A file that is removed when a signal ends the process; empty: none.
  static void remove_at_end(const std::string& path);
};

/// Signals are deferred while an object exists. (A mask is not sufficient: other threads, such as
/// MPI's, would receive them.)
class SignalPause {
 public:
  SignalPause();
  ~SignalPause();
  SignalPause(const SignalPause&) = delete;
  SignalPause& operator=(const SignalPause&) = delete;
};

}  // namespace samara::drivers
