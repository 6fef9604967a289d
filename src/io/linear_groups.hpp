// The group /linearize of a result (docs/case_file.md, "Results").
#pragma once

#include "samara/linear/linearization.hpp"

#include "hdf5_file.hpp"

namespace samara::io {

void write_linear_groups(Hdf5File& file, const linear::Linearization& linearization);

}  // namespace samara::io
