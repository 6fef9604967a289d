// Numbers in text files.
#pragma once

#include <optional>
#include <string>

namespace samara {

/// Reads "1.5", "-2.D+03", "+.5e1", whatever the locale; no value where the word is not a finite
/// number.
std::optional<double> parse_number(const std::string& word);

}  // namespace samara
