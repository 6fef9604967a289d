// The options of PETSc and SLEPc for the solvers of the program, by prefix.
#pragma once

#include <string>

namespace samara::drivers {

/// The table of `samara --help-options`.
std::string solver_options_text();

/// The right spelling of an option that was not used; empty if it is not an option of a solver
/// without its prefix. `option`: with its dash.
std::string prefixed_option(const std::string& option, const std::string& command);

/// `options`: all that are given, as text.
/// @throws InputError for one that the solvers cannot follow
void refuse_unsupported_options(const std::string& options);

}  // namespace samara::drivers
