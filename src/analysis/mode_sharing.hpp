// Modes of the first rank on all ranks.
#pragma once

#include "samara/analysis/mode.hpp"
#include "samara/analysis/ranks.hpp"

namespace samara::analysis {

/// Copies the modes of the first rank to all others, without their shapes.
void share_modes(const Ranks& ranks, ModeSet& set);

}  // namespace samara::analysis
