// Blades of OpenFAST's BeamDyn: its primary file and the file of the blade that it names.
#pragma once

#include <string>

#include "openfast_import.hpp"

namespace samara::decks {

/// False where an error has been found. Without `speaks` the report stays as it is.
bool read_beamdyn(OpenfastImport& import, const std::string& path, bool speaks,
                  model::BeamDefinition& beam);

}  // namespace samara::decks
