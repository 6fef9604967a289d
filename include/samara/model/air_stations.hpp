// Stations of the air on the blades (docs/theory.md, section 11).
#pragma once

#include "samara/model/turbine.hpp"

namespace samara::model {

/// Adds the stations of all blades to `air`, one for each Gauss point. `turbine`: as of build_air;
/// `air`: with its models. Chord, twist, centre and airfoils of a station are those of the
/// definition at its point. Elements with sections or airfoils that change inside have means that
/// keep the moments of the load over the element.
/// @throws InputError for a station that the models cannot have, with its blade and place
void place_air_stations(const TurbineDefinition& definition, const Turbine& turbine, Air& air);

}  // namespace samara::model
