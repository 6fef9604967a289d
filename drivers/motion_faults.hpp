// Motions that a history is given, and what no steps can follow.
#pragma once

#include <string>
#include <vector>

#include "samara/io/case.hpp"

namespace samara::drivers {

/// @throws InputError where a motion of the case jumps, or changes faster than the steps
void require_followed_motions(const io::Case& input);

/// Rates that jump, a line each.
std::vector<std::string> motion_notes(const io::Case& input);

}  // namespace samara::drivers
