// The error of a beam's mesh in a mode (docs/theory.md, section 5.9).
#pragma once

#include <vector>

#include "samara/model/beam.hpp"
#include "samara/system/metadata.hpp"

namespace samara::components {

/// Mesh error of element e; `points`: first unknown of each point of the beam.
system::MeshError find_mesh_error(const model::Beam& beam, int e, const std::vector<int>& points);

}  // namespace samara::components
