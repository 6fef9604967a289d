// A controller that is called at fixed instants, on a rotor whose speed has a closed form.
#include "samara/simulation/stepped_controller.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/simulation/transient_simulation.hpp"
#include "samara/simulation/validation.hpp"

#include "rotor.hpp"

using namespace samara;
using namespace samara::simulation;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

constexpr double rpm = 30.0 / std::numbers::pi;
constexpr double degree = std::numbers::pi / 180.0;

class Keeper final : public TransientOutput {
 public:
  void row(double t, std::span<const double> values) override {
    time.push_back(t);
    rows.emplace_back(values.begin(), values.end());
  }

  std::vector<double> time;
  std::vector<std::vector<double>> rows;
};

/// Demands functions of the time.
class Plan final : public SteppedController {
 public:
  ControlDemand call(const ControlMeasurement& measured) override {
    calls.push_back(measured);
    ControlDemand demand;
    demand.torque = torque(measured.time);
    demand.pitch.assign(measured.pitch.size(), pitch(measured.time));
    return demand;
  }

  std::function<double(double)> torque = [](double) { return generator_torque; };
  std::function<double(double)> pitch = [](double) { return 0.0; };
  std::vector<ControlMeasurement> calls;
};

Scenario controlled_rotor(double interval) {
  Scenario scenario = rigid_rotor();
  scenario.transient.channels = {"RotSpeed", "BldPitch1", "GenTq"};
  scenario.transient.controller.emplace();
  scenario.transient.controller->step = interval;
  return scenario;
}

void run(const Scenario& scenario, Plan& plan, Keeper& rows) {
  TransientSimulation simulation(scenario);
  simulation.start(rows);
  const TransientSummary done = simulation.run(rows, &plan);
  BOOST_TEST((done.run.reason == analysis::TransientEnd::complete));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(stepped_controller)

BOOST_AUTO_TEST_CASE(calls_come_at_their_instants_with_the_state_there) {
  Plan plan;
  const Scenario scenario = controlled_rotor(0.05);
  Keeper rows;
  run(scenario, plan, rows);
  BOOST_TEST(plan.calls.size() == 21U);
  using Call = ControlMeasurement::Call;
  BOOST_TEST((plan.calls.front().call == Call::first));
  BOOST_TEST((plan.calls.back().call == Call::last));
  for (std::size_t i = 0; i < plan.calls.size(); ++i) {
    const ControlMeasurement& now = plan.calls[i];
    BOOST_TEST(now.time == 0.05 * static_cast<double>(i), tolerance(1e-12));
    BOOST_TEST(now.interval == 0.05, tolerance(1e-12));
    if (i == 0) continue;
    BOOST_TEST((i + 1 == plan.calls.size() || now.call == Call::next));
    BOOST_TEST(now.rotor_speed == rows.rows[5 * i][0] / rpm, tolerance(1e-12));
    BOOST_TEST(now.generator_torque == 1e3 * rows.rows[5 * i][2], tolerance(1e-12));
  }
}

// A torque that is held is the law's own torque: the rotor's torque alone accelerates, and a step
// of the torque acts from its call on. BDF2 forgets a half of a step of it.
BOOST_AUTO_TEST_CASE(a_held_torque_replaces_the_law_of_the_generator) {
  const double change = 20.0;
  const double at = 0.5;
  for (const bool is_midpoint : {false, true}) {
    Scenario scenario = controlled_rotor(0.1);
    if (is_midpoint) scenario.transient.options.method = analysis::TransientMethod::midpoint;
    Plan plan;
    plan.torque = [&](double t) { return generator_torque + (t > at - 1e-6 ? change : 0.0); };
    Keeper rows;
    run(scenario, plan, rows);
    const double inertia = total_inertia(scenario);
    const double late = is_midpoint ? 0.0 : 0.5 * scenario.transient.options.step;
    const double t = rows.time.back();
    const double speed = rotor_speed + (rotor_torque - generator_torque) * t / inertia -
                         change * (t - at - late) / inertia;
    BOOST_TEST(rows.rows.back()[0] / rpm == speed, tolerance(1e-9));
    BOOST_TEST(1e3 * rows.rows.back()[2] == generator_torque + change, tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(a_lost_generator_has_no_demanded_torque) {
  Scenario scenario = controlled_rotor(0.1);
  turbine::TurbineEvent loss;
  loss.trigger.time = 0.32;
  loss.generator_off = true;
  scenario.transient.events = {loss};
  Plan plan;
  Keeper rows;
  run(scenario, plan, rows);
  BOOST_TEST(std::abs(rows.rows.back()[2]) < 1e-9);
  BOOST_TEST(1e3 * rows.rows[31][2] == generator_torque, tolerance(1e-6));
}

// The pitch arrives; its rate is continuous and has its limit.
BOOST_AUTO_TEST_CASE(a_prescribed_pitch_follows_its_demand_smoothly) {
  const double interval = 0.05;
  const double limit = 10.0 * degree;
  const double step = 0.01;
  Scenario scenario = controlled_rotor(interval);
  scenario.turbine.blades.each[2].pitch = 0.5 * degree;
  scenario.transient.channels = {"BldPitch1", "BldPitch2"};
  scenario.transient.controller->pitch_rate = limit;
  Plan plan;
  plan.pitch = [](double t) { return t < 0.19 ? 0.0 : t < 0.69 ? 3.0 * degree : 2.9 * degree; };
  Keeper rows;
  run(scenario, plan, rows);
  std::vector<double> rates;
  for (std::size_t i = 1; i < rows.rows.size(); ++i) {
    rates.push_back((rows.rows[i][0] - rows.rows[i - 1][0]) * degree / step);
    // The second blade has an offset, which the controller does not see.
    BOOST_TEST(rows.rows[i][1] - rows.rows[i][0] == 0.5, tolerance(1e-9));
  }
  BOOST_TEST(std::ranges::max(rates) == limit, tolerance(1e-9));
  // From no rate to the limit takes an interval.
  for (std::size_t i = 1; i < rates.size(); ++i)
    BOOST_TEST(std::abs(rates[i] - rates[i - 1]) < limit * step / interval * (1.0 + 1e-9));
  BOOST_TEST(rows.rows[65][0] == 3.0, tolerance(1e-9));
  BOOST_TEST(rows.rows.back()[0] == 2.9, tolerance(1e-9));
  for (const ControlMeasurement& now : plan.calls)
    BOOST_TEST(now.pitch[0] == now.pitch[1], tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(a_controller_and_its_setup_belong_together) {
  Keeper rows;
  Plan plan;
  TransientSimulation without(rigid_rotor());
  without.start(rows);
  BOOST_CHECK_THROW(without.run(rows, &plan), InputError);
  TransientSimulation simulation(controlled_rotor(0.1));
  simulation.start(rows);
  BOOST_CHECK_THROW(simulation.run(rows), InputError);
  Scenario locked = controlled_rotor(0.1);
  locked.turbine.shaft.generator.kind = model::JointKind::locked;
  BOOST_TEST(validate(locked, Analysis::transient).size() == 1U);
  BOOST_TEST(validate(controlled_rotor(0.015), Analysis::transient).size() == 1U);
}

BOOST_AUTO_TEST_SUITE_END()
