// Symmetry of a rotor from blade to blade.
#pragma once

#include <string>

#include "samara/model/turbine.hpp"

namespace samara::turbine {

/// Reason why the rotor does not repeat after 1/B of a revolution (B blades); empty if it does.
std::string find_symmetry_fault(const model::Turbine& turbine);

}  // namespace samara::turbine
