// Derivatives of exponents to numbers of a case: a hinged blade in closed form, and differences of
// the exponents that floquet finds by integration.
#include "samara/simulation/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/format.hpp"
#include "samara/io/case_numbers.hpp"

#include "air_case.hpp"

using namespace samara;
using namespace samara::test;
using Complex = std::complex<double>;
using simulation::Parameter;
using simulation::Sensitivity;

namespace {

/// A case with its modes by integration.
struct Solved {
  explicit Solved(const io::Case& input) : steady(input), set(steady.floquet(input.floquet)) {}
  Steady steady;
  analysis::ModeSet set;
};

io::Case with_value(const io::Case& input, const Parameter& parameter, double value) {
  std::vector<std::string> settings = input.settings;
  settings.push_back(parameter.key + "=" + shortest(value));
  return io::parse_case(input.path, input.file_text(), settings);
}

std::vector<Parameter> parameters_of(const io::Case& input, const std::vector<std::string>& keys) {
  std::vector<Parameter> parameters;
  for (const std::string& key : keys)
    for (const io::CaseNumber& number : io::find_numbers(input, key))
      parameters.push_back({number.key, number.value, ""});
  return parameters;
}

/// Modes that are resolved, move, and are not the air's.
std::vector<std::size_t> compared_modes(const analysis::ModeSet& set, double highest) {
  std::vector<std::size_t> modes;
  for (std::size_t m = 0; m < set.modes.size(); ++m) {
    const analysis::Mode& mode = set.modes[m];
    const double size = std::abs(mode.exponent);
    if (mode.resolved && !is_of_medium(mode) && size > 1e-3 * set.rotor_speed && size < highest)
      modes.push_back(m);
  }
  return modes;
}

std::vector<Sensitivity> sensitivities_of(const Solved& solved,
                                          const std::vector<std::size_t>& modes,
                                          const std::vector<Parameter>& parameters) {
  analysis::Observer silent;
  const io::Case& input = solved.steady.input;
  return simulation::find_sensitivities(
      input, solved.steady.system, solved.steady.trim, solved.set, modes, parameters,
      [&input](const Parameter& parameter, double value) {
        return with_value(input, parameter, value);
      },
      silent, PETSC_COMM_SELF);
}

/// The exponent of `set` that belongs to a mode of another set: next to it, of the same name if
/// there is one nearby.
Complex nearest(const analysis::ModeSet& set, const analysis::Mode& mode) {
  Complex best;
  double least = 1e300;
  for (const analysis::Mode& other : set.modes) {
    const double distance = std::abs(other.exponent - mode.exponent) +
                            (other.name == mode.name ? 0.0 : 0.05 * std::abs(mode.exponent));
    if (is_of_medium(other) || distance >= least) continue;
    least = distance;
    best = other.exponent;
  }
  return best;
}

/// Steps of differences, relative to the value. Exponents that are as close to each other as those
/// of blades that differ by a few steps ask for shorter ones: the truncation falls with the fourth
/// power.
constexpr double usual_step = 2e-3;
constexpr double short_step = 2e-4;

/// Of derivatives to differences, both of fourth order, with steady states to 1e-13.
constexpr double tolerance = 1e-5;

/// Compares derivatives with differences of fourth order, relative to the modulus of the exponent
/// by the value, or to the derivative where this is larger or the value is 0.
void compare_with_differences(const io::Case& input, const std::vector<std::string>& keys,
                              double highest, double relative_step, int least_compared) {
  const Solved solved(input);
  const std::vector<std::size_t> modes = compared_modes(solved.set, highest);
  const std::vector<Parameter> parameters = parameters_of(input, keys);
  const std::vector<Sensitivity> found = sensitivities_of(solved, modes, parameters);
  int compared = 0;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const double value = parameters[p].value;
    const double step = value == 0.0 ? 0.02 : relative_step * std::abs(value);
    std::vector<analysis::ModeSet> sets;
    for (const double offset : {-2.0, -1.0, 1.0, 2.0})
      sets.push_back(Solved(with_value(input, parameters[p], value + offset * step)).set);
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const analysis::Mode& mode = solved.set.modes[modes[i]];
      const Complex expected = (nearest(sets[0], mode) - 8.0 * nearest(sets[1], mode) +
                                8.0 * nearest(sets[2], mode) - nearest(sets[3], mode)) /
                               (12.0 * step);
      const Complex rate = found[p].rates[i];
      if (std::isnan(rate.real())) continue;
      const double scale = std::max(std::abs(expected),
                                    value == 0.0 ? 0.0 : std::abs(mode.exponent) / std::abs(value));
      BOOST_TEST_CONTEXT(parameters[p].key << ", " << mode.label << " " << mode.exponent << ": "
                                           << rate << ", by differences " << expected)
      BOOST_TEST(std::abs(rate - expected) < tolerance * scale);
      ++compared;
    }
  }
  BOOST_TEST(compared >= least_compared);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(sensitivity)

BOOST_AUTO_TEST_CASE(a_hinged_blade_has_its_closed_form) {
  // lambda^2 + (c/I) lambda + k/I + Omega^2 (1 + e S/I) = 0 of a rigid uniform blade of length l
  // with S = m l^2/2, I = m l^3/3.
  constexpr double speed = 3.0, e = 1.0, l = 9.0, m = 4.0, k = 3000.0, c = 200.0;
  constexpr double S = m * l * l / 2.0, I = m * l * l * l / 3.0;
  const io::Case input = io::parse_case(
      "hinged",
      "samara: 1\ngravity: 0\nshaft: {speed: 3}\nhub: {radius: 1}\nblades:\n  length: 9\n"
      "  elements: 3\n  order: 2\n  count: 3\n  sections: [{mass: 4, inertia: [0, 0, 0], "
      "stiffness: "
      "{EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}}]\n"
      "  hinges: [{axis: flap, offset: 1, joint: free, stiffness: 3000, damping: 200}]\n",
      {});
  const Solved solved(input);
  const std::vector<std::size_t> modes = compared_modes(solved.set, 100.0);
  BOOST_TEST(modes.size() == 3U);
  const std::vector<Parameter> parameters =
      parameters_of(input, {"blades.hinges.0.stiffness", "blades.hinges.0.damping", "shaft.speed",
                            "blades.sections.*.mass"});
  BOOST_REQUIRE(parameters.size() == 4U);
  const std::vector<Sensitivity> found = sensitivities_of(solved, modes, parameters);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const analysis::Mode& mode = solved.set.modes[modes[i]];
    // In the rotor's axes all three have the same exponent, up to multiples of the speed.
    const double square = k / I + speed * speed * (1.0 + e * S / I);
    const Complex lambda(-0.5 * c / I, std::sqrt(square - 0.25 * c * c / (I * I)));
    const double copies = std::round((mode.exponent.imag() - lambda.imag()) / speed);
    BOOST_TEST(std::abs(mode.exponent - lambda - Complex(0.0, copies * speed)) < 1e-7);
    const Complex slope = 2.0 * lambda + c / I;
    const std::vector<Complex> expected{
        -1.0 / (I * slope), -lambda / (I * slope),
        -2.0 * speed * (1.0 + e * S / I) / slope + Complex(0.0, copies),
        (c / I * lambda + k / I) / (m * slope)};
    for (std::size_t p = 0; p < expected.size(); ++p) {
      BOOST_TEST_CONTEXT(parameters[p].key << ", " << mode.label)
      BOOST_TEST(std::abs(found[p].rates[i] - expected[p]) < 1e-7 * std::abs(expected[p]));
      BOOST_TEST(found[p].errors[i] < 1e-4 * std::abs(expected[p]));
    }
  }
}

BOOST_AUTO_TEST_CASE(derivatives_are_the_limits_of_differences) {
  // Two blades under gravity with a free yaw: periodic coefficients, no symmetry.
  compare_with_differences(
      io::read_case(input_path("lee2002/baseline"),
                    {"gravity=9.81", "floquet.steps=72", "trim.harmonics=6", "trim.tolerance=1e-13",
                     "nacelle.yaw.stiffness=2e5", "blades.damping=[0, 0, 0, 0.002, 0.002, 0.002]"}),
      {"tower.sections.*.stiffness.EI2", "shaft.speed", "gravity", "blades.damping.4"}, 25.0,
      usual_step, 16);
}

BOOST_AUTO_TEST_CASE(the_change_of_the_steady_air_is_included) {
  compare_with_differences(
      io::read_case(input_path("nrel5mw/land"),
                    {"blades.elements=2", "blades.element_lengths=[1, 1]", "blades.order=2",
                     "tower.elements=1", "tower.order=2", "gravity=0", "shaft.tilt_deg=0",
                     "wind.speed=9", "floquet.steps=144", "trim.tolerance=1e-13"}),
      {"wind.speed", "blades.pitch_deg", "shaft.speed_rpm"}, 8.0, usual_step, 12);
}

BOOST_AUTO_TEST_CASE(a_number_of_one_blade_breaks_the_symmetry) {
  const auto rotor = [](const std::string& mass_factor) {
    return io::read_case(
        input_path("nrel5mw/land"),
        {"aero=none", "blades.elements=2", "blades.element_lengths=[1, 1]", "blades.order=2",
         "tower.elements=1", "tower.order=2", "shaft.speed_rpm=10",
         "blades.each={2: {mass_factor: " + mass_factor + "}}", "floquet.steps=48",
         "trim.tolerance=1e-13"});
  };
  const std::vector<std::string> keys{"blades.each.2.mass_factor"};
  compare_with_differences(rotor("1.02"), keys, 8.0, usual_step, 8);
  // About a rotor of equal blades.
  compare_with_differences(rotor("1"), keys, 8.0, short_step, 6);
}

BOOST_AUTO_TEST_SUITE_END()
