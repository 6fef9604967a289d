#include "case_controls.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

namespace samara::io {
namespace {

/// Of a set point that is meant to be the mean speed.
constexpr double speed_rounding = 1e-6;

void read_loop(MapReader& map, const char* key, std::optional<model::ControlLoop>& loop,
               double* schedule) {
  const YamlNode* node = map.find(key);
  if (node == nullptr) return;
  loop.emplace();
  MapReader gains(*node, map.where(key), map.errors());
  const bool has_p = gains.read("proportional", loop->proportional, any_number);
  const bool has_i = gains.read("integral", loop->integral, any_number);
  if (schedule != nullptr) read_angle(gains, "gain_schedule_deg", *schedule, positive);
  if (!has_p && !has_i) gains.require("proportional", "or \"integral\"");
  gains.finish();
}

/// An integral holds its set point: the speed of the case must be that.
void check_set_point(const MapReader& map, const model::ShaftDefinition& shaft,
                     const model::ControllerDefinition& controller) {
  const YamlNode* entry = map.node().find("set_point");
  if (entry == nullptr) entry = map.node().find("set_point_rpm");
  const double speed = shaft.generator_speed();
  if (entry == nullptr || !controller.has_integral() || speed == 0.0) return;
  if (std::abs(controller.set_point - speed) <= speed_rounding * speed) return;
  std::ostringstream text;
  text << "the integral holds the generator at " << controller.set_point
       << " rad/s, shaft.speed times gear_ratio is " << speed
       << " rad/s; hint: leave the set point out, it is that speed then";
  map.refuse(*entry, entry->key, text.str());
}

void check_loops(const MapReader& map, const YamlNode& node,
                 const model::TurbineDefinition& turbine,
                 const model::ControllerDefinition& controller) {
  if (turbine.shaft.generator.kind != model::JointKind::free)
    map.errors().add(
        find_blame(node), map.where(),
        "the generator is locked, its speed is given; hint: shaft.generator: {joint: free}");
  if (!controller.torque && !controller.pitch)
    map.errors().add(find_blame(node), map.where(), "expected torque, pitch or both");
  if (controller.schedule > 0.0 && !(controller.schedule + turbine.blades.pitch > 0.0))
    map.refuse(*node.find("pitch"), "pitch.gain_schedule_deg",
               "the gains are divided by 1 + pitch/gain_schedule, which is not > 0 at "
               "blades.pitch_deg");
  if (controller.torque && controller.pitch && controller.torque->integral != 0.0 &&
      controller.pitch->integral != 0.0)
    map.refuse(*node.find("pitch"), "pitch.integral",
               "torque and pitch cannot both have an integral: each would hold the speed, and "
               "nothing would say how they share the torque");
  if (controller.pitch && turbine.shaft.rotor_pitch_slope == 0.0)
    map.refuse(*node.find("pitch"), "pitch",
               "nothing makes the torque of the rotor depend on the pitch; hint: "
               "shaft.rotor.torque_pitch_slope, the place of the air");
}

}  // namespace

void read_pitch_actuator(MapReader& blades, model::BladesDefinition& definition) {
  const YamlNode* node = blades.find("pitch_actuator");
  if (node == nullptr) return;
  MapReader map(*node, blades.where("pitch_actuator"), blades.errors());
  model::PitchActuatorDefinition& actuator = definition.actuator.emplace();
  for (const char* key : {"frequency", "damping_ratio"}) map.require(key);
  actuator.frequency = actuator.damping_ratio = 1.0;  // where they are wrong
  map.read("frequency", actuator.frequency, positive);
  map.read("damping_ratio", actuator.damping_ratio, positive);
  read_angle(map, "rate_limit_deg", actuator.rate_limit, positive);
  read_angle(map, "lowest_deg", actuator.lowest, half_turn);
  read_angle(map, "highest_deg", actuator.highest, half_turn);
  map.finish();
  const auto refuse_beyond = [&](double pitch) {
    if (pitch >= actuator.lowest && pitch <= actuator.highest) return;
    std::ostringstream text;
    text << "the pitch of the case, " << pitch * 180.0 / std::numbers::pi
         << " deg, is not within lowest_deg and highest_deg";
    blades.refuse(*node, "pitch_actuator", text.str());
  };
  refuse_beyond(definition.pitch);
  for (const auto& [number, blade] : definition.each)
    if (blade.pitch != 0.0) refuse_beyond(definition.pitch + blade.pitch);
}

void read_controller(MapReader& map, model::TurbineDefinition& turbine) {
  const YamlNode* node = map.find("controller");
  if (node == nullptr) return;
  MapReader reader(*node, "controller", map.errors());
  model::ControllerDefinition& controller = turbine.controller.emplace();
  controller.set_point = turbine.shaft.generator_speed();
  reader.require("speed_filter");
  controller.filter = 1.0;  // where it is wrong
  reader.read("speed_filter", controller.filter, positive);
  double revolutions = 0.0;
  const bool has_speed = reader.read("set_point", controller.set_point, non_negative);
  if (reader.read("set_point_rpm", revolutions, non_negative)) {
    if (has_speed)
      reader.refuse(*node->find("set_point_rpm"), "set_point_rpm",
                    "given together with set_point; leave one of them out");
    controller.set_point = revolutions * std::numbers::pi / 30.0;
  }
  read_loop(reader, "torque", controller.torque, nullptr);
  read_loop(reader, "pitch", controller.pitch, &controller.schedule);
  reader.finish();
  if (node->kind != YamlNode::Kind::map) return;
  check_set_point(reader, turbine.shaft, controller);
  check_loops(reader, *node, turbine, controller);
}

void check_pitch_curves(const YamlNode& transient, const model::TurbineDefinition& turbine,
                        ErrorList& errors) {
  if (!turbine.controller || !turbine.controller->pitch || turbine.shaft.speed == 0.0) return;
  const auto refuse = [&](const YamlNode& node, const std::string& where) {
    errors.add(find_blame(node), where,
               "controller.pitch gives the pitch, which is not that of the case when this begins; "
               "hint: a case without controller.pitch");
  };
  if (const YamlNode* curve = transient.find("pitch_deg")) refuse(*curve, "transient.pitch_deg");
  const YamlNode* events = transient.find("events");
  for (std::size_t i = 0; events != nullptr && i < events->children.size(); ++i)
    if (const YamlNode* pitch = events->children[i].find("pitch"))
      refuse(*pitch, "transient.events[" + std::to_string(i) + "].pitch");
}

}  // namespace samara::io
