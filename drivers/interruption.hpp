// SIGINT, SIGTERM and SIGHUP: they end the program in good order, from its first instruction on.
//
// A signal ends the process at once with exit code 128 + its number (130, 143, 129): files are
// whole at any moment, so that nothing is left half written. While a time series runs, the first
// signal is noted instead, the time series ends with its rows written, and the second one ends it
// at once.
#pragma once

#include <string>

namespace samara::drivers {

/// While it lives, the first signal is noted and nothing more.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The exit code for the signal that was noted, 0: none has come.
  static int noted();
  static bool is_asked() { return noted() != 0; }

  /// A file that goes when a signal ends the process; empty: none.
  static void remove_at_end(const std::string& path);
};

/// While it lives, signals wait. (A mask would not do: other threads, MPI's, would take them.)
class SignalPause {
 public:
  SignalPause();
  ~SignalPause();
  SignalPause(const SignalPause&) = delete;
  SignalPause& operator=(const SignalPause&) = delete;
};

}  // namespace samara::drivers
