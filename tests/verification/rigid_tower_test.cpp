// The paper's rotor on a rigid tower. With the yaw locked its coefficients are constant in rotor
// axes, and every mode can be checked against the exponents and against displacement methods.
#include <array>

#include <boost/test/unit_test.hpp>

#include "cases.hpp"
#include "ritz.hpp"

using namespace samara;
using namespace samara::test;
using analysis::FloquetPeriod;
using boost::test_tools::tolerance;

namespace {

const std::string locked = "nacelle.yaw.joint=locked";

io::Case locked_rotor(int elements, int order) {
  return lee("rigid_tower", with(mesh(false, elements, order), {locked}));
}

/// By independent displacement elements (Hermite), converged, five digits stable; per rev, by
/// name.
struct Converged {
  const char* name;
  double per_rev;
};
constexpr std::array<Converged, 10> converged{{{"teeter", 0.99901},
                                               {"blade lead-lag", 3.24336},
                                               {"blade flap symmetric", 3.40149},
                                               {"blade flap antisymmetric", 10.1671},
                                               {"blade lead-lag", 19.7123},
                                               {"blade flap symmetric", 20.0687},
                                               {"blade flap antisymmetric", 34.0731},
                                               {"blade torsion", 43.837},
                                               {"blade lead-lag", 53.684},
                                               {"blade flap symmetric", 55.817}}};

/// Frequencies of modes of that name, in multiples of the rotor speed.
double nearest_per_rev(const analysis::ModeSet& set, const Converged& wanted) {
  std::vector<double> found = frequencies(set, wanted.name);
  for (double& value : found) value /= set.rotor_speed;
  return nearest(found, wanted.per_rev);
}

/// Frequency after the map (19) of the step, and its inverse.

/// omega dt / 2 beyond which a mode counts as unresolved (docs/case_file.md).
constexpr double largest_half_phase = 0.7;

}  // namespace

BOOST_AUTO_TEST_CASE(converged_frequencies_are_those_of_hermite_elements) {
  // 2e-4 relative: the last digit of the shortest figure.
  const analysis::ModeSet set = constant_modes_of(locked_rotor(10, 3).turbine);
  for (const Converged& wanted : converged)
    BOOST_TEST(nearest_per_rev(set, wanted) == wanted.per_rev, tolerance(2e-4));
}

BOOST_AUTO_TEST_CASE(converged_frequencies_are_those_of_ritz) {
  // More digits than the print: 1e-6. The Ritz solution leaves out the coupling of flap and twist
  // by 2 I2 Omega, I2 = 1e-4 of 5 kg m.
  const analysis::ModeSet set = constant_modes_of(locked_rotor(10, 3).turbine);
  const double speed = set.rotor_speed;
  const RitzBeam blade{8.42, 1.8, speed, 67.5772, 5.0, 0.0001, 4.9999, 1e7};
  const std::vector<double> symmetric = ritz_frequencies(blade, false);
  const std::vector<double> lag = ritz_frequencies(blade, true);
  const std::vector<double> teetering = ritz_frequencies(blade, false, {true, 50.0, 5.0, 50.0});
  for (std::size_t i = 0; i < 2; ++i) {
    BOOST_TEST(nearest(frequencies(set, "blade flap symmetric"), symmetric[i]) == symmetric[i],
               tolerance(1e-6));
    BOOST_TEST(nearest(frequencies(set, "blade lead-lag"), lag[i]) == lag[i], tolerance(1e-6));
    BOOST_TEST(
        nearest(frequencies(set, "blade flap antisymmetric"), teetering[i + 1]) == teetering[i + 1],
        tolerance(1e-6));
  }
  BOOST_TEST(nearest(frequencies(set, "teeter"), teetering[0]) == teetering[0], tolerance(1e-6));
  // Torsion: I1 omega^2 = GJ (pi / 2 l)^2 + (I3 - I2) Omega^2, in closed form.
  const double torsion =
      std::sqrt(1e7 / 5.0 * std::pow(pi / 16.84, 2) + (4.9999 - 0.0001) / 5.0 * speed * speed);
  BOOST_TEST(nearest(frequencies(set, "blade torsion"), torsion) == torsion, tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(order_is_two_s_on_the_turning_rotor) {
  const RitzBeam blade{8.42, 1.8, 6.02, 67.5772, 5.0, 0.0001, 4.9999, 1e7};
  const double flap = ritz_frequencies(blade, false)[1];
  const double hinged = ritz_frequencies(blade, false, {true, 50.0, 5.0, 50.0})[1];
  // The teeter's own axes need no mesh: the hinged mode tests its coupling with the blades.
  for (const auto& [order, first] : {std::pair{1, 12}, std::pair{2, 4}, std::pair{3, 2}}) {
    std::vector<double> symmetric;
    std::vector<double> antisymmetric;
    for (const int elements : {first, 2 * first}) {
      const analysis::ModeSet set = constant_modes_of(locked_rotor(elements, order).turbine);
      symmetric.push_back(std::abs(nearest(frequencies(set, "blade flap symmetric"), flap) - flap));
      antisymmetric.push_back(
          std::abs(nearest(frequencies(set, "blade flap antisymmetric"), hinged) - hinged));
    }
    BOOST_TEST(std::log2(symmetric[0] / symmetric[1]) == 2.0 * order, tolerance(0.1));
    BOOST_TEST(std::log2(antisymmetric[0] / antisymmetric[1]) == 2.0 * order, tolerance(0.1));
  }
}

BOOST_AUTO_TEST_CASE(floquet_frequencies_are_the_converged_ones_at_coarse_steps) {
  // A converged step for torsion would be 1/6000 revolution. At 400 steps (19) turns omega into
  // (2/dt) atan(omega dt/2), exactly where the coefficients are constant, and the analysis maps it
  // back exactly.
  const analysis::Floquet floquet = floquet_of(locked_rotor(5, 3).turbine, 400);
  const analysis::ModeSet& set = floquet.set;
  for (std::size_t i = 0; i < 8; ++i)
    BOOST_TEST(nearest_per_rev(set, converged[i]) == converged[i].per_rev, tolerance(2e-4));
}

BOOST_AUTO_TEST_CASE(every_resolved_mode_is_identified_and_every_multiplier_is_the_steps_map) {
  // 4, 8, 16 elements; 200 and 500 steps by the blade's period, 501 by the full one. Not a mode is
  // missing, folded by the rotor speed, or a constraint's artefact: as sets, the multipliers are
  // mu = ((1 + l dt/2) / (1 - l dt/2))^n of the exponents l, all of them.
  struct Run {
    int steps;
    FloquetPeriod period;
  };
  for (const int elements : {4, 8, 16}) {
    const model::TurbineDefinition definition = locked_rotor(elements, 1).turbine;
    const analysis::ModeSet constant = constant_modes_of(definition);
    const auto d = static_cast<std::size_t>(6 * elements + 1);
    BOOST_TEST(constant.degrees_of_freedom == static_cast<int>(d));
    BOOST_REQUIRE(constant.modes.size() == d);
    for (const Run& run : {Run{200, FloquetPeriod::blade}, Run{500, FloquetPeriod::blade},
                           Run{501, FloquetPeriod::full}}) {
      BOOST_TEST_CONTEXT(elements << " elements, " << run.steps << " steps") {
        const analysis::Floquet floquet = floquet_of(definition, run.steps, run.period);
        BOOST_TEST(floquet.steps == run.steps);
        BOOST_TEST(floquet.set.degrees_of_freedom == static_cast<int>(d));
        BOOST_REQUIRE(floquet.set.modes.size() == d);  // pairs only: 2 x pairs = 2 d
        const double dt = floquet.step;
        std::vector<double> wanted;
        for (const analysis::Mode& mode : constant.modes) {
          const double half_phase = 0.5 * mode.exponent.imag() * dt;
          BOOST_REQUIRE(std::abs(half_phase - largest_half_phase) > 1e-6);
          if (half_phase < largest_half_phase) wanted.push_back(mode.exponent.imag());
        }
        std::sort(wanted.begin(), wanted.end());
        std::vector<double> found;
        std::size_t flagged = 0;
        for (const analysis::Mode& mode : floquet.set.modes) {
          if (mode.resolved)
            found.push_back(mode.exponent.imag());
          else
            ++flagged;
        }
        std::sort(found.begin(), found.end());
        BOOST_REQUIRE(found.size() == wanted.size());
        BOOST_TEST(flagged == d - wanted.size());
        for (std::size_t i = 0; i < found.size(); ++i)
          BOOST_TEST(found[i] == wanted[i], tolerance(1e-9));

        std::vector<Complex> multipliers;
        for (const analysis::Mode& mode : floquet.set.modes) {
          multipliers.push_back(mode.multiplier);
          multipliers.push_back(std::conj(mode.multiplier));
        }
        for (const analysis::Mode& mode : constant.modes) {
          const Complex mu = std::pow(step_map(mode.exponent, dt), run.steps);
          for (const Complex value : {mu, std::conj(mu)}) {
            const auto best = std::min_element(multipliers.begin(), multipliers.end(),
                                               [value](Complex a, Complex b) {
                                                 return std::abs(a - value) < std::abs(b - value);
                                               });
            const bool resolved = 0.5 * mode.exponent.imag() * dt < largest_half_phase;
            // 1e-9 where resolved: round-off, 1e-12 in an exponent of 1e3 rad/s. Elsewhere it grows
            // with omega dt.
            BOOST_TEST(std::abs(*best - value) < (resolved ? 1e-9 : 1e-5),
                       mode.label << " " << std::abs(*best - value));
            multipliers.erase(best);  // each serves once
          }
        }
        BOOST_TEST(multipliers.empty());
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(blade_period_rounds_odd_steps_up) {
  const analysis::Floquet floquet =
      floquet_of(locked_rotor(2, 1).turbine, 501, FloquetPeriod::blade);
  BOOST_TEST(floquet.steps == 502);
  BOOST_TEST(floquet.sectors == 2);
  BOOST_TEST(floquet.step == 2.0 * pi / 6.02 / 502.0, tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(degenerate_lead_lag_is_labelled_only_where_it_splits) {
  // With the yaw locked the two blades' lead-lag do not know of each other: any mixture of the two
  // is a mode, and which one comes out is round-off. Only the blade period tells them apart, for
  // half a revolution later they differ in sign.
  const model::TurbineDefinition definition = locked_rotor(6, 2).turbine;
  const analysis::ModeSet constant = constant_modes_of(definition);
  const analysis::ModeSet full = floquet_of(definition, 300, FloquetPeriod::full).set;
  for (const analysis::ModeSet* set : {&constant, &full})
    for (const analysis::Mode& mode : set->modes)
      if (mode.name.starts_with("blade lead-lag") && mode.resolved)
        BOOST_TEST(mode.label.find("symmetric") == std::string::npos, mode.label);
  const analysis::ModeSet fast = floquet_of(definition, 300, FloquetPeriod::blade).set;
  BOOST_TEST(frequencies(fast, "blade lead-lag symmetric").size() >= 1U);
  BOOST_TEST(frequencies(fast, "blade lead-lag antisymmetric").size() >= 1U);
}

BOOST_AUTO_TEST_CASE(azimuth_of_the_first_blade_changes_no_exponent_of_constant_tangents) {
  const analysis::ModeSet at_zero = constant_modes_of(locked_rotor(6, 1).turbine);
  const analysis::ModeSet turned = constant_modes_of(
      lee("rigid_tower", with(mesh(false, 6, 1), {locked, "shaft.azimuth_deg=37"})).turbine);
  for (std::size_t i = 0; i < at_zero.modes.size(); ++i)
    BOOST_TEST(turned.modes[i].exponent.imag() == at_zero.modes[i].exponent.imag(),
               tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(free_yaw_has_a_real_pair_a_double_zero_and_splits_the_lead_lag) {
  // By two independent formulations: +-0.0452473 to 1e-4 relative, lead-lag 3.41091. With the yaw
  // free the coefficients are periodic and (19)'s error is O(dt^2), of any size: two steps,
  // extrapolated.
  std::vector<double> growth;
  std::vector<double> lag;
  std::vector<double> symmetric_lag;
  for (const int steps : {500, 1000}) {
    const analysis::Floquet floquet =
        floquet_of(lee("rigid_tower", mesh(false, 4, 3)).turbine, steps);
    const double speed = floquet.set.rotor_speed;
    int zeros = 0;
    std::vector<double> real;
    for (const analysis::Mode& mode : floquet.set.modes) {
      if (std::abs(mode.exponent.imag()) > 1e-6 * speed) continue;
      BOOST_TEST(mode.harmonic == 0);
      // Nothing restores the yaw; the pair tilts the disc, at once per revolution about the hinge.
      const bool is_zero = std::abs(mode.exponent.real()) < 1e-5 * speed;
      BOOST_TEST(mode.name.starts_with(is_zero ? "yaw" : "teeter"),
                 mode.label << " " << mode.exponent);
      if (is_zero)
        ++zeros;
      else
        real.push_back(mode.exponent.real() / speed);
    }
    BOOST_REQUIRE(real.size() == 2U);
    // The impulses after a step leave a growth of a higher order than the step's error.
    BOOST_TEST(real[0] == -real[1], tolerance(1e-6));
    // mu = 1 is defective: round-off splits it into a real pair, or a complex one in one row.
    BOOST_TEST((zeros == 1 || zeros == 2));
    growth.push_back(std::max(real[0], real[1]));
    const std::vector<double> antisymmetric =
        frequencies(floquet.set, "blade lead-lag antisymmetric");
    lag.push_back(nearest(antisymmetric, 3.41 * speed) / speed);
    symmetric_lag.push_back(
        nearest(frequencies(floquet.set, "blade lead-lag symmetric"), 3.24 * speed) / speed);
  }
  const auto extrapolated = [](const std::vector<double>& v) { return v[1] + (v[1] - v[0]) / 3.0; };
  BOOST_TEST(extrapolated(growth) == 0.0452473, tolerance(1e-4));
  BOOST_TEST(extrapolated(lag) == 3.41091, tolerance(1e-5));
  BOOST_TEST(extrapolated(symmetric_lag) == 3.24336, tolerance(1e-5));
  // The estimate of a rigid rotor: sigma^2 = (I_1 + I_3 - I_2) / (2 (I_y3 + m d^2)), 0.24 % high.
  const double hub = 50.0 + 50.0 - 5.0;
  const double blades = 2.0 * 8.42 * (5.0 + 0.0001 - 4.9999);
  const double mass = 2.0 * 67.5772 * 8.42;
  const double estimate = std::sqrt((hub + blades) / (2.0 * (16599.0 + mass * 2.388 * 2.388)));
  BOOST_TEST(extrapolated(growth) == estimate, tolerance(4e-3));
}
