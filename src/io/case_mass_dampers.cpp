#include "case_mass_dampers.hpp"

#include <array>

#include "case_beam.hpp"

namespace samara::io {
namespace {

using Carrier = model::MassDamperDefinition::Carrier;

/// The words of the axes b1 b2 b3 of a section or y1 y2 y3 of the nacelle.
using AxisWords = std::array<const char*, 3>;
constexpr AxisWords on_tower{"vertical", "side_side", "fore_aft"};
constexpr AxisWords on_nacelle{"side_side", "fore_aft", "vertical"};
constexpr AxisWords on_blade{"axial", "lead_lag", "flap"};

/// Reads `nacelle`, `tower`, `blades` or `blade 2`. False where it is none of this turbine.
bool read_carrier(MapReader& map, const model::TurbineDefinition& turbine,
                  model::MassDamperDefinition& damper) {
  const YamlNode* entry = map.require("on", "nacelle, tower, blades or one of them: blade 1");
  if (entry == nullptr) return false;
  const std::string& text = entry->text;
  const int blades = turbine.blades.count;
  if (text == "nacelle" || text == "tower") {
    damper.carrier = text == "tower" ? Carrier::tower : Carrier::nacelle;
    return true;
  }
  damper.carrier = Carrier::blade;
  if (text == "blades" && blades > 0) return true;
  for (int k = 1; k <= blades; ++k)
    if (text == "blade " + std::to_string(k)) damper.blade = k;
  if (damper.blade != 0) return true;
  map.refuse(
      *entry, "on",
      "expected nacelle, tower" +
          (blades == 0 ? std::string()
                       : ", blades or a blade from 1 to " + std::to_string(blades) + " (blade 1)") +
          ", " + describe(*entry));
  return false;
}

void read_axis(const YamlNode& node, const std::string& where, model::MassDamperAxis& axis,
               ErrorList& errors) {
  MapReader map(node, where, errors);
  map.require("stiffness");
  map.read("stiffness", axis.stiffness, positive);
  map.read("damping", axis.damping, non_negative);
  if (const YamlNode* entry = map.find("stops")) {
    MapReader stops(*entry, map.where("stops"), errors);
    stops.require("displacement");
    stops.require("stiffness");
    stops.read("displacement", axis.stop, positive);
    stops.read("stiffness", axis.stop_stiffness, positive);
    stops.read("damping", axis.stop_damping, non_negative);
    stops.finish();
  }
  map.finish();
}

void read_axes(MapReader& map, const AxisWords& words, model::MassDamperDefinition& damper) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const YamlNode* entry = map.find(words[i]);
    if (entry == nullptr) continue;
    model::MassDamperAxis axis;
    axis.axis = static_cast<int>(i);
    read_axis(*entry, map.where(words[i]), axis, map.errors());
    damper.axes.push_back(axis);
  }
  if (damper.axes.empty())
    map.require(words[2], "or \"" + std::string(words[1]) + "\", \"" + words[0] +
                              "\": spring and damper of an axis");
}

model::MassDamperDefinition read_mass_damper(MapReader& map,
                                             const model::TurbineDefinition& turbine) {
  model::MassDamperDefinition damper;
  const bool is_placed = read_carrier(map, turbine, damper);
  map.require("mass");
  map.read("mass", damper.mass, positive);
  read_vector(map, "position", damper.position, any_number);
  if (!is_placed) {
    for (const char* key : {"at", "axial", "lead_lag", "flap", "vertical", "side_side", "fore_aft"})
      map.find(key);
    return damper;
  }
  if (damper.carrier != Carrier::nacelle &&
      map.require("at", "its place along the beam") != nullptr)
    map.read("at", damper.at, beyond_the_root);
  read_axes(map,
            damper.carrier == Carrier::nacelle ? on_nacelle
            : damper.carrier == Carrier::tower ? on_tower
                                               : on_blade,
            damper);
  return damper;
}

}  // namespace

void read_mass_dampers(MapReader& map, model::TurbineDefinition& turbine) {
  const YamlNode* list = map.find("tuned_mass_dampers");
  if (list == nullptr) return;
  if (list->kind != YamlNode::Kind::list) {
    map.refuse(*list, "tuned_mass_dampers",
               "expected a list (each entry starts with \"- \"), " + describe(*list));
    return;
  }
  for (std::size_t i = 0; i < list->children.size(); ++i) {
    MapReader entry(list->children[i], join_path(map.where("tuned_mass_dampers"), i), map.errors());
    turbine.mass_dampers.push_back(read_mass_damper(entry, turbine));
    entry.finish();
  }
}

}  // namespace samara::io
