// Distribution of the air along the blades in a periodic steady state.
#pragma once

#include <vector>

#include "samara/analysis/trim.hpp"
#include "samara/simulation/spanwise_quantity.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

struct SpanwiseAir {
  std::size_t blades = 0;
  std::vector<double> fractions;  ///< of the stations, along the blade
  std::vector<double> radii;      ///< undeformed distance from the shaft axis [m]
  std::vector<double> chords;     ///< [m]
  std::vector<SpanwiseQuantity> quantities;
};

/// Empty without air.
SpanwiseAir find_spanwise_air(const turbine::TurbineSystem& system, const analysis::Trim& trim);

}  // namespace samara::simulation
