// The masses of a model in the result file.
#pragma once

#include "samara/io/result_file.hpp"
#include "samara/model/masses.hpp"

namespace samara::drivers {

/// Writes /model/mass, /model/center_of_mass and /model/inertia.
void write_masses(io::ResultFile& file, const model::Masses& masses);

}  // namespace samara::drivers
