// Orders of the time steps of Floquet on turbines, and agreement of blade and full period.
#include <boost/test/unit_test.hpp>

#include "turning.hpp"

using namespace samara;
using namespace samara::test;

namespace {

/// Two blades under gravity with rigid strains; the same with damping; three blades whose yaw turns
/// as prescribed; constant coefficients in rotor axes.
std::vector<std::pair<std::string, std::vector<std::string>>> turnings() {
  const std::vector<std::string> coarse{"blades.elements=1", "blades.order=3", "tower.elements=1",
                                        "tower.order=3"};
  return {{"lee2002/baseline", with(coarse, {"gravity=9.81", "trim.harmonics=6"})},
          {"lee2002/baseline",
           with(coarse, {"gravity=9.81", "trim.harmonics=6", "blades.damping=0.002"})},
          {"nrel5mw/land",
           with(coarse, {"nacelle.yaw={joint: prescribed, harmonic: {per_rev: 3, amplitude_deg: "
                         "2}}"})}};
}

double nearest_to(Complex wanted, const std::vector<Complex>& found) {
  double best = std::numeric_limits<double>::infinity();
  for (const Complex value : found) best = std::min(best, std::abs(value - wanted));
  return best;
}

/// Root mean square of the relative distances of the `count` slowest modes that oscillate from
/// those of a reference.
double distance(const analysis::ModeSet& set, const analysis::ModeSet& reference,
                std::size_t count) {
  std::vector<Complex> exact;
  for (const analysis::Mode& mode : reference.modes) exact.push_back(mode.exponent);
  double sum = 0.0;
  std::size_t seen = 0;
  for (const analysis::Mode& mode : set.modes) {
    if (!mode.resolved || mode.exponent.imag() < 0.1 * set.rotor_speed || seen == count) continue;
    ++seen;
    sum += std::pow(nearest_to(mode.exponent, exact) / std::abs(mode.exponent), 2);
  }
  BOOST_REQUIRE(seen == count);
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

BOOST_AUTO_TEST_CASE(errors_of_modes_fall_with_the_order_of_the_steps) {
  for (const auto& [name, settings] : turnings()) {
    Turning turbine(name, settings);
    const analysis::ModeSet reference = turbine.by_steps(300, 6);
    for (const auto& [order, steps] : {std::pair{2, 192}, std::pair{4, 96}, std::pair{6, 60}}) {
      const double coarse = distance(turbine.by_steps(steps, order), reference, 7);
      const double fine = distance(turbine.by_steps(2 * steps, order), reference, 7);
      BOOST_TEST_MESSAGE(name << " order " << order << ": " << coarse << " " << fine << " slope "
                              << std::log2(coarse / fine));
      BOOST_TEST(fine > 1e-10);
      BOOST_TEST(std::log2(coarse / fine) > order - 0.3, name << " " << order);
      BOOST_TEST(std::log2(coarse / fine) < order + 0.5, name << " " << order);
    }
  }
}

BOOST_AUTO_TEST_CASE(blade_and_full_period_agree_for_every_order) {
  for (const auto& [name, settings] : turnings()) {
    Turning turbine(name, settings);
    for (const int order : {2, 4, 6}) {
      const analysis::ModeSet blade = turbine.by_steps(36, order, analysis::FloquetPeriod::blade);
      const analysis::ModeSet full = turbine.by_steps(36, order, analysis::FloquetPeriod::full);
      std::vector<Complex> multipliers;
      for (const analysis::Mode& mode : full.modes) {
        multipliers.push_back(mode.multiplier);
        multipliers.push_back(std::conj(mode.multiplier));
      }
      for (const analysis::Mode& mode : blade.modes) {
        // A double multiplier 1 is split by the root of round-off.
        const bool is_double = std::abs(mode.multiplier - 1.0) < 1e-5;
        BOOST_TEST(
            nearest_to(mode.multiplier, multipliers) < (is_double || !mode.resolved ? 1e-5 : 1e-8) *
                                                           std::max(1.0, std::abs(mode.multiplier)),
            name << ", order " << order << ": " << mode.label);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(four_and_six_agree_within_their_estimates) {
  for (const auto& [name, settings] : turnings()) {
    Turning turbine(name, settings);
    const analysis::ModeSet four = turbine.by_steps(96, 4);
    const analysis::ModeSet six = turbine.by_steps(60, 6);
    std::vector<Complex> exact;
    for (const analysis::Mode& mode : six.modes) exact.push_back(mode.exponent);
    std::size_t seen = 0;
    for (const analysis::Mode& mode : four.modes) {
      if (!mode.resolved || std::abs(mode.exponent) < 0.1 * four.rotor_speed) continue;
      if (++seen > 10) break;
      double estimate = mode.step_error;
      for (const analysis::Mode& other : six.modes)
        if (other.label == mode.label) estimate += other.step_error;
      BOOST_TEST(
          nearest_to(mode.exponent, exact) < (3.0 * estimate + 1e-8) * std::abs(mode.exponent),
          name << " " << mode.label);
    }
    BOOST_TEST(seen >= 8U);
  }
}
