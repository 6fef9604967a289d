// Lists of names and of places in a case file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "yaml_reader.hpp"

namespace samara::io {

void read_words(MapReader& map, std::string_view key, std::vector<std::string>& words);

/// Reads fractions of a length.
void read_stations(MapReader& map, std::string_view key, std::vector<double>& places);

}  // namespace samara::io
