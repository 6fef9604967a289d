// Beams of OpenFAST's ElastoDyn: the files of the tower and of the blades.
#pragma once

#include <string>
#include <vector>

#include "openfast_import.hpp"

namespace samara::decks {

/// True where any mode of a direction is on; reports the effect.
bool is_flexible(OpenfastImport& import, Deck& deck, const std::vector<std::string>& keys,
                 const std::string& target);

/// Fills sections and damping of the case's tower, whose length is known.
void read_elastodyn_tower(OpenfastImport& import, const std::string& path, bool bends_fore_aft,
                          bool bends_sideways);

/// Fills sections and damping of a blade, whose length is known. False where an error has been
/// found. Without `speaks` the report stays as it is.
bool read_elastodyn_blade(OpenfastImport& import, const std::string& path, bool speaks,
                          bool bends_flap, bool bends_edge, model::BeamDefinition& beam);

}  // namespace samara::decks
