// The air around the rotor of a turbine: constants of the rotor and of the stations on its blades
// (docs/theory.md, section 11).
#pragma once

#include "samara/model/turbine.hpp"

namespace samara::model {

/// The air of a definition with `wind`, `aero` and `blades.aero_sections`. `turbine`: its beams,
/// roots, chain and speed are complete.
/// @throws InputError for a station that the models cannot have, with its blade and place
Air build_air(const TurbineDefinition& definition, const Turbine& turbine);

}  // namespace samara::model
