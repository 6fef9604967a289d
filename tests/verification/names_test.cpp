// Names of modes, against shares of kinetic energy that are computed here.
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <Eigen/Eigenvalues>
#include <boost/test/unit_test.hpp>

#include "samara/model/masses.hpp"

#include "air_case.hpp"
#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

io::Case input(const std::string& name, const std::vector<std::string>& settings) {
  return structure(name, settings);
}

io::Case parsed(const std::string& text, const std::vector<std::string>& settings = {}) {
  return io::parse_case("test", text, settings);
}

struct Run {
  explicit Run(const io::Case& input)
      : turbine(model::build_turbine(input.turbine)),
        system(turbine, PETSC_COMM_SELF),
        trim(analysis::find_trim(system, input.trim, observer)) {}
  analysis::ModeSet constant() const { return find_constant_modes(system, trim.solution); }
  analysis::ModeSet floquet(int steps) {
    return find_floquet_modes(system, trim.solution,
                              {steps, analysis::FloquetPeriod::automatic, 2, {}}, PETSC_COMM_SELF,
                              observer)
        .set;
  }

  analysis::Observer observer;
  model::Turbine turbine;
  turbine::TurbineSystem system;
  analysis::Trim trim;
};

std::vector<std::string> labels(const analysis::ModeSet& set, std::size_t count) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(set.modes.at(i).label);
  return result;
}

double part_share(const analysis::Mode& mode, const std::string& part) {
  for (const analysis::PartShare& share : mode.parts)
    if (share.part == part) return share.share;
  return 0.0;
}

constexpr const char* twisted = R"(
samara: 1
gravity: 0
shaft: {speed: 6}
hub: {radius: 1}
blades:
  length: 10
  elements: 6
  order: 3
  sections:
  - {at: 0, mass: 1, inertia: [2.0e-6, 1.0e-6, 1.0e-6], twist_deg: 0, stiffness: &s {EA: rigid, GA2: rigid, GA3: rigid, GJ: 1.0e+6, EI2: 1.0e+4, EI3: 4.0e+4}}
  - {at: 1, mass: 1, inertia: [2.0e-6, 1.0e-6, 1.0e-6], twist_deg: 40, stiffness: *s}
)";

/// A rotor of three rigid blades on lag hinges with dampers, on a foundation with springs.
constexpr const char* lagging = R"(
samara: 1
gravity: 0
tower:
  length: 0.1
  elements: 1
  order: 1
  support:
    stiffness: {u1: 1240481.8, u2: 1240481.8, u3: rigid, theta1: rigid, theta2: rigid, theta3: rigid}
    mass: 3283.6
    inertia: [1, 1, 1]
    damping: 0.024184151673970547
  sections:
  - {mass: 1.0e-6, inertia: [2.0e-8, 1.0e-8, 1.0e-8], stiffness: &r {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}}
shaft: {speed_rpm: 120}
hub: {radius: 0.3048}
blades:
  count: 3
  length: 5.273414315577439
  elements: 2
  order: 3
  support: {stiffness: {theta3: 1}, damping: 4067.5, mass: 1.0e-6, inertia: [1.0e-6, 1.0e-6, 1.0e-6]}
  sections:
  - {at: 0, mass: 9.608006364328515, inertia: [2.0e-6, 1.0e-6, 1.0e-6], stiffness: *r}
  - {at: 1, mass: 26.383855575921856, inertia: [2.0e-6, 1.0e-6, 1.0e-6], stiffness: *r}
)";

/// A rotor of stiff blades whose generator turns freely, with torques that depend on the speed.
constexpr const char* generating = R"(
samara: 1
gravity: 0
shaft:
  speed: 10
  generator: {joint: free, own_inertia: 300, torque: 500, torque_slope: 40}
  rotor: {torque: 500, torque_slope: -25}
hub: {radius: 1, mass: 50, inertia: [5, 8, 5]}
blades:
  count: 3
  length: 5
  elements: 2
  order: 3
  sections:
  - {mass: 4, inertia: [2.0e-4, 1.0e-4, 1.0e-4], stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: 1.0e+9, EI3: 1.0e+9}}
)";

/// A rotor at rest of two rigid blades, each on a flap and a lag hinge with springs at the axis of
/// a shaft that twists. The hinges are turned with the pitch.
constexpr const char* hinged = R"(
samara: 1
gravity: 0
shaft:
  speed: 0
  torsion: {joint: free, stiffness: 1}
hub: {radius: 1, mass: 1, inertia: [1, 1, 1]}
blades:
  count: 2
  length: 10
  elements: 1
  order: 3
  pitch_deg: 0
  hinges:
  - {axis: pitch, joint: locked}
  - {axis: flap, joint: free, stiffness: 1.0e+4}
  - {axis: lag, joint: free, stiffness: 2.0e+4}
  sections:
  - {mass: 3, inertia: [2.0e-6, 1.0e-6, 1.0e-6], stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}}
)";

/// The two modes of `hinged` in which both blades move alike. A thin blade that turns by x about
/// the shaft and by y across it, both times as a whole, has the energy I (x_dot^2 + y_dot^2)/2.
/// Springs are in series: a moment (m, n) on both blades turns them by C (m, n), where the shaft
/// adds 1/k to the compliances of the hinges. A free generator of inertia J turns against the
/// rotor; then x is the turn of one against the other, with the inertia 2 I J/(2 I + J).
struct HingedModes {
  Eigen::Vector2d omega;
  Eigen::Vector2d turning;  ///< share of the energy in the turn about the shaft
  /// Part of the shaft's spring in this turn, and the larger one of those of the hinges.
  Eigen::Vector2d of_shaft, of_hinges;

  HingedModes(double k, double pitch, double generator) {
    const double inertia = 2.0 * 3.0 * (std::pow(11.0, 3) - 1.0) / 3.0;
    const double c = std::cos(pitch);
    const double s = std::sin(pitch);
    const double flap = 0.5e-4;
    const double lag = 0.25e-4;
    Eigen::Matrix2d C;
    C << 1.0 / k + s * s * flap + c * c * lag, s * c * (flap - lag), s * c * (flap - lag),
        c * c * flap + s * s * lag;
    const double reduced = generator > 0.0 ? inertia * generator / (inertia + generator) : inertia;
    const Eigen::Vector2d root(std::sqrt(reduced), std::sqrt(inertia));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(root.asDiagonal() * C *
                                                                root.asDiagonal());
    for (int i = 0; i < 2; ++i) {
      const double period = solver.eigenvalues()(1 - i);
      omega(i) = 1.0 / std::sqrt(period);
      turning(i) = std::pow(solver.eigenvectors()(0, 1 - i), 2);
      const Eigen::Vector2d turns = solver.eigenvectors().col(1 - i).cwiseQuotient(root);
      const Eigen::Vector2d moments = C.inverse() * turns;
      of_shaft(i) = moments(0) / k / turns(0);
      of_hinges(i) = std::max(s * flap * (s * moments(0) + c * moments(1)) / turns(0),
                              c * lag * (c * moments(0) - s * moments(1)) / turns(0));
    }
  }
};

/// Share of motion along b3 of the twisted sections in that along b2 and b3, of a blade of evenly
/// spread mass.
double flap_share(const Run& run, const Eigen::MatrixXcd& shape) {
  const model::Beam& beam = run.turbine.blades[0];
  double along = 0.0;
  double across = 0.0;
  for (int p = 0; p < beam.point_count(); ++p) {
    const auto at = static_cast<std::size_t>(p);
    const double twist = 40.0 * pi / 180.0 * beam.fractions[at];
    const Vector3 b2(0.0, std::cos(twist), -std::sin(twist));  // turned about -b1
    const Vector3 b3(0.0, std::sin(twist), std::cos(twist));
    const Eigen::Vector3cd u = shape.block<3, 1>(run.system.layout().blade_point(0, p), 0);
    along += beam.point_length(p) * std::norm(b3.cast<Complex>().dot(u));
    across += beam.point_length(p) * std::norm(b2.cast<Complex>().dot(u));
  }
  return along / (along + across);
}

}  // namespace

BOOST_AUTO_TEST_CASE(motion_energies_of_a_standing_turbine_sum_to_the_kinetic_energy) {
  // The one from positions, the other from inertial velocities, which at rest are lambda times
  // them, and of a hub that teeters have its mass only. Everything that can move does.
  const std::string spring = "{joint: free, stiffness: 1e7, damping: 1e5}";
  for (const io::Case& turbine :
       {input("two_bladed/teetering",
              {"shaft.speed_rpm=0", "gravity=0", "hub.inertia=[0, 0, 0]", "shaft.torsion=" + spring,
               "shaft.generator={joint: free, own_inertia: 534.116}", "nacelle.yaw=" + spring,
               "blades.elements=2", "tower.elements=1"}),
        input("nrel5mw/beam_blades", {"shaft.speed_rpm=0", "blades.elements=2", "tower.elements=1",
                                      "nacelle.yaw=" + spring}),
        input("nrel5mw/beam_blades",
              {"shaft.speed_rpm=0", "gravity=0", "blades.elements=2", "tower.elements=2",
               "nacelle.yaw=" + spring,
               "tuned_mass_dampers=[{on: nacelle, position: [1, 3, 2], mass: 2e4, fore_aft: "
               "{stiffness: 9e4}, side_side: {stiffness: 7e4}}, {on: tower, at: 0.6, position: [0, "
               "1, 2], mass: 1e4, fore_aft: {stiffness: 3e5}}, {on: blades, at: 0.7, position: "
               "[0.3, 0.1, 0.2], mass: 200, flap: {stiffness: 3000}, axial: {stiffness: 5e4}}, "
               "{on: blade 2, at: 1, mass: 50, lead_lag: {stiffness: 900}}]"})}) {
    Run run(turbine);
    const analysis::ModeSet set = run.constant();
    const petsc::Handle<Vec> z = run.system.make_state();
    const petsc::Handle<Vec> z_dot = run.system.make_state();
    run.trim.solution.evaluate(0.0, z.get(), z_dot.get());
    const auto energies = run.system.motion_energies(0.0, z.get());
    std::size_t tested = 0;
    for (std::size_t m = 0; m < set.modes.size() && tested < 30; ++m) {
      const analysis::Mode& mode = set.modes[m];
      if (!mode.resolved || std::abs(mode.exponent) < 1e-3) continue;
      const Eigen::VectorXcd rate = mode.exponent * set.shapes[m].col(0);
      BOOST_TEST(energies->of(rate, rate).sum() == mode.kinetic_energy, tolerance(1e-6));
      ++tested;
    }
    BOOST_TEST(tested == 30U);
  }
}

BOOST_AUTO_TEST_CASE(what_moves_out_of_its_chord_is_flap_at_any_speed) {
  // Near 6 rad/s the frequencies of two modes nearly meet, and little of their energy is strain.
  for (const double speed : {0.0, 3.0, 5.0, 6.0, 8.0, 12.0}) {
    const Run run(parsed(twisted, {"shaft.speed=" + std::to_string(speed)}));
    const analysis::ModeSet set = run.constant();
    int clear = 0;
    for (std::size_t m = 0; m < 5; ++m) {
      const double share = flap_share(run, set.shapes[m]);
      if (share > 0.8) BOOST_TEST(set.modes[m].name.starts_with("blade flap"), speed << " " << m);
      if (share < 0.2) BOOST_TEST(set.modes[m].name.starts_with("blade lead"), speed << " " << m);
      if (share > 0.8 || share < 0.2) ++clear;
    }
    BOOST_TEST(clear >= 3);
    if (speed != 6.0) continue;
    BOOST_TEST(flap_share(run, set.shapes[0]) == 0.94, tolerance(0.01));
    BOOST_TEST(labels(set, 4) == (std::vector<std::string>{"1st blade flap", "1st blade lead-lag",
                                                           "2nd blade flap", "2nd blade lead-lag"}),
               boost::test_tools::per_element());
  }
}

BOOST_AUTO_TEST_CASE(a_motion_of_the_blades_is_not_the_foundations) {
  const analysis::ModeSet set = Run(parsed(lagging)).floquet(400);
  BOOST_REQUIRE(set.modes.size() == 5U);
  for (const analysis::Mode& mode : set.modes) {
    if (part_share(mode, "blade") > 0.9)
      BOOST_TEST(mode.name.starts_with("blade lag hinge"), mode.label);
    if (part_share(mode, "tower") > 0.7)
      BOOST_TEST(mode.name.starts_with("foundation"), mode.label);
  }
  BOOST_TEST(part_share(set.modes[0], "blade") > 0.95);
}

BOOST_AUTO_TEST_CASE(hinges_of_a_blade_have_names_of_their_own) {
  // On weak springs a blade of 1 kg/m moves about its hinge long before it bends.
  for (const auto& [direction, name] :
       {std::pair{"theta2", "blade flap hinge"}, std::pair{"theta3", "blade lag hinge"}}) {
    std::string text = twisted;
    const auto place = text.find("  length");
    text.insert(place, "  support: {stiffness: {" + std::string(direction) +
                           ": 1.0e+3}, mass: 1.0e-3, inertia: [1.0e-3, 1.0e-3, 1.0e-3]}\n");
    const analysis::ModeSet set = Run(parsed(text)).constant();
    BOOST_TEST(set.modes[0].label == name);
  }
}

BOOST_AUTO_TEST_CASE(torsion_of_blades_is_not_that_of_the_shaft) {
  const std::string torsion = "shaft.torsion={joint: free, stiffness: 867637000, damping: 6215000}";
  const analysis::ModeSet set =
      Run(input("nrel5mw/beam_blades", {torsion, "blades.elements=4", "tower.elements=1"}))
          .floquet(300);
  int shaft = 0;
  int blades = 0;
  for (const analysis::Mode& mode : set.modes) {
    if (!mode.resolved) continue;
    if (mode.name.starts_with("shaft torsion")) {
      ++shaft;
      BOOST_TEST(mode.exponent.imag() / (2.0 * pi) == 0.62, tolerance(0.02));
    }
    // The blades' first torsion, at rest 5.57 Hz.
    const double hertz = mode.exponent.imag() / (2.0 * pi);
    if (hertz > 5.4 && hertz < 5.7) {
      ++blades;
      BOOST_TEST(mode.name.starts_with("blade torsion"), mode.label);
    }
  }
  BOOST_TEST(shaft == 1);
  BOOST_TEST(blades == 3);
}

BOOST_AUTO_TEST_CASE(the_mode_of_the_shaft_keeps_its_name_at_any_speed) {
  // At 4 rpm the blades' regressive flap is one revolution away from it, and takes half its energy.
  for (const int rpm : {4, 6, 8, 10, 12}) {
    const analysis::ModeSet set =
        Run(input("nrel5mw/land", {"shaft.speed_rpm=" + std::to_string(rpm)})).floquet(300);
    int found = 0;
    for (const analysis::Mode& mode : set.modes) {
      if (!mode.resolved || !mode.name.starts_with("shaft torsion")) continue;
      ++found;
      BOOST_TEST(mode.exponent.imag() / (2.0 * pi) == 0.617, tolerance(0.01));
    }
    BOOST_TEST(found == 1, rpm << " rpm");
  }
}

BOOST_AUTO_TEST_CASE(a_rotor_that_turns_on_its_shaft_is_shaft_torsion) {
  // More by the spring of the shaft than by a hinge; a stiffer shaft leaves the turn to the hinges.
  for (const double generator : {0.0, 500.0})
    for (const double pitch_deg : {5.0, 20.0, 35.0, 70.0}) {
      std::vector<std::string> of_turn;  // names of the mode that turns most, over the stiffness
      int compared = 0;
      for (double k = 1e3; k < 2e7; k *= 1.25)
        BOOST_TEST_CONTEXT("k " << k << " pitch " << pitch_deg << " generator " << generator) {
          std::vector<std::string> settings{"shaft.torsion.stiffness=" + std::to_string(k),
                                            "blades.pitch_deg=" + std::to_string(pitch_deg)};
          if (generator > 0.0)
            settings.push_back(
                "shaft.generator={joint: free, own_inertia: " + std::to_string(generator) + "}");
          const analysis::ModeSet set = Run(parsed(hinged, settings)).constant();
          const HingedModes expected(k, pitch_deg * pi / 180.0, generator);
          for (int i = 0; i < 2; ++i) {
            const auto found = std::ranges::min_element(set.modes, {}, [&](const auto& mode) {
              return std::abs(mode.exponent.imag() - expected.omega(i));
            });
            // The hub has 4e-4 of the inertia of the blades.
            BOOST_TEST(found->exponent.imag() == expected.omega(i), tolerance(1e-3));
            const bool is_turn = expected.turning(i) > 0.52;
            const bool is_shaft = found->name == "shaft torsion";
            if (is_turn) of_turn.push_back(found->name);
            if (is_turn && expected.of_shaft(i) > 1.05 * expected.of_hinges(i))
              BOOST_TEST(is_shaft, found->label);
            if (expected.turning(i) < 0.48 || expected.of_shaft(i) < 0.95 * expected.of_hinges(i))
              BOOST_TEST(!is_shaft, found->label);
            if (!is_shaft) BOOST_TEST(found->name.ends_with("hinge symmetric"), found->label);
            ++compared;
          }
        }
      BOOST_TEST(compared == 90);
      // The name changes once.
      BOOST_TEST(of_turn.front() == "shaft torsion");
      BOOST_TEST(of_turn.back().starts_with("blade"));
      int changes = 0;
      for (std::size_t i = 1; i < of_turn.size(); ++i)
        if ((of_turn[i] == "shaft torsion") != (of_turn[i - 1] == "shaft torsion")) ++changes;
      BOOST_TEST(changes == 1);
    }
}

BOOST_AUTO_TEST_CASE(one_mode_of_two_blades_on_a_soft_shaft_is_shaft_torsion) {
  // It meets the blades' symmetric flap near 6 rpm and goes from the upper to the lower of two
  // frequencies that stay apart. The momentum of the rotor about the shaft tells which one it is.
  for (const char* elements : {"2", "4"})
    for (const double pitch : {0.0, 12.0})
      for (const double rpm : {2.0, 4.0, 8.0, 10.0, 14.0, 16.0})
        BOOST_TEST_CONTEXT(rpm << " rpm, " << pitch << " deg, " << elements << " elements") {
          Run run(input("two_bladed/teetering", {std::string("blades.elements=") + elements,
                                                 "blades.pitch_deg=" + std::to_string(pitch),
                                                 "shaft.speed_rpm=" + std::to_string(rpm)}));
          const analysis::ModeSet set = run.floquet(60);
          std::map<std::string, int> count;
          for (const analysis::Mode& mode : set.modes) {
            const double hertz = mode.exponent.imag() / (2.0 * pi);
            if (hertz > 0.6 && hertz < 0.9) ++count[mode.label];
          }
          BOOST_TEST(count.size() == 2U);
          BOOST_TEST(count["shaft torsion"] == 1);
          BOOST_TEST(count["1st blade flap symmetric"] == 1);
        }
}

BOOST_AUTO_TEST_CASE(teeter_is_teeter_where_the_yaw_is_free) {
  // Two exponents belong to the yaw, which nothing restores, and two to the teeter, which turns at
  // the rotor's speed about the hinge.
  const analysis::ModeSet set =
      Run(input("two_bladed/teetering",
                {"nacelle.yaw={joint: free}", "blades.elements=3", "tower.elements=1"}))
          .floquet(300);
  BOOST_TEST(labels(set, 4) ==
                 (std::vector<std::string>{"1st yaw", "2nd yaw", "1st teeter", "2nd teeter"}),
             boost::test_tools::per_element());
  BOOST_TEST(set.modes[2].exponent.real() > 0.0);
  BOOST_TEST(set.modes[3].exponent.real() < 0.0);
}

BOOST_AUTO_TEST_CASE(a_rotor_that_turns_as_a_whole_is_rotor_rotation) {
  // Exponents 0 and (slope of the rotor - slope of the generator) / inertia = -65/1168, the inertia
  // 300 + 8 + 3 x 4 (6^3 - 1)/3 = 1168 kg m^2.
  const analysis::ModeSet set = Run(parsed(generating)).constant();
  BOOST_TEST(
      labels(set, 2) == (std::vector<std::string>{"1st rotor rotation", "2nd rotor rotation"}),
      boost::test_tools::per_element());
  BOOST_TEST(set.modes[0].exponent == 0.0);
  // The sections have inertias of 1e-4 kg m, and the blades bend a little.
  BOOST_TEST(set.modes[1].exponent.real() == -65.0 / 1168.0, tolerance(1e-5));
  BOOST_TEST(set.modes[1].exponent.imag() == 0.0);
  BOOST_TEST(set.modes[1].resolved);
}

BOOST_AUTO_TEST_CASE(a_joint_has_no_more_real_exponents_than_states) {
  // The article's free yaw and teeter on a hub without inertia, where shaft torsion is free: while
  // the rotor disc drifts, the nacelle yaws below it. The yaw has its two zero exponents already.
  const io::Case turning =
      input("lee2002/baseline",
            {"shaft.torsion={joint: free, stiffness: 1e7, damping: 1e3}", "hub.inertia=[0, 0, 0]"});
  Run run(turning);
  for (const int modes : {0, 10}) BOOST_TEST_CONTEXT("modes " << modes) {
      analysis::FloquetOptions options;
      options.modes = modes;
      options.search = analysis::ModeSearch::hill;
      const analysis::ModeSet set =
          find_floquet_modes(run.system, run.trim.solution, options, PETSC_COMM_SELF, run.observer)
              .set;
      std::map<std::string, std::vector<double>> real;
      for (const analysis::Mode& mode : set.modes)
        if (mode.resolved && mode.exponent.imag() == 0.0)
          real[mode.name].push_back(std::abs(mode.exponent.real()));
      BOOST_TEST(real.size() == 2U);
      BOOST_TEST_REQUIRE(real["yaw"].size() == 2U);
      for (const double size : real["yaw"]) BOOST_TEST(size < 1e-6);
      BOOST_TEST_REQUIRE(real["teeter"].size() == 2U);
      for (const double size : real["teeter"]) BOOST_TEST(size > 1e-3);
    }
}

BOOST_AUTO_TEST_CASE(a_slow_drift_of_the_rotor_is_rotor_rotation_at_any_rate) {
  // The weight of the blades bends them once a revolution, and a slow drift changes the phase: its
  // kinetic energy is that of the bending. The exponent of the speed is -slope N^2 / inertia about
  // the shaft; the inertia of the generator counts N^2 times. A free yaw has two zero exponents, of
  // which any combination with those of the azimuth is a mode.
  struct Drive {
    const char* input;
    double own_inertia;  ///< [kg m^2]
    double ratio;        ///< N
    std::vector<std::string> mesh;
    std::vector<double> slopes;  ///< [N m s]
    std::size_t yaws;
  };
  const std::vector<Drive> drives = {
      {"lee2002/baseline", 5.0, 1.0, {"blades.elements=3", "tower.elements=2"}, {3.0}, 2},
      {"nrel5mw/land",
       500.0,
       97.0,
       {"blades.elements=2", "blades.order=2", "tower.elements=1"},
       {1000.0, 3.0, 0.0},
       0}};
  for (const Drive& drive : drives)
    for (const double slope : drive.slopes)
      for (const int modes : {0, 6})
        BOOST_TEST_CONTEXT(drive.input << ", slope " << slope << ", modes " << modes) {
          std::vector<std::string> settings = drive.mesh;
          settings.push_back(
              "shaft.generator={joint: free, own_inertia: " + std::to_string(drive.own_inertia) +
              ", torque: 0, torque_slope: " + std::to_string(slope) + "}");
          const io::Case turning = input(drive.input, settings);
          Run run(turning);
          analysis::FloquetOptions options;
          options.modes = modes;
          options.search = analysis::ModeSearch::hill;
          const analysis::ModeSet set = find_floquet_modes(run.system, run.trim.solution, options,
                                                           PETSC_COMM_SELF, run.observer)
                                            .set;
          std::vector<double> rotation;
          std::size_t yaws = 0;
          for (const analysis::Mode& mode : set.modes) {
            if (mode.name == "yaw") ++yaws;
            BOOST_TEST((std::abs(mode.exponent.imag() / set.rotor_speed - 1.0) > 1e-3), mode.label);
            if (mode.name != "rotor rotation") continue;
            rotation.push_back(mode.exponent.real());
            BOOST_TEST(mode.exponent.imag() == 0.0);
          }
          BOOST_TEST(yaws == drive.yaws);
          BOOST_TEST_REQUIRE(rotation.size() == 2U);
          std::ranges::sort(rotation);
          BOOST_TEST(std::abs(rotation[1]) < 1e-4 * set.rotor_speed);
          const double squared = drive.ratio * drive.ratio;
          const double inertia =
              model::compute_masses(turning.turbine, run.turbine).rotor.inertia(1, 1);
          const double decay = slope * squared / (inertia + squared * drive.own_inertia);
          BOOST_TEST(std::abs(rotation[0] + decay) < 2e-2 * decay + 1e-5 * set.rotor_speed);
        }
}

BOOST_AUTO_TEST_CASE(blades_together_move_in_multiblade_components) {
  // With three uncoupled blades each component has the frequency of one blade,
  // which the ground sees at omega, omega + Omega and |omega - Omega|.
  std::string text = twisted;
  text.insert(text.find("  length"), "  count: 3\n");
  const Run one(parsed(twisted));
  const Run three(parsed(text));
  const analysis::ModeSet set = three.constant();
  const double omega = one.constant().modes[0].exponent.imag();
  const double speed = 6.0;
  std::vector<std::string> found;
  for (std::size_t m = 0; m < 3; ++m) {
    const analysis::Mode& mode = set.modes[m];
    BOOST_TEST(mode.exponent.imag() == omega, tolerance(1e-8));
    found.push_back(mode.label);
    // From blade 1 to blade 2, in the sense of the turning, the phase is 0, -120 or 120 degrees.
    const Eigen::VectorXcd shape = set.shapes[m].col(0);
    const Complex ratio = shape(three.system.layout().blade_tip(1) + 2) /
                          shape(three.system.layout().blade_tip(0) + 2);
    const double phase = mode.name.starts_with("blade flap collective")    ? 0.0
                         : mode.name.starts_with("blade flap progressive") ? -2.0 * pi / 3.0
                                                                           : 2.0 * pi / 3.0;
    BOOST_TEST(std::abs(ratio - std::polar(1.0, phase)) < 1e-5, mode.label << " " << ratio);
    const double fixed = phase == 0.0 ? omega : phase < 0.0 ? omega + speed : omega - speed;
    BOOST_TEST(mode.fixed_frame_frequency == std::abs(fixed), tolerance(1e-8));
  }
  BOOST_TEST(
      found == (std::vector<std::string>{"1st blade flap collective", "1st blade flap progressive",
                                         "1st blade flap regressive"}),
      boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(whirl_of_a_turbine_is_seen_in_the_fixed_frame) {
  const analysis::ModeSet set = Run(input("nrel5mw/land", {"shaft.speed_rpm=12"})).floquet(300);
  const double speed = set.rotor_speed;
  int whirls = 0;
  for (const analysis::Mode& mode : set.modes) {
    if (!mode.resolved) continue;
    const std::string& name = mode.name;
    const double omega = mode.exponent.imag();
    if (name.ends_with("regressive")) {
      BOOST_TEST(mode.fixed_frame_frequency == std::abs(omega - speed), tolerance(1e-12));
      ++whirls;
    } else if (name.ends_with("progressive")) {
      BOOST_TEST(mode.fixed_frame_frequency == omega + speed, tolerance(1e-12));
      ++whirls;
    } else if (name.ends_with("collective") || name.starts_with("shaft") ||
               name.starts_with("tower")) {
      BOOST_TEST(mode.fixed_frame_frequency == omega, tolerance(1e-12));
    }
  }
  BOOST_TEST(whirls >= 8);
}

BOOST_AUTO_TEST_CASE(modes_of_the_tower_have_its_own_frequency_at_any_speed) {
  // The first two of a turbine that stands on the ground hardly depend on the rotor speed. At 45
  // rpm the tower's fore-aft motion meets the flap of the blades, and most of the energy is in
  // these, one revolution away.
  for (const char* speed : {"4", "12", "30", "45", "46", "60"})
    BOOST_TEST_CONTEXT(speed << " rpm") {
      const analysis::ModeSet set =
          Run(input("nrel5mw/land", {std::string("shaft.speed_rpm=") + speed})).floquet(300);
      std::set<std::string> found;
      for (const analysis::Mode& mode : set.modes) {
        if (!mode.resolved || !mode.name.starts_with("tower")) continue;
        BOOST_TEST(mode.fixed_frame_frequency == mode.exponent.imag(), tolerance(1e-12));
        if (mode.number != 1) continue;
        BOOST_TEST(mode.exponent.imag() == 2.0 * pi * 0.31, tolerance(0.07));
        found.insert(mode.label);
      }
      BOOST_TEST(found.size() == 2);
    }
}

BOOST_AUTO_TEST_CASE(modes_that_mix_at_will_have_no_words_for_it) {
  // A round beam bends any way, and blades at rest that do not know of each other in any mixture.
  BeamCase round;
  const analysis::ModeSet set = constant_modes_of(definition_of(round));
  BOOST_TEST(
      labels(set, 6) == (std::vector<std::string>{"1st blade bending", "1st blade bending (2)",
                                                  "2nd blade bending", "2nd blade bending (2)",
                                                  "3rd blade bending", "3rd blade bending (2)"}),
      boost::test_tools::per_element());
  std::string text = twisted;
  text.insert(text.find("  length"), "  count: 3\n");
  const analysis::ModeSet rest = Run(parsed(text, {"shaft.speed=0"})).constant();
  BOOST_TEST(labels(rest, 6) ==
                 (std::vector<std::string>{"1st blade flap", "1st blade flap (2)",
                                           "1st blade flap (3)", "1st blade lead-lag",
                                           "1st blade lead-lag (2)", "1st blade lead-lag (3)"}),
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(modes_keep_their_numbers_where_others_are_left_out) {
  // The air damps the first flap modes more than the second ones; a search of the least damped
  // modes leaves them out, and one next to a frequency leaves out all that are slower.
  const std::vector<std::string> settings{
      "blades.elements=4", "blades.element_lengths=[4, 4, 3, 2]", "floquet.steps=48"};
  const auto modes_of = [&settings](const std::vector<std::string>& more) {
    Steady turbine(io::read_case(input_path("nrel5mw/land"), with(settings, more)));
    return turbine.floquet(turbine.input.floquet);
  };
  const analysis::ModeSet all = modes_of({});
  std::set<std::string> found;
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"floquet.least_damped=16", "floquet.search=hill"},
        std::vector<std::string>{"floquet.near_hz=7", "floquet.modes=2"}}) {
    const analysis::ModeSet some = modes_of(more);
    for (const analysis::Mode& mode : some.modes) {
      found.insert(mode.label);
      const auto same = std::ranges::find(all.modes, mode.label, &analysis::Mode::label);
      if (same == all.modes.end() || !same->resolved) continue;
      BOOST_TEST(std::abs(same->exponent - mode.exponent) < 0.02 * std::abs(mode.exponent),
                 more.front() << " " << mode.label);
    }
    BOOST_TEST(
        std::ranges::count(some.modes, "1st blade flap collective", &analysis::Mode::label) == 0);
    BOOST_TEST(
        std::ranges::count(some.modes, "2nd blade flap collective", &analysis::Mode::label) == 1);
  }
  BOOST_TEST(found.contains("2nd blade lead-lag progressive"));
}

BOOST_AUTO_TEST_CASE(a_second_mode_is_known_alone) {
  // Displacements of the second mode of a tower with a heavy top have no node below it; its moment
  // changes its sign.
  std::string text = R"(
samara: 1
gravity: 0
tower:
  length: 80
  elements: 4
  order: 4
  tip_mass: 4.0e+5
  sections:
  - {at: 0, mass: 4000, inertia: [1, 1, 1], stiffness: &s {EA: rigid, GA2: rigid, GA3: rigid, GJ: 3.0e+11, EI2: 4.0e+11, EI3: 3.0e+11}}
  - {at: 1, mass: 4000, inertia: [1, 1, 1], stiffness: *s}
)";
  const analysis::ModeSet set = Run(parsed(text)).constant();
  for (const std::string name : {"tower fore-aft", "tower side-side"}) {
    int expected = 0;
    for (const analysis::Mode& mode : set.modes) {
      if (mode.name != name || ++expected > 4) continue;
      BOOST_TEST(mode.shape_number == expected, mode.label);
    }
    BOOST_TEST(expected >= 4);
  }
}
