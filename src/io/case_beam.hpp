// Beams of the case file: what the tower and the blades have in common (docs/case_file.md).
#pragma once

#include <array>
#include <string_view>

#include "samara/model/definition.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// Gauss points an element, at the most.
inline constexpr int max_order = 6;

/// The keys of damping ratios, in the order of model::ModalDamping.
using RatioKeys = std::array<const char*, 3>;
inline constexpr RatioKeys blade_ratios{"flap", "lead_lag", "torsion"};
inline constexpr RatioKeys tower_ratios{"fore_aft", "lateral", "torsion"};

/// Reads the keys that the tower and the blades have in common. `to_a`: from the axes in which the
/// file states the reference line.
void read_beam(MapReader& map, const Matrix3& to_a, const RatioKeys& ratios,
               model::BeamDefinition& beam);

/// Reads what holds an end: a word, or springs, at the root with a body on them.
void read_support(MapReader& beam, std::string_view key, bool at_root,
                  model::SupportDefinition& support);

}  // namespace samara::io
