// Tuned mass dampers: two-mass systems in closed form, the fixed points of J. P. Den Hartog
// (Mechanical Vibrations, 4th edition, 1956, section 3.3), turning blades, and dampers too stiff to
// move, which are masses of the turbine.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/linear/linear_model.hpp"
#include "samara/model/masses.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_input_output.hpp"

#include "cases.hpp"
#include "time_series.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

const std::string rigid =
    "stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}";

/// 100 kg on a spring and a damper along one direction of the tower's axes, u2 side-side or u3
/// fore-aft: 20 kg of support and tower, 80 kg of nacelle.
std::string carrier(const std::string& direction, double damping, const std::string& nacelle = "") {
  return "samara: 1\ngravity: 0\ntower:\n  length: 10\n  elements: 2\n  support: {stiffness: {" +
         direction + ": 1.0e+5}, mass: 10, damping: " + std::to_string(damping) +
         "}\n  sections: [{mass: 1, inertia: [0, 0, 0], " + rigid + "}]\nnacelle: {mass: 80" +
         nacelle + "}\n";
}

/// Exponents of two masses in a row with a damper of stiffness k and damping c on the second.
std::vector<Complex> two_masses(double first, double first_stiffness, double first_damping,
                                double mass, double k, double c) {
  Eigen::Matrix2d M;
  Eigen::Matrix2d K;
  Eigen::Matrix2d C;
  M << first, 0, 0, mass;
  K << first_stiffness + k, -k, -k, k;
  C << first_damping + c, -c, -c, c;
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A.topRightCorner<2, 2>().setIdentity();
  A.bottomLeftCorner<2, 2>() = -M.lu().solve(K);
  A.bottomRightCorner<2, 2>() = -M.lu().solve(C);
  const Eigen::Vector4cd values = A.eigenvalues();
  std::vector<Complex> upper;
  for (const Complex& one : values)
    if (one.imag() > 0.0) upper.push_back(one);
  return upper;
}

/// The largest distance of a mode to the nearest of the exponents, by its size.
double distance(const analysis::ModeSet& set, const std::vector<Complex>& wanted) {
  double largest = 0.0;
  for (const analysis::Mode& mode : set.modes) {
    double best = 1e9;
    for (const Complex& one : wanted) best = std::min(best, std::abs(mode.exponent - one));
    largest = std::max(largest, best / std::abs(mode.exponent));
  }
  return largest;
}

analysis::ModeSet modes_of(const std::string& text) {
  return constant_modes_of(io::parse_case("test", text, {}).turbine);
}

/// A rotor that turns at 3 rad/s without gravity, its blades rigid.
std::string rotor(const std::string& dampers, const std::string& blades = "") {
  return "samara: 1\ngravity: 0\nshaft: {speed: 3}\nhub: {radius: 1}\nblades:\n  length: 9\n"
         "  elements: 3\n  order: 2\n  sections: [{mass: 4, inertia: [0, 0, 0], " +
         rigid + "}]\n" + blades + "tuned_mass_dampers:\n" + dampers;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(mass_damper)

BOOST_AUTO_TEST_CASE(two_masses_have_the_roots_of_their_quartic) {
  const std::vector<Complex> wanted = two_masses(100.0, 1e5, 200.0, 5.0, 4500.0, 20.0);
  const std::string law = "mass: 5, fore_aft: {stiffness: 4500, damping: 20}}]\n";
  for (const std::string place : {"on: nacelle, position: [0.5, 1, 2], ", "on: tower, at: 1, ",
                                  "on: tower, at: 0.37, position: [1, 0.2, 0], "}) {
    const analysis::ModeSet set =
        modes_of(carrier("u3", 0.002) + "tuned_mass_dampers: [{" + place + law);
    BOOST_TEST(set.degrees_of_freedom == 2);
    BOOST_TEST(distance(set, wanted) < 1e-6, place);
  }
  // Side-side, and at a nacelle that is yawed by 90 degrees.
  const std::string across = "mass: 5, side_side: {stiffness: 4500, damping: 20}}]\n";
  BOOST_TEST(distance(modes_of(carrier("u2", 0.002) + "tuned_mass_dampers: [{on: tower, at: 0.5, " +
                               across),
                      wanted) < 1e-6);
  BOOST_TEST(distance(modes_of(carrier("u3", 0.002, ", yaw: {joint: prescribed, angle_deg: 90}") +
                               "tuned_mass_dampers: [{on: nacelle, " + across),
                      wanted) < 1e-6);
}

BOOST_AUTO_TEST_CASE(all_dampings_have_the_fixed_points_in_common) {
  // g^2 = [1 +- sqrt(mu/(2 + mu))]/(1 + mu), height sqrt(1 + 2/mu) at f = 1/(1 + mu).
  constexpr double mass = 100.0;
  constexpr double stiffness = 1e5;
  constexpr double mu = 0.05;
  const double omega = std::sqrt(stiffness / mass);
  const double own = omega / (1.0 + mu);
  for (const double ratio : {0.02, 0.2}) {
    const double k = mu * mass * own * own;
    const double c = 2.0 * ratio * mu * mass * own;
    const io::Case input = io::parse_case(
        "test",
        carrier("u3", 0.0) + "tuned_mass_dampers: [{on: nacelle, mass: 5, fore_aft: {stiffness: " +
            std::to_string(k) + ", damping: " + std::to_string(c) + "}}]\n",
        {});
    const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
    analysis::Observer observer;
    const analysis::Trim trim = analysis::find_trim(system, {}, observer);
    const turbine::TurbineInputOutput signals(system, {"top_force_n2"}, {}, {"YawBrTDxt"});
    const linear::LinearModel model(system, signals, trim.solution);
    const linear::StateSpace form = model.state_space(0.0);
    for (const double sign : {-1.0, 1.0}) {
      const double g = std::sqrt((1.0 + sign * std::sqrt(mu / (2.0 + mu))) / (1.0 + mu));
      const Complex s(0.0, g * omega);
      const Eigen::MatrixXcd A =
          s * Eigen::MatrixXcd::Identity(form.A.rows(), form.A.cols()) - form.A;
      const Eigen::MatrixXcd G = form.C * A.lu().solve(form.B.leftCols<1>().cast<Complex>());
      const double height = std::abs(G(0, 0) + form.D(0, 0)) * stiffness;
      BOOST_TEST(std::abs(height / std::sqrt(1.0 + 2.0 / mu) - 1.0) < 1e-6);
    }
  }
}

BOOST_AUTO_TEST_CASE(on_a_turning_blade_the_tangential_spring_is_weaker_by_the_speed) {
  // omega^2 = k/m along the shaft, k/m - Omega^2 across; with the radial axis as well both couple
  // by Coriolis: (s^2 + p)^2 + 4 Omega^2 s^2 = 0, p = k/m - Omega^2, about q = Omega^2 r/p.
  constexpr double squared = 500.0 / 5.0;
  constexpr double speed = 3.0;
  const auto first = [](const std::string& dampers) { return modes_of(rotor(dampers)); };
  const analysis::ModeSet along =
      first("  - {on: blade 1, at: 0.7, mass: 5, flap: {stiffness: 500}}\n");
  BOOST_TEST(along.modes[0].exponent.imag() == std::sqrt(squared), tolerance(1e-6));
  const analysis::ModeSet across =
      first("  - {on: blades, at: 1, mass: 5, lead_lag: {stiffness: 500}}\n");
  BOOST_TEST(across.modes[0].exponent.imag() == std::sqrt(squared - speed * speed),
             tolerance(1e-6));
  const io::Case input = io::parse_case(
      "test",
      rotor("  - {on: blades, at: 0.4, mass: 5, lead_lag: {stiffness: 500}, axial: {stiffness: "
            "500}}\n"),
      {});
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  const double p = squared - speed * speed;
  const turbine::TurbineChannels channels(system, {}, {"BStC1_B1_ZQ", "BStC1_B1_YQ"});
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  trim.solution.evaluate(0.0, z.get(), z_dot.get());
  std::array<double, 2> values{};
  channels.evaluate(0.0, z.get(), z_dot.get(), values);
  BOOST_TEST(values[0] == speed * speed * (1.0 + 0.4 * 9.0) / p, tolerance(1e-9));
  BOOST_TEST(std::abs(values[1]) < 1e-9);
  // x = s^2: x^2 + (2 p + 4 Omega^2) x + p^2 = 0.
  const double half = p + 2.0 * speed * speed;
  const double root = std::sqrt(half * half - p * p);
  const analysis::ModeSet set = analysis::find_constant_modes(system, trim.solution);
  BOOST_TEST(set.modes[0].exponent.imag() == std::sqrt(half - root), tolerance(1e-6));
  BOOST_TEST(set.modes[1].exponent.imag() == std::sqrt(half + root), tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(radial_masses_keep_the_angular_momentum_of_a_free_rotor) {
  // (J + Q m (r + q)^2) Omega is constant: the sense of Coriolis' force, which exponents do not
  // show.
  constexpr double inertia = 2.0 * (4.0 / 3.0) * (1000.0 - 1.0) + 50.0;
  std::string text = rotor("  - {on: blades, at: 0.4, mass: 50, axial: {stiffness: 5000}}\n");
  text.replace(text.find("{speed: 3}"), 10,
               "{speed: 3, generator: {joint: free, own_inertia: 50}}");
  text.replace(text.find("blades:\n"), 8, "blades:\n  count: 2\n");
  const io::Case input = io::parse_case("test", text, {});
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  const turbine::TurbineChannels channels(system, {}, {"RotSpeed", "BStC1_B1_ZQ"});
  Keeper<std::array<double, 2>> watch([&](const analysis::TransientSample& sample) {
    std::array<double, 2> values{};
    channels.evaluate(sample.t, sample.z, sample.z_dot, values);
    return values;
  });
  analysis::run_transient(system, analysis::start_undeformed(system, 0.0),
                          steps_of(1e-3, 1.0, analysis::TransientMethod::midpoint), watch);
  const double start = (inertia + 100.0 * std::pow(1.0 + 0.4 * 9.0, 2)) * 3.0;
  double furthest = 0.0;
  double slowest = 3.0;
  for (const auto& [rpm, q] : watch.values) {
    const double speed = rpm * pi / 30.0;
    const double momentum = (inertia + 100.0 * std::pow(1.0 + 0.4 * 9.0 + q, 2)) * speed;
    BOOST_REQUIRE_SMALL(momentum / start - 1.0, 1e-5);
    furthest = std::max(furthest, q);
    slowest = std::min(slowest, speed);
  }
  BOOST_TEST(furthest > 0.5);
  BOOST_TEST(slowest < 2.8);
}

BOOST_AUTO_TEST_CASE(a_damper_too_stiff_to_move_is_a_mass) {
  // On the nacelle, off the yaw axis that turns freely, on the tower and on the blades, which bend;
  // against a nacelle of more mass and inertia and against point masses.
  const auto turbine = [](double nacelle, double behind, const std::string& inertia,
                          const std::string& point, const std::string& dampers) {
    const std::string section =
        "  sections: [{mass: 8, inertia: [0.2, 0.1, 0.1], stiffness: {EA: rigid, GA2: rigid, GA3: "
        "rigid, GJ: 3.0e+5, EI2: 4.0e+6, EI3: 7.0e+6}}]\n";
    return "samara: 1\ntower:\n  length: 20\n  elements: 4\n  order: 2\n" + section + point +
           "nacelle: {mass: " + std::to_string(nacelle) + ", center_of_mass: [0, " +
           std::to_string(behind) + ", 0], inertia: " + inertia +
           ", yaw: {joint: free, stiffness: 4.0e+4}}\n"
           "shaft: {speed: 4, overhang: 1.5, tilt_deg: 5}\nhub: {radius: 0.5}\n"
           "blades:\n  count: 3\n  length: 7\n  precone_deg: 3\n  elements: 4\n  order: 2\n" +
           section + point + "trim: {harmonics: 6}\nfloquet: {steps: 240}\n" + dampers;
  };
  // 30 kg at 2 m downwind: with 200 kg at the tower top the centre is 60/230 m behind it.
  const double inertia = 200.0 * 30.0 / 230.0 * 4.0;
  const std::string own = std::to_string(50.0 + inertia);
  const std::string with_mass =
      turbine(230.0, 60.0 / 230.0, "[" + own + ", 50, " + own + "]",
              "  point_masses: [{at: 0.6, mass: 12, center: [0, 0.2, -0.1]}]\n", "");
  const std::string stiff = "{stiffness: 1.0e+10}";
  const std::string place = ", at: 0.6, position: [0, 0.2, -0.1], mass: 12, ";
  const std::string with_dampers = turbine(
      200.0, 0.0, "[50, 50, 50]", "",
      "tuned_mass_dampers:\n  - {on: nacelle, position: [0, 2, 0], mass: 30, side_side: " + stiff +
          ", fore_aft: " + stiff + "}\n  - {on: tower" + place + "side_side: " + stiff +
          ", vertical: " + stiff + "}\n  - {on: blades" + place + "flap: " + stiff +
          ", lead_lag: " + stiff + "}\n");
  std::vector<analysis::Floquet> both;
  for (const std::string& text : {with_mass, with_dampers}) {
    const io::Case input = io::parse_case("test", text, {});
    both.push_back(floquet_of(input));
    const model::Masses masses =
        model::compute_masses(input.turbine, model::build_turbine(input.turbine));
    BOOST_TEST(masses.whole.mass == 160.0 + 12.0 + 230.0 + 3.0 * (56.0 + 12.0), tolerance(1e-12));
    BOOST_TEST(masses.nacelle.center().y() == 60.0 / 230.0, tolerance(1e-5));
  }
  BOOST_TEST(both[0].sectors == 3);
  BOOST_TEST(both[1].sectors == 3);
  for (std::size_t i = 0; i < 12; ++i) {
    const analysis::Mode& mode = both[0].set.modes[i];
    double nearest = 1e9;
    for (const analysis::Mode& other : both[1].set.modes)
      nearest = std::min(nearest, std::abs(other.exponent - mode.exponent));
    BOOST_TEST(nearest < 1e-5 * std::abs(mode.exponent), mode.label << " " << nearest);
  }
}

BOOST_AUTO_TEST_CASE(stops_hold_what_the_weight_moves) {
  // A vertical axis: k q + k_s (q + d) = -m g where q < -d.
  const auto sag = [](const std::string& stops) {
    const io::Case input = io::parse_case(
        "test",
        "samara: 1\ngravity: 9.81\ntower:\n  length: 10\n  sections: [{mass: 1, inertia: [0, 0, "
        "0], " +
            rigid +
            "}]\ntuned_mass_dampers: [{on: tower, at: 0.5, mass: 5, vertical: {stiffness: "
            "100" +
            stops + "}}]\n",
        {});
    const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
    analysis::Observer observer;
    const analysis::Trim trim = analysis::find_trim(system, {}, observer);
    return trim.solution.coefficients()(system.equations().mass_dampers()[0]->first(0), 0);
  };
  BOOST_TEST(sag("") == -0.4905, tolerance(1e-9));
  BOOST_TEST(sag(", stops: {displacement: 0.2, stiffness: 900}") == -(49.05 + 180.0) / 1000.0,
             tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(on_the_parked_5_mw_turbine_it_moves_as_on_its_first_mode) {
  // The modal mass of the turbine's own fore-aft mode at the tower top, from what a mass there does
  // to its frequency: (omega/omega')^2 = 1 + dm/m.
  const auto parked = [](const std::vector<std::string>& settings) {
    std::vector<std::string> all{"shaft.speed=0", "gravity=0", "tower.damping=0",
                                 "blades.damping=0"};
    all.insert(all.end(), settings.begin(), settings.end());
    return constant_modes_of(structure("nrel5mw/land", all).turbine);
  };
  const auto first = [](const analysis::ModeSet& set) {
    for (const analysis::Mode& mode : set.modes)
      if (mode.label == "1st tower fore-aft") return mode.exponent.imag();
    return 0.0;
  };
  const double alone = first(parked({}));
  const double loaded = first(parked({"tower.tip_mass=1000"}));
  const double modal = 1000.0 / ((alone / loaded) * (alone / loaded) - 1.0);
  const double own = alone / 1.05;
  const double mass = 20000.0;
  const double k = mass * own * own;
  const double c = 2.0 * 0.1 * mass * own;
  const analysis::ModeSet set =
      parked({"tuned_mass_dampers=[{on: tower, at: 1, mass: 20000, fore_aft: {stiffness: " +
              std::to_string(k) + ", damping: " + std::to_string(c) + "}}]"});
  const std::vector<Complex> wanted = two_masses(modal, modal * alone * alone, 0.0, mass, k, c);
  int found = 0;
  for (const Complex& one : wanted)
    for (const analysis::Mode& mode : set.modes)
      if (std::abs(mode.exponent - one) < 0.02 * std::abs(one)) {
        BOOST_TEST(mode.exponent.real() == one.real(), tolerance(0.02));
        ++found;
      }
  BOOST_TEST(found == 2);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused_with_its_place) {
  const auto has = [](const std::string& entry, const std::string& words) {
    const std::string message =
        message_of(carrier("u3", 0.0) + "tuned_mass_dampers: [{" + entry + "}]\n");
    BOOST_TEST((message.find(words) != std::string::npos), message);
  };
  has("on: hub, mass: 1", "expected nacelle, tower, got \"hub\"");
  has("on: blades, mass: 1, flap: {stiffness: 1}", "expected nacelle, tower, got \"blades\"");
  has("on: tower, mass: 1, fore_aft: {stiffness: 1}", "missing key \"at\"");
  has("on: nacelle, at: 0.3, mass: 1, fore_aft: {stiffness: 1}", "unknown key \"at\"");
  has("on: nacelle, mass: 1", "missing key \"vertical\"");
  has("on: nacelle, mass: 1, flap: {stiffness: 1}", "unknown key \"flap\"");
  has("on: nacelle, mass: 0, fore_aft: {stiffness: 1}", "mass: expected a number > 0");
  has("on: nacelle, mass: 1, fore_aft: {damping: 1}", "missing key \"stiffness\"");
  has("on: nacelle, mass: 1, fore_aft: {stiffness: 1}, side_side: {stiffness: 1}, vertical: "
      "{stiffness: 1}",
      "one axis or two");
}

BOOST_AUTO_TEST_SUITE_END()
