// Distribution of the air along the blades in a periodic steady state.
#pragma once

#include <string>
#include <vector>

#include "samara/analysis/trim.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// One quantity at all stations of all blades, blade by blade, over a revolution. Mean, least and
/// largest value are those of equally spaced instants, 6 H + 1 of a series with H harmonics.
struct SpanwiseQuantity {
  std::string name;  ///< of a dataset
  std::string unit;
  std::string description;
  std::vector<double> mean;
  std::vector<double> least;
  std::vector<double> largest;
};

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
