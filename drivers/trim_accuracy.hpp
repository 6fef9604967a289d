// How accurate a steady state is, in words, for every command that uses one.
#pragma once

#include <string>

#include "samara/analysis/trim.hpp"

namespace samara::drivers {

/// What is rough about the steady state and what makes it better; empty where nothing is.
std::string roughness(const analysis::Trim& trim);

/// Notes the same where there is something to note. `source`: where the steady state comes from.
void note_roughness(const analysis::Trim& trim, analysis::Observer& observer,
                    const std::string& source = "trim");

}  // namespace samara::drivers
