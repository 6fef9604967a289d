// The NREL 5 MW reference turbine: natural frequencies of the parked turbine by two public codes,
// FAST and ADAMS (Jonkman et al., NREL/TP-500-38060 (2009), table 9-1).
#include <boost/test/unit_test.hpp>

#include "mesh_study.hpp"
#include "multiblade.hpp"
#include "record.hpp"
#include "ritz_turbine.hpp"

using namespace samara;
using namespace samara::test;

namespace {

/// Published blade mass [kg]; the deck's sections integrate to 17609 kg, as OpenFAST sums them over
/// few nodes.
constexpr double blade_mass = 17740.0;
constexpr double deck_blade_mass = 17608.8;

io::Case land(const std::vector<std::string>& settings) {
  return structure("nrel5mw/land", settings);
}

/// At rest, with blades as heavy as the report says.
io::Case parked(const std::vector<std::string>& settings) {
  io::Case input = land(with(settings, {"shaft.speed=0"}));
  for (model::SectionDefinition& section : input.turbine.blades.beam.sections)
    section.mass *= blade_mass / deck_blade_mass;
  return input;
}

struct Published {
  const char* name;   ///< begin of the names of the modes
  std::size_t place;  ///< among these, by frequency, from 1
  double fast;
  double adams;  ///< [Hz]
};

}  // namespace

BOOST_AUTO_TEST_CASE(parked_nrel5mw_lies_between_fast_and_adams) {
  // Within the spread of the two codes, widened by 2 %. The three blades' modes of a kind come as
  // two asymmetric ones and a collective one.
  const std::vector<Published> published{
      {"tower fore-aft", 1, 0.3240, 0.3195}, {"tower side-side", 1, 0.3120, 0.3164},
      {"shaft torsion", 1, 0.6205, 0.6094},  {"blade flap", 1, 0.6664, 0.6296},
      {"blade flap", 2, 0.6675, 0.6686},     {"blade flap", 3, 0.6993, 0.7019},
      {"blade lead-lag", 1, 1.0793, 1.0740}, {"blade lead-lag", 2, 1.0898, 1.0877},
      {"blade flap", 4, 1.9337, 1.6507},     {"blade flap", 5, 1.9223, 1.8558},
      {"blade flap", 6, 2.0205, 1.9601}};
  const analysis::ModeSet set = constant_modes_of(parked({}).turbine);
  const Figures page{"N1", "FAST and ADAMS, Jonkman et al. (2009), table 9-1",
                     "blades 3 elements of order 4, tower 1 of order 5"};
  for (const Published& mode : published) {
    std::vector<double> found = frequencies(set, mode.name);
    std::erase(found, 0.0);  // overdamped ones
    page.check_spread(std::string(mode.name) + " " + std::to_string(mode.place) + " [Hz]",
                      found.at(mode.place - 1) / (2.0 * pi), {mode.fast, mode.adams}, 0.02);
  }
  // The second tower modes share their energy with the blades, and their names with it.
  const std::vector<double> all = frequencies(set);
  const double fore_aft = nearest(all, pi * (2.9003 + 2.8590)) / (2.0 * pi);
  page.check_spread("second tower fore-aft [Hz]", fore_aft, {2.9003, 2.8590}, 0.02);
}

BOOST_AUTO_TEST_CASE(second_side_side_of_parked_nrel5mw_is_one_mode_in_the_published_shapes) {
  // The second collective edge mode of the blades, on the shaft that twists, comes as near to the
  // tower's second side-side mode as 0.3 Hz. FAST has one edge shape a blade, which leaves it out:
  // Ritz's method in FAST's shapes meets FAST's figure, in many it has two modes beside it, which
  // this program finds.
  const model::TurbineDefinition turbine = parked({}).turbine;
  const double shaft = turbine.shaft.torsion.stiffness;
  const RitzBlade theirs(turbine, {{0.0, 0.0, 0.3627, 2.5337, -3.5772, 2.376, -0.6952}},
                         {{0.0, 0.0, 0.0622, 1.7254, -3.2452, 4.7131, -2.2555},
                          {0.0, 0.0, -0.5809, 1.2067, -15.5349, 29.7347, -13.8255}});
  const RitzBlade converged(turbine, polynomials(2, 8), polynomials(2, 8));
  const std::vector<double> in_their_shapes = tower_frequencies(
      turbine, side_side_shapes(), top_of(turbine, false, &theirs), &theirs, 3, shaft);
  const std::vector<double> in_many = tower_frequencies(
      turbine, polynomials(2, 9), top_of(turbine, false, &converged), &converged, 8, shaft);
  const Figures page{"N1", "FAST, Jonkman et al. (2009), table 9-1; Ritz's method",
                     "blades 3 elements of order 4, tower 1 of order 5"};
  page.check_relative("second tower side-side, Ritz in FAST's shapes [Hz]", in_their_shapes[4],
                      2.9361, 0.01);
  const std::vector<double> all = frequencies(constant_modes_of(turbine));
  for (const auto& [name, mode] : {std::pair{"collective edge with tower side-side", 4u},
                                   std::pair{"tower side-side with collective edge", 5u}})
    page.check_relative(name + std::string(" [Hz]"),
                        nearest(all, 2.0 * pi * in_many[mode]) / (2.0 * pi), in_many[mode], 5e-3);
}

BOOST_AUTO_TEST_CASE(the_generator_of_parked_nrel5mw_rolls_once_with_the_tower) {
  // A locked generator does not turn against the nacelle, whatever its gear: 534 kg m^2 roll, which
  // is nothing beside the rotor's 4e7. Its inertia at the shaft's speed, 97^2 as much, would take
  // 0.31184 to 0.31113 Hz.
  const auto side_side = [](const std::vector<std::string>& keys) {
    const analysis::ModeSet set = constant_modes_of(land(with(keys, {"shaft.speed=0"})).turbine);
    return nearest(frequencies(set, "tower side-side"), 0.6 * pi) / (2.0 * pi);
  };
  const double geared = side_side({});
  BOOST_TEST(geared == 0.31184, boost::test_tools::tolerance(2e-5));
  BOOST_TEST(geared == side_side({"shaft.gear_ratio=-1"}), boost::test_tools::tolerance(1e-9));
  const std::string at_the_shaft =
      "shaft.generator.own_inertia=" + std::to_string(534.116 * 97 * 97);
  BOOST_TEST(side_side({"shaft.gear_ratio=1", at_the_shaft}) == 0.31113,
             boost::test_tools::tolerance(2e-5));
}

BOOST_AUTO_TEST_CASE(frequencies_of_parked_nrel5mw_converge_with_slope_two_s) {
  check_mesh_study(
      "N1", [](const std::vector<std::string>& mesh) { return mean_frequencies(parked(mesh)); });
}

BOOST_AUTO_TEST_CASE(nrel5mw_under_gravity_repeats_every_blade_passage) {
  // Full revolution and a third of one, with tilt, cone, twist and gravity.
  const io::Case input =
      land({"blades.elements=4", "blades.order=2", "tower.elements=2", "tower.order=2"});
  const analysis::Floquet fast =
      floquet_of(input.turbine, 600, analysis::FloquetPeriod::automatic, input.trim);
  const analysis::Floquet full =
      floquet_of(input.turbine, 600, analysis::FloquetPeriod::full, input.trim);
  BOOST_TEST(fast.sectors == 3);
  int seen = 0;
  for (const analysis::Mode& mode : full.set.modes) {
    if (!mode.resolved || mode.exponent.imag() > 30.0 || mode.exponent.imag() == 0.0) continue;
    double off = 1e9;
    for (const analysis::Mode& other : fast.set.modes)
      off = std::min(off, std::abs(mode.multiplier - other.multiplier) +
                              std::abs(mode.exponent.imag() - other.exponent.imag()) * 1e-3);
    ++seen;
    BOOST_TEST(off < 1e-6, mode.label << " " << mode.exponent << " " << off);
  }
  BOOST_TEST(seen >= 10);
}
