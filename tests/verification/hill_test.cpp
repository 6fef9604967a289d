// Hill's method against integration over a period, on turbines.
#include <algorithm>
#include <set>
#include <tuple>

#include <boost/test/unit_test.hpp>

#include "samara/simulation/stability.hpp"

#include "air_case.hpp"
#include "hill_count.hpp"
#include "turning.hpp"

using namespace samara;
using namespace samara::test;

namespace {

/// Each mode of `some` has its own mode in `all`, with the same exponent, damping, name and
/// number, and each resolved mode of `all` below `some.searched` has one in `some`.
void require_agreement(const analysis::ModeSet& some, const analysis::ModeSet& all,
                       const std::string& place, double residual = 1e-7) {
  BOOST_REQUIRE(some.searched);
  BOOST_TEST(some.searched->is_counted, place);
  const bool is_at_rest = some.rotor_speed == 0.0;
  const double speed = is_at_rest ? 1.0 : some.rotor_speed;
  std::set<std::size_t> used;
  for (const analysis::Mode& mode : some.modes) {
    BOOST_TEST(mode.resolved, place << ": " << mode.label);
    BOOST_TEST(mode.residual < residual, place << ": " << mode.label << " " << mode.residual);
    double best = std::numeric_limits<double>::infinity();
    std::size_t at = 0;
    for (std::size_t m = 0; m < all.modes.size(); ++m) {
      // Among equal exponents the one with the same name.
      const bool same_name = all.modes[m].name == mode.name;
      const double distance =
          std::abs(all.modes[m].exponent - mode.exponent) + (same_name ? 0.0 : 1e-7 * speed);
      if (used.count(m) == 0 && distance < best) {
        best = distance;
        at = m;
      }
    }
    used.insert(at);
    const analysis::Mode& other = all.modes[at];
    best = std::abs(other.exponent - mode.exponent);
    const double size = std::max(std::abs(mode.exponent), speed);
    // A double zero is known up to the square root of round-off.
    const double zero = std::abs(mode.exponent) < 1e-5 * size ? 1e-6 : 0.0;
    BOOST_TEST(best / size < 1e-8 + zero + other.step_error,
               place << ": " << mode.label << " " << mode.exponent << " " << other.label << " "
                     << other.exponent << " " << best / size << " " << other.step_error);
    BOOST_TEST(std::abs(std::abs(mode.multiplier) - std::abs(other.multiplier)) <=
                   1e-5 * std::abs(other.multiplier),
               place << ": " << mode.label << " " << mode.multiplier << " " << other.multiplier);
    if (other.resolved && !(is_at_rest && zero > 0.0))  // of several double zeros any mixture
      BOOST_TEST((mode.name == other.name && (mode.shape_number == 0 || other.shape_number == 0 ||
                                              mode.number == other.number)),
                 place << ": " << mode.label << " " << other.label);
  }
  for (std::size_t m = 0; m < some.modes.size() && some.participation.size() > 0; ++m)
    if (std::abs(some.modes[m].exponent) > 1e-5 * speed)
      BOOST_TEST(std::abs(some.participation.row(static_cast<Eigen::Index>(m)).sum() - 1.0) < 1e-9,
                 place << ": " << some.modes[m].label);
  for (std::size_t m = 0; m < all.modes.size(); ++m) {
    const analysis::Mode& mode = all.modes[m];
    const bool is_inside = mode.resolved && mode.exponent.imag() > some.searched->low &&
                           mode.exponent.imag() < some.searched->high &&
                           std::abs(mode.exponent.real()) < some.searched->decay;
    BOOST_TEST((!is_inside || used.count(m) == 1),
               place << ": " << mode.label << " " << mode.exponent << " is missing");
  }
}

struct Example {
  std::string name;
  std::vector<std::string> settings;
  int modes;
  int steps;
  double residual = 1e-7;  ///< of the modes, at most

  std::string place() const {
    std::string text = name;
    for (const std::string& setting : settings) text += " " + setting;
    return text;
  }
};

const std::vector<std::string> coarse{"blades.elements=1", "blades.order=3", "tower.elements=1",
                                      "tower.order=3"};

/// Three, two and four blades; gravity, free yaw and teeter; a growing motion; unlike blades; a
/// rotating beam; constant coefficients.
std::vector<Example> examples() {
  return {
      {"nrel5mw/land", coarse, 8, 180},
      {"nrel5mw/land", with(coarse, {"nacelle.yaw={joint: free}", "trim.harmonics=6"}), 8, 180},
      {"nrel5mw/land", with(coarse, {"gravity=0"}), 8, 180},
      {"nrel5mw/land", with(coarse, {"shaft.speed=4.0", "trim.harmonics=6"}), 6, 180},
      {"nrel5mw/land", with(coarse, {"blades.pitch_actuator={frequency: 4, damping_ratio: 0.6}"}),
       9, 180},
      {"iea15mw/land", coarse, 6, 180},
      {"two_bladed/teetering", coarse, 6, 180},
      {"lee2002/rigid_tower", {"blades.elements=2", "gravity=9.81", "trim.harmonics=6"}, 6, 180},
      // The shapes of its modes change much with the number of harmonics. They need 20 to 40, with
      // which cancellation limits the residuals.
      {"lee2002/ratio10",
       {"shaft.speed_rpm=30.9", "shaft.tilt_deg=14.4", "blades.damping=0.0001",
        "trim.harmonics=auto"},
       8,
       400,
       1e-6},
      {"ground_resonance/hammond", {}, 6, 180},
      {"beam/rotating", {}, 4, 180},
  };
}

}  // namespace

BOOST_AUTO_TEST_CASE(hill_agrees_with_integration) {
  for (const Example& example : examples()) {
    const std::string place = example.place();
    BOOST_TEST_CONTEXT(place) {
      Turning turbine(example.name, example.settings);
      const analysis::Floquet found = turbine.by_hill(example.modes);
      BOOST_TEST(found.harmonics > 0);
      BOOST_TEST(static_cast<int>(found.set.modes.size()) >= std::min(example.modes, 6));
      if (found.set.modes.size() >= static_cast<std::size_t>(example.modes))
        BOOST_TEST(found.set.modes[static_cast<std::size_t>(example.modes) - 1].exponent.imag() <
                   found.set.searched->high);
      require_agreement(found.set, turbine.by_steps(example.steps), place, example.residual);
    }
  }
}

/// At rest with gravity, with a free generator or a teeter, in still and in moving air; a rotor, a
/// beam and a tower that turn in their own axes.
BOOST_AUTO_TEST_CASE(searches_of_constant_tangents_agree_with_all_modes) {
  const std::vector<std::string> at_rest = with(coarse, {"shaft.speed=0"});
  const std::vector<std::string> still = with(at_rest, {"aero=none"});
  const std::vector<std::tuple<std::string, std::vector<std::string>, int>> cases{
      {"nrel5mw/land", still, 8},
      {"nrel5mw/land", with(still, {"shaft.generator={joint: free, own_inertia: 5e6}"}), 9},
      {"nrel5mw/land",
       with(at_rest, {"aero={airfoil_dynamics: static, induction: none}", "wind.speed=30",
                      "blades.pitch_deg=80"}),
       8},
      {"two_bladed/teetering", still, 6},
      {"lee2002/rigid_tower", {"shaft.speed=0", "gravity=0", "blades.elements=2"}, 9},
      {"beam/rotating", {}, 5},
      {"goland/wing", {"wind.speed=100", "blades.elements=4"}, 5},
  };
  for (const auto& [name, settings, count] : cases)
    BOOST_TEST_CONTEXT(Example({name, settings, count, 0}).place()) {
      const Steady steady(io::read_case(input_path(name), settings));
      const analysis::ModeSet all = steady.constant_modes();
      const auto find = [&](const analysis::FloquetOptions& options) {
        analysis::Observer observer;
        return analysis::find_constant_modes(steady.system, steady.trim.solution, options,
                                             PETSC_COMM_SELF, observer);
      };
      analysis::FloquetOptions options;
      options.modes = count;
      options.search = analysis::ModeSearch::hill;
      const analysis::ModeSet slowest = find(options);
      require_agreement(slowest, all, "slowest");
      BOOST_TEST(slowest.modes.size() >= static_cast<std::size_t>(count));
      BOOST_TEST(slowest.searched->low == 0.0);
      BOOST_TEST(slowest.rotor_speed == all.rotor_speed);
      options.near_hz = 1.2 * slowest.modes.back().exponent.imag() / (2.0 * std::numbers::pi);
      require_agreement(find(options), all, "near");
      options = {};
      options.least_damped = count;
      const analysis::ModeSet decays = find(options);
      require_agreement(decays, all, "slowest decays");
      BOOST_TEST(decays.modes.size() >= static_cast<std::size_t>(count));
    }
}

BOOST_AUTO_TEST_CASE(rough_approximations_of_a_search_are_no_further_exponents) {
  // The first range, about the double zero of the free yaw, ends with exponents that are right to
  // 1e-3 of themselves.
  for (const int elements : {47, 51, 55, 60, 65}) BOOST_TEST_CONTEXT(elements << " elements") {
      const Steady steady(
          io::read_case(input_path("lee2002/baseline"),
                        {"shaft.speed=0", "hub.teeter={joint: locked}", "blades.order=2",
                         "tower.order=2", "blades.elements=" + std::to_string(elements),
                         "tower.elements=60", "nacelle.mass=" + std::to_string(6860 + elements)}));
      analysis::Observer observer;
      analysis::FloquetOptions options;
      options.modes = 12;
      options.search = analysis::ModeSearch::hill;
      const analysis::ModeSet set = analysis::find_constant_modes(
          steady.system, steady.trim.solution, options, PETSC_COMM_SELF, observer);
      BOOST_TEST_REQUIRE(set.searched.has_value());
      BOOST_TEST(set.searched->is_counted);
      BOOST_TEST(set.modes.size() == 13U);
    }
}

/// The steps find energies from time series of the signals of all initial states, Hill's method
/// from the series of one mode.
BOOST_AUTO_TEST_CASE(energies_of_modes_are_those_of_their_series) {
  for (const auto& [name, order, steps] :
       {std::tuple{"nrel5mw/land", 6, 36}, std::tuple{"nrel5mw/land", 2, 360},
        std::tuple{"two_bladed/teetering", 6, 48}}) {
    Turning turbine(name, with(coarse, {"gravity=9.81"}));
    const analysis::ModeSet some = turbine.by_hill(8).set;
    const analysis::ModeSet all = turbine.by_steps(steps, order);
    int compared = 0;
    for (std::size_t m = 0; m < some.modes.size(); ++m) {
      const analysis::Mode& mode = some.modes[m];
      const auto found = std::ranges::find_if(all.modes, [&](const analysis::Mode& other) {
        return other.resolved && other.name == mode.name &&
               std::abs(other.exponent - mode.exponent) < 1e-3 * std::abs(mode.exponent);
      });
      if (found == all.modes.end()) continue;
      ++compared;
      const std::string place = std::string(name) + ": " + mode.label;
      for (const analysis::PartShare& part : mode.parts) {
        const auto same = std::ranges::find(found->parts, part.part, &analysis::PartShare::part);
        const double share = same == found->parts.end() ? 0.0 : same->share;
        BOOST_TEST(std::abs(share - part.share) < 2e-3,
                   place << " " << part.part << " " << share << " " << part.share);
      }
      const auto row = static_cast<Eigen::Index>(m);
      const auto other = static_cast<Eigen::Index>(found - all.modes.begin());
      for (int k = -4; k <= 4; ++k) {  // from the stated harmonic
        const double share = all.participation(other, found->harmonic + k - all.first_harmonic);
        const double expected = some.participation(row, mode.harmonic + k - some.first_harmonic);
        BOOST_TEST(std::abs(share - expected) < 2e-3,
                   place << " k = " << k << " " << share << " " << expected);
      }
    }
    BOOST_TEST(compared >= 5, name << " " << compared);
  }
}

BOOST_AUTO_TEST_CASE(slowest_decays_agree_with_integration) {
  std::vector<Example> all = examples();
  // Without damping, and with little, the decays of the search are errors of its steps.
  const std::vector<std::string> undamped =
      with(coarse, {"blades.damping=0", "tower.damping=0", "shaft.torsion.damping=0"});
  all.push_back({"nrel5mw/land", undamped, 4, 180});
  all.push_back(
      {"nrel5mw/land",
       with(coarse, {"blades.damping=1e-5", "tower.damping=1e-5", "shaft.torsion.damping=0"}), 7,
       180});
  all.push_back(
      {"two_bladed/teetering", with(coarse, {"blades.damping=0", "tower.damping=0"}), 1, 180});
  for (const Example& example : all) {
    // Its two exponents at zero are not resolved, also by shift and invert.
    if (example.name == "lee2002/ratio10") continue;
    const std::string place = example.place();
    BOOST_TEST_CONTEXT(place) {
      Turning turbine(example.name, example.settings);
      const analysis::Floquet found = turbine.by_least_damped(example.modes);
      BOOST_TEST(found.harmonics > 0);
      BOOST_TEST(static_cast<int>(found.set.modes.size()) >= std::min(example.modes, 5));
      for (const analysis::Mode& mode : found.set.modes)
        BOOST_TEST(-mode.exponent.real() <= found.set.searched->decay, place << " " << mode.label);
      require_agreement(found.set, turbine.by_steps(example.steps), place, example.residual);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_slow_decay_of_high_frequency_is_found) {
  // Without damping of the tower, its second modes decay slower than the second ones of the blades.
  Turning turbine("nrel5mw/land", with(coarse, {"tower.damping=0"}));
  const analysis::Floquet found = turbine.by_least_damped(12);
  const analysis::ModeSet all = turbine.by_steps(180);
  require_agreement(found.set, all, "no damping of the tower");
  BOOST_REQUIRE(found.set.searched);
  int faster = 0;  // of a lower frequency, but not among the slowest decays
  for (const analysis::Mode& mode : all.modes)
    if (mode.resolved && mode.exponent.imag() < found.set.searched->high &&
        -mode.exponent.real() > 1.1 * found.set.searched->decay)
      ++faster;
  BOOST_TEST(faster > 0);
}

BOOST_AUTO_TEST_CASE(hill_finds_modes_next_to_a_frequency) {
  Turning turbine("nrel5mw/land", coarse);
  const analysis::Floquet found = turbine.by_hill(3, 2.0);
  BOOST_TEST(found.set.modes.size() >= 3U);
  BOOST_REQUIRE(found.set.searched);
  BOOST_TEST(found.set.searched->low < 2.0 * 2.0 * std::numbers::pi);
  BOOST_TEST(found.set.searched->high > 2.0 * 2.0 * std::numbers::pi);
  for (const analysis::Mode& mode : turbine.by_steps(180).modes) {
    if (!mode.resolved || std::abs(mode.exponent.imag() / (2.0 * std::numbers::pi) - 2.0) > 0.3)
      continue;
    double best = std::numeric_limits<double>::infinity();
    for (const analysis::Mode& other : found.set.modes)
      best = std::min(best, std::abs(other.exponent - mode.exponent));
    BOOST_TEST(best < (1e-8 + mode.step_error) * std::abs(mode.exponent), mode.label);
  }
}

BOOST_AUTO_TEST_CASE(hill_finds_a_growing_motion) {
  // Hammond's helicopter with one damper out of work (its blades are unlike then).
  Turning turbine("ground_resonance/hammond", {"blades.each={1: {hinges: {lag: {damping: 0}}}}"});
  const analysis::Floquet found = turbine.by_hill(6);
  const simulation::StabilityAssessment some = simulation::assess_stability(found.set);
  const simulation::StabilityAssessment all = simulation::assess_stability(turbine.by_steps(180));
  BOOST_TEST((some.stability == all.stability));
  BOOST_TEST((some.stability == simulation::Stability::unstable));
  require_agreement(found.set, turbine.by_steps(180), "one damper out");
}

BOOST_AUTO_TEST_CASE(count_notices_a_missing_exponent) {
  for (const auto& [name, harmonics] :
       {std::pair{"nrel5mw/land", 1}, std::pair{"two_bladed/teetering", 2}}) {
    Turning turbine(name, coarse);
    analysis::HillPencil pencil(turbine.system, turbine.trim.solution, harmonics);
    BOOST_TEST_CONTEXT(name) {
      HillCount count(pencil, pencil.speed(), 0.2);
      for (std::size_t i = 0; i < count.found.size(); i += 5) count.leave_out(i, 1);
    }
  }
}

/// Exponents far away add 2 rad to the phase for each rad/s along an edge.
BOOST_AUTO_TEST_CASE(count_on_a_fine_mesh_takes_few_points) {
  std::string lengths = "blades.element_lengths=[1";
  for (int i = 1; i < 60; ++i) lengths += ", 1";
  Turning turbine("nrel5mw/land", {"blades.elements=60", lengths + "]"});
  analysis::HillPencil pencil(turbine.system, turbine.trim.solution, 1);
  HillCount count(pencil, 20.0 * pencil.speed(), 0.2);
  BOOST_TEST(count.points < 100);
  count.leave_out(0, 1);
}

BOOST_AUTO_TEST_CASE(verdict_of_a_search_needs_its_count) {
  Turning turbine("nrel5mw/land", coarse);
  analysis::ModeSet set = turbine.by_hill(6).set;
  BOOST_TEST((simulation::assess_stability(set).stability == simulation::Stability::stable));
  set.searched->is_counted = false;
  BOOST_TEST((simulation::assess_stability(set).doubt == simulation::Doubt::incomplete));
  set.searched->is_counted = true;
  set.modes.front().resolved = false;
  BOOST_TEST((simulation::assess_stability(set).doubt == simulation::Doubt::unresolved));
}
