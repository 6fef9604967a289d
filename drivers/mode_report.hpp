// Modes as a table, and the verdict on stability in words.
#pragma once

#include <string>

#include "samara/analysis/mode.hpp"
#include "samara/simulation/stability.hpp"

namespace samara::drivers {

/// Which modes are listed.
struct ModeListing {
  bool all = false;  ///< also those that are not resolved
  int first = 0;     ///< so many rows; 0: all
};

/// One line a mode, by its number in the result; those that are not resolved stand below the
/// others. Harmonics stand there where the set has participations.
std::string mode_table(const analysis::ModeSet& set,
                       const simulation::StabilityAssessment& assessment,
                       const ModeListing& listing);

/// "stable: ...", "neutral: ..." or "unstable: ...", the frequency up to which it holds and what
/// was left out; or "no verdict: ..." and what to change. `all`: unresolved modes are listed.
std::string verdict_text(const analysis::ModeSet& set,
                         const simulation::StabilityAssessment& assessment, bool all);

/// @throws ConvergenceError where there is no verdict, for the exit code
void require_verdict(const analysis::ModeSet& set,
                     const simulation::StabilityAssessment& assessment);

}  // namespace samara::drivers
