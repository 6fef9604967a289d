// InflowWind's file: steady and uniform wind.
#pragma once

#include <optional>
#include <string>

#include "openfast_import.hpp"

namespace samara::decks {

struct InflowSource {
  std::string path;         ///< of InflowWind's file
  double foot = 0.0;        ///< of the tower above the ground [m]
  double yaw = 0.0;         ///< of a nacelle that is locked, counter-clockwise from above [rad]
  double density = 1.225;   ///< of the air [kg/m^3]
  std::string density_key;  ///< behind the density in the case
};

/// The wind where it is steady, or the one at time 0 of a uniform wind; none, with a note, where a
/// file of turbulence gives it.
std::optional<model::WindDefinition> read_inflow(OpenfastImport& import,
                                                 const InflowSource& source);

}  // namespace samara::decks
