// The origins of points that are kept in files while a sweep runs (io::PointFiles).
#pragma once

#include <string>
#include <vector>

#include "samara/simulation/operation.hpp"

namespace samara::drivers {

/// Of a point of the case with this text; `value`: what else it depends on.
std::string point_origin(const std::string& case_text, const std::string& value);

/// Numbers with all digits, each with a blank behind it; of rows: wind speed, speed and pitch.
std::string exact_words(const std::vector<double>& values);
std::string row_words(const std::vector<simulation::ScheduledPoint>& table);

}  // namespace samara::drivers
