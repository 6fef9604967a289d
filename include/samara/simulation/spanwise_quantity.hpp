// A quantity along beams over a revolution of a periodic steady state.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace samara::simulation {

/// One quantity at all stations of all beams of a kind, beam by beam. Mean, least and largest value
/// are those of equally spaced instants, 6 H + 1 of a series with H harmonics.
struct SpanwiseQuantity {
  std::string name;  ///< of a dataset
  std::string unit;
  std::string frame;
  std::string description;
  std::vector<double> mean{};
  std::vector<double> least{};
  std::vector<double> largest{};

  void resize(std::size_t size) {
    mean.assign(size, 0.0);
    least.assign(size, std::numeric_limits<double>::infinity());
    largest.assign(size, -std::numeric_limits<double>::infinity());
  }
  /// Adds one of `instants` values at a station.
  void add(std::size_t at, double value, int instants) {
    mean[at] += value / instants;
    least[at] = std::min(least[at], value);
    largest[at] = std::max(largest[at], value);
  }
};

}  // namespace samara::simulation
