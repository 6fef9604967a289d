// The places of the tangents K and M that a turbine fills: declared by what its equations couple,
// at no state in particular.
#pragma once

#include <vector>

#include "samara/system/turbine_residual.hpp"

namespace samara::system {

struct TurbinePattern {
  /// Columns of each row, ascending: everywhere else the tangents are zero at all states and times.
  std::vector<std::vector<int>> K;
  std::vector<std::vector<int>> M;
};

TurbinePattern find_pattern(const TurbineResidual& equations);

}  // namespace samara::system
