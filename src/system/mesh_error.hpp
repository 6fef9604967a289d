// The error of the beams' meshes in a mode (docs/theory.md, section 5.9).
#pragma once

#include <vector>

#include "samara/model/layout.hpp"
#include "samara/model/turbine.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::system {

/// One entry an element of every beam.
std::vector<MeshError> find_mesh_errors(const model::Turbine& turbine, const model::Layout& layout);

}  // namespace samara::system
