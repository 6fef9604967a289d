#include "case_blades.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <utility>

#include "case_beam.hpp"
#include "case_controls.hpp"
#include "case_joint.hpp"

namespace samara::io {
namespace {

constexpr int max_blades = 100;

constexpr std::array<std::pair<const char*, model::HingeAxis>, 3> hinge_axes{
    {{"flap", model::HingeAxis::flap},
     {"lag", model::HingeAxis::lag},
     {"pitch", model::HingeAxis::pitch}}};

/// Spring and damper of the hinges of one blade where they are others than those of all.
void read_hinge_differences(const YamlNode& node, const std::string& where,
                            model::BladeDifference& difference, ErrorList& errors) {
  MapReader map(node, where, errors);
  for (const auto& [word, axis] : hinge_axes) {
    const YamlNode* entry = map.find(word);
    if (entry == nullptr) continue;
    MapReader hinge(*entry, map.where(word), errors);
    model::HingeDifference& own = difference.hinges[axis];
    double value = 0.0;
    if (hinge.read("stiffness", value, non_negative)) own.stiffness = value;
    if (hinge.read("damping", value, non_negative)) own.damping = value;
    hinge.finish();
  }
  map.finish();
}

/// From the hub outward.
void read_hinges(MapReader& map, const YamlNode& list, model::BladesDefinition& blades) {
  if (list.kind != YamlNode::Kind::list) {
    map.refuse(list, "hinges",
               "expected a list of hinges, from the hub outward, " + describe(list));
    return;
  }
  for (std::size_t i = 0; i < list.children.size(); ++i) {
    const std::string place = "hinges[" + std::to_string(i) + "]";
    MapReader hinge(list.children[i], map.where(place), map.errors());
    model::HingeDefinition definition;
    hinge.require("axis", "flap, lag or pitch");
    hinge.require("joint", "free, locked or prescribed");
    hinge.read("axis", definition.axis,
               {{"flap", model::HingeAxis::flap},
                {"lag", model::HingeAxis::lag},
                {"pitch", model::HingeAxis::pitch}});
    hinge.read("offset", definition.offset, non_negative);
    read_joint(hinge, definition.joint);
    read_angle(hinge, "delta3_deg", definition.delta3, quarter_turn);
    hinge.finish();
    blades.hinges.push_back(definition);
  }
}

void read_each(const YamlNode& node, const std::string& where, model::BladesDefinition& blades,
               ErrorList& errors) {
  MapReader map(node, where, errors);
  for (int number = 1; number <= blades.count; ++number) {
    const std::string key = std::to_string(number);
    const YamlNode* entry = map.find(key);
    if (entry == nullptr) continue;
    MapReader blade(*entry, map.where(key), errors);
    model::BladeDifference& difference = blades.each[number];
    read_angle(blade, "pitch_deg", difference.pitch, half_turn);
    blade.read("mass_factor", difference.mass_factor, positive);
    blade.read("stiffness_factor", difference.stiffness_factor, positive);
    if (const YamlNode* hinges = blade.find("hinges"))
      read_hinge_differences(*hinges, blade.where("hinges"), difference, errors);
    blade.finish();
  }
  if (node.kind != YamlNode::Kind::map) return;
  for (const YamlNode& entry : node.children) {
    const bool is_known =
        std::any_of(blades.each.begin(), blades.each.end(),
                    [&](const auto& known) { return entry.key == std::to_string(known.first); });
    if (!is_known) {
      errors.add(entry.place, where,
                 "expected a blade number from 1 to " + std::to_string(blades.count) + ", got \"" +
                     entry.key + "\"");
    }
  }
}

}  // namespace

void read_blades(const YamlNode& node, model::BladesDefinition& blades, ErrorList& errors) {
  MapReader map(node, "blades", errors);
  map.read("count", blades.count, 1, max_blades);
  read_angle(map, "precone_deg", blades.precone, quarter_turn);
  read_angle(map, "pitch_deg", blades.pitch, half_turn);
  read_beam(map, Matrix3::Identity(), blade_ratios, blades.beam);
  read_support(map, "end_support", false, blades.beam.end_support);
  if (const YamlNode* entry = map.find("hinges")) read_hinges(map, *entry, blades);
  read_angle(map, "pitch_link_delta3_deg", blades.pitch_link, quarter_turn);
  if (const YamlNode* entry = map.find("each")) {
    read_each(*entry, map.where("each"), blades, errors);
  }
  read_pitch_actuator(map, blades);
  map.finish();
}

}  // namespace samara::io
