// Faults of a definition, field by field.
#pragma once

#include <string>
#include <vector>

namespace samara {

struct Fault {
  std::string field;  ///< its path in a case file: "blades.hinges[0].offset"
  std::string text;   ///< the fault and a hint
  /// Other fields that contradict it. The reader of a file reports the fault at the one given last.
  std::vector<std::string> others = {};
};

/// True where a field is `outer` or lies below it.
bool is_within(const std::string& field, const std::string& outer);

/// @throws InputError of all faults, one a line: "source: field: text"
void require_none(const std::vector<Fault>& faults, const std::string& source);

}  // namespace samara
