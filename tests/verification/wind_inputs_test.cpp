// Linear models of turbines in wind: the answer to a constant change of the wind is the difference
// of two steady states.
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/base/format.hpp"
#include "samara/linear/linear_model.hpp"
#include "samara/turbine/turbine_input_output.hpp"

#include "air_case.hpp"

using namespace samara;
using namespace samara::test;

namespace {

const std::vector<std::string> wind_names{"wind_speed", "wind_direction", "wind_upflow",
                                          "wind_shear_up", "wind_shear_left"};

/// Change of outputs by a constant change of each input: D - C A^-1 B.
Eigen::MatrixXd slow_answers(const Steady& steady, const std::vector<std::string>& inputs,
                             const std::vector<std::string>& channels) {
  const turbine::TurbineInputOutput ports(steady.system, inputs, {}, channels);
  linear::LinearModel model(steady.system, ports, steady.trim.solution);
  const linear::StateSpace form = model.state_space(0.0);
  return form.D - form.C * form.A.partialPivLu().solve(form.B);
}

std::string number(double value) {
  std::string text = general(value, 17);
  return text;
}

/// A parked turbine with feathered blades meets a wind from the side.
BOOST_AUTO_TEST_CASE(parked_turbines_answer_to_every_change_of_the_wind) {
  const std::vector<std::string> channels{"TwrBsFxt",  "TwrBsFyt",  "TwrBsMzt",
                                          "RootFxc1",  "RootMyc2",  "YawBrMxp",
                                          "B1N5Alpha", "Wind1VelX", "RtAeroFxh"};
  constexpr double speed = 20.0;
  const auto steady_in = [&](const std::vector<std::string>& more) {
    std::vector<std::string> settings{
        "gravity=0",
        "shaft.speed=0",
        "blades.pitch_deg=80",
        "blades.elements=3",
        "blades.order=2",
        "tower.order=3",
        "wind.height=90",
        "aero.induction=none",
        "wind.nacelle={areas: [40, 30, 50], drag: 0.8, center: [0, 2, 2]}"};
    settings.insert(settings.end(), more.begin(), more.end());
    return Steady(io::read_case(input_path("nrel5mw/land"), settings));
  };
  const double height = steady_in({"wind.speed=20"}).system.turbine().air->hub_height;
  const auto steady_with = [&](const std::array<double, 5>& change) {
    constexpr double degree = std::numbers::pi / 180.0;
    const double V = speed + change[0];
    return steady_in(
        {"wind.speed=" + number(V), "wind.direction_deg=" + number(15.0 + change[1] / degree),
         "wind.upflow_deg=" + number(3.0 + change[2] / degree), "wind.height=" + number(height),
         "wind.shear={length: 1, up: " + number((0.02 + change[3]) / V) +
             ", left: " + number((-0.01 + change[4]) / V) + "}"});
  };
  const Eigen::MatrixXd found = slow_answers(steady_with({}), wind_names, channels);
  BOOST_REQUIRE(found.allFinite());
  for (std::size_t i = 0; i < 5; ++i) {
    const double step = i == 0 ? 1e-3 : 1e-5;
    std::array<double, 5> change{};
    change[i] = step;
    const std::vector<double> after = steady_with(change).channels(channels);
    change[i] = -step;
    const std::vector<double> before = steady_with(change).channels(channels);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double difference = (after[c] - before[c]) / (2.0 * step);
      const double answer = found(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(i));
      double largest = 0.0;
      for (Eigen::Index k = 0; k < 5; ++k)
        largest = std::max(largest, std::abs(found(static_cast<Eigen::Index>(c), k)));
      BOOST_TEST(std::abs(answer - difference) < 1e-4 * largest,
                 wind_names[i] << " to " << channels[c] << ": " << answer << ", " << difference);
    }
  }
}

/// A foot that turns about the vertical feels a wind that turns the other way.
BOOST_AUTO_TEST_CASE(a_turned_foot_is_a_wind_turned_back) {
  const std::vector<std::string> channels{"TwrBsFxt", "TwrBsFyt", "TwrBsMxt", "TwrBsMyt",
                                          "TwrBsMzt", "RootMyc2", "YawBrMxp", "YawBrFyp"};
  const Steady steady(io::read_case(
      input_path("nrel5mw/land"),
      {"gravity=0", "shaft.speed=0", "blades.pitch_deg=80", "blades.elements=3", "blades.order=2",
       "tower.order=3", "aero.induction=none", "wind.speed=20", "wind.direction_deg=15",
       "wind.upflow_deg=3", "wind.tower={sections: [[0, 6, 0.6], [87.6, 3.9, 0.6]]}",
       "wind.nacelle={areas: [40, 30, 50], drag: 0.8, center: [0, 2, 2]}"}));
  const Eigen::MatrixXd found =
      slow_answers(steady, {"wind_direction", "base_rot_n3"}, channels);  // second: its value
  for (Eigen::Index c = 0; c < found.rows(); ++c)
    BOOST_TEST(std::abs(found(c, 0) + found(c, 1)) < 1e-6 * found.col(0).cwiseAbs().maxCoeff(),
               channels[static_cast<std::size_t>(c)] << ": " << found(c, 0) << ", " << found(c, 1));
}

/// A turning rotor in axial wind, with every lag of the air.
BOOST_AUTO_TEST_CASE(thrust_and_torque_answer_to_the_speed_of_the_wind) {
  const std::vector<std::string> channels{"RotThrust", "RotTorq", "RtAeroFxh"};
  for (const std::string inflow : {"oye", "peters_he"}) {
    const auto steady_at = [&](double speed) {
      return Steady(
          rotor_in_axial_wind({"aero.inflow=" + inflow, "aero.wake_shapes=[3]",
                               "shaft.speed_rpm=12.1", "blades.pitch_deg=8.7", "blades.elements=3",
                               "aero.tau1=5", "wind.speed=" + number(speed)}));
    };
    const Eigen::MatrixXd found = slow_answers(steady_at(14.0), {"wind_speed"}, channels);
    const std::vector<double> after = steady_at(14.001).channels(channels);
    const std::vector<double> before = steady_at(13.999).channels(channels);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double difference = (after[c] - before[c]) / 0.002;
      const double answer = found(static_cast<Eigen::Index>(c), 0);
      BOOST_TEST(std::abs(answer / difference - 1.0) < 1e-4,
                 inflow << ", " << channels[c] << ": " << answer << ", " << difference);
    }
  }
}

}  // namespace
