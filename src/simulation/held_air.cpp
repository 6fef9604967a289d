#include "samara/simulation/held_air.hpp"

namespace samara::simulation {
namespace {

bool has_frozen_wake(const turbine::TurbineSystem& system) {
  const std::optional<model::Air>& air = system.turbine().air;
  return air && air->rotor.models.inflow == elements::Inflow::frozen;
}

std::unique_ptr<turbine::TurbineSystem> hold(const turbine::TurbineSystem& system, bool load) {
  model::Turbine held = system.turbine();
  held.air->rotor.wake_is_held = has_frozen_wake(system);
  held.air->rotor.load_is_held = load;
  return std::make_unique<turbine::TurbineSystem>(held, system.comm());
}

}  // namespace

std::unique_ptr<turbine::TurbineSystem> hold_wake(const turbine::TurbineSystem& system) {
  return has_frozen_wake(system) ? hold(system, false) : nullptr;
}

std::unique_ptr<turbine::TurbineSystem> hold_air(const turbine::TurbineSystem& system) {
  return system.turbine().air ? hold(system, true) : nullptr;
}

}  // namespace samara::simulation
