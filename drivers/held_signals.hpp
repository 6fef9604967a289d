// The signals that the launcher holds back until the program has handlers for them.
#pragma once

#include <csignal>
#include <initializer_list>

namespace samara::drivers {

/// `how`: SIG_BLOCK or SIG_UNBLOCK. Also before the libraries start, a sanitizer's among them.
[[gnu::no_sanitize_address, gnu::no_sanitize_undefined]] inline void change_held_signals(int how) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, number);
  ::sigprocmask(how, &signals, nullptr);
}

}  // namespace samara::drivers
