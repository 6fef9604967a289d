#include "samara/simulation/scenario.hpp"

#include <algorithm>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"

namespace samara::simulation {
namespace {

/// A box must hold the rotor at rest over the whole run.
void require_enough(const model::WindBox& box, const model::Turbine& turbine, double duration) {
  const double radius = turbine.air->rotor.tip_radius;
  const double hub = turbine.air->hub_height;
  const double half = 0.5 * box.width * (box.columns - 1);
  const double top = box.bottom + box.height * (box.rows - 1);
  const std::string place = "transient.wind.box: ";
  if (half < radius || top < hub + radius || box.bottom > hub - radius)
    throw InputError(place + "is smaller than the rotor: it is " + general(2.0 * half, 4) +
                     " m wide and reaches from " + general(box.bottom, 4) + " to " +
                     general(top, 4) + " m above the ground, the rotor has a radius of " +
                     general(radius, 4) + " m and its hub a height of " + general(hub, 4) + " m");
  const double end = box.duration() - (box.front + radius) / box.speed;
  if (!box.is_periodic && end < duration)
    throw InputError(place + "is too short: its wind is known to t = " + general(end, 4) +
                     " s, transient.duration is " + general(duration, 6) + " s");
}

void change_wind(const Scenario& scenario, model::Turbine& turbine) {
  if (!turbine.air)
    throw InputError("transient.wind: there is no air; hint: wind.speed and blades.aero_sections");
  const model::WindChange& change = *scenario.transient.wind;
  if (change.box) require_enough(*change.box, turbine, scenario.transient.options.duration);
  const model::GustSite site{turbine.air->hub_wind, turbine.air->hub_height,
                             2.0 * turbine.air->rotor.tip_radius};
  turbine.air->rotor.wind.changing = model::make_changing_wind(
      change, turbine.air->rotor.wind.mean, scenario.turbine.wind->shear_length, site);
}

}  // namespace

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
  if (transient.wind) change_wind(scenario, turbine);
  return turbine;
}

}  // namespace samara::simulation
