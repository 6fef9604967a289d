// Errors whose messages name the place and a remedy. The class of an error determines the exit code
// of the program.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace samara {

/// Input error, which the user can correct: a file, a key, an option, a path (exit code 2).
/// The message may have several lines, one error each.
class InputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An iteration did not converge, or a linear solve is not trustworthy (exit code 3).
class ConvergenceError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A quantity left the range in which the equations hold, e.g. a rotation of 180 degrees.
/// Inside a nonlinear solve it cuts the step; outside it ends the run (exit code 3).
class DomainError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The user ended the run (exit code 130, as of any program that Ctrl-C ends).
class Interrupted : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The environment failed, or the program has a defect (exit code 1).
class InternalError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `work` and puts the place in front of the message of an input error.
template <class Work>
auto at_place(const std::string& place, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(place + ": " + error.what());
  }
}

}  // namespace samara
