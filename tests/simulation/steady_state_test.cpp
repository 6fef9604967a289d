// Steady states that cannot be, and why.
#include "samara/simulation/steady_state.hpp"

#include <numbers>
#include <string>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

#include "rotor.hpp"

using namespace samara;
using namespace samara::simulation;
using namespace samara::test;

namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// A rotor that gives 30 N m more than its generator takes, 400 N m less for each rad of pitch.
Scenario controlled(double highest) {
  Scenario scenario = rigid_rotor();
  model::TurbineDefinition& turbine = scenario.turbine;
  turbine.shaft.rotor_pitch_slope = -400.0;
  turbine.controller.emplace();
  turbine.controller->filter = 2.0;
  turbine.controller->pitch = model::ControlLoop{0.01, 0.002};
  turbine.blades.actuator.emplace();
  turbine.blades.actuator->frequency = 6.0;
  turbine.blades.actuator->damping_ratio = 0.7;
  turbine.blades.actuator->highest = highest;
  return scenario;
}

analysis::Trim trim_of(const Scenario& scenario, analysis::TrimMethod method) {
  const turbine::TurbineSystem system(model::build_turbine(scenario.turbine), PETSC_COMM_SELF);
  analysis::TrimOptions options = trim_options(scenario);
  options.method = method;
  analysis::Observer observer;
  return solve_trim(scenario, system, options, observer);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(steady_states)

BOOST_AUTO_TEST_CASE(a_limit_that_the_controller_cannot_pass_is_named) {
  // 30/400 rad are 4.297 degrees.
  for (const analysis::TrimMethod method :
       {analysis::TrimMethod::harmonic_balance, analysis::TrimMethod::shooting}) {
    BOOST_CHECK_NO_THROW(trim_of(controlled(5.0 * degree), method));
    BOOST_CHECK_EXCEPTION(trim_of(controlled(4.0 * degree), method), ConvergenceError,
                          [](const ConvergenceError& error) {
                            const std::string text = error.what();
                            BOOST_TEST_MESSAGE(text);
                            return text.find("needs a pitch of 4.297 deg") != std::string::npos &&
                                   text.find("highest_deg is 4:") != std::string::npos;
                          });
  }
}

// The pitch needed is -4.297 degrees; a gain schedule of K allows -K/2.
BOOST_AUTO_TEST_CASE(a_pitch_out_of_reach_of_the_gain_schedule_is_named) {
  Scenario scenario = controlled(90.0 * degree);
  scenario.turbine.shaft.rotor_pitch_slope = 400.0;
  scenario.turbine.controller->pitch = model::ControlLoop{-0.01, -0.002};
  scenario.turbine.controller->schedule = 10.0 * degree;
  BOOST_CHECK_NO_THROW(trim_of(scenario, analysis::TrimMethod::harmonic_balance));
  scenario.turbine.controller->schedule = 8.0 * degree;
  BOOST_CHECK_EXCEPTION(trim_of(scenario, analysis::TrimMethod::harmonic_balance), ConvergenceError,
                        [](const ConvergenceError& error) {
                          const std::string text = error.what();
                          BOOST_TEST_MESSAGE(text);
                          return text.find("needs a pitch of -4.297 deg") != std::string::npos &&
                                 text.find("allows none below -4:") != std::string::npos;
                        });
}

BOOST_AUTO_TEST_SUITE_END()
