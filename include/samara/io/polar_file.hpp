// Files with the polars of an airfoil: airfoil files of AeroDyn, and plain columns.
#pragma once

#include <string>
#include <vector>

#include "samara/model/air_definition.hpp"

namespace samara::io {

/// Reads the polars of a file, by rising Reynolds number. A file with a line NumAlf is an airfoil
/// file of AeroDyn: it may have tables for several Reynolds numbers, as many as NumTabs states; its
/// data for unsteady aerodynamics are not read. Any other file has lines of the angle [deg], Cl, Cd
/// and Cm. Cm is 0 where there is no column for it. `!`, `#` and `%` start a comment.
/// @throws InputError with the file, the line and a hint
std::vector<model::PolarDefinition> read_polar_file(const std::string& path);

/// The same for a text; `path` is its name in errors.
std::vector<model::PolarDefinition> parse_polars(const std::string& path, const std::string& text);

}  // namespace samara::io
