// Joints of the case file: springs, dampers and prescribed motions (docs/case_file.md).
#pragma once

#include "samara/model/definition.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

inline constexpr int max_harmonics = 200;

/// Reads `per_rev` or `frequency` of something that oscillates.
void read_frequency(MapReader& map, int& per_rev, double& frequency);

/// Reads stiffness, damping and the word of a joint that may be prescribed.
void read_joint(MapReader& map, model::JointDefinition& joint);

}  // namespace samara::io
