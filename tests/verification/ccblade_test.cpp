// The NREL 5 MW rotor with cone, tilt and shear against the published arrays of the tests of
// CCBlade.jl (Ning 2021): loads per length at 17 stations, and coefficients over the tip-speed
// ratio.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/math/rotation.hpp"

#include "air_case.hpp"
#include "record.hpp"

using namespace samara;
using namespace samara::test;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double hub = 1.5;  // [m]
constexpr double tip = 63.0;
constexpr double cone = 2.5 * pi / 180.0;
constexpr double wind = 10.0;  // [m/s]

/// Radii of the stations. They are the middles of these elements, which have one point each.
constexpr std::array<double, 17> radii{2.8667, 5.6,   8.3333,  11.75, 15.85,  19.95,
                                       24.05,  28.15, 32.25,   36.35, 40.45,  44.55,
                                       48.65,  52.75, 56.1667, 58.9,  61.6333};

Steady rotor_at(double ratio, const std::string& thrust) {
  io::Case input = io::read_case(
      input_path("nrel5mw/land"),
      {"gravity=0", "wind.speed=10", "wind.height=90", "wind.shear.power=0.2",
       "shaft.speed=" + std::to_string(ratio * wind / (tip * std::cos(cone))), "blades.elements=17",
       "blades.order=1",
       "blades.element_lengths=[2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 2, 2, 2]",
       "tower.elements=1", "tower.order=1", "shaft.torsion.joint=locked",
       "shaft.torsion.stiffness=0", "shaft.torsion.damping=0", "aero.airfoil_dynamics=static",
       "aero.inflow=equilibrium", "aero.skew=none", "aero.thrust=" + thrust, "trim.harmonics=8"});
  make_rigid(input.turbine.blades.beam);
  make_rigid(input.turbine.tower);
  for (model::AeroSectionDefinition& section : input.turbine.blades.aero_sections)
    section.center = {};
  return Steady(input);
}

using Report = components::AirPointReport<double>;

std::vector<std::vector<Report>> reports_at(const Steady& rotor, double t) {
  const petsc::Handle<Vec> z = rotor.system.make_state();
  const petsc::Handle<Vec> z_dot = rotor.system.make_state();
  rotor.trim.solution.evaluate(t, z.get(), z_dot.get());
  return rotor.system.equations().air_report<double>(t, petsc::values_of(z.get()),
                                                     petsc::values_of(z_dot.get()), {});
}

/// Loads per length normal to the coned blade and the shaft's circle, and along that circle.
struct Load {
  double normal, tangential;
};

Load load_of(const Report& report) {
  const Vector3 axis = report.hub_axes.col(1);
  const Vector3 arm = report.place - report.hub_place;
  const Vector3 e_r = (arm - axis * axis.dot(arm)).normalized();
  const Vector3 e_t = math::cross<double>(axis, e_r);
  // The blade leans upwind by the cone.
  const Vector3 normal = axis * std::cos(cone) + e_r * std::sin(cone);
  return {report.force.dot(normal), report.force.dot(e_t)};
}

BOOST_AUTO_TEST_CASE(loads_of_the_upper_blade_are_those_of_ccblade) {
  constexpr std::array<double, 17> normal{0.09718, 0.13149, 0.12221, 1.16349, 1.70013, 2.07163,
                                          2.51200, 3.13362, 3.69168, 4.38866, 5.06890, 5.46517,
                                          6.03506, 6.53913, 6.83139, 6.69267, 4.85157};  // kN/m
  constexpr std::array<double, 17> tangential{
      -0.03321, -0.08727, -0.12002, 0.46964, 0.62263, 0.63230, 0.64741, 0.68250, 0.69999,
      0.72188,  0.73655,  0.74939,  0.75291, 0.73925, 0.69812, 0.61452, 0.40353};
  const Steady rotor = rotor_at(7.55, "buhl_f");
  const std::vector<Report> blade = reports_at(rotor, 0.0).front();
  BOOST_REQUIRE(blade.size() == radii.size());
  double worst_normal = 0.0;
  double worst_tangential = 0.0;
  for (std::size_t i = 0; i < blade.size(); ++i) {
    const Load load = load_of(blade[i]);
    BOOST_TEST(std::abs(blade[i].radius / std::cos(cone) - radii[i]) < 2e-3);
    worst_normal = std::max(worst_normal, std::abs(load.normal * 1e-3 - normal[i]));
    worst_tangential = std::max(worst_tangential, std::abs(load.tangential * 1e-3 - tangential[i]));
  }
  const Figures figures{"A8", "CCBlade.jl, its tests", mesh_name(17, 1)};
  figures.check_absolute("largest difference of normal loads, by their largest",
                         worst_normal / *std::ranges::max_element(normal), 0.0, 5e-3);
  figures.check_absolute("largest difference of tangential loads, by their largest",
                         worst_tangential / *std::ranges::max_element(tangential), 0.0, 1e-2);
}

/// Trapezoids over the stations, with no load at hub and tip; mean of four azimuths.
BOOST_AUTO_TEST_CASE(coefficients_over_the_tip_speed_ratio_are_those_of_ccblade) {
  struct Expected {
    double ratio, power, thrust;
  };
  for (const Expected& expected :
       {Expected{6.789, 0.45890, 0.71170}, {8.842, 0.45764, 0.83263}, {10.895, 0.40136, 0.91873}}) {
    const Steady rotor = rotor_at(expected.ratio, "buhl");
    double thrust = 0.0;
    double torque = 0.0;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const std::vector<Report> blade =
          reports_at(rotor, rotor.system.period() * quarter / 4).front();
      double before_r = hub;
      Load before{0.0, 0.0};
      for (std::size_t i = 0; i <= blade.size(); ++i) {
        const double r = i < blade.size() ? radii[i] : tip;
        const Load load = i < blade.size() ? load_of(blade[i]) : Load{0.0, 0.0};
        const double half = 0.5 * (r - before_r) * 3.0 / 4.0;  // three blades, four azimuths
        thrust += half * (load.normal + before.normal) * std::cos(cone);
        torque += half * (load.tangential * r + before.tangential * before_r) * std::cos(cone);
        before_r = r;
        before = load;
      }
    }
    const double radius = tip * std::cos(cone);
    const double pressure = 0.5 * 1.225 * wind * wind * pi * radius * radius;
    const double speed = expected.ratio * wind / radius;
    const Figures figures{"A8", "CCBlade.jl, its tests", mesh_name(17, 1)};
    const std::string name = "tip-speed ratio " + in_short(expected.ratio) + ": ";
    figures.check_relative(name + "C_P", torque * speed / (pressure * wind), expected.power, 5e-3);
    figures.check_relative(name + "C_T", thrust / pressure, expected.thrust, 5e-3);
  }
}

}  // namespace
