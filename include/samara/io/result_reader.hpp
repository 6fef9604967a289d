// Reads the case and the steady state of a result, for other commands.
#pragma once

#include <string>

#include "samara/analysis/trim.hpp"
#include "samara/io/case.hpp"

namespace samara::io {

/// Kind of a result, as a source of loads.
enum class ResultKind {
  time_series,   ///< rows of `samara transient`
  steady_state,  ///< harmonics of `samara trim` or `samara floquet`
  other,
};

/// @throws InputError if there is no result of this program, or it cannot be opened
ResultKind find_result_kind(const std::string& path);

/// The case as it was run, with its settings.
/// @throws InputError as `find_result_kind`, and if this program does not accept the case
Case read_result_case(const std::string& path);

/// Reads the solution and the loads that hold coordinates from /trim. @throws InputError if there
/// is none
analysis::Trim read_result_trim(const std::string& path);

/// Finds the unknowns of held coordinates by the names in the file.
void place_held(const system::PeriodicSystem& system, std::vector<analysis::HeldCoordinate>& held);

}  // namespace samara::io
