// The numbers in the text of a case, by their keys.
#pragma once

#include <string>
#include <vector>

#include "samara/io/case.hpp"

namespace samara::io {

struct CaseNumber {
  std::string key;  ///< as --set takes it: "tower.sections.0.mass"
  double value = 0.0;
};

/// The numbers at a key and below it, in the order of the text; * in the place of a key or of the
/// number of an item stands for all of them: "tower.sections.*.mass", "blades.damping".
/// @throws InputError if there is none
std::vector<CaseNumber> find_numbers(const Case& input, const std::string& pattern);

}  // namespace samara::io
