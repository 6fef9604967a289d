// The options of PETSc and SLEPc that the program's solvers take, by their prefixes.
#pragma once

#include <string>

namespace samara::drivers {

/// The table of `samara --help-options`.
std::string solver_options_text();

/// Hint with the right spelling of an option that nothing asked for; empty where it is no
/// option of a solver that lacks its prefix. `option`: with its dash.
std::string prefixed_option(const std::string& option, const std::string& command);

}  // namespace samara::drivers
