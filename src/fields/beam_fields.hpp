// Common keys of tower and blades.
#pragma once

#include "samara/fields/turbine_fields.hpp"

namespace samara::fields {

enum class BeamPlace { tower, blade };

void declare_beam(Visitor& fields, BeamPlace place, model::BeamDefinition& beam);

/// A mass on a beam or on the hub; `axes` names those of its place and its inertia.
template <class Mass>
void declare_lump(Visitor& fields, Mass& lump, const char* center_text, const char* inertia_text) {
  fields.number(Field("mass", "kg", positive, "").required(), lump.mass);
  fields.vector({"center", "m", center_text}, lump.center);
  fields.vector({"inertia", "kg m^2", non_negative, inertia_text}, lump.inertia);
}

}  // namespace samara::fields
