// A rotor under torques that are constant between events: its speed is a line, and bends where an
// event is.
#include "samara/simulation/transient_simulation.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

#include "rotor.hpp"

using namespace samara;
using namespace samara::simulation;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

constexpr double rpm = 30.0 / std::numbers::pi;
constexpr double brake_torque = 200.0;  // [N m]
constexpr double loss_time = 0.4;       // [s]

/// Keeps all that a simulation gives.
class Keeper final : public TransientOutput {
 public:
  void row(double t, std::span<const double> values) override {
    time.push_back(t);
    speed.push_back(values[0] / rpm);
  }
  void checkpoint(const TransientState& state) override { checkpoints.push_back(state); }
  bool goes_on() override { return most_rows == 0 || time.size() < most_rows; }
  void note(const std::string& text) override { notes.push_back(text); }

  std::vector<double> time;
  std::vector<double> speed;  // [rad/s]
  std::vector<TransientState> checkpoints;
  std::vector<std::string> notes;
  std::size_t most_rows = 0;
};

turbine::TurbineEvent at(double time) {
  turbine::TurbineEvent event;
  event.trigger.time = time;
  return event;
}

/// The generator is lost at 0.4 s, the brake comes where the rotor turns at `level`.
Scenario protected_rotor(double level) {
  Scenario scenario = rigid_rotor();
  turbine::TurbineEvent loss = at(loss_time);
  loss.generator_off = true;
  turbine::TurbineEvent brake;
  brake.trigger.channel = "RotSpeed";
  brake.trigger.level = level * rpm;
  brake.brake = brake_torque;
  scenario.transient.events = {loss, brake};
  return scenario;
}

double speed_at_loss(double inertia) {
  return rotor_speed + loss_time * (rotor_torque - generator_torque) / inertia;
}

double brake_time(double level, double inertia) {
  return loss_time + (level - speed_at_loss(inertia)) / (rotor_torque / inertia);
}

/// The speed of the protected rotor.
double speed_at(double t, double level, double inertia) {
  if (t < loss_time) return rotor_speed + t * (rotor_torque - generator_torque) / inertia;
  const double braked = brake_time(level, inertia);
  if (t < braked) return speed_at_loss(inertia) + (t - loss_time) * rotor_torque / inertia;
  return level + (t - braked) * (rotor_torque - brake_torque) / inertia;
}

/// The brake's torque is smooth about rest, less by (0.01 / speed)^2 / 2; the first row is that of
/// a thousandth of a step later.
void check_speeds(const Keeper& rows, double level, double inertia, double offset = 0.0) {
  for (std::size_t i = 0; i < rows.time.size(); ++i) {
    const double t = rows.time[i] + offset;
    const bool is_smooth = i == 0 || t > brake_time(level, inertia);
    BOOST_TEST(rows.speed[i] == speed_at(t, level, inertia), tolerance(is_smooth ? 1e-5 : 1e-9));
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(transient_simulation)

BOOST_AUTO_TEST_CASE(events_bend_the_speed_where_they_come) {
  const double level = 6.5;
  const Scenario scenario = protected_rotor(level);
  const double inertia = total_inertia(scenario);
  TransientSimulation simulation(scenario);
  Keeper rows;
  BOOST_CHECK_THROW(simulation.run(rows), InputError);  // there is no start yet
  simulation.start(rows);
  const TransientSummary done = simulation.run(rows);
  BOOST_TEST((done.run.reason == analysis::TransientEnd::complete));
  BOOST_TEST(rows.time.size() == 101U);
  check_speeds(rows, level, inertia);
  BOOST_TEST(done.end.events[0] == 0.4);
  const double braked = 0.4 + (level - speed_at(0.4, level, inertia)) / (rotor_torque / inertia);
  BOOST_TEST(done.end.events[1] == braked, tolerance(1e-9));
  BOOST_TEST(done.ranges.at(0).rows == 101);
  BOOST_TEST(done.ranges[0].last == rows.speed.back() * rpm);
}

BOOST_AUTO_TEST_CASE(a_checkpoint_goes_on_as_the_run_did) {
  Scenario scenario = protected_rotor(6.5);
  scenario.transient.checkpoint = 0.3;
  TransientSimulation whole(scenario);
  Keeper rows;
  whole.start(rows);
  whole.run(rows);
  BOOST_TEST(rows.checkpoints.size() == 3U);
  const TransientState& state = rows.checkpoints[1];  // between the two events, or behind both
  BOOST_TEST(state.point.time == 0.6, tolerance(1e-12));
  TransientSimulation rest(scenario);
  rest.restart(scenario, state);
  Keeper more;
  const TransientSummary done = rest.run(more);
  BOOST_TEST(done.began == 0.6, tolerance(1e-12));
  BOOST_TEST(more.time.size() == 40U);
  for (std::size_t i = 0; i < more.time.size(); ++i) {
    BOOST_TEST(more.time[i] == rows.time[61 + i]);
    BOOST_TEST(more.speed[i] == rows.speed[61 + i]);
  }
  Scenario other = scenario;
  other.transient.options.step = 0.004;
  BOOST_CHECK_THROW(TransientSimulation(other).restart(scenario, state), InputError);
  other = scenario;
  other.transient.events.pop_back();
  BOOST_CHECK_THROW(TransientSimulation(other).restart(scenario, state), InputError);
  other = scenario;
  other.turbine.blades.beam.elements = 5;
  BOOST_CHECK_THROW(TransientSimulation(other).restart(scenario, state), InputError);
}

BOOST_AUTO_TEST_CASE(events_before_stay_done) {
  const double level = 6.5;
  const Scenario first = protected_rotor(level);
  TransientSimulation before(first);
  Keeper ignore;
  before.start(ignore);
  const TransientState end = before.run(ignore).end;
  Scenario second = first;
  second.transient.events.clear();
  TransientSimulation after(second);
  Keeper rows;
  after.start_after(first, end, rows);
  BOOST_TEST(rows.notes.size() == 2U);
  after.run(rows);
  check_speeds(rows, level, total_inertia(first), 1.0);
}

BOOST_AUTO_TEST_CASE(a_simulation_ends_once) {
  TransientSimulation simulation(rigid_rotor());
  Keeper rows;
  simulation.start(rows);
  simulation.run(rows);
  BOOST_CHECK_THROW(simulation.run(rows), InputError);
  Scenario other = rigid_rotor();
  other.turbine.hub.mass += 1.0;
  other.transient.options.duration = 2.0;
  TransientSimulation after(other);
  BOOST_CHECK_EXCEPTION(
      after.restart(simulation.scenario(), simulation.state()), InputError,
      [](const InputError& error) {
        return std::string(error.what()).starts_with("was run with another turbine");
      });
  other.transient.start = TransientOrigin::result;
  TransientSimulation none(other);
  BOOST_CHECK_THROW(none.start(rows), InputError);
}

BOOST_AUTO_TEST_CASE(the_output_may_end_it) {
  TransientSimulation simulation(rigid_rotor());
  Keeper rows;
  rows.most_rows = 12;
  simulation.start(rows);
  const TransientSummary done = simulation.run(rows);
  BOOST_TEST((done.run.reason == analysis::TransientEnd::observer));
  BOOST_TEST(rows.time.size() == 12U);
}

BOOST_AUTO_TEST_CASE(two_at_once_do_not_meet) {
  const Scenario scenario = rigid_rotor();
  Scenario other = scenario;
  other.turbine.shaft.rotor.torque = 20.0;
  TransientSimulation a(scenario);
  TransientSimulation b(other);
  Keeper rows_a;
  Keeper rows_b;
  a.start(rows_a);
  b.start(rows_b);
  b.run(rows_b);
  a.run(rows_a);
  const double inertia = total_inertia(scenario);
  BOOST_TEST(rows_a.speed.back() == rotor_speed + 30.0 / inertia, tolerance(1e-9));
  BOOST_TEST(rows_b.speed.back() == rotor_speed - 30.0 / inertia, tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(names_that_are_none_are_refused) {
  Scenario scenario = rigid_rotor();
  scenario.transient.channels = {"RotSped"};
  BOOST_CHECK_EXCEPTION(TransientSimulation{scenario}, InputError, [](const InputError& error) {
    return std::string(error.what()).starts_with("transient.output.channels: ");
  });
}

BOOST_AUTO_TEST_SUITE_END()
