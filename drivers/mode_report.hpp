// Modes as a table, and what they say about stability.
#pragma once

#include <string>

#include "samara/analysis/mode.hpp"

namespace samara::drivers {

enum class Motion { rigid_body, undamped, growing, decaying };

/// What the exponent says; rates below their error, and exponents below analysis::zero_exponent,
/// count as zero.
Motion motion_of(const analysis::Mode& mode, double rotor_speed);

/// Which modes are listed.
struct ModeListing {
  bool all = false;  ///< also those that are not resolved
  int first = 0;     ///< so many rows; 0: all
};

/// One line a mode, by its number in the result; those that are not resolved stand below the
/// others. Harmonics stand there where the set has participations.
std::string mode_table(const analysis::ModeSet& set, const ModeListing& listing);

struct Verdict {
  /// "stable: ...", "neutral: ..." or "unstable: ...", the frequency up to which it holds and what
  /// was left out; or "no verdict: ..." and what to change.
  std::string text;
  bool is_given = true;
};
Verdict find_verdict(const analysis::ModeSet& set, bool all);

/// @throws ConvergenceError where there is no verdict, for the exit code
void require_verdict(const Verdict& verdict);

}  // namespace samara::drivers
