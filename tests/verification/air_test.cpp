// Aeroelastic cases: the wing of Goland, flap damping in closed form, the NREL 5 MW rotor, and the
// agreement of analyses with each other.
#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/constant_modes.hpp"
#include "samara/simulation/air_part.hpp"
#include "samara/simulation/held_air.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/simulation/transient_simulation.hpp"
#include "samara/turbine/turbine_channels.hpp"

#include "air_case.hpp"
#include "record.hpp"
#include "turning.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

// ---- the wing of Goland ------------------------------------------------------------------------

Complex fastest_growth(const std::vector<std::string>& settings) {
  const Steady wing(io::read_case(input_path("goland/wing"), settings));
  Complex found(-1e300, 0.0);
  for (const analysis::Mode& mode : wing.constant_modes().modes)
    if (mode.exponent.real() > found.real() && mode.exponent.imag() > 1.0) found = mode.exponent;
  return found;
}

/// The highest speed without growth, by bisection to a tolerance, between one without and one with.
template <class Growth>
double last_stable(const Growth& growth, double low, double high, double tolerance) {
  BOOST_REQUIRE(growth(low) < 0.0);
  BOOST_REQUIRE(growth(high) > 0.0);
  while (high - low > tolerance) {
    const double middle = 0.5 * (low + high);
    (growth(middle) > 0.0 ? high : low) = middle;
  }
  return low;
}

/// Natural frequencies in still air without its inertia, of an independent converged program.
BOOST_AUTO_TEST_CASE(goland_wing_has_its_natural_frequencies) {
  const Steady wing(io::read_case(input_path("goland/wing"), {"aero=none", "blades.elements=3"}));
  const std::vector<analysis::Mode> modes = wing.constant_modes().modes;
  const std::vector<double> expected{48.1523, 95.7026, 243.735, 347.58};
  const Figures figures{"A2", "independent program, converged", mesh_name(3, 4)};
  for (std::size_t i = 0; i < expected.size(); ++i)
    figures.check_relative("natural frequency " + std::to_string(i + 1) + " [rad/s]",
                           modes[i].exponent.imag(), expected[i], 1e-4);
}

/// Flutter with strip theory and Jones's constants, of the same program: 137.335 m/s, 69.346 rad/s.
BOOST_AUTO_TEST_CASE(goland_wing_flutters_at_the_speed_of_strip_theory) {
  const auto growth = [](double speed) {
    return fastest_growth(
        {"blades.elements=3", "blades.order=4", "wind.speed=" + std::to_string(speed)});
  };
  const double low =
      last_stable([&](double speed) { return growth(speed).real(); }, 137.0, 138.0, 1e-4);
  const Figures figures{"A2", "independent program, converged", mesh_name(3, 4)};
  figures.check_relative("flutter speed, Jones [m/s]", low, 137.335, 1e-4);
  figures.check_relative("flutter frequency, Jones [rad/s]", growth(low).imag(), 69.346, 1e-4);
}

/// The same with six finite states: 136.12901 m/s, 70.04582 rad/s.
BOOST_AUTO_TEST_CASE(goland_wing_with_finite_states_flutters_at_the_speed_of_strip_theory) {
  const auto growth = [](double speed) {
    return fastest_growth({"blades.elements=3", "blades.order=4", "aero.airfoil_dynamics=peters",
                           "wind.speed=" + std::to_string(speed)});
  };
  const double low =
      last_stable([&](double speed) { return growth(speed).real(); }, 136.0, 136.3, 1e-4);
  const Figures figures{"A2", "independent program, converged", mesh_name(3, 4)};
  figures.check_relative("flutter speed, finite states [m/s]", low, 136.12901, 1e-5);
  figures.check_relative("flutter frequency, finite states [rad/s]", growth(low).imag(), 70.04582,
                         1e-5);
}

/// Divergence of a uniform cantilever wing in strip theory: q_D = (pi/2L)^2 GJ/(c e a), with the
/// aerodynamic centre e = 0.08 c ahead of the elastic axis and the slope a = 2 pi.
BOOST_AUTO_TEST_CASE(goland_wing_diverges_at_the_speed_in_closed_form) {
  constexpr double chord = 1.8288;
  const double pressure =
      std::pow(pi / (2.0 * 6.096), 2) * 0.987e6 / (chord * 0.08 * chord * 2.0 * pi);
  const double expected = std::sqrt(2.0 * pressure / 1.225);
  const auto growth = [](double speed) {
    const Steady wing(io::read_case(
        input_path("goland/wing"),
        {"blades.elements=3", "blades.order=4", "wind.speed=" + std::to_string(speed)}));
    double largest = -1e300;
    for (const analysis::Mode& mode : wing.constant_modes().modes)
      if (std::abs(mode.exponent.imag()) < 1e-3) largest = std::max(largest, mode.exponent.real());
    return largest;
  };
  const double low = last_stable(growth, 0.99 * expected, 1.01 * expected, 1e-6 * expected);
  Figures{"A2", "closed form", mesh_name(3, 4)}.check_relative("divergence speed [m/s]", low,
                                                               expected, 1e-5);
}

// ---- the typical section -----------------------------------------------------------------------

/// Exponents of the input from an independent program that has Theodorsen's loads with R. T.
/// Jones's constants, and with six finite states of Peters.
BOOST_AUTO_TEST_CASE(typical_section_has_the_exponents_of_theodorsens_loads) {
  struct Expected {
    const char* dynamics;
    double speed;
    std::vector<Complex> exponents;
  };
  const std::vector<Expected> all{
      {"hgm",
       1.0,
       {{-0.044206, 0.0}, {-0.275051, 0.0}, {-0.035119, 0.403721}, {-0.039229, 0.960490}}},
      {"hgm",
       2.0,
       {{-0.072686, 0.0}, {-0.385647, 0.0}, {-0.172736, 0.521491}, {-0.066052, 0.702986}}},
      {"hgm",
       2.5,
       {{-0.050697, 0.0}, {-0.274882, 0.0}, {0.084480, 0.601219}, {-0.506633, 0.551897}}},
      {"peters",
       2.0,
       {{-0.088960, 0.0},
        {-0.522497, 0.0},
        {-3.989423, 0.0},
        {-5.174727, 0.0},
        {-0.175127, 0.497881},
        {-0.054034, 0.710102},
        {-4.570257, 11.043529}}}};
  for (const Expected& expected : all) {
    const Steady section(io::read_case(input_path("typical_section/section"),
                                       {std::string("aero.airfoil_dynamics=") + expected.dynamics,
                                        "wind.speed=" + std::to_string(expected.speed)}));
    const std::vector<analysis::Mode> modes = section.constant_modes().modes;
    for (const Complex& value : expected.exponents) {
      double best = 1e300;
      for (const analysis::Mode& mode : modes)
        best = std::min(best, std::abs(mode.exponent - value));
      BOOST_TEST_CONTEXT(expected.dynamics << ", U = " << expected.speed << ", " << value)
      BOOST_TEST(best < 1e-5);
      if (value.imag() == 0.0) continue;
      const auto nearest = std::ranges::min_element(
          modes, {}, [&](const analysis::Mode& mode) { return std::abs(mode.exponent - value); });
      const Figures figures{"A1", "independent program, Theodorsen's loads", mesh_name(1, 1)};
      const bool is_jones = std::string(expected.dynamics) == "hgm";
      const std::string name = std::string(is_jones ? "Jones" : "finite states") +
                               ", U = " + in_short(expected.speed) + ", " + in_short(value.imag()) +
                               ": ";
      figures.check_absolute(name + "growth", nearest->exponent.real(), value.real(), 1e-5);
      figures.check_absolute(name + "frequency", nearest->exponent.imag(), value.imag(), 1e-5);
    }
  }
}

// ---- flap damping in closed form ---------------------------------------------------------------

/// A rigid blade on a flap hinge at the axis in still air, Cl = a alpha, no drag, no induced
/// velocity: the growth of flap is -(gamma Omega/16)(1 - x^4), gamma = rho a c R^4/I, x the radius
/// of the root by that of the tip.
BOOST_AUTO_TEST_CASE(flap_damping_of_a_hinged_blade_is_that_of_its_lock_number) {
  constexpr double a = 5.7;
  constexpr double chord = 0.5;
  constexpr double R = 10.0;
  constexpr double mass = 8.0;  // per length
  constexpr double Omega = 15.0;
  for (const double x : {0.0, 0.3}) {
    const std::string slope = std::to_string(a * 30.0 * pi / 180.0);
    const std::string text =
        "samara: 1\ngravity: 0\nshaft: {speed: 15}\nhub: {radius: " + std::to_string(x * R) +
        "}\nwind: {speed: 0}\naero: {induction: none, airfoil_dynamics: static}\nblades:\n"
        "  count: 1\n  length: " +
        std::to_string((1.0 - x) * R) +
        "\n  elements: 2\n  order: 3\n  hinges: [{axis: flap, offset: 0, joint: free}]\n"
        "  sections:\n    - {mass: 8, inertia: [0, 0, 0], stiffness: {EA: rigid, GA2: rigid, GA3: "
        "rigid, GJ: rigid, EI2: rigid, EI3: rigid}}\n"
        "  airfoils:\n    line: {polars: [{table: [[-180, 0, 0, 0], [-30, -" +
        slope + ", 0, 0], [30, " + slope + ", 0, 0], [180, 0, 0, 0]]}]}\n" +
        "  aero_sections:\n    - {at: 0, chord: 0.5, airfoil: line}\n";
    const Steady rotor(io::parse_case("hinged blade", text, {}));
    const double I = mass * R * R * R * (1.0 - x * x * x) / 3.0;
    const double gamma = 1.225 * a * chord * std::pow(R, 4) / I;
    const double expected = -gamma * Omega / 16.0 * (1.0 - std::pow(x, 4));
    double found = 0.0;
    for (const analysis::Mode& mode : rotor.constant_modes().modes)
      if (mode.label.find("flap") != std::string::npos) found = mode.exponent.real();
    Figures{"A3", "closed form", mesh_name(2, 3)}.check_relative(
        "growth of flap [1/s], root at " + in_short(x) + " of the radius", found, expected, 1e-3);
  }
}

// ---- the NREL 5 MW rotor -----------------------------------------------------------------------

struct OperatingPoint {
  double wind, rpm, pitch_deg, power, thrust;  // MW, kN
};

void require_point(const OperatingPoint& at, const std::vector<std::string>& mesh,
                   double relative) {
  std::vector<std::string> settings{"wind.speed=" + std::to_string(at.wind),
                                    "shaft.speed_rpm=" + std::to_string(at.rpm),
                                    "blades.pitch_deg=" + std::to_string(at.pitch_deg)};
  settings.insert(settings.end(), mesh.begin(), mesh.end());
  const Steady rotor(rigid_rotor(settings));
  const std::vector<double> found = rotor.channels({"RotPwr", "RotThrust"});
  const model::BeamDefinition& blade = rotor.input.turbine.blades.beam;
  const Figures figures{"A4", "independent program, converged",
                        mesh_name(blade.elements, blade.order)};
  const std::string name = in_short(at.wind) + " m/s: ";
  figures.check_relative(name + "power [MW]", found[0] * 1e-3, at.power, relative);
  figures.check_relative(name + "thrust [kN]", found[1], at.thrust, relative);
}

/// Converged figures of an independent program: rigid, no cone and tilt, static polars, Buhl's
/// thrust law with the tip loss inside.
constexpr OperatingPoint nrel_points[] = {
    {8.0, 9.155, 0.0, 1.9173, 387.1},   {10.0, 11.444, 0.0, 3.7447, 604.9},
    {13.0, 12.1, 6.60, 5.3320, 510.7},  {15.0, 12.1, 10.45, 5.3223, 422.4},
    {17.0, 12.1, 13.54, 5.3157, 369.8}, {20.0, 12.1, 17.47, 5.3374, 322.4},
    {25.0, 12.1, 23.47, 4.7387, 252.0}};

BOOST_AUTO_TEST_CASE(nrel_rotor_has_the_converged_power_and_thrust) {
  for (const OperatingPoint& at : nrel_points)
    require_point(at, {"blades.elements=24", "blades.order=2"}, 3e-3);
}

BOOST_AUTO_TEST_CASE(mesh_of_the_input_has_power_and_thrust_within_6_per_mille) {
  for (const OperatingPoint& at : nrel_points) require_point(at, {}, 6e-3);
}

// ---- damping of a tower in closed form ---------------------------------------------------------

/// The rigid rotor on a rigid mast that a spring holds in the direction of the wind: its damping
/// coefficient is dT/dV, the change of the thrust by the wind at constant speed and pitch. Figures
/// of an independent program for a wake in equilibrium and a frozen one, 24 x 2 points.
BOOST_AUTO_TEST_CASE(a_rotor_on_a_spring_is_damped_by_the_slope_of_its_thrust) {
  struct Point {
    double wind, rpm, pitch_deg;
    const char* inflow;
    double damping;  // N s/m
  };
  for (const Point& at :
       {Point{8.0, 9.155, 0.0, "equilibrium", 66.7e3},
        Point{13.0, 12.1, 6.60, "equilibrium", 79.0e3},
        Point{18.0, 12.1, 14.92, "equilibrium", 77.6e3}, Point{8.0, 9.155, 0.0, "frozen", 68.9e3},
        Point{13.0, 12.1, 6.60, "frozen", 94.2e3}, Point{18.0, 12.1, 14.92, "frozen", 92.3e3}}) {
    io::Case input = rigid_rotor(
        {"blades.elements=24", "blades.order=2", std::string("aero.inflow=") + at.inflow,
         "wind.speed=" + std::to_string(at.wind), "shaft.speed_rpm=" + std::to_string(at.rpm),
         "blades.pitch_deg=" + std::to_string(at.pitch_deg)});
    // A mast of one rigid element on a spring along n2; it cannot turn.
    constexpr double stiffness = 2e6;
    model::TurbineDefinition& turbine = input.turbine;
    turbine.has_tower = true;
    turbine.tower.elements = 1;
    turbine.tower.order = 2;
    make_rigid(turbine.tower);
    model::SupportDefinition& support = turbine.tower.support;
    support.rigid = {true, true, false, true, true, true};
    support.stiffness.setZero();
    support.stiffness(2, 2) = stiffness;
    support.mass = 1000.0;
    Steady rotor(input);
    double found = 0.0;
    for (const analysis::Mode& mode :
         rotor.floquet({72, analysis::FloquetPeriod::automatic, 6}).modes)
      if (!is_of_medium(mode) && mode.exponent.imag() > 0.1) {
        // m s^2 + c s + k = 0.
        const double mass = stiffness / std::norm(mode.exponent);
        found = -2.0 * mass * mode.exponent.real();
      }
    Figures{"A5", "independent program, dT/dV", mesh_name(24, 2)}.check_relative(
        in_short(at.wind) + " m/s, wake " +
            (std::string(at.inflow) == "frozen" ? "frozen" : "in equilibrium") +
            ": damping [kN s/m]",
        1e-3 * found, 1e-3 * at.damping, 0.02);
  }
}

// ---- a wind that changes -----------------------------------------------------------------------

/// Rows of a time series.
struct Series {
  std::vector<double> times;
  std::vector<std::vector<double>> values;
};

class Rows final : public simulation::TransientOutput {
 public:
  void row(double t, std::span<const double> row_values) override {
    series.times.push_back(t);
    series.values.emplace_back(row_values.begin(), row_values.end());
  }
  Series series;
};

Series run(const simulation::Scenario& scenario) {
  simulation::TransientSimulation simulation(scenario);
  analysis::Observer observer;
  simulation.start(observer);
  Rows rows;
  simulation.run(rows);
  return rows.series;
}

/// The wind at a rigid wing turns by half a degree within a hundredth of a half chord: the lift
/// grows with Wagner's function, in R. T. Jones's form 1 - 0.165 exp(-0.0455 s) - 0.335 exp(-0.3
/// s), s the half chords travelled.
BOOST_AUTO_TEST_CASE(lift_after_a_turn_of_the_wind_is_that_of_wagner) {
  constexpr double speed = 50.0;
  constexpr double angle = 0.5;                  // [deg]
  constexpr double time = 0.5 * 1.8288 / speed;  // of a half chord
  constexpr double ramp = 0.01 * time;
  io::Case input = io::read_case(input_path("goland/wing"),
                                 {"wind.speed=50", "blades.elements=1", "blades.order=1",
                                  "transient={duration: 0.2, step: 9.144e-5, checkpoint: none}"});
  make_rigid(input.turbine.blades.beam);
  simulation::Scenario scenario = input;
  scenario.transient.channels = {"B1N1Cl", "Wind1VelY"};
  scenario.transient.stations.blade = {0.5};
  model::WindChange change;
  constexpr double degree = pi / 180.0;
  change.direction = math::TimeCurve::along(
      {{0.0, 90.0 * degree}, {ramp, (90.0 - angle) * degree}, {1.0, (90.0 - angle) * degree}});
  scenario.transient.wind = change;
  const Series rows = run(scenario);
  BOOST_REQUIRE(rows.times.size() > 2000u);
  BOOST_TEST(rows.values.back()[1] == speed * std::cos(angle * degree), tolerance(1e-9));
  const double steady = 2.0 * pi * std::sin(angle * degree);
  for (const double s : {0.5, 1.0, 2.0, 5.0, 10.0}) {
    const auto i = static_cast<std::size_t>(std::lround(s * time / 9.144e-5));
    // The mean over the ramp.
    const double t = rows.times[i] / time - 0.5 * ramp / time;
    const double wagner = 1.0 - 0.165 * std::exp(-0.0455 * t) - 0.335 * std::exp(-0.3 * t);
    Figures{"A6", "Wagner's function in Jones's form", mesh_name(1, 1)}.check_relative(
        "lift by its steady value after " + in_short(s) + " half chords",
        std::abs(rows.values[i][0]) / steady, wagner, 1e-4);
  }
}

/// In a change that is slow against all lags the turbine is in its steady state of each instant.
BOOST_AUTO_TEST_CASE(a_slow_change_of_the_wind_passes_through_steady_states) {
  simulation::Scenario scenario =
      rigid_rotor({"blades.elements=3", "blades.order=2", "wind.speed=8", "shaft.speed_rpm=9.155",
                   "transient={duration: 900, step: 0.5, checkpoint: none}", "aero.inflow=oye"});
  scenario.transient.channels = {"RtAeroFxh", "RtAeroPwr"};
  model::WindChange change;
  change.speed = math::TimeCurve::ramp(0.0, 8.0, 10.0, 0.004);
  scenario.transient.wind = change;
  const Series rows = run(scenario);
  const Steady end(rigid_rotor({"blades.elements=3", "blades.order=2", "wind.speed=10",
                                "shaft.speed_rpm=9.155", "aero.inflow=oye"}));
  const std::vector<double> expected = end.channels({"RtAeroFxh", "RtAeroPwr"});
  for (std::size_t c = 0; c < 2; ++c)
    BOOST_TEST(rows.values.back()[c] == expected[c],
               tolerance(1e-3));  // tau1 follows the mean wind
}

/// Linear shear as the documentation of the case states it: speed (1 + left y/L + up (z -
/// height)/L).
BOOST_AUTO_TEST_CASE(linear_shear_is_a_part_of_the_speed) {
  const io::Case input =
      io::read_case(input_path("nrel5mw/land"),
                    {"wind={speed: 12, height: 90, shear: {left: 0.2, up: 0.1, length: 126}}"});
  const elements::Wind wind = model::build_turbine(input.turbine).air->rotor.wind;
  const Vector3 there = wind.at<double>(Vector3(-21.0, -5.0, 111.0), 0.0);  // 21 m left and up
  BOOST_TEST(there(1) == 12.0 * (1.0 + 0.3 * 21.0 / 126.0), tolerance(1e-12));
}

// ---- the tower in the wind ---------------------------------------------------------------------

/// A rigid tower with a blade that the wind does not load.
const std::string bare_tower = R"(samara: 1
gravity: 0
tower:
  length: 30
  elements: 8
  sections:
    - {mass: 500, inertia: [100, 50, 50], stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}}
shaft: {speed: 0}
hub: {radius: 1}
wind:
  speed: 20
  height: 30
  shear: {power: 0.5}
  tower: {sections: [[0, 4, 0.5], [30, 4, 0.5]], potential: none}
aero: {induction: none, airfoil_dynamics: static}
blades:
  count: 1
  length: 10
  sections:
    - {mass: 8, inertia: [1, 0.5, 0.5], stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}}
  airfoils:
    none: {polars: [{table: [[-180, 0, 0, 0], [180, 0, 0, 0]]}]}
  aero_sections: [{at: 0, chord: 0.5, airfoil: none}]
)";

/// A tower alone in a wind that the blades do not feel: the force at its foot is the integral of
/// rho/2 C_d D v^2.
BOOST_AUTO_TEST_CASE(the_drag_of_the_tower_is_at_its_foot) {
  const auto foot_force = [&](const std::vector<std::string>& settings) {
    const Steady tower(io::parse_case("tower", bare_tower, settings));
    return tower.trim.solution.coefficients()(tower.system.layout().tower_root() + 2, 0);
  };
  // v^2 = 400 z/30, except below 1 m: the integral is 400 x 15 = 6000 to 1e-3.
  const double expected = 0.5 * 1.225 * 0.5 * 4.0 * 6000.0;
  BOOST_TEST(std::abs(foot_force({}) / expected - 1.0) < 2e-3);
  BOOST_TEST(std::abs(foot_force({"wind.tower.drag_load=false"})) < 1e-6 * expected);
}

/// The wind blows 30 degrees from the axis of the nacelle, at 33 m: v^2 = 440.
BOOST_AUTO_TEST_CASE(the_drag_of_the_nacelle_is_at_the_foot_and_turns_the_yaw) {
  const auto loaded = [&](const std::string& yaw) {
    return Steady(
        io::parse_case("tower", bare_tower,
                       {"wind.tower.drag_load=false", "wind.direction_deg=30",
                        "wind.nacelle={areas: [8, 12, 5], drag: [1, 0.5, 2], center: [0, 2, 3]}",
                        "nacelle={yaw: " + yaw + "}"}));
  };
  const double pressure = 0.5 * 1.225 * 440.0;
  const double along = 12.0 * 0.5 * pressure * 0.75;  // cos^2
  const double across = -8.0 * pressure * 0.25;       // counter-clockwise is toward -n1
  const Steady locked = loaded("{joint: locked}");
  const Eigen::VectorXd foot =
      locked.trim.solution.coefficients().col(0).segment(locked.system.layout().tower_root(), 6);
  BOOST_TEST(foot(2) == along, tolerance(1e-6));
  BOOST_TEST(foot(1) == across, tolerance(1e-6));
  BOOST_TEST(std::abs(foot(0)) < 1e-3);
  BOOST_TEST(foot(3) == -2.0 * across, tolerance(1e-6));  // about n3
  BOOST_TEST(foot(4) == -33.0 * along, tolerance(1e-6));  // about n1
  BOOST_TEST(foot(5) == 33.0 * across, tolerance(1e-6));  // about n2
  constexpr double stiffness = 1e9;
  const Steady free = loaded("{joint: free, stiffness: 1e9}");
  const double angle = free.trim.solution.coefficients()(free.system.layout().yaw(), 0);
  BOOST_TEST(angle == -2.0 * across / stiffness, tolerance(1e-4));
  // Turned by 40 degrees toward the wind: it comes from 10 degrees on the other side.
  const Steady turned = loaded("{joint: prescribed, angle_deg: 40}");
  const Eigen::VectorXd there =
      turned.trim.solution.coefficients().col(0).segment(turned.system.layout().tower_root(), 6);
  constexpr double degree = pi / 180.0;
  const double own_along = 6.0 * pressure * std::pow(std::cos(10.0 * degree), 2);
  const double own_across = 8.0 * pressure * std::pow(std::sin(10.0 * degree), 2);
  const double c40 = std::cos(40.0 * degree);
  const double s40 = std::sin(40.0 * degree);
  BOOST_TEST(there(1) == c40 * own_across - s40 * own_along, tolerance(1e-5));
  BOOST_TEST(there(2) == s40 * own_across + c40 * own_along, tolerance(1e-5));
}

/// On a spring along the wind the drag of the nacelle is a damper, c = rho C_d A v.
BOOST_AUTO_TEST_CASE(the_drag_of_the_nacelle_damps_its_motion) {
  constexpr double stiffness = 1e6;
  const Steady mast(
      io::parse_case("tower", bare_tower,
                     {"wind.tower.drag_load=false", "tower.elements=1",
                      "tower.support={stiffness: {u3: 1e6}, mass: 1000}",
                      "wind.nacelle={areas: [8, 12, 5], drag: [1, 0.5, 2], center: [0, 2, 3]}"}));
  double found = 0.0;
  for (const analysis::Mode& mode : mast.constant_modes().modes)
    if (!is_of_medium(mode) && mode.exponent.imag() > 0.1)
      found = -2.0 * stiffness / std::norm(mode.exponent) * mode.exponent.real();
  BOOST_TEST(found == 1.225 * 0.5 * 12.0 * std::sqrt(440.0), tolerance(1e-3));
}

// ---- the part of the air in the damping -------------------------------------------------------

/// A rigid blade on a flap hinge without other damping: all damping is that of the air, and the
/// work per cycle is that of a damper, pi c omega a^2 = 2 pi (2 sigma) omega T with the kinetic
/// energy T = I a^2/2 at the amplitude a and the growth sigma.
BOOST_AUTO_TEST_CASE(work_of_the_air_on_flapping_is_that_of_its_damping) {
  const std::string slope = std::to_string(0.2 * 30.0 * pi / 180.0);  // light damping
  const std::string text =
      "samara: 1\ngravity: 0\nshaft: {speed: 15}\nhub: {radius: 3}\nwind: {speed: 0}\naero: "
      "{induction: none, airfoil_dynamics: static}\nblades:\n  count: 1\n  length: 7\n  "
      "elements: 2\n  order: 3\n  hinges: [{axis: flap, offset: 0, joint: free}]\n  sections:\n  "
      "  - {mass: 8, inertia: [0, 0, 0], stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, "
      "EI2: rigid, EI3: rigid}}\n  airfoils:\n    line: {polars: [{table: [[-180, 0, 0, 0], [-30, "
      "-" +
      slope + ", 0, 0], [30, " + slope +
      ", 0, 0], [180, 0, 0, 0]]}]}\n  aero_sections:\n    - {at: 0, chord: 0.5, airfoil: line}\n";
  const Steady rotor(io::parse_case("hinged blade", text, {}));
  const analysis::ModeSet set = rotor.constant_modes();
  const auto still = simulation::hold_air(rotor.system);
  const simulation::AirPart part =
      simulation::find_air_part(rotor.system, rotor.trim.solution, set,
                                analysis::find_constant_modes(*still, rotor.trim.solution));
  bool is_found = false;
  for (std::size_t m = 0; m < set.modes.size(); ++m) {
    const analysis::Mode& mode = set.modes[m];
    if (mode.label.find("flap") == std::string::npos) continue;
    is_found = true;
    BOOST_TEST(std::abs(part.held_damping[m]) < 1e-8);
    BOOST_TEST(part.likeness[m] > 0.9999);
    const double a = std::abs(set.shapes[m](rotor.system.layout().hinge(0, 0), 0));
    const double I = 8.0 * (1000.0 - 27.0) / 3.0;
    const double sigma = mode.exponent.real();
    const double omega = mode.exponent.imag();
    const double work = 2.0 * pi * sigma * I * a * a * std::norm(mode.exponent) / omega;
    BOOST_TEST(part.whole_work(m) == work, tolerance(1e-5));
  }
  BOOST_TEST(is_found);
}

// ---- analyses agree ----------------------------------------------------------------------------

/// The map of the steps of order 2 is exact where tangents are constant.
BOOST_AUTO_TEST_CASE(floquet_and_constant_modes_agree_in_axial_wind) {
  for (const std::string inflow : {"oye", "equilibrium"}) {
    Steady rotor(rotor_in_axial_wind({"aero.inflow=" + inflow}));
    require_same_exponents(rotor.floquet({400, analysis::FloquetPeriod::automatic, 2}),
                           rotor.constant_modes(), 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(blade_passage_and_revolution_agree_in_sheared_skewed_wind) {
  const std::vector<std::string> settings{
      "wind.speed=10",  "wind.height=90", "wind.shear.power=0.2", "wind.direction_deg=20",
      "blades.order=2", "tower.order=3",  "trim.harmonics=8"};
  Steady turbine(io::read_case(input_path("nrel5mw/land"), settings));
  require_same_exponents(turbine.floquet({72, analysis::FloquetPeriod::automatic, 6}),
                         turbine.floquet({72, analysis::FloquetPeriod::full, 6}), 1e-8);
}

}  // namespace
