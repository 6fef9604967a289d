// Control of the generator's speed by torque and by pitch, with and without actuators, against the
// characteristic polynomials of a rigid rotor.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/base/format.hpp"
#include "samara/linear/linear_model.hpp"
#include "samara/simulation/validation.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_input_output.hpp"

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

constexpr double gear = 97.0;
constexpr double slope = 1e6;    ///< of the rotor's torque, downward [N m s/rad]
constexpr double pitched = 5e7;  ///< the same by the pitch [N m/rad]
constexpr double corner = 1.570796;

/// A rigid rotor that turns at 1.2 rad/s without gravity.
std::string rotor(const std::string& controls, const std::string& blades = "") {
  return "samara: 1\ngravity: 0\nshaft:\n  speed: 1.2\n  gear_ratio: 97\n"
         "  generator: {joint: free, own_inertia: 500}\n"
         "  rotor: {torque: 4.0e+6, torque_slope: -1.0e+6, torque_pitch_slope: -5.0e+7}\n"
         "hub: {radius: 1.5, mass: 100, inertia: [10, 10, 10]}\nblades:\n  count: 3\n"
         "  length: 60\n  elements: 1\n  order: 3\n"
         "  sections: [{mass: 300, inertia: [0, 0, 0], stiffness: {EA: rigid, GA2: rigid, GA3: "
         "rigid, GJ: rigid, EI2: rigid, EI3: rigid}}]\n" +
         blades + "controller:\n  speed_filter: 1.570796\n" + controls;
}

/// Inertia of that rotor and its generator about the shaft [kg m^2].
double inertia() {
  return 900.0 * (std::pow(61.5, 3) - std::pow(1.5, 3)) / 3.0 + 10.0 + gear * gear * 500.0;
}

/// Coefficients from the constant on.
using Polynomial = std::vector<double>;

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial c(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  return c;
}

std::vector<Complex> roots(const Polynomial& p) {
  const auto n = static_cast<Eigen::Index>(p.size()) - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  companion.diagonal(-1).setOnes();
  for (Eigen::Index i = 0; i < n; ++i)
    companion(i, n - 1) = -p[static_cast<std::size_t>(i)] / p.back();
  const Eigen::VectorXcd values = companion.eigenvalues();
  return {values.begin(), values.end()};
}

/// (J s + c)(s + w_c) s A(s) + n w_c G (K_P s + K_I) = 0, A(s) of an actuator.
std::vector<Complex> closed_loop(double G, const model::ControlLoop& loop,
                                 const Polynomial& actuator = {1.0}) {
  Polynomial p = product(product({slope, inertia()}, {corner, 1.0}), product({0.0, 1.0}, actuator));
  p[0] += gear * corner * G * loop.integral;
  p[1] += gear * corner * G * loop.proportional;
  return roots(p);
}

struct Solved {
  explicit Solved(const std::string& text)
      : input(io::parse_case("test", text, {})),
        system(model::build_turbine(input.turbine), PETSC_COMM_SELF),
        trim(analysis::find_trim(system, input.trim, observer)) {}
  std::vector<double> channels(const std::vector<std::string>& names, double t = 0.0) const {
    const turbine::TurbineChannels some(system, {}, names);
    const petsc::Handle<Vec> z = system.make_state();
    const petsc::Handle<Vec> z_dot = system.make_state();
    trim.solution.evaluate(t, z.get(), z_dot.get());
    std::vector<double> values(names.size());
    some.evaluate(t, z.get(), z_dot.get(), values);
    return values;
  }

  io::Case input;
  analysis::Observer observer;
  turbine::TurbineSystem system;
  analysis::Trim trim;
};

/// Each of the wanted exponents is that of a mode, or the conjugate of one, but for those that are
/// both at zero.
void require_modes(const analysis::ModeSet& set, const std::vector<Complex>& wanted, double error) {
  for (const Complex& one : wanted) {
    double best = 1e9;
    for (const analysis::Mode& mode : set.modes)
      best =
          std::min({best, std::abs(mode.exponent - one), std::abs(std::conj(mode.exponent) - one)});
    BOOST_TEST(best < error * std::abs(one), one << " misses by " << best);
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(controller)

BOOST_AUTO_TEST_CASE(torque_and_pitch_loops_have_the_roots_of_their_polynomials) {
  // G: of the torque on the shaft, n over the torque of the generator.
  struct Loop {
    std::string controls;
    double G;
    model::ControlLoop gains;
  };
  for (const Loop& loop :
       {Loop{"  torque: {proportional: 800, integral: 100}\n", gear, {800.0, 100.0}},
        Loop{"  pitch: {proportional: 0.0188, integral: 0.008}\n", pitched, {0.0188, 0.008}},
        Loop{"  torque: {proportional: 800}\n", gear, {800.0, 0.0}}}) {
    const Solved solved(rotor(loop.controls));
    std::vector<Complex> wanted = closed_loop(loop.G, loop.gains);
    if (loop.gains.integral == 0.0)
      std::erase_if(wanted, [](const Complex& one) { return std::abs(one) < 1e-9; });
    const analysis::ModeSet set =
        analysis::find_constant_modes(solved.system, solved.trim.solution);
    require_modes(set, wanted, 1e-8);
    // By Floquet, whose exponents have the step's map undone, over a third of a revolution.
    constexpr int steps = 36;
    analysis::Observer observer;
    const analysis::Floquet floquet = analysis::find_floquet_modes(
        solved.system, solved.trim.solution, {steps, analysis::FloquetPeriod::blade},
        PETSC_COMM_SELF, observer);
    require_modes(floquet.set, wanted, 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(an_integral_holds_its_set_point) {
  const Solved by_torque(rotor("  torque: {proportional: 800, integral: 100}\n"));
  const std::vector<double> torque = by_torque.channels({"GenSpeed", "GenTq"});
  BOOST_TEST(torque[0] == 1.2 * gear * 30.0 / pi, tolerance(1e-9));
  BOOST_TEST(1e3 * torque[1] == 4e6 / gear, tolerance(1e-9));
  // With a torque of the generator by law, the pitch takes up the difference.
  std::string text =
      rotor("  pitch: {proportional: 0.0188, integral: 0.008}\n", "  pitch_deg: 4\n");
  text.replace(text.find("joint: free"), 11, "joint: free, torque: 30000");
  const Solved by_pitch(text);
  const std::vector<double> pitch = by_pitch.channels({"GenSpeed", "GenTq", "BldPitch1"});
  BOOST_TEST(pitch[0] == 1.2 * gear * 30.0 / pi, tolerance(1e-9));
  BOOST_TEST(1e3 * pitch[1] == 30000.0, tolerance(1e-9));
  BOOST_TEST(pitch[2] == 4.0 + (4e6 - 30000.0 * gear) / pitched * 180.0 / pi, tolerance(1e-9));
  // The mean of all pitches counts.
  const Solved unequal(
      rotor("  torque: {proportional: 800, integral: 100}\n", "  each: {1: {pitch_deg: 0.5}}\n"));
  BOOST_TEST(
      1e3 * unequal.channels({"GenTq"})[0] == (4e6 - pitched * 0.5 * pi / 180.0 / 3.0) / gear,
      tolerance(1e-8));
  // A blade that is heavier than the others: the mean of the measured speed is the set point.
  const Solved uneven([] {
    std::string one = rotor("  torque: {proportional: 800, integral: 100}\ntrim: {harmonics: 4}\n",
                            "  each: {1: {mass_factor: 1.02}}\n");
    return one.replace(one.find("gravity: 0"), 10, "gravity: 9.81");
  }());
  double mean = 0.0;
  for (int i = 0; i < 16; ++i)
    mean += uneven.channels({"GenSpeed"}, uneven.system.period() * i / 16)[0] / 16.0;
  BOOST_TEST(mean == 1.2 * gear * 30.0 / pi, tolerance(1e-9));
}

// A teetering rotor with flexible blades under its weight whose controller must pitch the blades by
// about 30 degrees. The state is that of blades mounted at this pitch, without a controller.
BOOST_AUTO_TEST_CASE(a_large_pitch_of_a_teetering_rotor_is_found) {
  constexpr double by_pitch = 4e6;
  const double generator_torque = 20000.0;
  const auto rotor_of = [&](double pitch_deg, double torque) {
    return structure("two_bladed/teetering",
                     {"blades.pitch_deg=" + general(pitch_deg, 17), "trim={harmonics: 4}",
                      "shaft.generator={joint: free, own_inertia: 534.116, torque: " +
                          general(generator_torque, 17) + "}",
                      "shaft.rotor={torque: " + general(torque, 17) + ", torque_slope: -4e5, " +
                          "torque_pitch_slope: " + general(-by_pitch, 17) + "}"});
  };
  const std::vector<std::string> names{"TipDxb1",  "TipDyb1",  "RootMyc1",
                                       "TeetDefl", "TwrBsMyt", "BldPitch1"};
  struct State {
    std::vector<double> values;
    double held = 0.0;
  };
  const auto solve = [&](const io::Case& input) {
    const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
    analysis::Observer observer;
    const analysis::Trim trim = analysis::find_trim(system, input.trim, observer);
    const turbine::TurbineChannels channels(system, {}, names);
    const petsc::Handle<Vec> z = system.make_state();
    const petsc::Handle<Vec> z_dot = system.make_state();
    State state;
    std::vector<double> values(names.size());
    for (const double t : {0.0, 1.1, 2.9}) {
      trim.solution.evaluate(t, z.get(), z_dot.get());
      channels.evaluate(t, z.get(), z_dot.get(), values);
      state.values.insert(state.values.end(), values.begin(), values.end());
    }
    for (const analysis::HeldCoordinate& held : trim.held)
      if (held.name == "generator") state.held = held.load;
    return state;
  };
  const double driving = generator_torque * gear + by_pitch * 30.0 * pi / 180.0;
  io::Case controlled = rotor_of(0.0, driving);
  controlled.turbine.controller.emplace();
  controlled.turbine.controller->filter = 0.02;
  controlled.turbine.controller->pitch = model::ControlLoop{0.06, 0.03};
  const State found = solve(controlled);
  // The dampers of teeter and yaw take a part of the power.
  const double pitch_deg = found.values.back();
  BOOST_TEST(pitch_deg == 30.0, tolerance(3e-4));
  const State mounted = solve(rotor_of(pitch_deg, driving - by_pitch * pitch_deg * pi / 180.0));
  BOOST_TEST(std::abs(mounted.held) < 1e-4 * driving);
  // The filter leaves an oscillation of 5e-4 degrees of the pitch.
  for (std::size_t i = 0; i < found.values.size(); ++i)
    BOOST_TEST(found.values[i] == mounted.values[i], tolerance(1e-3) << names[i % names.size()]);
}

BOOST_AUTO_TEST_CASE(gains_fall_with_the_pitch) {
  // u = (1 + pitch/K) pitch: the slope of the pitch by u is K/(K + 2 pitch).
  std::string text =
      rotor("  pitch: {proportional: 0.0188, integral: 0.008, gain_schedule_deg: 6.3}\n");
  text.replace(text.find("joint: free"), 11, "joint: free, torque: 30000");
  const Solved solved(text);
  const double angle = (4e6 - 30000.0 * gear) / pitched;
  BOOST_TEST(solved.channels({"BldPitch2"})[0] == angle * 180.0 / pi, tolerance(1e-9));
  const double K = 6.3 * pi / 180.0;
  require_modes(analysis::find_constant_modes(solved.system, solved.trim.solution),
                closed_loop(pitched * K / (K + 2.0 * angle), {0.0188, 0.008}), 1e-7);
}

BOOST_AUTO_TEST_CASE(actuators_are_of_second_order) {
  const std::string actuator = "  pitch_actuator: {frequency: 4, damping_ratio: 0.6}\n";
  const Polynomial A{1.0, 2.0 * 0.6 / 4.0, 1.0 / 16.0};
  const Solved solved(rotor("  pitch: {proportional: 0.0188, integral: 0.008}\n", actuator));
  const analysis::ModeSet set = analysis::find_constant_modes(solved.system, solved.trim.solution);
  require_modes(set, closed_loop(pitched, {0.0188, 0.008}, A), 1e-8);
  require_modes(set, roots(A), 1e-8);  // of pitches whose sum is zero
  BOOST_TEST(solved.system.symmetry().sectors == 3);
  // They move together as blades do.
  analysis::Observer observer;
  const analysis::Floquet floquet = analysis::find_floquet_modes(
      solved.system, solved.trim.solution, {36}, PETSC_COMM_SELF, observer);
  for (const std::string word : {"collective", "regressive", "progressive"})
    BOOST_TEST(std::ranges::count(floquet.set.modes, "pitch actuator " + word,
                                  &analysis::Mode::label) == 1);
  // Response of the pitch to a pitch input, without a controller.
  std::string open = rotor("", actuator);
  open.erase(open.find("controller:"));
  const Solved alone(open);
  const turbine::TurbineInputOutput signals(alone.system, {"pitch_2"}, {}, {"BldPitch2"});
  const linear::LinearModel model(alone.system, signals, alone.trim.solution);
  const linear::StateSpace form = model.state_space(0.3);
  for (const double omega : {0.5, 4.0, 9.0}) {
    const Complex s(0.0, omega);
    const Eigen::MatrixXcd B =
        form.A.cast<Complex>() - s * Eigen::MatrixXcd::Identity(form.A.rows(), form.A.cols());
    const Complex found =
        form.D(0, 0) - (form.C * B.lu().solve(form.B.leftCols<1>().cast<Complex>()))(0, 0);
    const Complex wanted = 180.0 / pi / (A[0] + A[1] * s + A[2] * s * s);
    BOOST_TEST(std::abs(found - wanted) < 1e-8 * std::abs(wanted));
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused_with_its_place) {
  const auto has = [](const std::string& text, const std::string& words) {
    const std::string message = message_of(text);
    BOOST_TEST((message.find(words) != std::string::npos), message);
  };
  const std::string loop = "  torque: {integral: 100}\n";
  has(rotor("  set_point_rpm: 1100\n" + loop),
      "controller.set_point_rpm: the integral holds the generator at 115.192 rad/s");
  has(rotor(loop + "  pitch: {integral: 1}\n"), "cannot both have an integral");
  has(rotor(""), "expected torque, pitch or both");
  has(rotor("  torque: {}\n"), "missing key \"proportional\"");
  std::string locked = rotor(loop);
  has(locked.replace(locked.find("joint: free"), 11, "joint: locked"), "the generator is locked");
  std::string flat = rotor("  pitch: {integral: 1}\n");
  has(flat.replace(flat.find(", torque_pitch_slope: -5.0e+7"), 29, ""),
      "the torque of the rotor does not depend on the pitch");
  has(rotor(loop, "  pitch_actuator: {frequency: 4}\n"), "missing key \"damping_ratio\"");
  has(rotor(loop, "  pitch_actuator: {frequency: 4, damping_ratio: 1, lowest_deg: 2}\n"),
      "is not within lowest_deg and highest_deg");
  has(rotor("  pitch: {integral: 1, gain_schedule_deg: 3}\n", "  pitch_deg: -3\n"),
      "which is not > 0 at blades.pitch_deg");
  for (const std::string block :
       {"pitch_deg: {formula: t}", "events: [{at: 1, pitch: {to_deg: 9, rate_deg: 1}}]"}) {
    const std::string text =
        rotor("  pitch: {integral: 1}\ntransient: {duration: 2, step: 0.01, " + block + "}\n");
    const std::vector<Fault> faults =
        simulation::validate(io::parse_case("test", text, {}), simulation::Analysis::transient);
    BOOST_TEST_REQUIRE(faults.size() == 1U);
    BOOST_TEST(faults[0].text.starts_with("controller.pitch sets the pitch"));
  }
  BOOST_TEST(message_of(rotor("  set_point_rpm: 1100\n  torque: {proportional: 1}\n")) == "");
}

BOOST_AUTO_TEST_SUITE_END()
