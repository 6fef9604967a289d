// The files of AeroDyn 15: models of the air, airfoils and aerodynamic sections of the blades.
#pragma once

#include <optional>
#include <string>

#include "openfast_import.hpp"

namespace samara::decks {

struct AerodynSource {
  std::string path;          ///< of AeroDyn's main file
  int blades = 3;            ///< of the rotor
  double air_density = 0.0;  ///< of OpenFAST's main file [kg/m^3]; 0: it has none
};

/// What of a deck belongs to the wind and the models of the air of a case.
struct AerodynModels {
  model::AeroDefinition aero;
  double density = 0.0;                             ///< [kg/m^3]
  std::optional<model::TowerFlowDefinition> tower;  ///< its heights count from the ground
  std::optional<model::NacelleDragDefinition> nacelle;
};

/// Fills airfoils and aerodynamic sections of the blades, whose beam is known, and returns the
/// models. Comments and the report speak of all.
AerodynModels read_aerodyn(OpenfastImport& import, const AerodynSource& source);

}  // namespace samara::decks
