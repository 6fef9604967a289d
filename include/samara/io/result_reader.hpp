// Reads of a result what other commands go on with: its case, its steady state.
#pragma once

#include <string>

#include "samara/analysis/trim.hpp"
#include "samara/io/case.hpp"

namespace samara::io {

/// Kind of a result that loads can be taken from.
enum class ResultKind {
  time_series,   ///< rows of `samara transient`
  steady_state,  ///< harmonics of `samara trim` or `samara floquet`
  other,
};

/// @throws InputError where there is no result of this program, or none that can be opened
ResultKind find_result_kind(const std::string& path);

/// The case as it was run, with its settings.
/// @throws InputError as `find_result_kind`, and where this program does not accept the case
Case read_result_case(const std::string& path);

/// Reads from /trim the solution and the loads that hold coordinates. @throws InputError where
/// there is none
analysis::Trim read_result_trim(const std::string& path);

/// Finds the unknowns of held coordinates, of which a file has the names.
void place_held(const system::PeriodicSystem& system, std::vector<analysis::HeldCoordinate>& held);

}  // namespace samara::io
