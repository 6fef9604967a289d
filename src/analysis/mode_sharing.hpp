// Modes of one rank on all ranks.
#pragma once

#include "samara/analysis/mode.hpp"
#include "samara/analysis/ranks.hpp"

namespace samara::analysis {

/// Copies a mode of the rank `source` to all others.
void share_mode(const Ranks& ranks, int source, Mode& mode);

/// Copies the modes of the first rank to all others, without their shapes.
void share_modes(const Ranks& ranks, ModeSet& set);

}  // namespace samara::analysis
