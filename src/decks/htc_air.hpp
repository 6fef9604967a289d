// Wind and aerodynamics of a HAWC2 deck: `wind`, `aero`, `aerodrag`, and the tables .ae and .pc.
#pragma once

#include <string>
#include <vector>

#include "htc_import.hpp"
#include "import_common.hpp"

namespace samara::decks {

/// The blades of the rotor, and the vector about which it turns.
struct HtcRotor {
  std::vector<std::string> blades;  ///< bodies, by the numbers of the blades
  std::string hub_body;             ///< whose axis it is
  int hub_axis = 0;                 ///< 1 to 3: x, y, z; < 0: against it
  std::string place;
  const HtcBlock* block = nullptr;
};
HtcRotor read_htc_rotor(HtcImport& import);

struct HtcAirSource {
  double foot = 0.0;  ///< of the tower above the origin of HAWC2 [m]
  double yaw = 0.0;   ///< of the nacelle, counter-clockwise from above [rad]
  std::string tower;  ///< body, in lower case
  Curve twist;        ///< of the blades, over the share of their length [rad]
  const HtcBlock* aero = nullptr;
};

/// Fills wind, models, airfoils and aerodynamic sections. The beam of the blades is known.
void read_htc_air(HtcImport& import, const HtcAirSource& source);

}  // namespace samara::decks
