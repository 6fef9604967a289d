// A periodic steady state in the result file.
#pragma once

#include "samara/analysis/trim.hpp"
#include "samara/io/result_file.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::drivers {

/// Writes /trim, and the distributions along the beams in it: /trim/blades, /trim/tower, /trim/air.
void write_steady_state(io::ResultFile& file, const turbine::TurbineSystem& system,
                        const analysis::Trim& trim);

}  // namespace samara::drivers
