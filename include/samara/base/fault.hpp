// Faults of a definition, field by field.
#pragma once

#include <string>
#include <vector>

namespace samara {

struct Fault {
  std::string field;  ///< its path in a case file: "blades.hinges[0].offset"
  std::string text;   ///< what is wrong, and a hint
  /// Other fields that are at odds with it; whoever reads a file blames the one given last.
  std::vector<std::string> others = {};
};

/// Whether a field is that of `outer` or stands below it.
bool is_within(const std::string& field, const std::string& outer);

/// @throws InputError of all faults, one a line: "source: field: text"
void require_none(const std::vector<Fault>& faults, const std::string& source);

}  // namespace samara
