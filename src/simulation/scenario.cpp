#include "samara/simulation/scenario.hpp"

#include <algorithm>

namespace samara::simulation {

int highest_harmonic(const model::TurbineDefinition& turbine) {
  if (turbine.shaft.speed == 0.0) return 0;
  int highest = std::max(turbine.nacelle.yaw.motion.per_rev, turbine.hub.teeter.motion.per_rev);
  for (const model::LoadDefinition& load : turbine.loads)
    highest = std::max(highest, load.variation.per_rev);
  for (const model::HingeDefinition& hinge : turbine.blades.hinges)
    highest = std::max(highest, hinge.joint.motion.per_rev);
  return highest;
}

analysis::TrimOptions trim_options(const Scenario& scenario) {
  analysis::TrimOptions options = scenario.trim;
  options.least_harmonics = std::max(options.least_harmonics, highest_harmonic(scenario.turbine));
  return options;
}

model::Turbine build_operated_turbine(const Scenario& scenario) {
  model::Turbine turbine = model::build_turbine(scenario.turbine);
  const TransientSetup& transient = scenario.transient;
  if (transient.speed)
    turbine.operation.turning.emplace(*transient.speed, transient.options.duration);
  if (transient.pitch) turbine.operation.pitch.assign(turbine.blades.size(), transient.pitch);
  turbine.operation.yaw = transient.yaw;
  turbine.operation.teeter = transient.teeter;
  return turbine;
}

}  // namespace samara::simulation
