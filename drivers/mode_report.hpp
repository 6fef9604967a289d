// Modes as a table, and what they say about stability.
#pragma once

#include <string>

#include "samara/analysis/mode.hpp"

namespace samara::drivers {

enum class Motion { rigid_body, undamped, growing, decaying };

/// What the exponent says; rates below analysis::zero_exponent count as zero.
Motion motion_of(const analysis::Mode& mode, double rotor_speed);

/// One line a mode, by its number in the result; those that are not resolved, where `all` are
/// wanted, stand below the others. Harmonics stand there where the set has participations.
std::string mode_table(const analysis::ModeSet& set, bool all);

/// "stable: ...", "neutral: ..." or "unstable: ...", and what was left out of the verdict; or "no
/// verdict: ..." where the growth is an error of the mesh (docs/theory.md, section 5.8).
std::string verdict(const analysis::ModeSet& set, bool all);

}  // namespace samara::drivers
