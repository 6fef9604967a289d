// Instabilities of rotors in the air: a sweep finds the change of the sign of the damping, and a
// transient beyond it grows with the exponent.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "air_case.hpp"
#include "growth.hpp"

using namespace samara;
using namespace samara::test;

namespace {

/// The mode of a structure that grows most. Axial modes are undamped, and much faster.
FoundMode fastest_growth(const Steady& steady) {
  constexpr double fastest = 60.0;  // [rad/s]
  const analysis::ModeSet set = steady.constant_modes();
  FoundMode found;
  for (std::size_t i = 0; i < set.modes.size(); ++i) {
    const analysis::Mode& mode = set.modes[i];
    if (!mode.resolved || is_of_medium(mode) || mode.exponent.imag() < 1.0 ||
        mode.exponent.imag() > fastest)
      continue;
    if (found.shape.size() > 0 && mode.exponent.real() < found.mode.exponent.real()) continue;
    found = {mode, set.shapes[i].col(0)};
  }
  BOOST_REQUIRE(found.shape.size() > 0);
  return found;
}

/// Where the growth changes its sign, between one without growth and one with.
template <class At>
double edge_of(const At& at, double stable, double unstable, double tolerance) {
  BOOST_REQUIRE(fastest_growth(at(stable)).mode.exponent.real() < 0.0);
  BOOST_REQUIRE(fastest_growth(at(unstable)).mode.exponent.real() > 0.0);
  while (std::abs(unstable - stable) > tolerance) {
    const double middle = 0.5 * (stable + unstable);
    (fastest_growth(at(middle)).mode.exponent.real() > 0.0 ? unstable : stable) = middle;
  }
  return unstable;
}

/// A rotor at rest with feathered blades in a storm from the side: stall along the leading edge
/// feeds the lead-lag motion.
BOOST_AUTO_TEST_CASE(lead_lag_motion_at_standstill_grows_in_wind_from_the_side) {
  const auto parked = [](double direction) {
    return Steady(io::read_case(
        input_path("nrel5mw/land"),
        {"gravity=0", "shaft.speed=0", "blades.pitch_deg=90", "wind.speed=40", "blades.elements=3",
         "blades.order=2", "tower.order=3", "wind.direction_deg=" + std::to_string(direction)}));
  };
  const double edge = edge_of(parked, 10.0, 20.0, 0.1);
  BOOST_TEST_MESSAGE("edge at " << edge << " deg");
  const Steady beyond = parked(edge + 2.0);
  const FoundMode found = fastest_growth(beyond);
  BOOST_TEST(found.mode.label.find("lead-lag") != std::string::npos, found.mode.label);
  require_exponent(beyond.system, beyond.trim, found, {1.0, 200, 12}, 1e-2);
}

/// A rotor that runs away at small loads: bending and torsion of the blades flutter.
BOOST_AUTO_TEST_CASE(blades_of_a_runaway_rotor_flutter) {
  const auto runaway = [](double rpm) {
    io::Case input = io::read_case(
        input_path("iea15mw/land"),
        {"gravity=0", "shaft.tilt_deg=0", "wind.speed=10", "aero.inflow=equilibrium",
         "blades.elements=3", "blades.order=3", "shaft.speed_rpm=" + std::to_string(rpm)});
    input.turbine.has_tower = false;
    return Steady(input);
  };
  const double edge = edge_of(runaway, 13.0, 15.0, 0.1);
  BOOST_TEST_MESSAGE("edge at " << edge << " rpm");
  const Steady beyond = runaway(edge + 0.5);
  const FoundMode found = fastest_growth(beyond);
  BOOST_TEST_MESSAGE(found.mode.label << " " << found.mode.exponent);
  require_exponent(beyond.system, beyond.trim, found, {beyond.system.period(), 600, 4}, 1e-2);
}

}  // namespace
