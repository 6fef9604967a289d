// Supports that are free in some direction: hinges, and what may slide.
#pragma once

#include <vector>

#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// The free directions of all supports, each as a coordinate that a load may hold at zero.
std::vector<system::NeutralCoordinate> find_free_supports(const system::PeriodicSystem& system);

}  // namespace samara::analysis
