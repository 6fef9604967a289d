// Wind, models of the air, airfoils and aerodynamic sections.
#pragma once

#include "samara/fields/turbine_fields.hpp"

namespace samara::fields {

/// `airfoils` and `aero_sections` of the blades.
void declare_airfoils(Visitor& fields, model::BladesDefinition& blades);

void declare_wind(Visitor& fields, model::TurbineDefinition& turbine);

/// Models of the air. A reader gives the default models to a turbine with wind and aerodynamic
/// sections where the key is left out; it must have read both before.
void declare_aero(Visitor& fields, model::TurbineDefinition& turbine);

}  // namespace samara::fields
