// What loads, prescribed motions and supports a command can take.
#include "samara/analysis/trim.hpp"
#include "samara/base/error.hpp"

#include "commands.hpp"

namespace samara::drivers {
namespace {

/// A root that moves needs inertia in every direction that moves.
void require_mass(const io::Case& input, const std::string& key,
                  const model::SupportDefinition& support) {
  bool displaces = false;
  bool turns = false;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!support.rigid[at] && !(support.mass + support.added_mass(i) > 0.0)) displaces = true;
    if (!support.rigid[3 + at] && !(support.inertia(i) + support.added_mass(3 + i) > 0.0))
      turns = true;
  }
  if (displaces)
    throw InputError(input.path + ": " + key +
                     " may move without a mass; hint: give the mass and inertia of what stands "
                     "on the springs (a foundation, a bearing); samara static needs none");
  if (turns)
    throw InputError(input.path + ": " + key +
                     " may turn about an axis without inertia; hint: instead of a word give "
                     "stiffness: {theta1: free, ...} with inertia: [I1, I2, I3], > 0 where it may "
                     "turn; samara static needs none");
}

/// @throws InputError where more harmonics are asked for than the trim has.
void require_harmonics(const io::Case& input, const std::string& place, int per_rev) {
  const analysis::TrimOptions& trim = input.trim;
  const bool truncates = input.turbine.shaft.speed > 0.0 && !trim.automatic &&
                         trim.method == analysis::TrimMethod::harmonic_balance;
  if (truncates && per_rev > trim.harmonics)
    throw InputError(
        place + ".harmonic.per_rev is " + std::to_string(per_rev) +
        ", more than trim.harmonics; hint: --set trim.harmonics=" + std::to_string(per_rev));
  const bool shoots = trim.method == analysis::TrimMethod::shooting;
  const int most = shoots ? analysis::shooting_harmonics(trim.steps) : analysis::auto_harmonics;
  if (input.turbine.shaft.speed > 0.0 && (shoots || trim.automatic) && per_rev > most)
    throw InputError(place + ".harmonic.per_rev is " + std::to_string(per_rev) +
                     ", more than the " + std::to_string(most) + " harmonics of trim." +
                     (shoots ? "method: shooting" : "harmonics: auto") +
                     "; hint: --set trim.harmonics=" + std::to_string(per_rev));
}

void require_repeating_motion(const io::Case& input, const std::string& joint,
                              const model::JointHistory& motion) {
  const std::string place = input.path + ": " + joint;
  if (!motion.is_constant() && motion.per_rev == 0)
    throw InputError(place +
                     " does not repeat with the rotor; hint: harmonic: {per_rev: ...}, or samara "
                     "static, which takes its angle at t = 0");
  require_harmonics(input, place, motion.per_rev);
}

}  // namespace

void require_motion(const io::Case& input) {
  for (std::size_t i = 0; i < input.turbine.loads.size(); ++i) {
    const model::LoadHistory& history = input.turbine.loads[i].history;
    const std::string place = input.path + ": loads[" + std::to_string(i) + "]";
    if (!history.is_constant() && (!history.table.empty() || history.per_rev == 0))
      throw InputError(place +
                       " does not repeat with the rotor; hint: harmonic: {per_rev: ...}; samara "
                       "static takes the loads at t = 0, samara transient any with "
                       "transient.start: undeformed or RESULT.h5");
    require_harmonics(input, place, history.per_rev);
  }
  require_repeating_motion(input, "nacelle.yaw", input.turbine.nacelle.yaw.motion);
  require_repeating_motion(input, "hub.teeter", input.turbine.hub.teeter.motion);
  const std::vector<model::HingeDefinition>& hinges = input.turbine.blades.hinges;
  for (std::size_t i = 0; i < hinges.size(); ++i)
    require_repeating_motion(input, "blades.hinges[" + std::to_string(i) + "]",
                             hinges[i].joint.motion);
  if (input.turbine.has_tower) require_mass(input, "tower.support", input.turbine.tower.support);
  require_mass(input, "blades.support", input.turbine.blades.beam.support);
}

}  // namespace samara::drivers
