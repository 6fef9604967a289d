// The keys of a case file for editors and documents.
#pragma once

#include <string>

namespace samara::io {

/// The JSON Schema (draft 7) of a case file: every key with its type, range, default and meaning.
/// Beside the schema's own words a key has "x-unit", "x-range" (its range in words) and, where no
/// value tells the default, "x-default".
std::string case_schema();

}  // namespace samara::io
