// Searches for some modes of turbines in wind, against all modes by integration over a period.
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/simulation/stability.hpp"

#include "air_case.hpp"
#include "hill_count.hpp"

using namespace samara;
using namespace samara::test;

namespace {

using Complex = std::complex<double>;

struct Example {
  std::string name;
  std::vector<std::string> settings;
  bool is_counted = true;
  std::size_t least = 5;  ///< modes that a search for six finds
};

/// Six points a blade.
const std::vector<std::string> coarse{"blades.elements=2", "blades.element_lengths=[1, 1]",
                                      "blades.order=3", "tower.elements=1", "tower.order=3"};

std::vector<std::string> with_coarse(std::vector<std::string> settings) {
  settings.insert(settings.begin(), coarse.begin(), coarse.end());
  return settings;
}

std::vector<Example> examples() {
  return {
      {"nrel5mw/land", with_coarse({})},
      {"nrel5mw/land", with_coarse({"wind.shear.power=0.2", "wind.direction_deg=20"})},
      {"nrel5mw/land", with_coarse({"aero.airfoil_dynamics=static", "aero.inflow=equilibrium"})},
      // The change from the search to the first number of harmonics is small by chance.
      {"nrel5mw/land",
       with_coarse({"aero.airfoil_dynamics=static", "aero.inflow=equilibrium", "wind.speed=12.5"})},
      {"nrel5mw/land", with_coarse({"aero.inflow=peters_he"})},
      {"iea15mw/land",
       with_coarse({"wind.speed=15", "shaft.speed_rpm=7.5", "blades.pitch_deg=10"})},
      // Teeter and inflow move together: modes of strong damping cannot be counted.
      {"two_bladed/teetering", with_coarse({}), false, 4},
  };
}

/// Each mode of `some` has an exponent among `all`, and each resolved mode of a part among `all` in
/// the region that was searched is one of `some`. Exponents agree within the estimated errors.
/// Motions of very strong damping are not told from those of the air.
void require_agreement(const analysis::ModeSet& some, const analysis::ModeSet& all, int least = 3) {
  BOOST_REQUIRE(some.searched);
  const analysis::SearchedRegion& region = *some.searched;
  const auto distance = [](Complex a, Complex b) { return std::abs(a - b); };
  for (const analysis::Mode& mode : some.modes) {
    BOOST_TEST(mode.resolved, mode.label);
    double best = std::numeric_limits<double>::infinity();
    double error = 0.0;
    bool is_of_air = false;
    for (const analysis::Mode& other : all.modes)
      if (const double apart = distance(mode.exponent, other.exponent); apart < best) {
        best = apart;
        error = other.step_error;
        is_of_air = is_of_medium(other);
      }
    BOOST_TEST(!is_of_air, mode.label << " " << mode.exponent);
    const double size = std::abs(mode.exponent);
    BOOST_TEST(best <= (mode.step_error + error + 1e-6) * size,
               mode.label << " " << mode.exponent << " " << best / size);
  }
  int inside = 0;
  for (const analysis::Mode& mode : all.modes) {
    const double modulus = std::abs(mode.exponent);
    if (!mode.resolved || is_of_medium(mode) || modulus < region.low || modulus > region.high ||
        -mode.exponent.real() > 0.99 * region.decay || mode.exponent.real() > region.growth ||
        mode.damping_ratio > 0.9)
      continue;
    ++inside;
    double best = std::numeric_limits<double>::infinity();
    for (const analysis::Mode& other : some.modes)
      best = std::min(best, distance(mode.exponent, other.exponent));
    BOOST_TEST(best < 1e-2 * modulus, mode.label << " " << mode.exponent << " is missing");
  }
  BOOST_TEST(inside >= least);
}

analysis::FloquetOptions some_modes(int modes) {
  analysis::FloquetOptions options;
  options.modes = modes;
  options.search = analysis::ModeSearch::hill;
  return options;
}

analysis::FloquetOptions slowest_decays(int modes) {
  analysis::FloquetOptions options;
  options.least_damped = modes;
  options.search = analysis::ModeSearch::hill;
  return options;
}

}  // namespace

BOOST_AUTO_TEST_CASE(searches_in_wind_agree_with_integration) {
  for (const Example& example : examples()) {
    std::string place = example.name;
    for (const std::string& setting : example.settings) place += " " + setting;
    BOOST_TEST_CONTEXT(place) {
      Steady turbine(io::read_case(input_path(example.name), example.settings));
      const analysis::ModeSet all = turbine.floquet({120, analysis::FloquetPeriod::automatic, 6});
      const analysis::ModeSet first = turbine.floquet(some_modes(6));
      BOOST_TEST(first.modes.size() >= example.least);
      require_agreement(first, all);
      if (example.is_counted) BOOST_TEST(first.searched->is_counted);
      const analysis::ModeSet slowest = turbine.floquet(slowest_decays(4));
      BOOST_TEST(slowest.modes.size() >= 4U);
      BOOST_TEST(slowest.searched->is_counted);
      require_agreement(slowest, all);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_mode_of_the_inflow_is_none_of_the_turbine) {
  // With a free yaw on a soft spring, part of the motion of a mode of the inflow is that of the
  // turbine: the search finds it, and the participation factors of its states tell what it is.
  Steady turbine(
      io::read_case(input_path("two_bladed/teetering"),
                    {"blades.elements=2", "blades.order=2", "tower.elements=1", "wind.speed=11",
                     "blades.pitch_deg=0", "nacelle.yaw={joint: free, stiffness: 4e6}"}));
  const analysis::ModeSet all = turbine.floquet({120, analysis::FloquetPeriod::automatic, 6});
  BOOST_TEST(std::ranges::any_of(all.modes, [](const analysis::Mode& mode) {
    return is_of_medium(mode) && mode.name == "inflow symmetric";
  }));
  require_agreement(turbine.floquet(some_modes(6)), all);
  const analysis::ModeSet slowest = turbine.floquet(slowest_decays(6));
  BOOST_TEST(slowest.modes.size() >= 6U);
  require_agreement(slowest, all);
}

BOOST_AUTO_TEST_CASE(a_shift_in_time_neither_grows_nor_decays) {
  // With a free generator one exponent is zero, whatever the steady state lacks: few harmonics move
  // it, and the speed's own decay by as much.
  for (const char* harmonics : {"2", "4", "12"}) BOOST_TEST_CONTEXT(harmonics << " harmonics") {
      Steady turbine(io::read_case(
          input_path("two_bladed/teetering"),
          {"blades.elements=2", "blades.order=2", "tower.elements=1", "wind.shear.power=0.2",
           "shaft.generator.joint=free", std::string("trim.harmonics=") + harmonics}));
      const analysis::ModeSet set = turbine.floquet({60, analysis::FloquetPeriod::automatic, 6});
      const simulation::StabilityAssessment found = simulation::assess_stability(set);
      BOOST_TEST(found.rigid_body == 1);
      BOOST_TEST(found.growing.empty());
      BOOST_TEST(found.may_grow.empty());
      const auto slowest = std::ranges::min_element(
          set.modes, {}, [](const analysis::Mode& mode) { return std::abs(mode.exponent); });
      BOOST_TEST(slowest->name == "rotor rotation");
    }
}

BOOST_AUTO_TEST_CASE(growth_beside_few_wanted_modes_in_wind) {
  // Beyond rated wind without pitch the rotor stalls: a mode grows, and modes of weaker decay lie
  // above the range of frequencies. Neither may take the place of a wanted mode in the range.
  for (const std::vector<std::string>& settings :
       {std::vector<std::string>{"wind.speed=20", "blades.pitch_deg=0"},
        {"wind.speed=20", "blades.pitch_deg=0", "blades.damping=0",
         "shaft.torsion.damping=30000000"}}) {
    Steady turbine(io::read_case(input_path("nrel5mw/land"), with_coarse(settings)));
    const analysis::ModeSet all = turbine.floquet({120, analysis::FloquetPeriod::automatic, 6});
    for (const int modes : {1, 2, 5})
      BOOST_TEST_CONTEXT(settings.size() << " settings, " << modes << " modes") {
        const analysis::ModeSet found = turbine.floquet(slowest_decays(modes));
        BOOST_TEST(found.modes.size() >= static_cast<std::size_t>(modes));
        BOOST_TEST(found.searched->is_counted);
        require_agreement(found, all, modes - 1);  // the last one is at the edge
      }
  }
}

BOOST_AUTO_TEST_CASE(search_in_wind_next_to_a_frequency) {
  Steady turbine(io::read_case(input_path("nrel5mw/land"), coarse));
  analysis::FloquetOptions options = some_modes(3);
  options.near_hz = 2.0;
  const analysis::ModeSet found = turbine.floquet(options);
  BOOST_TEST(found.searched->is_counted);
  require_agreement(found, turbine.floquet({120, analysis::FloquetPeriod::automatic, 6}));
}

/// Where the multiplier of a mode is real and negative, two motions have one frequency, half of the
/// rotor speed (of three of them with three blades) but for multiples of it. One may grow.
void require_both_motions(Steady& turbine, const analysis::FloquetOptions& options, int sectors) {
  const auto of_half_speed = [sectors](const analysis::ModeSet& set) {
    std::vector<Complex> exponents;
    for (const analysis::Mode& mode : set.modes) {
      const double turns = 2.0 * mode.exponent.imag() / set.rotor_speed;
      const double odd = std::remainder(turns - sectors, 2.0 * sectors);
      if (mode.resolved && !is_of_medium(mode) && mode.exponent.imag() > 0.1 * set.rotor_speed &&
          std::abs(sectors == 1 ? odd : std::remainder(turns - 1.0, 2.0)) < 1e-3)
        exponents.push_back(mode.exponent);
    }
    std::ranges::sort(exponents, {}, [](Complex one) { return one.real(); });
    return exponents;
  };
  const analysis::ModeSet all = turbine.floquet({120, analysis::FloquetPeriod::automatic, 6});
  const analysis::ModeSet found = turbine.floquet(options);
  const std::vector<Complex> expected = of_half_speed(all);
  const std::vector<Complex> exponents = of_half_speed(found);
  BOOST_REQUIRE(expected.size() == 2U);
  BOOST_REQUIRE(exponents.size() == expected.size());
  for (std::size_t i = 0; i < exponents.size(); ++i)
    BOOST_TEST(std::abs(exponents[i] - expected[i]) < 1e-3 * std::abs(expected[i]),
               exponents[i] << " " << expected[i]);
  BOOST_TEST(std::abs(expected[0].real() - expected[1].real()) > 3e-3 * std::abs(expected[0]));
  BOOST_TEST((simulation::assess_stability(found).stability ==
              simulation::assess_stability(all).stability));
}

BOOST_AUTO_TEST_CASE(two_motions_of_one_frequency_in_wind) {
  // A rotating beam with weight and thin air: one motion at half the speed grows.
  io::Case beam = io::read_case(input_path("beam/rotating"), {});
  std::string text = beam.file_text();
  text += R"(
  airfoils: {flat: {polars: [{table: [[-180, 0, 0.01, 0], [-90, 0, 1, 0], [-15, -1.5, 0.02, 0],
    [15, 1.5, 0.02, 0], [90, 0, 1, 0], [180, 0, 0.01, 0]]}]}}
  aero_sections: [{chord: 0.3, airfoil: flat}]
)";
  Steady rotating(io::parse_case(
      beam.path, text, {"wind.speed=5", "wind.density=0.02", "gravity=5", "shaft.speed=10.1"}));
  BOOST_TEST_CONTEXT("one blade") require_both_motions(rotating, some_modes(4), 1);
  // Three blades: the search has too few harmonics to couple a motion with its conjugate.
  Steady turbine(io::read_case(
      input_path("nrel5mw/land"),
      with_coarse({"wind.direction_deg=-60", "wind.shear.power=-0.5", "shaft.speed_rpm=12.2"})));
  BOOST_TEST_CONTEXT("three blades") require_both_motions(turbine, some_modes(6), 3);
}

/// In axial wind the tangents are constant in axes of the rotor: no harmonics are left out.
BOOST_AUTO_TEST_CASE(searches_in_axial_wind_are_exact) {
  Steady turbine(rotor_in_axial_wind({}));
  const analysis::ModeSet found = turbine.floquet(some_modes(8));
  BOOST_TEST(found.searched->is_counted);
  const analysis::ModeSet all = turbine.constant_modes();
  int compared = 0;
  for (const analysis::Mode& mode : found.modes) {
    double best = std::numeric_limits<double>::infinity();
    for (const analysis::Mode& other : all.modes)
      for (const double sign : {1.0, -1.0})
        best = std::min(
            best, std::hypot(other.exponent.real() - mode.exponent.real(),
                             std::remainder(sign * other.exponent.imag() - mode.exponent.imag(),
                                            found.rotor_speed)));
    BOOST_TEST(best < 1e-8 * std::abs(mode.exponent), mode.label << " " << mode.exponent);
    ++compared;
  }
  BOOST_TEST(compared >= 8);
}

/// The runaway rotor of instability_test.cpp, beyond its edge.
BOOST_AUTO_TEST_CASE(search_in_wind_finds_growth) {
  io::Case input =
      io::read_case(input_path("iea15mw/land"),
                    {"gravity=0", "shaft.tilt_deg=0", "wind.speed=10", "aero.inflow=equilibrium",
                     "blades.elements=3", "blades.order=3", "shaft.speed_rpm=14.5"});
  input.turbine.has_tower = false;
  Steady turbine(input);
  const analysis::ModeSet all = turbine.floquet({120, analysis::FloquetPeriod::automatic, 6});
  const analysis::ModeSet found = turbine.floquet(slowest_decays(4));
  BOOST_TEST((simulation::assess_stability(all).stability == simulation::Stability::unstable));
  BOOST_TEST((simulation::assess_stability(found).stability == simulation::Stability::unstable));
  require_agreement(found, all, 0);
}

BOOST_AUTO_TEST_CASE(count_in_wind_notices_a_missing_exponent) {
  Steady turbine(io::read_case(input_path("nrel5mw/land"), coarse));
  analysis::HillPencil pencil(turbine.system, turbine.trim.solution, 1);
  HillCount count(pencil, 1.5 * pencil.speed(), 0.6);
  for (std::size_t i = 0; i + 1 < count.found.size(); ++i) count.leave_out(i, 2);
  int checked = 0;
  for (std::size_t i = 0; i < count.found.size(); i += 2)
    if (count.leave_out(i, 1) > 0) ++checked;
  BOOST_TEST(checked >= 3);
}

/// In the complement of the border, couplings of less than 1e-4 of the largest one are left out.
BOOST_AUTO_TEST_CASE(the_preconditioner_solves_for_the_map_without_coupled_harmonics) {
  Steady turbine(io::read_case(input_path("nrel5mw/land"), coarse));
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  for (const int harmonics : {1, 3})
    for (const bool by_sector : {true, false}) {
      analysis::HillPencil pencil(turbine.system, turbine.trim.solution, harmonics, by_sector);
      const Complex shift = pencil.speed() * Complex(0.3, 2.4);
      BOOST_REQUIRE(pencil.set_shift(shift));
      Eigen::MatrixXcd x = Eigen::MatrixXcd::NullaryExpr(
          pencil.size(), 2, [&] { return Complex(normal(generator), normal(generator)); });
      pencil.drop_absent(x);
      Eigen::MatrixXcd y(x.rows(), x.cols());
      pencil.multiply_uncoupled(x, shift * x, y);
      Eigen::MatrixXcd solved(x.rows(), x.cols());
      pencil.precondition(y, solved);
      BOOST_TEST((solved - x).norm() <= (harmonics == 1 ? 1e-10 : 5e-3) * x.norm());
      Eigen::MatrixXcd coupled(x.rows(), x.cols());
      pencil.multiply(x, shift * x, coupled);
      BOOST_TEST((coupled - y).norm() > 1e-4 * y.norm());
    }
}
