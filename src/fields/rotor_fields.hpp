// Joints, shaft, hub and blades.
#pragma once

#include "samara/fields/turbine_fields.hpp"

namespace samara::fields {

/// Units of the gains of a loop.
struct Units {
  const char* proportional;
  const char* integral;
};

/// `per_rev` or `frequency` of something that oscillates.
void declare_frequency(Visitor& fields, int& per_rev, double& frequency);

/// A joint that may be prescribed. `required`: the words for one that must say its kind; null: it
/// has a default.
void declare_joint(Visitor& fields, const char* required, model::JointDefinition& joint);

void declare_shaft(Visitor& fields, model::ShaftDefinition& shaft);
void declare_hub(Visitor& fields, model::HubDefinition& hub);
void declare_blades(Visitor& fields, model::BladesDefinition& blades);

}  // namespace samara::fields
