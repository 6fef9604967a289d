// The keys of a case file for editors and documents.
#pragma once

#include <string>

namespace samara::io {

/// The JSON Schema (draft 7) of a case file: every key with its type, range, default and meaning.
/// Beside the standard keywords a key has "x-unit", "x-range" (its range in words) and "x-default"
/// if words describe the default instead of a value.
std::string case_schema();

}  // namespace samara::io
