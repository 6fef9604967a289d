#include "case_controls.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

namespace samara::io {
namespace {

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
}

void read_controller(MapReader& map, model::TurbineDefinition& turbine) {
  const YamlNode* node = map.find("controller");
  if (node == nullptr) return;
  MapReader reader(*node, "controller", map.errors());
  model::ControllerDefinition& controller = turbine.controller.emplace();
  reader.require("speed_filter");
  controller.filter = 1.0;  // where it is wrong
  reader.read("speed_filter", controller.filter, positive);
  double revolutions = 0.0;
  double speed = 0.0;
  const bool has_speed = reader.read("set_point", speed, non_negative);
  if (has_speed) controller.set_point = speed;
  if (reader.read("set_point_rpm", revolutions, non_negative)) {
    if (has_speed)
      reader.refuse(*node->find("set_point_rpm"), "set_point_rpm",
                    "given together with set_point; leave one of them out");
    controller.set_point = revolutions * std::numbers::pi / 30.0;
  }
  read_loop(reader, "torque", controller.torque, nullptr);
  read_loop(reader, "pitch", controller.pitch, &controller.schedule);
  reader.finish();
}

}  // namespace samara::io
