// The simple generators of ServoDyn as laws of the operating points.
#pragma once

#include "openfast_import.hpp"

namespace samara::decks {

/// Fills the law of `operation` where the torque of the generator is a function of its speed:
/// VSContrl 1, or VSContrl 0 with GenModel 1. The turbine's gear ratio must be known.
/// `rotor_speed`: of the deck [rad/s].
void read_generator_law(OpenfastImport& import, Deck& servo, double rotor_speed);

}  // namespace samara::decks
