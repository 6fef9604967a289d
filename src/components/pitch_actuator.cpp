#include "samara/components/pitch_actuator.hpp"

#include <numbers>
#include <string>

namespace samara::components {
namespace {

/// Limits a value to [lowest, highest]. A NaN stays a NaN.
template <class T>
T limited(const T& value, double lowest, double highest) {
  if (math::plain_value(value) < lowest) return T(lowest);
  if (math::plain_value(value) > highest) return T(highest);
  return value;
}

}  // namespace

PitchActuator::PitchActuator(const model::Turbine& turbine, std::size_t k, int rank)
    : turbine_(turbine), k_(k), rank_(rank) {}

void PitchActuator::place(Registry& registry) {
  first_ = registry.add_shared(rank_, 2);
  command_port_ = registry.add_port(1);
}

void PitchActuator::describe(Registry& registry) {
  using system::Frame;
  using system::RowRole;
  using system::UnknownRole;
  constexpr double usual = 0.1;  // [rad]
  const system::Owner owner(system::PartKind::law, "pitch actuator", static_cast<int>(k_) + 1);
  const double omega = turbine_.pitch_actuator->frequency;
  registry.describe(first_,
                    {owner, "", "angle", "rad", UnknownRole::state, Frame::rotating, false, usual},
                    RowRole::evolution);
  registry.describe(
      first_ + 1,
      {owner, "", "rate", "rad/s", UnknownRole::state, Frame::rotating, false, usual * omega},
      RowRole::evolution);
  connections_.arguments = {unknowns(first_, 2), rates(first_, 2), port_values(command_port_, 1)};
  connections_.shares = {{first_, 2, 0}};
  connections_.provisions = {{pitch_port_, 2}};
}

/// angle' = rate; rate' = 2 zeta omega (wanted - rate). The wanted rate is omega (command -
/// angle)/(2 zeta), within its limit. Where no limit is active, this is rate' = omega^2 (command -
/// angle) - 2 zeta omega rate. The rate never exceeds its limit.
template <class System>
void PitchActuator::state(System& system) const {
  const model::PitchActuatorDefinition& law = *turbine_.pitch_actuator;
  const double own = turbine_.roots[k_].pitch;
  const auto rows_of = [&]<class T>(const Eigen::Matrix<T, arguments, 1>& x) {
    T command = x(4);
    if (turbine_.has_pitch_curve(k_))
      command += T(system.varying(turbine_.pitch_at(k_, system.time()).value - own));
    if constexpr (System::has_inputs)
      if (!system.inputs().pitch.empty()) command += system.inputs().pitch[k_];
    command = limited<T>(command, law.lowest - own, law.highest - own);
    const T wanted = limited<T>((command - x(0)) * (law.frequency / (2.0 * law.damping_ratio)),
                                -law.rate_limit, law.rate_limit);
    Eigen::Matrix<T, values, 1> y;
    y << x(2) - x(1), x(3) - (wanted - x(1)) * (2.0 * law.damping_ratio * law.frequency), x(0),
        x(1);
    return y;
  };
  system.template add<arguments, values>(connections_, rows_of);
}

template class Stated<PitchActuator>;

}  // namespace samara::components
