// The parts of a report of a HAWC2 deck that do not depend on the turbine.
#pragma once

#include "htc_import.hpp"

namespace samara::decks {

/// Names the files that were read, and those that may have been cut off.
void report_files(HtcImport& import);

/// Names all blocks and commands that no reader has used. Call it last.
void report_rest(HtcImport& import);

}  // namespace samara::decks
