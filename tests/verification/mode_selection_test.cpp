// Some modes that are taken from all modes, on turbines.
#include <algorithm>
#include <numbers>
#include <set>

#include <boost/test/unit_test.hpp>

#include "samara/simulation/stability.hpp"

#include "air_case.hpp"
#include "turning.hpp"

using namespace samara;
using namespace samara::test;

namespace {

using analysis::Mode;
using analysis::ModeSet;

constexpr double hertz = 2.0 * std::numbers::pi;

const std::vector<std::string> coarse{"blades.elements=1", "blades.order=3", "tower.elements=1",
                                      "tower.order=3"};
/// Fine enough for all modes that the examples compare.
constexpr int fine_steps = 144;

/// Three and two blades, unlike blades, a rigid tower under gravity, free yaw.
const std::vector<std::pair<std::string, std::vector<std::string>>> examples{
    {"nrel5mw/land", coarse},
    {"nrel5mw/land", with(coarse, {"nacelle.yaw={joint: free}", "trim.harmonics=6"})},
    {"two_bladed/teetering", coarse},
    {"lee2002/rigid_tower", {"blades.elements=2", "gravity=9.81", "trim.harmonics=6"}},
    {"ground_resonance/hammond", {}},
    {"ground_resonance/hammond", {"blades.each={1: {hinges: {lag: {damping: 0}}}}"}},
};

analysis::FloquetOptions of_all(int modes, int least_damped) {
  analysis::FloquetOptions options;
  options.modes = modes;
  options.least_damped = least_damped;
  options.search = analysis::ModeSearch::all;
  return options;
}

/// The resolved modes of a fine integration, ascending by a key.
template <class Key>
std::vector<const Mode*> sorted(const ModeSet& all, Key key) {
  std::vector<const Mode*> modes;
  for (const Mode& mode : all.modes)
    if (mode.resolved && !is_of_medium(mode)) modes.push_back(&mode);
  std::ranges::stable_sort(modes, {}, [&](const Mode* mode) { return key(*mode); });
  return modes;
}

/// Whether a mode is among others, with the errors of both by their steps.
bool is_among(const Mode& mode, const ModeSet& others, double speed) {
  return std::ranges::any_of(others.modes, [&](const Mode& other) {
    const double error = mode.step_error + other.step_error + 1e-8;
    // A double zero is known up to the square root of round-off.
    return std::abs(mode.exponent - other.exponent) <
           error * std::max(std::abs(mode.exponent), speed) + 1e-5 * speed;
  });
}

/// Whether a mode is in the range that is reported, not next to its edge.
bool is_inside(const Mode& mode, const analysis::SearchedRegion& region) {
  constexpr double inside = 0.999;
  return mode.exponent.imag() >= region.low / inside &&
         mode.exponent.imag() < inside * region.high &&
         std::abs(mode.exponent.real()) < inside * region.decay;
}

/// Takes modes of a turbine and requires that the first `count` of all modes by `key` are among
/// them, and all others of the range.
template <class Key>
void require_first(Turning& turbine, const ModeSet& all, int count,
                   const analysis::FloquetOptions& options, Key key) {
  const analysis::Floquet found = turbine.modes(options);
  BOOST_TEST(found.harmonics == 0);
  BOOST_REQUIRE(found.set.searched);
  const analysis::SearchedRegion& region = *found.set.searched;
  BOOST_TEST(region.is_of_all);
  BOOST_TEST(region.low < region.high);
  const double speed = all.rotor_speed;
  BOOST_TEST(found.set.modes.size() >= static_cast<std::size_t>(count));
  BOOST_TEST(static_cast<std::size_t>(found.set.participation.rows()) == found.set.modes.size());
  BOOST_TEST(found.set.shapes.size() == found.set.modes.size());
  for (const Mode& mode : found.set.modes) {
    BOOST_TEST(mode.resolved, mode.label);
    BOOST_TEST(is_among(mode, all, speed), mode.label << " is in none of the others");
  }
  const std::vector<const Mode*> order = sorted(all, key);
  BOOST_REQUIRE(order.size() >= static_cast<std::size_t>(count));
  const double last = key(*order[static_cast<std::size_t>(count) - 1]);
  int inside = 0;
  for (const Mode* mode : order) {
    // The slowest decays are those of a range of frequencies.
    const bool is_first = options.least_damped == 0 && key(*mode) <= last;
    if (!is_first && !is_inside(*mode, region)) continue;
    ++inside;
    BOOST_TEST(is_among(*mode, found.set, speed),
               mode->label << " " << mode->exponent << " is missing");
  }
  BOOST_TEST(inside >= count);
}

}  // namespace

BOOST_AUTO_TEST_CASE(exponents_at_the_start_are_those_of_the_rotor_at_rest) {
  // Few of many by Krylov-Schur, against all modes of the same tangents: structure and air, yaw
  // that nothing restores, massless directions and rigid strains.
  const std::vector<std::pair<std::string, std::vector<std::string>>> at_rest{
      {"nrel5mw/land", {"aero=none"}},
      {"nrel5mw/land", {"wind.speed=6"}},
      {"nrel5mw/beam_blades", {"nacelle.yaw={joint: free}"}},
      {"two_bladed/teetering", {"aero=none", "gravity=0"}},
  };
  for (const auto& [name, settings] : at_rest) BOOST_TEST_CONTEXT(name << ' ' << settings.front()) {
      Steady parked(io::read_case(input_path(name), with(settings, {"shaft.speed_rpm=0"})));
      std::vector<double> wanted;
      for (const Mode& mode : parked.constant_modes().modes)
        if (std::abs(mode.exponent) > 1e-5) wanted.push_back(std::abs(mode.exponent));
      std::ranges::sort(wanted);
      constexpr int count = 3;
      const std::vector<double> found =
          analysis::find_moduli_at_start(parked.system, parked.trim.solution, count);
      BOOST_REQUIRE(found.size() >= static_cast<std::size_t>(count));
      BOOST_TEST(found.size() < wanted.size() / 2);  // not all of them
      // Krylov-Schur finds few of many equal exponents, such as those of the air.
      auto from = wanted.begin();
      for (const double modulus : found) {
        const auto equal = std::find_if(from, wanted.end(), [&](double other) {
          return std::abs(modulus / other - 1.0) < 1e-3;
        });
        BOOST_TEST((equal != wanted.end()), modulus);
        if (equal == wanted.end()) continue;
        for (auto missed = from; missed < equal; ++missed)
          BOOST_TEST(std::abs(*missed / wanted.front() - 1.0) < 1e-3, *missed);
        from = equal + 1;
      }
    }
}

BOOST_AUTO_TEST_CASE(some_of_all_modes) {
  constexpr double frequency = 1.5;
  for (const auto& [name, settings] : examples) {
    Turning turbine(name, settings);
    const ModeSet all = turbine.by_steps(fine_steps);
    BOOST_TEST_CONTEXT(name << " " << (settings.empty() ? "" : settings.back())) {
      for (const int count : {3, 5})
        require_first(turbine, all, count, of_all(count, 0),
                      [](const Mode& mode) { return std::abs(mode.exponent); });
      require_first(turbine, all, 4, of_all(0, 4),
                    [](const Mode& mode) { return -mode.exponent.real(); });
      analysis::FloquetOptions next_to = of_all(2, 0);
      next_to.near_hz = frequency;
      require_first(turbine, all, 2, next_to, [](const Mode& mode) {
        return std::abs(mode.exponent.imag() - hertz * frequency);
      });
    }
  }
}

BOOST_AUTO_TEST_CASE(strong_damping_is_not_missing_in_the_range) {
  // In wind, the first flap modes have a lower frequency than others with their modulus.
  for (const std::string name : {"nrel5mw/land", "two_bladed/teetering"}) {
    Steady turbine(
        io::read_case(input_path(name), {"blades.elements=2", "blades.element_lengths=[1, 1]",
                                         "blades.order=3", "tower.elements=1", "tower.order=3"}));
    analysis::FloquetOptions options;
    options.steps = fine_steps;
    const ModeSet all = turbine.floquet(options);
    for (const int count : {3, 5, 8})
      for (const std::optional<double> near : {std::optional<double>(), std::optional(0.7)}) {
        options = of_all(count, 0);
        options.near_hz = near;
        const ModeSet some = turbine.floquet(options);
        BOOST_REQUIRE(some.searched);
        BOOST_TEST(some.searched->high > 0.5 * std::abs(some.modes.back().exponent));
        for (const Mode& mode : all.modes)
          if (mode.resolved && !is_of_medium(mode) && is_inside(mode, *some.searched))
            BOOST_TEST(std::ranges::any_of(some.modes,
                                           [&](const Mode& one) {
                                             return std::abs(one.exponent - mode.exponent) <
                                                    1e-3 * std::abs(mode.exponent);
                                           }),
                       name << " " << count << ": " << mode.label << " " << mode.exponent);
      }
  }
}

BOOST_AUTO_TEST_CASE(a_growing_mode_is_never_left_out) {
  // The motion that grows is faster than the slowest one.
  Turning turbine("ground_resonance/hammond", {"blades.each={1: {hinges: {lag: {damping: 0}}}}"});
  const ModeSet all = turbine.by_steps(fine_steps);
  const auto grows = [](const Mode& mode) { return mode.exponent.real() > 0.01; };
  const std::vector<const Mode*> order =
      sorted(all, [](const Mode& mode) { return std::abs(mode.exponent); });
  BOOST_REQUIRE(!grows(*order.front()));
  BOOST_REQUIRE(std::ranges::any_of(all.modes, grows));
  const ModeSet some = turbine.modes(of_all(1, 0)).set;
  BOOST_TEST(some.modes.size() < all.modes.size());
  BOOST_TEST(std::ranges::any_of(some.modes, grows));
  BOOST_TEST((simulation::assess_stability(some).stability == simulation::Stability::unstable));
}

BOOST_AUTO_TEST_CASE(a_growth_keeps_the_decay_that_belongs_to_it) {
  // Without damping, a growth alone would be an error of the mesh.
  Turning turbine("lee2002/rigid_tower", {"blades.elements=2", "gravity=9.81", "trim.harmonics=6"});
  for (const analysis::FloquetOptions& options : {of_all(1, 0), of_all(0, 3)}) {
    const ModeSet some = turbine.modes(options).set;
    BOOST_TEST(some.conservative);
    BOOST_TEST((simulation::assess_stability(some).stability == simulation::Stability::unstable));
  }
}

BOOST_AUTO_TEST_CASE(the_way_to_some_modes_follows_the_size) {
  const auto harmonics_of = [](const std::string& name, const std::vector<std::string>& settings) {
    Turning turbine(name, settings);
    return turbine.modes(turbine.input.floquet).harmonics;
  };
  BOOST_TEST(harmonics_of("two_bladed/teetering", with(coarse, {"floquet.modes=6"})) == 0);
  BOOST_TEST(harmonics_of("two_bladed/teetering",
                          with(coarse, {"floquet.modes=6", "floquet.search=hill"})) > 0);
  BOOST_TEST(harmonics_of("nrel5mw/land", with(coarse, {"floquet.modes=2", "floquet.near_hz=2"})) >
             0);
  std::string lengths = "[1";
  for (int i = 1; i < 40; ++i) lengths += ", 1";
  BOOST_TEST(
      harmonics_of("nrel5mw/land", {"blades.elements=40", "blades.element_lengths=" + lengths + "]",
                                    "blades.order=2", "tower.elements=40", "floquet.modes=4"}) > 0);
}

BOOST_AUTO_TEST_CASE(given_steps_resolve_what_they_can) {
  Turning turbine("nrel5mw/land", coarse);
  analysis::FloquetOptions options = of_all(40, 0);
  options.steps = 36;
  const analysis::Floquet found = turbine.modes(options);
  BOOST_TEST(found.steps == 36);
  BOOST_REQUIRE(found.set.searched);
  BOOST_TEST(found.set.searched->wanted == 40);
  BOOST_TEST(found.set.modes.size() < 40U);
  BOOST_TEST(found.set.modes.size() > 5U);
  for (const Mode& mode : found.set.modes) BOOST_TEST(mode.resolved);
  // Nothing is known of a frequency beyond their reach.
  options.near_hz = 40.0;
  BOOST_CHECK_THROW(turbine.modes(options), ConvergenceError);
}

BOOST_AUTO_TEST_CASE(few_steps_lead_to_no_verdict_by_some_modes) {
  // These steps resolve a few modes, all of which decay. The list of all modes has no verdict.
  Turning turbine("nrel5mw/land", coarse);
  for (analysis::FloquetOptions options : {of_all(10, 0), of_all(0, 10)}) {
    options.steps = 6;
    const ModeSet some = turbine.modes(options).set;
    BOOST_TEST(some.modes.size() < 10U);
    BOOST_TEST((simulation::assess_stability(some).doubt == simulation::Doubt::unresolved));
  }
}
