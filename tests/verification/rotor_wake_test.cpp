// The finite-state wake of a whole rotor: momentum theory, decay rates in closed form, and the
// agreement of analyses with each other.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

#include "air_case.hpp"
#include "record.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

constexpr double pi = std::numbers::pi;

/// The rigid rotor of the NREL 5 MW turbine at its operating point in 20 m/s.
io::Case rotor_at_20(std::vector<std::string> settings) {
  settings.insert(settings.begin(), {"wind.speed=20", "shaft.speed_rpm=12.1",
                                     "blades.pitch_deg=17.47", "aero.inflow=peters_he"});
  return rigid_rotor(settings);
}

struct Means {
  double thrust = 0.0;   ///< of the loads on the blades [N]
  double balance = 0.0;  ///< 2 rho A V_T w_m [N]
};

Means find_means(const Steady& rotor) {
  const elements::AirRotor& air = rotor.system.turbine().air->rotor;
  const double area = pi * air.tip_radius * air.tip_radius;
  const int instants = simulation::instants_of_means(rotor.trim);
  Means means;
  means.thrust = simulation::mean_channels(rotor.system, rotor.trim, {"RtAeroFxh"}).front();
  simulation::visit_instants(rotor.system, rotor.trim, [&](double t, Vec z, Vec z_dot) {
    const auto flow =
        rotor.system.equations().disk_flow(t, petsc::values_of(z), petsc::values_of(z_dot));
    BOOST_REQUIRE(flow.has_value());
    means.balance += 2.0 * air.density * area * flow->speed * flow->mean / instants;
  });
  return means;
}

/// The mean load is in balance with the momentum of the flow through the disk, also in yaw.
BOOST_AUTO_TEST_CASE(thrust_is_the_momentum_of_the_flow_through_the_disk) {
  for (const std::string yaw : {"0", "30"}) {
    const Steady rotor(
        rotor_at_20({"wind.direction_deg=" + yaw, "trim.harmonics=6", "blades.order=1"}));
    const Means means = find_means(rotor);
    BOOST_TEST(means.thrust > 5e4);
    Figures{"A7", "momentum theory", ""}.check_relative("thrust [N], wind at " + yaw + " deg",
                                                        means.thrust, means.balance, 1e-6);
  }
}

/// Away from stall and tip the balance of momentum in each annulus and that of the states agree.
BOOST_AUTO_TEST_CASE(light_loads_have_the_power_of_the_momentum_theory_of_annuli) {
  const std::vector<std::string> names{"RotPwr", "RotThrust"};
  const Steady states(rotor_at_20({"aero.wake_shapes=[8]"}));
  const Steady annuli(rotor_at_20({"aero.inflow=equilibrium", "aero.thrust=buhl",
                                   "aero.tip_loss=false", "aero.hub_loss=false"}));
  const std::vector<double> found = states.channels(names);
  const std::vector<double> expected = annuli.channels(names);
  BOOST_TEST(found[0] == expected[0], tolerance(0.02));
  BOOST_TEST(found[1] == expected[1], tolerance(0.02));
}

/// Decay rates of a wake without load on the blades, in V/R, of an independent program.
BOOST_AUTO_TEST_CASE(wake_without_load_decays_with_the_rates_of_its_shapes) {
  io::Case input = rotor_at_20({"aero.wake_shapes=[3, 3, 3]", "blades.order=1"});
  for (model::AeroSectionDefinition& section : input.turbine.blades.aero_sections)
    section.chord *= 1e-6;
  Steady rotor(input);
  const analysis::ModeSet set = rotor.floquet({72, analysis::FloquetPeriod::automatic, 6});
  const double unit = 20.0 / rotor.system.turbine().air->rotor.tip_radius;
  std::vector<double> rates;
  for (const analysis::Mode& mode : set.modes)
    if (mode.label.find("inflow") != std::string::npos)
      rates.insert(rates.end(), mode.exponent.imag() == 0.0 ? 1 : 2, -mode.exponent.real() / unit);
  // Cosines and sines of a harmonic decay alike.
  std::vector<double> expected{2.0061, 5.1544, 11.4442};
  for (const double rate : {3.4534, 6.7227, 14.5549, 4.7687, 8.2356, 17.6898})
    expected.insert(expected.end(), 2, rate);
  std::ranges::sort(rates);
  for (const double rate : rates) BOOST_TEST_MESSAGE("rate " << rate);
  std::ranges::sort(expected);
  BOOST_REQUIRE(rates.size() == expected.size());
  for (std::size_t i = 0; i < rates.size(); ++i)
    BOOST_TEST(rates[i] == expected[i], tolerance(2e-4));
}

/// In skewed wind: the mean of V t is that of tau/2 for every shape, the load of the points on the
/// shape, and the induced velocity is larger on the downstream side.
BOOST_AUTO_TEST_CASE(every_shape_is_in_balance_with_its_load) {
  const Steady rotor(rotor_at_20({"wind.direction_deg=30", "trim.harmonics=10", "blades.order=1"}));
  const elements::AirRotor& air = rotor.system.turbine().air->rotor;
  const int instants = simulation::instants_of_means(rotor.trim);
  const std::vector<elements::WakeShape> shapes =
      elements::make_wake_shapes(air.models.wake_shapes);
  std::vector<double> loads(2 * shapes.size(), 0.0);
  std::vector<double> carried(2 * shapes.size(), 0.0);
  double downstream = 0.0;
  simulation::visit_instants(rotor.system, rotor.trim, [&](double t, Vec z, Vec z_dot) {
    const std::vector<double> state = petsc::values_of(z);
    const std::vector<double> rate = petsc::values_of(z_dot);
    const auto reports = rotor.system.equations().air_report<double>(t, state, rate, {});
    for (std::size_t k = 0; k < reports.size(); ++k)
      for (std::size_t p = 0; p < reports[k].size(); ++p) {
        const components::AirPointReport<double>& point = reports[k][p];
        const Vector3 arm = point.place - point.hub_place;
        const double length = rotor.system.turbine().blades[k].point_length(static_cast<int>(p));
        // Azimuth from the vertical, in the sense of turning: the axis is n2.
        const double psi = std::atan2(arm(0), arm(2));
        const double r = point.radius / air.tip_radius;
        for (std::size_t s = 0; s < shapes.size(); ++s) {
          const int m = shapes[s].harmonic;
          const double load = point.thrust * length *
                              elements::wake_shape_at<double>(shapes[s], r, 0.0)[0] /
                              ((m == 0 ? 4.0 : 2.0) * pi * air.density * air.tip_radius *
                               air.tip_radius * instants);
          loads[2 * s] += load * std::cos(m * psi);
          loads[2 * s + 1] += load * std::sin(m * psi);
        }
        // The wind turns toward -n1.
        downstream += point.induced_n * point.radius * length * (-arm(0));
      }
    const auto flow = rotor.system.equations().disk_flow(t, state, rate);
    for (std::size_t u = 0; u < rotor.system.unknowns().size(); ++u) {
      const system::Unknown& unknown = rotor.system.unknowns()[u];
      for (std::size_t s = 0; s < shapes.size(); ++s) {
        if (unknown.place != "harmonic " + std::to_string(shapes[s].harmonic)) continue;
        const std::string order = std::to_string(shapes[s].order);
        const double speed = s == 0 ? flow->speed : flow->carrying;
        if (unknown.quantity == "t_c" + order) carried[2 * s] += speed * state[u] / instants;
        if (unknown.quantity == "t_s" + order) carried[2 * s + 1] += speed * state[u] / instants;
      }
    }
  });
  BOOST_TEST(downstream < 0.0);
  const double largest = std::abs(loads[0]);
  int compared = 0;
  for (std::size_t s = 0; s < shapes.size(); ++s)
    for (std::size_t part = 0; part < 2; ++part) {
      if (shapes[s].harmonic == 0 && part == 1) continue;
      BOOST_TEST(std::abs(loads[2 * s + part] - carried[2 * s + part]) < 1e-6 * largest,
                 "harmonic " << shapes[s].harmonic << " order " << shapes[s].order << ": "
                             << loads[2 * s + part] << ", " << carried[2 * s + part]);
      if (std::abs(loads[2 * s + part]) > 1e-4 * largest) ++compared;
    }
  BOOST_TEST(compared >= 10);
}

BOOST_AUTO_TEST_CASE(blade_passage_and_revolution_agree_with_states_of_the_wake) {
  Steady turbine(io::read_case(
      input_path("nrel5mw/land"),
      {"wind.speed=14", "blades.pitch_deg=8.7", "shaft.speed_rpm=12.1", "wind.height=90",
       "wind.shear.power=0.2", "wind.direction_deg=20", "blades.order=1", "tower.order=3",
       "trim.harmonics=12", "trim.tolerance=1e-12", "aero.inflow=peters_he"}));
  require_same_exponents(turbine.floquet({72, analysis::FloquetPeriod::automatic, 6}),
                         turbine.floquet({72, analysis::FloquetPeriod::full, 6}), 1e-8);
}

/// With the balance of momentum this rotor has a thrust coefficient above 1.
BOOST_AUTO_TEST_CASE(a_rotor_that_stops_the_wind_is_refused) {
  io::Case input = rotor_at_20({"wind.speed=8", "blades.pitch_deg=-2", "aero.wake_shapes=[3]"});
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  analysis::Observer silent;
  std::string words;
  try {
    simulation::require_wake_range(system,
                                   simulation::solve_trim(input, system, input.trim, silent));
  } catch (const ConvergenceError& error) {
    words = error.what();
  }
  BOOST_TEST(words.find("aero.inflow: peters_he: the ") != std::string::npos, words);
  BOOST_TEST(words.find("the finite-state wake holds up to 0.") != std::string::npos, words);
}

}  // namespace
