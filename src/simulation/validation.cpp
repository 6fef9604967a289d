#include "samara/simulation/validation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "samara/analysis/shooting.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/base/format.hpp"
#include "samara/math/curve_faults.hpp"
#include "samara/model/turbine.hpp"
#include "samara/model/validation.hpp"
#include "samara/simulation/scenario_fields.hpp"

namespace samara::simulation {
namespace {

using model::JointKind;

constexpr double least_steps_a_revolution = 40.0;

/// A prescribed motion of a transient.
struct Motion {
  std::string key;
  std::string unit;
  double factor = 1.0;  ///< from SI to `unit`
  const std::optional<math::TimeCurve>& curve;
};

/// Prescribed motions, angles first.
std::vector<Motion> motions_of(const TransientSetup& transient) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  return {{"pitch_deg", "deg", degrees, transient.pitch},
          {"yaw_deg", "deg", degrees, transient.yaw},
          {"teeter_deg", "deg", degrees, transient.teeter},
          {"speed", "rad/s", 1.0, transient.speed}};
}

std::string indexed(const std::string& list, std::size_t i) {
  return list + "[" + std::to_string(i) + "]";
}

class Validation {
 public:
  explicit Validation(const Scenario& scenario)
      : scenario_(scenario), turbine_(scenario.turbine), faults_(find_range_faults(scenario)) {
    // Further faults at a number that is out of its range are not reported.
    const std::vector<Fault> ranges = faults_;
    for (const Fault& fault : model::find_faults(turbine_))
      if (std::ranges::none_of(ranges, [&fault](const Fault& range) {
            return is_within(range.field, fault.field) || is_within(fault.field, range.field);
          }))
        faults_.push_back(fault);
    if (!faults_.empty()) return;
    model::TurbineDefinition completed = turbine_;
    faults_ = model::complete(completed);
  }

  std::vector<Fault> find(Analysis analysis) {
    // The transient block of a case is checked for every analysis.
    if (analysis != Analysis::transient && scenario_.transient.options.duration > 0.0) {
      check_curves();
      for (std::size_t i = 0; i < scenario_.transient.events.size(); ++i) check_event(i);
      check_library();
    }
    switch (analysis) {
      case Analysis::check:
        break;
      case Analysis::statics:
        check_rest();
        break;
      case Analysis::modes:
        check_steady();
        check_search();
        break;
      case Analysis::trim:
        check_steady();
        break;
      case Analysis::linearize:
        check_steady();
        if (scenario_.linearize.options.multiblade && turbine_.blades.count < 3)
          add("linearize.forms",
              "multiblade coordinates are for three and more blades; hint: lyapunov_floquet, hill");
        break;
      case Analysis::floquet:
        check_period();
        check_steady();
        break;
      case Analysis::transient:
        check_transient();
        check_inflow();
        break;
      case Analysis::operate:
        check_steady();
        check_operation();
        break;
      case Analysis::campbell:
        check_steady();
        check_operation();
        check_search();
        break;
    }
    return std::move(faults_);
  }

 private:
  void add(const std::string& field, const std::string& text) { faults_.push_back({field, text}); }

  void check_rest() {
    if (turbine_.shaft.speed != 0.0)
      add("shaft.speed",
          "must be 0: samara static needs a rotor at rest; hint: use samara trim, or --set "
          "shaft.speed=0");
  }

  void check_wind(const model::WindChange& wind) {
    const double duration = scenario_.transient.options.duration;
    if (!turbine_.wind || !turbine_.aero) {
      add("transient.wind", "there is no air; hint: a case with wind and blades.aero_sections");
      return;
    }
    const bool has_shear = turbine_.wind->shear_length > 0.0;
    if ((wind.shear_left || wind.shear_up) && !has_shear)
      add("wind.shear.length", "missing key \"length\" of the shears of transient.wind");
    const bool has_power = turbine_.wind->profile == model::WindDefinition::Profile::power &&
                           turbine_.wind->height > 0.0;
    if (wind.exponent && !has_power)
      add("transient.wind.power", "needs the power law; hint: wind.shear.power and wind.height");
    if (wind.standard && !(turbine_.wind->speed > 0.0))
      add("transient.wind.gust", "needs a mean wind; hint: wind.speed");
    if (wind.standard && !(wind.standard->start < duration))
      add("transient.wind.gust.start", "never comes: transient.duration is " +
                                           general(duration, 6) +
                                           " s; hint: an earlier start or a longer duration");
    const bool is_hawc = wind.box_path.size() == 3;
    if (is_hawc && !(turbine_.wind->speed > 0.0))
      add("transient.wind.box", "needs the speed with which it moves; hint: wind.speed");
    if (wind.box_path.size() == 1 && (wind.speed || wind.standard || !wind.table_path.empty()))
      add("transient.wind.box",
          "has the whole wind; hint: leave out speed, gust and table, or take a box of HAWC2");
  }

  void check_inflow() {
    if (turbine_.aero && turbine_.aero->inflow == model::Inflow::frozen)
      add("aero.inflow",
          "frozen is for small motions about a steady state; hint: oye or equilibrium");
  }

  void check_operation() {
    const model::OperatingPointsDefinition& operation = scenario_.operation;
    if (!turbine_.wind || !turbine_.aero) {
      add("wind",
          "operating points need wind and blades with blades.aero_sections; hint: --set "
          "wind.speed=8");
      return;
    }
    if (operation.wind_speeds.empty() && operation.table_path.empty() &&
        !(turbine_.wind->speed > 0.0))
      add("operation.wind_speeds", "missing; hint: --set operation.wind_speeds=[4,6,8,10]");
    const bool has_law = operation.torque_gain > 0.0 || !operation.torque_table.empty();
    if (!operation.table_path.empty()) {
      if (has_law || operation.rated_speed > 0.0 || operation.rated_power > 0.0 ||
          operation.least_speed > 0.0)
        add("operation.table", "gives speed and pitch; hint: leave out speeds, power and torque");
      return;
    }
    if (!(operation.rated_speed > 0.0))
      add("operation", "missing key \"rated_speed\" or \"rated_speed_rpm\"; hint: or table");
    else if (operation.least_speed >= operation.rated_speed)
      add("operation.least_speed", "must be below the rated speed");
    if (!(operation.rated_power > 0.0)) add("operation", "missing key \"rated_power\"");
    if (!has_law)
      add("operation",
          "missing key \"torque_gain\" or \"torque_table\": the torque of the "
          "generator below the rated speed");
  }

  /// Floquet theory needs a period.
  void check_period() {
    if (turbine_.shaft.speed == 0.0)
      add("shaft.speed",
          "must not be 0: a parked rotor has no period; hint: use samara modes, or "
          "--set "
          "shaft.speed=...");
    check_search();
  }

  void check_search() {
    if (scenario_.floquet.near_hz && scenario_.floquet.modes == 0)
      add("floquet.near_hz", "needs floquet.modes, the number of modes to find");
    if (scenario_.floquet.least_damped > 0 && scenario_.floquet.modes > 0)
      add("floquet.least_damped",
          "and floquet.modes exclude each other; hint: leave one of them out");
    if (scenario_.floquet.search != analysis::ModeSearch::automatic &&
        !analysis::asks_for_some(scenario_.floquet))
      add("floquet.search", "needs floquet.modes or floquet.least_damped");
    check_count("floquet.modes", scenario_.floquet.modes);
    check_count("floquet.least_damped", scenario_.floquet.least_damped);
  }

  /// A search for more modes than there are does not end soon.
  void check_count(const std::string& field, int count) {
    if (count == 0 || !faults_.empty()) return;
    const int all = model::build_turbine(turbine_).degrees_of_freedom;
    if (count > all)
      add(field, "is " + std::to_string(count) + ", the turbine has " + std::to_string(all) +
                     " degrees of freedom; hint: leave it out, for all modes");
  }

  /// Checks that loads and prescribed motions are constant or periodic with the rotor, and that the
  /// root of a beam has inertia where it may move.
  void check_steady() {
    for (std::size_t i = 0; i < turbine_.loads.size(); ++i) {
      const model::LoadVariation& variation = turbine_.loads[i].variation;
      const std::string place = indexed("loads", i);
      if (!variation.is_constant() && (!variation.table.empty() || variation.per_rev == 0))
        add(place,
            "does not repeat with the rotor; hint: harmonic: {per_rev: ...}; samara static takes "
            "the loads at t = 0, samara transient any with transient.start: undeformed or "
            "RESULT.h5");
      check_harmonics(place, variation.per_rev);
    }
    check_motion("nacelle.yaw", turbine_.nacelle.yaw.motion);
    check_motion("hub.teeter", turbine_.hub.teeter.motion);
    for (std::size_t i = 0; i < turbine_.blades.hinges.size(); ++i)
      check_motion(indexed("blades.hinges", i), turbine_.blades.hinges[i].joint.motion);
    if (turbine_.has_tower) check_mass("tower.support", turbine_.tower.support);
    check_mass("blades.support", turbine_.blades.beam.support);
  }

  void check_motion(const std::string& joint, const model::PrescribedMotion& motion) {
    if (!motion.is_constant() && motion.per_rev == 0)
      add(joint,
          "does not repeat with the rotor; hint: harmonic: {per_rev: ...}, or samara static, which "
          "takes its angle at t = 0");
    check_harmonics(joint, motion.per_rev);
  }

  /// A trim must include the harmonics of its excitation.
  void check_harmonics(const std::string& place, int per_rev) {
    if (turbine_.shaft.speed == 0.0) return;
    const analysis::TrimOptions& trim = scenario_.trim;
    const bool shoots = trim.method == analysis::TrimMethod::shooting;
    const int most = shoots           ? analysis::shooting_harmonics(trim.steps)
                     : trim.automatic ? analysis::auto_harmonics
                                      : trim.harmonics;
    if (per_rev <= most) return;
    const std::string bound =
        shoots           ? "the " + std::to_string(most) + " harmonics of trim.method: shooting"
        : trim.automatic ? "the " + std::to_string(most) + " harmonics of trim.harmonics: auto"
                         : "trim.harmonics";
    add(place + ".harmonic.per_rev",
        std::to_string(per_rev) + ", more than " + bound + "; hint: " +
            (shoots ? "more trim.steps, or trim.method: harmonic_balance"
                    : "--set trim.harmonics=" + std::to_string(per_rev)));
  }

  /// The root of a beam needs inertia in every direction that it can move in.
  void check_mass(const std::string& key, const model::SupportDefinition& support) {
    bool displaces = false;
    bool turns = false;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!support.rigid[at] && !(support.mass + support.added_mass(i) > 0.0)) displaces = true;
      if (!support.rigid[3 + at] && !(support.inertia(i) + support.added_mass(3 + i) > 0.0))
        turns = true;
    }
    if (displaces)
      add(key,
          "may move without a mass; hint: give the mass and inertia of the body on the springs "
          "(a foundation, a bearing); samara static needs none");
    if (turns)
      add(key,
          "may turn about an axis without inertia; hint: instead of clamped or pinned give "
          "stiffness: "
          "{theta1: free, ...} with inertia: [I1, I2, I3], > 0 where it may turn; samara static "
          "needs none");
  }

  void check_transient() {
    const TransientSetup& transient = scenario_.transient;
    if (!(transient.options.duration > 0.0)) {
      add("", "missing key \"transient\"; hint: --set \"transient={duration: 60, step: 0.01}\"");
      return;
    }
    if (!(transient.options.step > 0.0 && transient.options.step <= transient.options.duration)) {
      add("transient.step", "expected a number > 0, transient.duration at the most");
      return;
    }
    if (transient.output_steps < 1)
      add("transient.output.every", "expected a multiple of transient.step");
    if (transient.start == TransientOrigin::trim) check_steady();
    check_curves();
    if (transient.wind) check_wind(*transient.wind);
    for (std::size_t i = 0; i < transient.events.size(); ++i) check_event(i);
    check_library();
    for (std::size_t i = 0; i < turbine_.loads.size(); ++i) {
      const auto& table = turbine_.loads[i].variation.table;
      if (!table.empty() &&
          (table.front().first > 0.0 || table.back().first < transient.options.duration))
        add(indexed("loads", i) + ".table", "does not cover the run, from 0 to " +
                                                general(transient.options.duration, 6) +
                                                " s; hint: entries at the start and at the end");
    }
    for (const Motion& motion : motions_of(transient)) check_followed(motion);
  }

  bool is_free() const { return turbine_.shaft.generator.kind == JointKind::free; }

  bool has_blades(const std::string& field) {
    if (turbine_.blades.count == 0)
      add(field, "there are no blades; hint: loads and nacelle.yaw move a tower alone");
    return turbine_.blades.count > 0;
  }

  void check_curves() {
    const TransientSetup& transient = scenario_.transient;
    if (transient.speed && has_blades("transient.speed") && is_free())
      add("transient.speed",
          "the generator is free, its torque determines the speed; hint: shaft.generator.joint: "
          "locked");
    if (transient.yaw && turbine_.nacelle.yaw.kind != JointKind::prescribed)
      add("transient.yaw_deg", "only a joint: prescribed has a motion");
    if (transient.teeter && turbine_.hub.teeter.kind != JointKind::prescribed)
      add("transient.teeter_deg", "only a joint: prescribed has a motion");
    if (transient.pitch && has_blades("transient.pitch_deg"))
      check_pitch_loop("transient.pitch_deg");
  }

  void check_event(std::size_t i) {
    const turbine::TurbineEvent& event = scenario_.transient.events[i];
    const std::string place = indexed("transient.events", i);
    if (!has_blades(place)) return;
    if (!event.pitch && !event.generator_off && event.brake == 0.0)
      add(place, "has no effect; expected pitch, generator_off or brake");
    if (event.trigger.time && !(*event.trigger.time < scenario_.transient.options.duration))
      add(place + ".at", "never comes: transient.duration is " +
                             general(scenario_.transient.options.duration, 6) + " s");
    if (!is_free() && (event.brake > 0.0 || event.generator_off))
      add(place, "the generator is locked and takes any torque; hint: shaft.generator.joint: free");
    if (!event.pitch) return;
    if (event.pitch->blade > turbine_.blades.count)
      add(place + ".pitch.blade",
          "there is no such blade, there are " + std::to_string(turbine_.blades.count));
    check_pitch_loop(place + ".pitch");
  }

  /// A controller library has the whole pitch and the whole torque.
  void check_library() {
    if (!scenario_.transient.controller || !has_blades("transient.controller")) return;
    const ControllerSetup& controller = *scenario_.transient.controller;
    constexpr int most_individual = 3;
    if (!is_free())
      add("transient.controller",
          "sets the torque of the generator, which is locked; hint: shaft.generator.joint: free");
    if (turbine_.controller)
      add("controller", "and transient.controller exclude each other; hint: leave one of them out");
    if (scenario_.transient.pitch)
      add("transient.pitch_deg", "transient.controller sets the pitch; hint: leave out pitch_deg");
    if (controller.is_individual && turbine_.blades.count > most_individual)
      add("transient.controller.individual_pitch",
          "has demands of three blades at the most, there are " +
              std::to_string(turbine_.blades.count));
    const double calls = controller.step / scenario_.transient.options.step;
    if (controller.step < 0.0 || std::abs(calls - std::round(calls)) > 1e-6)
      add("transient.controller.step", "expected a multiple of transient.step");
  }

  void check_pitch_loop(const std::string& field) {
    if (turbine_.controller && turbine_.controller->pitch && turbine_.shaft.speed != 0.0)
      add(field,
          "controller.pitch sets the pitch, it differs from that of the case when this begins; "
          "hint: a case without controller.pitch");
  }

  /// Finds a fault of a motion that the steps cannot follow.
  void check_followed(const Motion& motion) {
    const analysis::TransientOptions& options = scenario_.transient.options;
    if (!motion.curve) return;
    const auto fault = math::find_jump(*motion.curve, options.duration, options.step);
    if (!fault) return;
    const std::string size = general(std::abs(fault->size) * motion.factor, 4) + " " + motion.unit;
    if (fault->kind == math::CurveFault::Kind::jump)
      add("transient." + motion.key,
          "jumps, by " + size + " within less than a step, at t = " + general(fault->time, 6) +
              " s; hint: a table or a formula with a change over several steps");
    else
      add("transient." + motion.key,
          "changes too fast for the steps: from t = " + general(fault->time, 6) +
              " s on it is off the straight line by " + size + " within a step of " +
              general(options.step, 6) + " s; hint: a smaller transient.step");
  }

  const Scenario& scenario_;
  const model::TurbineDefinition& turbine_;
  std::vector<Fault> faults_;
};

/// Note on too few steps per revolution for the loads that repeat with it; empty: there are enough.
std::string step_note(const Scenario& scenario) {
  const analysis::TransientOptions& options = scenario.transient.options;
  double speed = std::abs(scenario.turbine.shaft.speed);
  if (scenario.transient.speed)
    for (double t = 0.0; t <= options.duration; t += std::max(options.step, options.duration / 1e3))
      speed = std::max(speed, std::abs(scenario.transient.speed->at(t).value));
  if (speed == 0.0) return "";
  const double steps = 2.0 * std::numbers::pi / (speed * options.step);
  if (steps >= least_steps_a_revolution) return "";
  return "transient.step: " + general(steps, 3) + " steps a revolution at " + general(speed, 4) +
         " rad/s, fewer than " + general(least_steps_a_revolution, 3) + "; motions faster than " +
         general(1.0 / (steps_a_cycle * options.step), 3) + " Hz have fewer than " +
         general(steps_a_cycle, 3) + " steps a cycle";
}

}  // namespace

std::vector<Fault> validate(const Scenario& scenario, Analysis analysis) {
  return Validation(scenario).find(analysis);
}

std::vector<std::string> transient_notes(const Scenario& scenario) {
  const analysis::TransientOptions& options = scenario.transient.options;
  std::vector<std::string> notes;
  for (const Motion& motion : motions_of(scenario.transient)) {
    if (!motion.curve || motion.key == "speed") continue;
    if (const auto kink = math::find_kink(*motion.curve, options.duration, options.step))
      notes.push_back("transient." + motion.key +
                      ": the rate jumps at t = " + general(kink->time, 6) + " s by " +
                      general(std::abs(kink->size) * motion.factor, 4) + " " + motion.unit +
                      "/s: an impulse, whose loads depend on the step");
  }
  if (const std::string note = step_note(scenario); !note.empty()) notes.push_back(note);
  return notes;
}

}  // namespace samara::simulation
