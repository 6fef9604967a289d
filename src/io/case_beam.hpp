// Beams of the case file: what the tower and the blades have in common (docs/case_file.md).
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "samara/model/definition.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

inline constexpr NumberRule beyond_the_root{"a number above 0, to 1",
                                            std::numeric_limits<double>::min(), 1.0};

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

/// Reads the list `point_masses` of a beam or of the hub; `read_own` takes what an entry has beside
/// mass, center and inertia.
template <class Mass, class Own>
void read_mass_list(MapReader& map, std::vector<Mass>& masses, const Own& read_own) {
  const YamlNode* list = map.find("point_masses");
  if (list == nullptr) return;
  if (list->kind != YamlNode::Kind::list) {
    map.refuse(*list, "point_masses", "expected a list, " + describe(*list));
    return;
  }
  for (std::size_t i = 0; i < list->children.size(); ++i) {
    MapReader entry(list->children[i], join_path(map.where("point_masses"), i), map.errors());
    Mass lump;
    read_own(entry, lump);
    entry.require("mass");
    entry.read("mass", lump.mass, positive);
    read_vector(entry, "center", lump.center, any_number);
    read_vector(entry, "inertia", lump.inertia, non_negative);
    entry.finish();
    masses.push_back(lump);
  }
}

}  // namespace samara::io
