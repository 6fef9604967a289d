#include "samara/components/blade_root.hpp"

#include <numbers>
#include <string>

namespace samara::components {

const char* hinge_name(model::HingeAxis axis) {
  switch (axis) {
    case model::HingeAxis::flap:
      return "flap hinge";
    case model::HingeAxis::lag:
      return "lag hinge";
    case model::HingeAxis::pitch:
      break;
  }
  return "pitch hinge";
}

BladeRoot::BladeRoot(const model::Turbine& turbine, std::size_t k) : turbine_(turbine), k_(k) {}

void BladeRoot::place(Registry& registry, int rank) {
  const int count = static_cast<int>(root().hinges.size());
  if (count > 0) first_ = registry.add_shared(rank, 2 * count);
  if (turbine_.pitch_actuator || (turbine_.controller && turbine_.controller->pitch))
    pitch_port_ = registry.add_port(2);
}

/// Arguments q, U and, if `with_rates`, the rates of q.
std::vector<Argument> BladeRoot::hinge_arguments(bool with_rates) const {
  std::vector<Argument> arguments;
  const int count = static_cast<int>(root().hinges.size());
  const auto add = [&](int offset, bool is_rate) {
    for (int i = 0; i < count; ++i)
      arguments.push_back(is_rate ? rates(first_ + 2 * i, 1)
                                  : unknowns(first_ + 2 * i + offset, 1));
    if (count < most_hinges) arguments.push_back(zeros(most_hinges - count));
  };
  add(0, false);
  add(1, false);
  if (with_rates) add(0, true);
  return arguments;
}

void BladeRoot::describe(Registry& registry, int reactions, int hub_port, int load_port,
                         int root_port) {
  using system::Frame;
  using system::PartKind;
  const int number = static_cast<int>(k_) + 1;
  const Argument pitch = pitch_port_ < 0 ? zeros(2) : port_values(pitch_port_, 2);
  load_.arguments = {unknowns(reactions, 6), pitch};
  motion_.arguments = {port_values(hub_port, 9), pitch};
  for (const Argument& argument : hinge_arguments(true)) load_.arguments.push_back(argument);
  for (const Argument& argument : hinge_arguments(false)) motion_.arguments.push_back(argument);
  load_.provisions = {{load_port, 0}};
  motion_.provisions = {{root_port, 0}};
  for (std::size_t i = 0; i < root().hinges.size(); ++i) {
    const model::RootHinge& hinge = root().hinges[i];
    const int local = static_cast<int>(i);
    const int at = first_ + 2 * local;
    const std::string name = hinge_name(hinge.axis);
    const system::Owner owner(PartKind::joint, "blade", number);
    registry.describe(at,
                      {owner, name, "angle", "rad", system::UnknownRole::position, Frame::rotating},
                      system::RowRole::kinematic);
    registry.describe(
        at + 1, {owner, name, "speed", "rad/s", system::UnknownRole::velocity, Frame::rotating},
        system::RowRole::balance);
    describe_channel(registry, hinge.axis, at);
    load_.shares.push_back({at, 1, 6 + most_hinges + local});
    load_.shares.push_back({at + 1, 1, 6 + local});
    if (hinge.stiffness > 0.0)
      registry.add(system::EnergyGroup{system::EnergyGroup::Kind::strain,
                                       {PartKind::support, "blade", number},
                                       name,
                                       Frame::rotating,
                                       {at},
                                       {hinge.stiffness},
                                       hinge.damping / hinge.stiffness});
    else if (is_unloaded())
      registry.add(system::UnconstrainedCoordinate{owner.name() + " " + name, at, at + 1, "N m"});
    else
      registry.add_free({owner.name() + " " + name, at, at + 1, "N m"});
  }
}

void BladeRoot::connect_pose(int hub_port) {
  pose_.arguments = {port_values(hub_port, hub_pose_values),
                     pitch_port_ < 0 ? zeros(2) : port_values(pitch_port_, 2)};
  for (const Argument& argument : hinge_arguments(false)) pose_.arguments.push_back(argument);
  pose_.provisions = {{pose_port_, 0}};
}

void BladeRoot::describe_channel(Registry& registry, model::HingeAxis axis, int angle) const {
  const char* names[] = {"FlapHinge", "LagHinge", "PitchHinge"};
  const char* ways[] = {"downwind", "against the turning", "toward feather"};
  const std::string number = std::to_string(k_ + 1);
  const auto which = static_cast<std::size_t>(axis);
  registry.add(Channel{names[which] + number, "deg", "blade " + number + ", root",
                       std::string(hinge_name(axis)) + " angle, " + ways[which], angle,
                       180.0 / std::numbers::pi});
}

/// True without rotor speed, gravity and prescribed loads. Nothing then turns a hinge that has no
/// spring.
bool BladeRoot::is_unloaded() const {
  return turbine_.speed == 0.0 && turbine_.chain.gravity == 0.0 &&
         turbine_.blades[k_].loads.empty();
}

bool BladeRoot::is_conservative() const {
  if (turbine_.rotor_pitch_slope != 0.0 && (pitch_port_ >= 0 || !root().hinges.empty()))
    return false;
  for (const model::RootHinge& hinge : root().hinges)
    if (hinge.damping != 0.0) return false;
  return true;
}

}  // namespace samara::components
