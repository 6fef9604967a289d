// The NREL 5 MW turbine at 12 rpm, under gravity, with tilt and cone, against OpenFAST with BeamDyn
// blades and ElastoDyn's tower; and what the discretization of those two does to the frequencies.
#include <boost/test/unit_test.hpp>

#include "mesh_study.hpp"
#include "multiblade.hpp"
#include "record.hpp"
#include "ritz_turbine.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

io::Case beam_blades(const std::vector<std::string>& settings) {
  return structure("nrel5mw/beam_blades", settings);
}

std::vector<std::string> coarse() {
  return {"blades.elements=2", "blades.order=2", "tower.elements=2", "tower.order=2"};
}

/// Converged to 0.1 % in the first modes of the blades.
std::vector<std::string> fine() {
  return {"blades.elements=12", "blades.order=3", "tower.elements=4", "tower.order=3"};
}

constexpr double rpm12 = 12.0 * pi / 30.0;
/// Polynomials of the whole blade and tower that are as good as converged, to 0.3 %.
constexpr int many = 14;
constexpr int beamdyn_order = 5;  // order_elem of the deck

}  // namespace

BOOST_AUTO_TEST_CASE(ritz_in_their_shapes_finds_what_beamdyn_and_elastodyn_find_alone) {
  // frequencies.txt of case 5MW_Land_BD_Linear of OpenFAST's regression tests, 12.1 rpm: each of
  // the three BeamDyn blades alone (their mean here: gravity makes them differ by 1 %), and
  // ElastoDyn without blades.
  const model::TurbineDefinition turbine = beam_blades({}).turbine;
  const double speed = 12.1 * pi / 30.0;
  const RitzBlade blade(turbine, beamdyn_order, speed);
  const std::vector<double> found = hertz(blade.squares);
  BOOST_TEST(found[0] == (0.738975804 + 0.747847739 + 0.740438615) / 3.0, tolerance(5e-3));
  BOOST_TEST(found[2] == (2.087324059 + 2.096841543 + 2.088817603) / 3.0, tolerance(5e-3));
  BOOST_TEST(found[3] == (3.785142507 + 3.789916179 + 3.785403199) / 3.0, tolerance(5e-3));
  BOOST_TEST(found[4] == (4.953143272 + 4.960876364 + 4.954502781) / 3.0, tolerance(5e-3));
  // The edgewise figure has no -Omega^2: there the motion is seen in axes that stand still (issue
  // 3394 of OpenFAST).
  const double edge = (1.110355322 + 1.115626950 + 1.111274933) / 3.0;
  const double in_turning_axes = std::sqrt(edge * edge - std::pow(speed / (2.0 * pi), 2));
  BOOST_TEST(found[1] == in_turning_axes, tolerance(5e-3));

  const std::vector<double> fore_aft =
      tower_frequencies(turbine, fore_aft_shapes(), top_of(turbine, true, nullptr), nullptr);
  const std::vector<double> side_side =
      tower_frequencies(turbine, side_side_shapes(), top_of(turbine, false, nullptr), nullptr);
  BOOST_TEST(side_side[0] == 0.349716321, tolerance(1e-2));
  BOOST_TEST(fore_aft[0] == 0.354365494, tolerance(1e-2));
  BOOST_TEST(fore_aft[1] == 2.882901234, tolerance(1e-2));
  BOOST_TEST(side_side[1] == 2.965064506, tolerance(1e-2));
}

BOOST_AUTO_TEST_CASE(nrel5mw_at_12_rpm_has_the_frequencies_of_openfast) {
  // OpenFAST with BeamDyn blades (one element of order 5) and ElastoDyn's tower (two shapes a
  // direction), the mean of 36 azimuths in multiblade coordinates (issue 3394, pull request 3400 of
  // OpenFAST): tower fore-aft and side-side; flap backward, collective; edge backward; flap
  // forward; edge collective, forward; second flap backward. Hz, to be met within 2 %. Side-side is
  // that of a rerun of the public code, the others were the same there to 2e-4.
  const std::vector<double> published{0.3250, 0.3179, 0.5429, 0.7575, 0.9001,
                                      0.9389, 1.0455, 1.3049, 1.8562};
  const model::TurbineDefinition turbine = beam_blades({}).turbine;
  std::vector<double> sideways;
  const std::vector<double> found = mean_frequencies(beam_blades(fine()), &sideways);
  BOOST_REQUIRE(found.size() >= published.size());
  BOOST_TEST(sideways[0] < std::sqrt(0.5));  // the spin mixes the two, 0.3 % apart
  BOOST_TEST(sideways[1] > std::sqrt(0.5));
  const std::vector<std::string> names{
      "tower fore-aft", "tower side-side", "flap backward", "flap collective",     "edge backward",
      "flap forward",   "edge collective", "edge forward",  "second flap backward"};
  const std::string source = "OpenFAST, BeamDyn blades, ElastoDyn tower";
  const std::string mesh = "blades 12 elements of order 3, tower 4 of order 3";
  const Figures page{"N2", source, mesh};
  // The first modes of the blades are met as they are, the others not: 6 % is a bound, no claim.
  for (std::size_t i = 0; i < published.size(); ++i) {
    const bool is_met = i >= 2 && i <= 7 && i != 6;
    page.check_relative(names[i] + " [Hz]", found[i], published[i], is_met ? 0.02 : 0.06);
  }
  // The reason: two shapes are too stiff for the tower, on which the locked rotor rolls
  // with its collective edge mode, and one element of order 5 for the second flap. Ritz's method in
  // the published code's shapes and in many, without a figure of this program, says by how much:
  // then all agree to 0.5 %.
  const RitzBlade theirs(turbine, beamdyn_order, rpm12);
  const RitzBlade converged(turbine, many, rpm12);
  const auto stiffer = [&](int mode) {
    return std::sqrt(theirs.squares(mode) / converged.squares(mode));
  };
  const std::vector<Polynomial> plenty = polynomials(2, 9);
  const Top pitching = top_of(turbine, true, &converged);
  const Top rolling = top_of(turbine, false, &converged);
  const double fore_aft = tower_frequencies(turbine, fore_aft_shapes(), pitching, nullptr)[0] /
                          tower_frequencies(turbine, plenty, pitching, nullptr)[0];
  const std::vector<double> roll_theirs =
      tower_frequencies(turbine, side_side_shapes(), rolling, &theirs);
  const std::vector<double> roll = tower_frequencies(turbine, plenty, rolling, &converged);
  const double turn = rpm12 / (2.0 * pi);  // between fixed and turning axes
  const std::vector<double> expected{found[0] * fore_aft,
                                     found[1] * roll_theirs[0] / roll[0],
                                     (found[2] + turn) * stiffer(0) - turn,
                                     found[3] * stiffer(0),
                                     (found[4] + turn) * stiffer(1) - turn,
                                     (found[5] - turn) * stiffer(0) + turn,
                                     found[6] * roll_theirs[2] / roll[2],
                                     (found[7] - turn) * stiffer(1) + turn,
                                     (found[8] + turn) * stiffer(2) - turn};
  for (std::size_t i = 0; i < published.size(); ++i)
    page.check_relative(names[i] + ", in its shapes [Hz]", expected[i], published[i], 0.005);

  // The tower does not droop as the rotor turns.
  const std::vector<double> still =
      mean_frequencies(beam_blades(with(fine(), {"shaft.speed_rpm=0"})));
  for (const std::size_t i : {0u, 1u}) BOOST_TEST(found[i] == still[i], tolerance(0.02));
}

BOOST_AUTO_TEST_CASE(frequencies_of_nrel5mw_at_12_rpm_converge_with_slope_two_s) {
  check_mesh_study("N2", [](const std::vector<std::string>& mesh) {
    return mean_frequencies(beam_blades(mesh));
  });
}

BOOST_AUTO_TEST_CASE(floquet_of_nrel5mw_under_gravity_is_near_the_mean_over_the_azimuth) {
  // The mean omits the part of the weight at three per revolution, which changes frequencies by
  // 1e-4.
  const io::Case input = beam_blades(coarse());
  const std::vector<double> mean = mean_frequencies(input);
  const analysis::Floquet floquet =
      floquet_of(input.turbine, 450, analysis::FloquetPeriod::automatic, input.trim);
  std::vector<double> seen;
  for (const analysis::Mode& mode : floquet.set.modes) {
    const double omega = mode.exponent.imag();
    for (const double k : {-1.0, 0.0, 1.0})
      seen.push_back(std::abs(omega + k * floquet.set.rotor_speed) / (2.0 * pi));
  }
  BOOST_REQUIRE(mean.size() >= 9u);
  for (std::size_t i = 0; i < 9; ++i)
    BOOST_TEST(nearest(seen, mean[i]) == mean[i], tolerance(5e-4));
}

BOOST_AUTO_TEST_CASE(edge_modes_of_the_nrel5mw_blade_are_flap_modes_less_the_speed) {
  // ElastoDyn's blade, which bends alone, without twist and cone: pitched by 90 degrees it flaps in
  // its edge modes. In the plane of rotation the centrifugal force follows the motion:
  // omega_edge^2 = omega_flap^2 - Omega^2.
  model::TurbineDefinition turbine = structure("nrel5mw/land", coarse()).turbine;
  turbine.has_tower = false;
  turbine.has_nacelle = false;
  turbine.gravity = 0.0;
  turbine.shaft.torsion.kind = model::JointKind::locked;
  turbine.blades.count = 1;
  turbine.blades.precone = 0.0;
  turbine.blades.beam.damping.setZero();
  for (model::SectionDefinition& section : turbine.blades.beam.sections) section.twist = 0.0;
  const std::vector<double> edge = frequencies(constant_modes_of(turbine), "blade lead-lag");
  turbine.blades.pitch = 0.5 * pi;
  const std::vector<double> pitched = frequencies(constant_modes_of(turbine));
  const double speed = turbine.shaft.speed;
  BOOST_REQUIRE(edge.size() >= 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double flap = std::sqrt(edge[i] * edge[i] + speed * speed);
    BOOST_TEST(nearest(pitched, flap) == flap, tolerance(1e-8));
  }
}
