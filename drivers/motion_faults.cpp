#include "motion_faults.hpp"

#include <cmath>
#include <numbers>

#include "samara/base/error.hpp"
#include "samara/math/curve_faults.hpp"

#include "table.hpp"

namespace samara::drivers {
namespace {

struct Motion {
  std::string key;
  std::string unit;
  double factor = 1.0;  ///< from SI to `unit`
  const std::optional<math::TimeCurve>& curve;
};

/// Angles first.
std::vector<Motion> motions_of(const io::TransientCase& transient) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  return {{"pitch_deg", "deg", degrees, transient.pitch},
          {"yaw_deg", "deg", degrees, transient.yaw},
          {"teeter_deg", "deg", degrees, transient.teeter},
          {"speed", "rad/s", 1.0, transient.speed}};
}

}  // namespace

void require_followed_motions(const io::Case& input) {
  const analysis::TransientOptions& options = input.transient.options;
  for (const Motion& motion : motions_of(input.transient)) {
    if (!motion.curve) continue;
    const auto fault = math::find_jump(*motion.curve, options.duration, options.step);
    if (!fault) continue;
    const std::string place = input.path + ": transient." + motion.key + ": ";
    const std::string size = general(std::abs(fault->size) * motion.factor, 4) + " " + motion.unit;
    if (fault->kind == math::CurveFault::Kind::jump)
      throw InputError(place + "jumps, by " + size +
                       " within less than a step, at t = " + general(fault->time, 6) +
                       " s; hint: a table or a formula that takes several steps for it");
    throw InputError(place + "changes too fast for the steps: from t = " + general(fault->time, 6) +
                     " s on it is off the straight line by " + size + " within a step of " +
                     general(options.step, 6) + " s; hint: a smaller transient.step");
  }
}

std::vector<std::string> motion_notes(const io::Case& input) {
  const analysis::TransientOptions& options = input.transient.options;
  std::vector<std::string> notes;
  for (const Motion& motion : motions_of(input.transient)) {
    if (!motion.curve || motion.key == "speed") continue;
    if (const auto kink = math::find_kink(*motion.curve, options.duration, options.step))
      notes.push_back("transient." + motion.key +
                      ": the rate jumps at t = " + general(kink->time, 6) + " s by " +
                      general(std::abs(kink->size) * motion.factor, 4) + " " + motion.unit +
                      "/s: an impulse, whose loads depend on the step");
  }
  return notes;
}

}  // namespace samara::drivers
