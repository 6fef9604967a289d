// Lists of words and of numbers in a case.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "yaml_reader.hpp"

namespace samara::io {

/// Finds a list; `items` names its items in messages. Null if the key is left out or no list.
const YamlNode* find_list(MapReader& map, std::string_view key, const std::string& items);

/// Reads names; each may be given only once.
void read_words(MapReader& map, std::string_view key, std::vector<std::string>& words);

void read_numbers(MapReader& map, std::string_view key, const Range& range,
                  std::vector<double>& values, const std::string& items = "numbers");

}  // namespace samara::io
