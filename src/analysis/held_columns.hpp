// Held coordinates in a tangent.
#pragma once

#include <vector>

#include "samara/petsc/handle.hpp"
#include "samara/system/metadata.hpp"

namespace samara::analysis {

/// Replaces the column of each coordinate by that of the load that holds it: 1 in its row.
void hold_coordinates(Mat tangent, const std::vector<system::UnconstrainedCoordinate>& held);

}  // namespace samara::analysis
