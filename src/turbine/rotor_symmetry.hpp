// Whether a rotor looks the same from blade to blade.
#pragma once

#include <string>

#include "samara/model/turbine.hpp"

namespace samara::turbine {

/// Why the rotor does not look the same after 1/B of a turn, B the number of its blades; empty
/// where it does.
std::string find_symmetry_fault(const model::Turbine& turbine);

}  // namespace samara::turbine
