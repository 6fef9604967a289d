// Turbines whose air does not follow small motions about a steady state.
#pragma once

#include <memory>

#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// The same turbine for small motions: with `aero.inflow: frozen` it holds the induced velocity.
/// Null with any other inflow, for which it is `system` itself.
std::unique_ptr<turbine::TurbineSystem> hold_wake(const turbine::TurbineSystem& system);

/// The same turbine whose air loads no small motion changes: they are those of the steady state.
/// Null without air.
std::unique_ptr<turbine::TurbineSystem> hold_air(const turbine::TurbineSystem& system);

}  // namespace samara::simulation
