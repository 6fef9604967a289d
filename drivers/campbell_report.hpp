// A Campbell diagram in tables.
#pragma once

#include <string>
#include <vector>

#include "samara/io/campbell_file.hpp"
#include "samara/simulation/campbell.hpp"

namespace samara::drivers {

/// "shaft.speed_rpm=7", "shaft.speed_rpm=7, wind.speed=9".
std::string words_of(const std::vector<io::SweptQuantity>& quantities,
                     const simulation::SweepPlace& place);

/// One line per point: speed, pitch, stability, and the least damped mode.
std::string campbell_point_table(const std::vector<io::SweptQuantity>& quantities,
                                 const std::vector<simulation::CampbellPoint>& points,
                                 const std::vector<simulation::CampbellLine>& lines);

/// One line per mode with two or more points: frequencies at its ends, least damping, and the
/// ranges in which it grows; of a map the number of points at which it grows.
std::string campbell_line_table(const std::vector<simulation::CampbellPoint>& points,
                                const std::vector<simulation::CampbellLine>& lines,
                                const std::vector<simulation::StabilityEdge>& edges);

/// The steps along lines at which another mode may be as close, whole lines; empty if there are
/// none.
std::string campbell_doubts(const std::vector<simulation::CampbellPoint>& points,
                            const std::vector<simulation::CampbellLine>& lines);

}  // namespace samara::drivers
