// Scenarios built in C++, and what is wrong with them.
#include "samara/simulation/validation.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

#include "rotor.hpp"

using namespace samara;
using namespace samara::simulation;
using namespace samara::test;

namespace {

std::vector<std::string> fields_of(const Scenario& scenario, Analysis analysis) {
  std::vector<std::string> fields;
  for (const Fault& fault : validate(scenario, analysis)) {
    BOOST_TEST(!fault.text.empty());
    fields.push_back(fault.field);
  }
  return fields;
}

void check(const Scenario& scenario, Analysis analysis, const std::vector<std::string>& expected) {
  BOOST_TEST(fields_of(scenario, analysis) == expected, boost::test_tools::per_element());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(validation)

BOOST_AUTO_TEST_CASE(a_sound_scenario_has_no_fault) {
  for (const Analysis analysis : {Analysis::check, Analysis::modes, Analysis::trim,
                                  Analysis::floquet, Analysis::transient, Analysis::linearize})
    check(rigid_rotor(), analysis, {});
}

BOOST_AUTO_TEST_CASE(analyses_ask_for_a_speed_or_for_rest) {
  Scenario scenario = rigid_rotor();
  check(scenario, Analysis::statics, {"shaft.speed"});
  scenario.turbine.shaft.speed = 0.0;
  check(scenario, Analysis::statics, {});
  check(scenario, Analysis::floquet, {"shaft.speed"});
  scenario.transient.options.duration = 0.0;
  check(scenario, Analysis::transient, {""});
}

BOOST_AUTO_TEST_CASE(all_faults_are_found_at_once) {
  Scenario scenario = rigid_rotor();
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.blades.count = 3;
  turbine.hub.teeter.kind = model::JointKind::free;
  turbine.shaft.gear_ratio = 0.0;
  turbine.blades.hinges = {{model::HingeAxis::lag, 0.4, {}, 0.1},
                           {model::HingeAxis::lag, 0.2, {}, 0.0}};
  turbine.blades.each[4].pitch = 0.1;
  model::LoadDefinition load;
  load.on_tower = true;
  load.variation.amplitude = 1.0;
  load.variation.frequency = 2.0;
  turbine.loads = {load};
  check(scenario, Analysis::check,
        {"shaft.gear_ratio", "hub.teeter.joint", "blades.hinges[0].delta3_deg",
         "blades.hinges[1].axis", "blades.hinges", "blades.each", "loads[0].beam"});
  const std::vector<std::string> steady = fields_of(scenario, Analysis::trim);
  BOOST_TEST(std::ranges::count(steady, "loads[0]") == 1);
  BOOST_CHECK_EXCEPTION(require_none(validate(scenario, Analysis::check), "rotor"), InputError,
                        [](const InputError& error) {
                          const std::string text = error.what();
                          return std::ranges::count(text, '\n') == 6 &&
                                 text.starts_with("rotor: shaft.gear_ratio: ");
                        });
}

BOOST_AUTO_TEST_CASE(numbers_out_of_their_range_are_faults) {
  Scenario scenario = rigid_rotor();
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.hub.mass = -3.0;
  turbine.shaft.tilt = 2.0;
  turbine.blades.beam.order = 0;
  turbine.blades.beam.sections[0].mass(0, 0) = std::numeric_limits<double>::quiet_NaN();
  turbine.shaft.generator.inertia = 1e31;
  scenario.trim.harmonics = -1;
  scenario.transient.options.step_tolerance = 1.0;
  const std::vector<Fault> faults = validate(scenario, Analysis::check);
  check(scenario, Analysis::check,
        {"shaft.tilt_deg", "shaft.generator.own_inertia", "hub.mass", "blades.order",
         "blades.sections[0].mass_matrix", "trim.harmonics", "transient.step_tolerance"});
  BOOST_TEST(faults[0].text == "expected an angle between -90 and 90 degrees, got 114.592");
  BOOST_TEST(faults[2].text == "expected a number >= 0, got -3");
}

BOOST_AUTO_TEST_CASE(what_only_a_program_can_state_is_checked) {
  Scenario scenario = rigid_rotor();
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.shaft.generator.kind = model::JointKind::prescribed;
  turbine.shaft.rotor.table = {{5.0, 1.0}, {7.0, 2.0}};
  check(scenario, Analysis::check, {"shaft.generator.joint", "shaft.rotor.torque_table"});
  scenario = rigid_rotor();
  scenario.turbine.blades.beam.modal_damping[0] = 0.01;  // of a rigid blade
  check(scenario, Analysis::check, {"blades.damping"});
  scenario = rigid_rotor();
  scenario.transient.output_steps = 0;
  scenario.transient.events.resize(1);
  scenario.transient.events[0].trigger.time = 2.0;
  check(scenario, Analysis::transient,
        {"transient.output.every", "transient.events[0]", "transient.events[0].at"});
}

BOOST_AUTO_TEST_CASE(a_trim_has_the_harmonics_of_what_drives_it) {
  Scenario scenario = rigid_rotor();
  model::PrescribedMotion& motion = scenario.turbine.nacelle.yaw.motion;
  scenario.turbine.nacelle.yaw.kind = model::JointKind::prescribed;
  motion.amplitude = 0.1;
  motion.per_rev = 6;
  BOOST_TEST(highest_harmonic(scenario.turbine) == 6);
  BOOST_TEST(trim_options(scenario).least_harmonics == 6);
  check(scenario, Analysis::trim, {"nacelle.yaw.harmonic.per_rev"});
  scenario.trim.harmonics = 6;
  check(scenario, Analysis::trim, {});
  scenario.trim.automatic = true;
  motion.per_rev = 61;
  check(scenario, Analysis::trim, {"nacelle.yaw.harmonic.per_rev"});
  motion.per_rev = 0;
  motion.frequency = 3.0;
  check(scenario, Analysis::trim, {"nacelle.yaw"});
}

BOOST_AUTO_TEST_CASE(a_root_that_moves_has_inertia) {
  Scenario scenario = rigid_rotor();
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.has_tower = true;
  turbine.tower = turbine.blades.beam;
  turbine.tower.support.rigid = {false, true, true, true, true, true};
  turbine.tower.support.stiffness(0, 0) = 1e6;
  check(scenario, Analysis::modes, {"tower.support"});
  turbine.tower.support.mass = 5.0;
  check(scenario, Analysis::modes, {});
}

BOOST_AUTO_TEST_CASE(a_transient_can_follow_what_is_prescribed) {
  Scenario scenario = rigid_rotor();
  scenario.transient.speed = math::TimeCurve::through({{0.0, 6.0}, {1.0, 6.0}});
  check(scenario, Analysis::transient, {"transient.speed"});  // the generator is free
  scenario.turbine.shaft.generator.kind = model::JointKind::locked;
  check(scenario, Analysis::transient, {});
  scenario.transient.speed.reset();
  scenario.transient.pitch =
      math::TimeCurve::through({{0.0, 0.0}, {0.5, 0.0}, {0.501, 1.0}, {1.0, 1.0}});
  check(scenario, Analysis::transient, {"transient.pitch_deg"});
  scenario.transient.pitch = math::TimeCurve::formula("0.1*abs(t-0.5)");
  check(scenario, Analysis::transient, {});
  BOOST_TEST(transient_notes(scenario).size() == 1U);  // the rate jumps
  scenario.transient.options.step = 0.1;
  scenario.transient.pitch.reset();
  BOOST_TEST(transient_notes(scenario).size() == 1U);  // 10 steps a revolution
  turbine::TurbineEvent event;
  event.trigger.time = 0.5;
  event.brake = 10.0;
  scenario.transient.events = {event};
  check(scenario, Analysis::transient, {"transient.events[0]"});
}

BOOST_AUTO_TEST_SUITE_END()
