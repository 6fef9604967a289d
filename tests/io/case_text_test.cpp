// A written turbine reads back as the same turbine.
#include "samara/io/case_text.hpp"

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/fields/field.hpp"
#include "samara/io/case.hpp"

namespace samara::io {
namespace {

const std::string everything = R"(samara: 1
title: 'a "title": with # signs'
gravity: 9.81
tower:
  reference_line: [[0, 0, 0], [0.1, 0.2, 9], [0, 0, 20]]
  order: 2
  sections:
    - at: 0
      mass: 100
      inertia: [12, 6, 6]
      mass_center: [0.1, -0.2]
      stiffness: {EA: 1e9, GA2: rigid, GA3: 3e8, GJ: 1e8, EI2: 2e8, EI3: 2.1e8}
    - at: 1
      mass: 80
      inertia: [12, 6, 6]
      stiffness: {EA: 1e9, GA2: rigid, GA3: 3e8, GJ: 1e8, EI2: 2e8, EI3: 2.1e8}
  damping: {fore_aft: 0.01, side_side: 0.012}
  tip_mass: 30
  point_masses: [{at: 0.5, mass: 40, center: [0, 0.1, 0]}]
  support:
    stiffness: {u1: 2e9, u2: rigid, theta2: 1e11, theta3: 1.1e11}
    mass: 1e5
    inertia: [1e5, 2e5, 3e5]
    added_mass: {u2: 5}
    damping: 2e-3
nacelle:
  mass: 500
  center_of_mass: [0, 0.3, 0.4]
  inertia: [10, 20, 30]
  yaw: {joint: prescribed, angle_deg: 7.3, harmonic: {per_rev: 2, amplitude_deg: 0.3, phase_deg: 40}}
shaft:
  speed_rpm: 71.3
  overhang: -2.2
  tilt_deg: -4.7
  height: 0.9
  azimuth_deg: 33
  mass: 20
  inertia: {axial: 3, transverse: 4}
  torsion: {joint: free, stiffness: 4e6, damping: 300}
  gear_ratio: -31.7
  generator: {joint: free, own_inertia: 2, torque_table: [[100, 3], [300, 12]]}
  rotor: {torque: 200, torque_slope: -30, torque_pitch_slope: -400}
hub:
  mass: 90
  inertia: [3, 4, 5]
  radius: 0.8
  point_masses: [{mass: 3, center: [0, 0, 0.3], inertia: [1, 1, 1]}]
  teeter:
    stiffness: 300
    stops: {angle_deg: 3.1, stiffness: 5e4, damping: 20}
    undersling: 0.2
    delta3_deg: 15
blades:
  count: 2
  precone_deg: -3.3
  pitch_deg: 1.7
  length: 9.3
  elements: 3
  sections:
    - mass: 8
      inertia: [0.2, 0.1, 0.1]
      stiffness_matrix:
        - [1e8, 0, 0, 0, 0, 1e3]
        - [0, 1e7, 0, 0, 0, 0]
        - [0, 0, 1e7, 0, 0, 0]
        - [0, 0, 0, 1e5, 0, 0]
        - [0, 0, 0, 0, 2e5, 0]
        - [1e3, 0, 0, 0, 0, 4e5]
      twist_deg: 5.1
  damping: [0, 0, 0, 1e-3, 2e-3, 3e-3]
  mass_damping: 0.1
  hinges:
    - {axis: flap, offset: 0.1, joint: free, stiffness: 1e4, damping: 3, delta3_deg: 11}
    - {axis: pitch, joint: prescribed, harmonic: {per_rev: 1, amplitude_deg: 2}}
  pitch_link_delta3_deg: 4
  each: {2: {pitch_deg: 0.4, mass_factor: 1.01, hinges: {flap: {damping: 0}}}}
  pitch_actuator: {frequency: 6, damping_ratio: 0.7, rate_limit_deg: 8, lowest_deg: -3}
  airfoils:
    circle:
      polars: [{table: [[-180, 0, 0.5, 0], [180, 0, 0.5, 0]]}]
      thickness: 1
    FFA-W3 24+:
      polars:
        - {reynolds: 7.5e5, table: [[-180, 0, 0.1, 0], [-17.3, -1, 0.02, 0.1], [180, 0, 0.1, 0]]}
        - reynolds: 3e6
          table: [[-180, 0, 0.1, 0], [9.7, 1.1, 0.013, -0.1], [33.3, 1, 0.7, 0], [180, 0, 0.1, 0]]
      lift_slope: 6.31
  aero_sections:
    - {at: 0.1, chord: 1.3, twist_deg: 13.7, airfoil: circle}
    - {at: 0.9, chord: 0.3, twist_deg: -0.7, airfoil: FFA-W3 24+, center: [0.01, -0.02]}
controller:
  speed_filter: 1.5
  pitch: {proportional: 0.02, integral: 0.008, gain_schedule_deg: 6.3}
wind:
  speed: 11.4
  height: 20.9
  shear: {power: 0.143, left: -0.1, up: 0.07, length: 20.2}
  direction_deg: 7.7
  veer_deg: 0.0123
  upflow_deg: 8.1
  density: 1.1
aero:
  induction: axial
  inflow: equilibrium
  tau1: 14.7
  closure: load
  thrust: buhl_f
  tip_loss: false
  hub_loss: false
  axial_drag: false
  tangential_drag: false
  skew: 0.7
  airfoil_dynamics: oye
  wake_constants: [0.3, 0.7, 0.14, 0.53]
  T_p: 1.5
  T_f: 6
  cut_out_deg: 47.3
tuned_mass_dampers:
  - {on: nacelle, mass: 20, position: [0, 1.5, 2], side_side: {stiffness: 700, damping: 7}}
  - {on: blade 2, at: 0.8, mass: 1, lead_lag: {stiffness: 7000, stops: {displacement: 0.1, stiffness: 5e4}}}
loads:
  - {beam: blade 1, at: 0.5, force: [0, 0, 50], follower: true}
  - {beam: tower, from: 0.1, to: 0.8, moment: [0, 20, 0], harmonic: {frequency: 3, amplitude: 0.1, mean: 1}}
  - {beam: blades, at: 1, force: [0, 1, 0], table: [[0, 1], [1, 2.5]]}
)";

void check_round_trip(const model::TurbineDefinition& turbine, const std::string& name) {
  const std::string text = write_case_text(turbine, {});
  const model::TurbineDefinition again = parse_case(name, text, {}).turbine;
  BOOST_TEST((again == turbine), name + " is not what was written");
}

BOOST_AUTO_TEST_SUITE(case_texts)

BOOST_AUTO_TEST_CASE(every_key_comes_back) {
  check_round_trip(parse_case("everything", everything, {}).turbine, "everything");
}

BOOST_AUTO_TEST_CASE(every_choice_of_wind_and_air_comes_back) {
  using Profile = model::WindDefinition::Profile;
  model::TurbineDefinition turbine = parse_case("everything", everything, {}).turbine;
  turbine.wind->exponent = 0.0;  // a power law all the same
  check_round_trip(turbine, "exponent 0");
  turbine.wind->profile = Profile::logarithmic;
  turbine.wind->roughness = 0.03;
  check_round_trip(turbine, "roughness");
  turbine.wind.emplace();
  check_round_trip(turbine, "still air");
  turbine.aero.emplace();
  BOOST_TEST(write_case_text(turbine, {}).find("aero: {}") != std::string::npos);
  check_round_trip(turbine, "the default models");
  turbine.aero->skew = 0.0;
  turbine.aero->dynamics = model::AirfoilDynamics::static_polar;
  check_round_trip(turbine, "no skewed wake");
  turbine.aero.reset();
  BOOST_TEST(write_case_text(turbine, {}).find("aero: none") != std::string::npos);
  check_round_trip(turbine, "no models");
  turbine.wind.reset();
  BOOST_TEST(write_case_text(turbine, {}).find("aero:") == std::string::npos);
  check_round_trip(turbine, "no wind");
}

BOOST_AUTO_TEST_CASE(inputs_come_back) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::string(SAMARA_SOURCE_DIR) + "/inputs")) {
    if (entry.path().extension() != ".yaml") continue;
    check_round_trip(read_case(entry.path().string(), {}).turbine, entry.path().string());
    ++count;
  }
  BOOST_TEST(count > 10);
}

BOOST_AUTO_TEST_CASE(angles_and_speeds_come_back_to_the_last_digit) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> in_file(-85.0, 85.0);
  const auto draw = [&] { return fields::deg.to_si(in_file(random)); };
  model::TurbineDefinition turbine = parse_case("everything", everything, {}).turbine;
  for (int i = 0; i < 200; ++i) {
    turbine.shaft.azimuth = draw();
    turbine.shaft.tilt = draw();
    turbine.blades.precone = draw();
    turbine.blades.beam.sections[0].twist = draw();
    turbine.blades.aero_sections[1].twist = draw();
    turbine.blades.airfoils["circle"].polars[0].angles = {-fields::deg.to_si(180.0), draw(),
                                                          fields::deg.to_si(180.0)};
    for (auto values : {&model::PolarDefinition::lift, &model::PolarDefinition::drag,
                        &model::PolarDefinition::moment})
      (turbine.blades.airfoils["circle"].polars[0].*values) = {0.1, draw(), 0.1};
    turbine.wind->direction = draw();
    turbine.wind->veer = fields::deg.to_si(1e-3 * in_file(random));
    turbine.gravity = std::abs(draw()) * 1e-7;
    turbine.shaft.speed = fields::rpm.to_si(std::abs(in_file(random)));
    turbine.controller->set_point = turbine.shaft.generator_speed();
    turbine.shaft.generator.law.table.clear();
    check_round_trip(turbine, "random");
  }
}

BOOST_AUTO_TEST_CASE(comments_stand_behind_their_keys) {
  model::TurbineDefinition turbine = parse_case("everything", everything, {}).turbine;
  turbine.hub.teeter.damping = 0.0;
  const std::string text = write_case_text(
      turbine, {{"a head"}, {{"shaft.overhang", "OverHang"}, {"hub.teeter.damping", "TeetDmp"}}});
  BOOST_TEST(text.starts_with("# a head\n"));
  BOOST_TEST(text.find("overhang: -2.2 ") != std::string::npos);
  BOOST_TEST(text.find("# m; OverHang\n") != std::string::npos);
  // A default that has a comment is written.
  BOOST_TEST(text.find("damping: 0 ") != std::string::npos);
  BOOST_TEST(text.find("height: 0.9") != std::string::npos);
  BOOST_TEST(text.find("center_of_mass: 0") == std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
}  // namespace samara::io
