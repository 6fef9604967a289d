// The places between two points of a sweep where modes begin or cease to grow (docs/theory.md,
// section 5.12).
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "samara/simulation/campbell.hpp"

namespace samara::simulation {

/// Indices of neighbouring points with different numbers of growing modes, or between which the
/// mode of a line begins or ceases to grow.
std::vector<std::pair<std::size_t, std::size_t>> find_changes(
    const std::vector<CampbellPoint>& points, const std::vector<CampbellLine>& lines);

/// Finds the edges between two points by bisection to edge_accuracy. The modes of the points at
/// both ends of an interval are linked by their shapes; an interval is divided where a mode grows
/// at one end only. Thus no change is lost where others make up for it in number. An interval in
/// which `point_at` has no modes is not divided further.
/// All points have their signatures.
/// @returns edges in the order of the sweep, each with different numbers of growing modes
std::vector<StabilityEdge> find_edges(const CampbellPoint& from, const CampbellPoint& to,
                                      const std::function<CampbellPoint(double)>& point_at);

}  // namespace samara::simulation
