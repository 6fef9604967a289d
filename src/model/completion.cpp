// Completes a definition with values that follow from other values.
#include <algorithm>

#include "samara/base/error.hpp"
#include "samara/model/beam_modes.hpp"
#include "samara/model/definition.hpp"

namespace samara::model {
namespace {

Matrix6 symmetric(const Matrix6& matrix) { return 0.5 * (matrix + matrix.transpose()); }

bool has_ratios(const BeamDefinition& beam) {
  return std::ranges::any_of(beam.modal_damping, [](const auto& one) { return one.has_value(); });
}

void complete_beam(const std::string& key, BeamDefinition& beam, std::vector<Fault>& faults) {
  if (!beam.reference_line.empty()) beam.length = compute_arc_length(beam.reference_line);
  for (SectionDefinition& section : beam.sections) {
    section.stiffness = symmetric(section.stiffness);
    section.mass = symmetric(section.mass);
  }
  for (SupportDefinition* support : {&beam.support, &beam.end_support})
    support->stiffness = symmetric(support->stiffness);
  std::ranges::stable_sort(beam.point_masses, {}, &PointMassDefinition::at);
  if (!has_ratios(beam) || !beam.damping.isZero(0.0)) return;
  try {
    beam.damping = fit_damping(build_beam(key, beam), beam.modal_damping);
  } catch (const InputError& error) {
    faults.push_back({key + ".damping", error.what()});
  }
}

}  // namespace

std::vector<Fault> complete(TurbineDefinition& definition) {
  std::vector<Fault> faults;
  if (definition.has_tower) complete_beam("tower", definition.tower, faults);
  if (definition.blades.count > 0) complete_beam("blades", definition.blades.beam, faults);
  if (definition.controller && !definition.controller->set_point)
    definition.controller->set_point = definition.shaft.generator_speed();
  return faults;
}

}  // namespace samara::model
