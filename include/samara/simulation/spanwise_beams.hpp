// Deflections and internal loads along the blades and the tower in a periodic steady state.
#pragma once

#include <vector>

#include "samara/analysis/trim.hpp"
#include "samara/simulation/spanwise_quantity.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// Beams of one kind, with equal stations: root, Gauss points, end.
struct SpanwiseBeams {
  std::size_t count = 0;
  std::vector<double> fractions;  ///< of the length
  /// Undeformed distance from the shaft axis (blades) or height above the foot (tower) [m].
  std::vector<double> places;
  std::vector<SpanwiseQuantity> quantities;
};

struct SpanwiseStructure {
  SpanwiseBeams blades;  ///< empty: none
  SpanwiseBeams tower;   ///< the same
};

SpanwiseStructure find_spanwise_structure(const turbine::TurbineSystem& system,
                                          const analysis::Trim& trim);

}  // namespace samara::simulation
