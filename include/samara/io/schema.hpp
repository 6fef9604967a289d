// The keys of a case file for editors and documents.
#pragma once

#include <string>

namespace samara::io {

/// The JSON Schema (draft 7) of a case file: every key with its type, range, default and meaning.
/// Beside the standard keywords a key has "x-unit", "x-range" (its range in words) and "x-default"
/// if words describe the default instead of a value.
std::string case_schema();

/// Unit of a key of a case file by its path, "blades.sections.0.mass": "kg/m"; "1" for a pure
/// number and for a key that is not known.
std::string unit_of_key(const std::string& path);

}  // namespace samara::io
