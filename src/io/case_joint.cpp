#include "case_joint.hpp"

#include <utility>

namespace samara::io {
namespace {

using model::JointKind;

/// Reads the motion of a prescribed joint; refuses it for one of another kind.
void read_motion(MapReader& map, model::JointDefinition& joint) {
  const YamlNode* angle = map.find("angle_deg");
  const YamlNode* harmonic = map.find("harmonic");
  if (joint.kind != JointKind::prescribed) {
    for (const auto& [key, entry] :
         {std::pair("angle_deg", angle), std::pair("harmonic", harmonic)})
      if (entry != nullptr) map.refuse(*entry, key, "only a joint: prescribed has a motion");
    return;
  }
  for (const char* key : {"stiffness", "damping"})
    if (const YamlNode* entry = map.node().find(key))
      map.refuse(*entry, key, "a prescribed joint moves as it is told, whatever springs it has");
  if (angle == nullptr && harmonic == nullptr)
    map.require("angle_deg", "of a prescribed joint, or \"harmonic\"");
  read_angle(map, "angle_deg", joint.motion.angle, half_turn);
  if (harmonic == nullptr) return;
  MapReader wave(*harmonic, map.where("harmonic"), map.errors());
  read_frequency(wave, joint.motion.per_rev, joint.motion.frequency);
  wave.require("amplitude_deg");
  read_angle(wave, "amplitude_deg", joint.motion.amplitude, half_turn);
  read_angle(wave, "phase_deg", joint.motion.phase, any_number);
  wave.finish();
}

}  // namespace

void read_frequency(MapReader& map, int& per_rev, double& frequency) {
  const bool has_multiple = map.read("per_rev", per_rev, 1, max_harmonics);
  const bool has_frequency = map.read("frequency", frequency, positive);
  if (has_multiple && has_frequency)
    map.refuse(*map.node().find("frequency"), "frequency",
               "given together with per_rev; leave one of them out");
  if (map.node().find("per_rev") == nullptr && map.node().find("frequency") == nullptr)
    map.require("per_rev", "or \"frequency\"");
}

void read_joint(MapReader& map, model::JointDefinition& joint) {
  map.read("stiffness", joint.stiffness, non_negative);
  map.read("damping", joint.damping, non_negative);
  if (map.read("joint", joint.kind,
               {{"free", JointKind::free},
                {"locked", JointKind::locked},
                {"prescribed", JointKind::prescribed}}) ||
      map.node().find("joint") == nullptr) {
    read_motion(map, joint);
    return;
  }
  for (const char* key : {"angle_deg", "harmonic"}) map.find(key);
}

}  // namespace samara::io
