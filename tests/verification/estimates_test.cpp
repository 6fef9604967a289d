// Estimated errors of modes against true ones: three meshes and five time steps of each turbine,
// and a reference whose own refinements agree to a tenth of the estimate.
//
// SAMARA_ALL_INPUTS=1 in the environment takes all inputs, some minutes (scripts/verify does).
#include <cstdlib>
#include <optional>

#include <boost/test/unit_test.hpp>

#include "samara/model/masses.hpp"
#include "samara/simulation/stability.hpp"

#include "turning.hpp"

using namespace samara;
using namespace samara::test;

namespace {

struct Mesh {
  int elements, order;
};

/// A turbine, its meshes (the same in blades and tower), and two references.
struct Input {
  const char* name;
  bool has_tower;
  bool is_large;  ///< not part of every run
  std::array<Mesh, 3> meshes;
  std::array<Mesh, 2> references;
};

const std::vector<Input>& all_inputs() {
  static const std::vector<Input> inputs{
      {"lee2002/baseline", true, false, {{{1, 3}, {1, 4}, {2, 3}}}, {{{2, 5}, {3, 5}}}},
      {"lee2002/ratio10", true, true, {{{1, 3}, {1, 4}, {2, 3}}}, {{{2, 5}, {3, 5}}}},
      {"lee2002/ratio1000", true, true, {{{1, 3}, {1, 4}, {2, 3}}}, {{{2, 5}, {3, 5}}}},
      {"lee2002/rigid_tower", false, false, {{{1, 3}, {1, 4}, {2, 3}}}, {{{2, 5}, {3, 5}}}},
      {"beam/rotating", false, false, {{{2, 3}, {4, 2}, {4, 3}}}, {{{4, 5}, {6, 5}}}},
      {"two_bladed/teetering", true, true, {{{2, 3}, {3, 2}, {3, 3}}}, {{{4, 5}, {5, 5}}}},
      {"nrel5mw/land", true, false, {{{2, 3}, {3, 2}, {3, 3}}}, {{{4, 5}, {5, 5}}}},
      {"nrel5mw/beam_blades", true, true, {{{2, 3}, {3, 2}, {3, 3}}}, {{{4, 4}, {4, 5}}}},
      {"iea15mw/land", true, true, {{{2, 3}, {3, 2}, {3, 3}}}, {{{4, 4}, {4, 5}}}}};
  return inputs;
}

/// Time steps of a revolution, and their order.
struct Rule {
  int order, steps;
};
constexpr std::array<Rule, 5> rules{{{2, 120}, {2, 480}, {4, 48}, {6, 24}, {6, 48}}};
constexpr std::array<Rule, 2> reference_rules{{{6, 120}, {6, 150}}};
/// Estimates beyond it count for no verdict.
constexpr double largest_estimate = 0.1;
/// True errors below it are round-off.
constexpr double round_off = 1e-8;
/// Modes of a run that are compared: those of the first verdicts, and half as many again.
constexpr std::size_t compared = 15;

analysis::ModeSet modes_of(const Input& input, Mesh used, Rule rule) {
  const io::Case found = structure(input.name, mesh(input.has_tower, used.elements, used.order));
  return floquet_of(found.turbine, rule.steps, found.floquet.period, found.trim, PETSC_COMM_SELF,
                    rule.order)
      .set;
}

/// Distance to the nearest mode of the same name; each is known modulo i Omega, and stands for its
/// conjugate.
double distance(const analysis::Mode& mode, const analysis::ModeSet& set) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const analysis::Mode& other : set.modes) {
    if (!other.resolved || other.name != mode.name) continue;
    for (const Complex exponent : {other.exponent, std::conj(other.exponent)}) {
      const Complex off = mode.exponent - exponent;
      nearest =
          std::min(nearest, std::hypot(off.real(), std::remainder(off.imag(), set.rotor_speed)));
    }
  }
  return nearest / std::abs(mode.exponent);
}

struct Figures {
  int counted = 0;
  int honest = 0;                ///< true error below three estimates
  std::vector<double> generous;  ///< estimate over true error
};

void compare(const analysis::ModeSet& set, const std::array<analysis::ModeSet, 2>& references,
             Figures& figures) {
  std::size_t seen = 0;
  for (const analysis::Mode& mode : set.modes) {
    const double estimate = total_error(mode);
    if (!mode.resolved || std::abs(mode.exponent) < 1e-3 * set.rotor_speed) continue;
    if (++seen > compared) break;
    const double error = distance(mode, references[1]);
    const double before = distance(mode, references[0]);
    if (estimate > largest_estimate || std::abs(error - before) > 0.1 * estimate) continue;
    ++figures.counted;
    const bool is_honest = error < 3.0 * estimate + round_off;
    if (is_honest) ++figures.honest;
    BOOST_TEST_MESSAGE((is_honest ? "" : "DISHONEST ")
                       << mode.label << " " << mode.exponent << " estimate " << estimate << " ("
                       << mode.step_error << " " << mode.mesh_error << " " << mode.round_off_error
                       << ") error " << error);
    if (error > round_off) figures.generous.push_back(estimate / error);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(estimated_errors_are_honest_and_useful) {
  const bool all = std::getenv("SAMARA_ALL_INPUTS") != nullptr;
  Figures figures;
  for (const Input& input : all_inputs()) {
    if (input.is_large && !all) continue;
    BOOST_TEST_CONTEXT(input.name) {
      const std::array<analysis::ModeSet, 2> references{
          modes_of(input, input.references[0], reference_rules[0]),
          modes_of(input, input.references[1], reference_rules[1])};
      std::size_t pairs = 0;
      for (const Mesh& used : input.meshes)
        for (const Rule rule : rules) {
          if (++pairs % 2 == 0 && !all) continue;  // every other pair, as on a chessboard
          Figures own;
          BOOST_TEST_MESSAGE(input.name << " " << used.elements << " x " << used.order << ", "
                                        << rule.steps << " steps of order " << rule.order);
          compare(modes_of(input, used, rule), references, own);
          figures.counted += own.counted;
          figures.honest += own.honest;
          figures.generous.insert(figures.generous.end(), own.generous.begin(), own.generous.end());
        }
    }
  }
  BOOST_REQUIRE(figures.counted > 100);
  const auto middle =
      figures.generous.begin() + static_cast<std::ptrdiff_t>(figures.generous.size() / 2);
  std::nth_element(figures.generous.begin(), middle, figures.generous.end());
  BOOST_TEST_MESSAGE(figures.honest << " of " << figures.counted << " honest, median of estimate "
                                    << "over error " << *middle);
  BOOST_TEST(figures.honest >= 0.95 * figures.counted);
  BOOST_TEST(*middle < 10.0);
}

BOOST_AUTO_TEST_CASE(accuracy_keeps_its_promise) {
  const bool all = std::getenv("SAMARA_ALL_INPUTS") != nullptr;
  int counted = 0;
  int kept = 0;
  for (const Input& input : all_inputs()) {
    if (input.is_large && !all) continue;
    const io::Case found = structure(
        input.name, mesh(input.has_tower, input.meshes[0].elements, input.meshes[0].order));
    const turbine::TurbineSystem system(model::build_turbine(found.turbine), PETSC_COMM_SELF);
    analysis::Observer observer;
    const analysis::Trim trim = analysis::find_trim(system, found.trim, observer);
    const auto run = [&](int steps, std::optional<double> accuracy) {
      return analysis::find_floquet_modes(system, trim.solution,
                                          {steps, found.floquet.period, 6, accuracy},
                                          PETSC_COMM_SELF, observer)
          .set;
    };
    const analysis::ModeSet reference = run(200, {});
    for (const double accuracy : {1e-3, 1e-5}) {
      const analysis::ModeSet set = run(0, accuracy);
      std::size_t slow = 0;
      for (const analysis::Mode& mode : set.modes) {
        if (!mode.resolved) continue;
        if (std::abs(mode.exponent) < set.reach) ++slow;
        BOOST_TEST(mode.step_error <= accuracy);
        if (std::abs(mode.exponent) < 1e-3 * set.rotor_speed) continue;
        const double error = distance(mode, reference);
        ++counted;
        if (error <= accuracy) ++kept;
        BOOST_TEST(error <= 10.0 * accuracy, input.name << " " << mode.label << " " << error);
      }
      BOOST_TEST(slow >= 10U, input.name << ": " << slow);
    }
  }
  BOOST_REQUIRE(counted > 60);
  BOOST_TEST(kept >= 0.95 * counted);
}

BOOST_AUTO_TEST_CASE(errors_of_growth_are_honest_where_dampers_couple_harmonics) {
  // Dampers of hinges that are unlike, or in the nacelle's axes: the multipliers' left and right
  // eigenvectors differ, and the step changes the growth as much as the frequency.
  const std::string one_free = "blades.each={1: {hinges: {lag: {damping: 0}}}}";
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
      {"ground_resonance/hammond", {one_free, "shaft.speed=22.02"}},
      {"ground_resonance/hammond", {one_free, "shaft.speed=32.0"}},
      {"ground_resonance/hammond", {one_free, "shaft.speed=32.08"}},
      {"ground_resonance/hammond", {}},
      {"lee2002/baseline",
       {"nacelle.yaw.stiffness=2e5", "hub.teeter.damping=1e4", "blades.mass_damping=0.2"}},
      {"nrel5mw/land",
       {"blades.elements=2", "blades.order=3", "tower.elements=1",
        "shaft.generator={joint: free, own_inertia: 534, torque: 0, torque_slope: 500}",
        "nacelle.yaw={joint: free, stiffness: 1e8, damping: 5e7}"}}};
  int counted = 0;
  int honest = 0;
  for (const auto& [name, settings] : cases) BOOST_TEST_CONTEXT(name) {
      const io::Case found = structure(name, settings);
      const turbine::TurbineSystem system(model::build_turbine(found.turbine), PETSC_COMM_SELF);
      analysis::Observer observer;
      const analysis::Trim trim = analysis::find_trim(system, found.trim, observer);
      const auto run = [&](Rule rule) {
        return analysis::find_floquet_modes(system, trim.solution,
                                            {rule.steps, found.floquet.period, rule.order, {}},
                                            PETSC_COMM_SELF, observer)
            .set;
      };
      const analysis::ModeSet reference = run({6, 192});
      for (const Rule rule : {Rule{2, 24}, Rule{2, 60}, Rule{4, 24}, Rule{6, 24}}) {
        const analysis::ModeSet set = run(rule);
        for (const analysis::Mode& mode : set.modes) {
          if (!mode.resolved || mode.step_error > largest_estimate) continue;
          const analysis::Mode* nearest = nullptr;
          for (const analysis::Mode& other : reference.modes)
            if (other.resolved &&
                (nearest == nullptr || std::abs(other.exponent - mode.exponent) <
                                           std::abs(nearest->exponent - mode.exponent)))
              nearest = &other;
          const double error = std::abs(nearest->exponent.real() - mode.exponent.real());
          const double own = mode.growth_error - mode.mesh_growth_error;
          const double least = round_off * std::max(std::abs(mode.exponent), set.rotor_speed);
          ++counted;
          if (error <= own + least) ++honest;
          BOOST_TEST(error <= 5.0 * own + least, rule.steps << " of order " << rule.order << ": "
                                                            << mode.label << " " << error << " "
                                                            << own);
        }
      }
    }
  BOOST_REQUIRE(counted > 100);
  BOOST_TEST_MESSAGE(honest << " of " << counted << " honest");
  BOOST_TEST(honest >= 0.95 * counted);
}

BOOST_AUTO_TEST_CASE(slow_exponents_have_the_error_of_the_steady_state) {
  // Two blades on a teeter spring, free yaw and a free generator, whose torque falls with its
  // speed. With few harmonics, the exponents at zero of yaw and rotation mix. The speed of the
  // rotor grows with -slope n^2 / (I + n^2 J) but for the small motions of the tower.
  constexpr double gear = 97.0;
  constexpr double own_inertia = 534.116;
  for (const double slope : {0.0, -1.0, -10.0, -50.0})
    for (const std::string harmonics : {"4", "8"}) {
      Turning turbine(
          "two_bladed/teetering",
          {"blades.elements=2", "blades.element_lengths=[1, 1]", "nacelle.yaw={joint: free}",
           "hub.teeter={joint: free, stiffness: 3e7, damping: 2e6}",
           "shaft.generator={joint: free, own_inertia: 534.116, torque_slope: " +
               std::to_string(slope) + "}",
           "trim.harmonics=" + harmonics});
      const model::Masses masses =
          model::compute_masses(turbine.input.turbine, model::build_turbine(turbine.input.turbine));
      const double expected =
          -slope * gear * gear / (masses.rotor.inertia(1, 1) + gear * gear * own_inertia);
      const analysis::ModeSet set = turbine.modes({}).set;
      const simulation::StabilityAssessment verdict = simulation::assess_stability(set);
      BOOST_TEST_CONTEXT("slope " << slope << ", " << harmonics << " harmonics") {
        const analysis::Mode* fastest = nullptr;
        for (const analysis::Mode& mode : set.modes) {
          if (!mode.resolved || std::abs(mode.exponent) > 0.05 * set.rotor_speed) continue;
          BOOST_TEST((mode.name == "yaw" || mode.name == "rotor rotation"), mode.label);
          if (fastest == nullptr || mode.exponent.real() > fastest->exponent.real())
            fastest = &mode;
        }
        BOOST_REQUIRE(fastest != nullptr);
        BOOST_TEST(
            std::abs(fastest->exponent.real() - expected) < fastest->growth_error + 0.01 * expected,
            fastest->exponent << " +- " << fastest->growth_error << ", not " << expected);
        if (slope == 0.0)
          BOOST_TEST((verdict.stability == simulation::Stability::neutral));
        else
          // By the sum of the exponents, also where each of them has a large error.
          BOOST_TEST((verdict.stability == simulation::Stability::unstable));
        // One that is known from zero is known to a few percent.
        if (slope <= -10.0) BOOST_TEST(fastest->growth_error < 0.2 * expected);
      }
    }
}
