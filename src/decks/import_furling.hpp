// Furling of OpenFAST's ElastoDyn. It is locked in a case: its masses move with the nacelle.
#pragma once

#include "openfast_import.hpp"

namespace samara::decks {

/// Adds the bodies of the file that `FurlFile` names to the nacelle of the case.
void add_locked_furling(OpenfastImport& import, Deck& elastodyn);

}  // namespace samara::decks
