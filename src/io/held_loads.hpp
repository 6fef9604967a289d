// Constant loads that hold unconstrained coordinates, in a result.
#pragma once

#include <string>
#include <vector>

#include "samara/analysis/trim.hpp"

#include "hdf5_file.hpp"
#include "hdf5_reader.hpp"

namespace samara::io {

/// Writes `group`/held_name, with this description, and `group`/held_load.
void write_held_loads(Hdf5File& file, const std::string& group,
                      const std::vector<analysis::HeldCoordinate>& held,
                      const std::string& description);

/// @throws InputError if `group` has none
std::vector<analysis::HeldCoordinate> read_held_loads(const Hdf5Reader& file,
                                                      const std::string& group);

}  // namespace samara::io
