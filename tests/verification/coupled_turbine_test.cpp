// The paper's turbine with its tower: coefficients periodic in any axes.
#include <array>

#include <boost/test/unit_test.hpp>

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using analysis::FloquetPeriod;
using boost::test_tools::tolerance;

namespace {

/// The free yaw: mu = 1 twice with one vector, which round-off splits by its root.
bool is_defective(const analysis::Mode& mode, double speed) {
  return std::abs(mode.exponent) < 1e-5 * speed;
}
constexpr double defective = 1e-4;  // in the multiplier

bool is_real_pair(const analysis::Mode& mode, double speed) {
  return std::abs(mode.exponent.imag()) < 1e-6 * speed && !is_defective(mode, speed);
}

/// Distance to the nearest exponent of another run.
double distance(Complex exponent, const analysis::ModeSet& other) {
  double best = std::numeric_limits<double>::infinity();
  for (const analysis::Mode& mode : other.modes)
    best = std::min(best, std::abs(mode.exponent - exponent));
  return best;
}

/// Distance of a multiplier to the nearest one of another run or its conjugate.
double multiplier_distance(Complex multiplier, const analysis::ModeSet& other) {
  double best = std::numeric_limits<double>::infinity();
  for (const analysis::Mode& mode : other.modes)
    best = std::min({best, std::abs(mode.multiplier - multiplier),
                     std::abs(std::conj(mode.multiplier) - multiplier)});
  return best;
}

/// The exponent of `other`, as the steps have it, that is nearest.
Complex nearest_step_exponent(Complex exponent, const analysis::ModeSet& other) {
  Complex best = std::numeric_limits<double>::infinity();
  for (const analysis::Mode& mode : other.modes)
    if (std::abs(mode.step_exponent - exponent) < std::abs(best - exponent))
      best = mode.step_exponent;
  return best;
}

const analysis::Floquet& baseline() {
  static const analysis::Floquet run = floquet_of(lee("baseline", {}).turbine, 500);
  return run;
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_row_is_an_artefact_of_constraints_with_even_and_odd_steps) {
  // 2 x pairs + reals = 2 x (3 M + 6 N + 2). A constraint that is carried along has the multiplier
  // (-1)^steps: apart from the free yaw nothing may sit at 1 or -1.
  for (const auto& [elements, order] : {std::pair{4, 1}, std::pair{2, 2}}) {
    const int degrees = order * elements * 9 + 2;
    for (const int steps : {500, 501}) {
      const analysis::Floquet run = floquet_of(lee("baseline", mesh(true, elements, order)).turbine,
                                               steps, FloquetPeriod::full);
      BOOST_TEST(run.set.degrees_of_freedom == degrees);
      int pairs = 0;
      int reals = 0;
      int at_yaw = 0;
      for (const analysis::Mode& mode : run.set.modes) {
        if (mode.multiplier.imag() == 0.0)
          ++reals;
        else
          ++pairs;
        const double distance_to_one =
            std::min(std::abs(mode.multiplier - 1.0), std::abs(mode.multiplier + 1.0));
        if (distance_to_one > defective) continue;
        BOOST_TEST(is_defective(mode, run.set.rotor_speed), mode.label);
        at_yaw += mode.multiplier.imag() == 0.0 ? 1 : 2;
      }
      BOOST_TEST(2 * pairs + reals == 2 * degrees);
      BOOST_TEST(at_yaw == 2);
    }
  }
}

BOOST_AUTO_TEST_CASE(resolved_modes_are_the_same_with_even_and_odd_steps) {
  // One step in 500 more changes what the step leaves: no more than both estimates.
  const analysis::ModeSet& even = baseline().set;
  const analysis::Floquet odd = floquet_of(lee("baseline", {}).turbine, 501, FloquetPeriod::full);
  std::vector<double> found;
  for (const analysis::Mode& mode : odd.set.modes)
    if (mode.resolved) found.push_back(mode.exponent.imag());
  std::size_t resolved = 0;
  for (const analysis::Mode& mode : even.modes) {
    if (!mode.resolved) continue;
    ++resolved;
    const double wanted = mode.exponent.imag();
    BOOST_TEST(std::abs(nearest(found, wanted) - wanted) <
                   2.0 * mode.step_error * wanted + 1e-9 * even.rotor_speed,
               mode.label << " " << nearest(found, wanted) - wanted);
  }
  BOOST_TEST(resolved > 15U);
}

BOOST_AUTO_TEST_CASE(resolved_modes_of_the_undamped_turbine_are_on_the_unit_circle) {
  // Conservative but for the shaft's drive. The impulses after each step leave growth of the order
  // of the rule and one more; it is below the error that is stated.
  int seen = 0;
  const double period = 2.0 * pi / baseline().set.rotor_speed;
  for (const analysis::Mode& mode : baseline().set.modes) {
    if (!mode.resolved || is_real_pair(mode, baseline().set.rotor_speed)) continue;
    ++seen;
    const double off = std::abs(std::abs(mode.multiplier) - 1.0);
    BOOST_TEST(off < (is_defective(mode, baseline().set.rotor_speed)
                          ? defective
                          : 0.2 * mode.growth_error * period + 1e-9),
               mode.label << " " << off);
    if (mode.exponent.imag() < 15.0 * baseline().set.rotor_speed) BOOST_TEST(off < 1e-5);
  }
  BOOST_TEST(seen > 15);
}

BOOST_AUTO_TEST_CASE(full_and_blade_period_have_the_same_multipliers) {
  BOOST_TEST(baseline().sectors == 2);
  const analysis::Floquet full = floquet_of(lee("baseline", {}).turbine, 500, FloquetPeriod::full);
  BOOST_TEST(full.sectors == 1);
  BOOST_REQUIRE(full.set.modes.size() == baseline().set.modes.size());
  for (const analysis::Mode& mode : full.set.modes) {
    const bool loose = is_defective(mode, full.set.rotor_speed);
    if (!mode.resolved && !loose) continue;
    const double off = multiplier_distance(mode.multiplier, baseline().set);
    BOOST_TEST(off < (loose ? defective : 1e-7), mode.label << " " << off);
    // The identified exponent too: T = 1.04 s.
    if (!loose)
      BOOST_TEST(distance(mode.exponent, baseline().set) < 1e-8,
                 mode.label << " " << distance(mode.exponent, baseline().set));
  }
}

BOOST_AUTO_TEST_CASE(full_and_blade_period_agree_under_gravity) {
  // Constraints that change with time, and with cone and tilt couplings that the plain rotor has
  // not; there the rest of the smooth start (docs/theory.md, section 5.2) is some 1e-8.
  struct Run {
    std::vector<std::string> settings;
    double regular;
  };
  for (const Run& run :
       {Run{{"gravity=9.80665"}, 1e-8},
        Run{{"gravity=9.80665", "blades.precone_deg=3", "shaft.tilt_deg=4"}, 1e-7}}) {
    const model::TurbineDefinition definition = lee("baseline", run.settings).turbine;
    const analysis::Floquet fast = floquet_of(definition, 500, FloquetPeriod::blade);
    const analysis::Floquet full = floquet_of(definition, 500, FloquetPeriod::full);
    for (const analysis::Mode& mode : full.set.modes) {
      const bool loose = is_defective(mode, full.set.rotor_speed);
      if (!mode.resolved && !loose) continue;
      const double off = multiplier_distance(mode.multiplier, fast.set);
      BOOST_TEST(off < (loose ? defective : run.regular), mode.label << " " << off);
    }
  }
}

BOOST_AUTO_TEST_CASE(three_blades_tell_the_direction_of_renaming) {
  // With two blades P is its own inverse but for signs; three, and gravity, show its direction.
  model::TurbineDefinition definition = lee("baseline", mesh(true, 2, 1)).turbine;
  definition.blades.count = 3;
  definition.hub.teeter.kind = model::JointKind::locked;
  for (const double gravity : {0.0, 9.80665}) {
    definition.gravity = gravity;
    const analysis::Floquet fast = floquet_of(definition, 600, FloquetPeriod::automatic);
    BOOST_TEST(fast.sectors == 3);
    const analysis::Floquet full = floquet_of(definition, 600, FloquetPeriod::full);
    BOOST_TEST(full.set.degrees_of_freedom == 3 * 2 + 9 * 2 + 1);
    int seen = 0;
    for (const analysis::Mode& mode : full.set.modes) {
      const bool loose = is_defective(mode, full.set.rotor_speed);
      if (!mode.resolved && !loose) continue;
      ++seen;
      // The wrong direction is off by tenths. Blades of different azimuth have different scales of
      // their coordinates under gravity: 1e-6 where P forgets them.
      const double off = multiplier_distance(mode.multiplier, fast.set);
      BOOST_TEST(off < (loose ? defective : 1e-7),
                 "gravity " << gravity << " " << mode.label << " " << off);
    }
    BOOST_TEST(seen > 8);
  }
}

BOOST_AUTO_TEST_CASE(dissimilar_blades_get_the_full_period) {
  model::TurbineDefinition definition = lee("baseline", mesh(true, 1, 1)).turbine;
  BOOST_TEST(floquet_of(definition, 60).sectors == 2);
  definition.blades.each[2].mass_factor = 1.01;
  BOOST_TEST(floquet_of(definition, 60).sectors == 1);
}

BOOST_AUTO_TEST_CASE(azimuth_of_the_first_blade_changes_no_exponent) {
  // The start of the period is free; the step's grid with it, whose phase leaves the exponents
  // alone but for what aliases, far below 1e-9 at 500 steps.
  for (const char* gravity : {"gravity=0", "gravity=9.80665"}) {
    const analysis::ModeSet at_zero = floquet_of(lee("baseline", {gravity}).turbine, 500).set;
    const analysis::ModeSet turned =
        floquet_of(lee("baseline", {gravity, "shaft.azimuth_deg=37"}).turbine, 500).set;
    for (const analysis::Mode& mode : at_zero.modes) {
      if (!mode.resolved || is_defective(mode, at_zero.rotor_speed)) continue;
      BOOST_TEST(distance(mode.exponent, turned) <
                     1e-9 * std::max(std::abs(mode.exponent), at_zero.rotor_speed),
                 gravity << " " << mode.label << " " << distance(mode.exponent, turned));
    }
  }
}

BOOST_AUTO_TEST_CASE(order_is_two_s_on_the_coupled_turbine) {
  // The same step on all meshes, so that its error cancels, against a mesh of order 5. Modes by
  // their place among the lowest: tower, first blade modes, second tower modes.
  constexpr int steps = 200;
  const analysis::ModeSet fine = floquet_of(lee("baseline", mesh(true, 4, 5)).turbine, steps).set;
  for (const auto& [order, first] : {std::pair{1, 8}, std::pair{2, 3}, std::pair{3, 2}}) {
    const analysis::ModeSet coarse =
        floquet_of(lee("baseline", mesh(true, first, order)).turbine, steps).set;
    const analysis::ModeSet halved =
        floquet_of(lee("baseline", mesh(true, 2 * first, order)).turbine, steps).set;
    int seen = 0;
    for (const analysis::Mode& mode : fine.modes) {
      const double per_rev = mode.exponent.imag() / fine.rotor_speed;
      if (per_rev < 0.5 || per_rev > 12.0) continue;
      const double large = distance(mode.exponent, coarse);
      const double small = distance(mode.exponent, halved);
      if (small < 1e-8) continue;  // round-off
      ++seen;
      // The slope itself converges with the mesh: within 15 % here, as for the cantilever.
      BOOST_TEST(std::log2(large / small) == 2.0 * order, tolerance(0.15));
    }
    BOOST_TEST(seen >= 5, "order " << order << ": " << seen << " modes");
  }
}

BOOST_AUTO_TEST_CASE(order_is_two_in_the_time_step) {
  std::vector<analysis::ModeSet> runs;
  for (const int steps : {250, 500, 1000})
    runs.push_back(floquet_of(lee("baseline", mesh(true, 3, 1)).turbine, steps).set);
  int seen = 0;
  for (const analysis::Mode& mode : runs[2].modes) {
    if (is_defective(mode, runs[2].rotor_speed)) continue;
    if (mode.exponent.imag() > 20.0 * runs[2].rotor_speed) continue;
    const Complex fine = mode.step_exponent;
    const Complex middle = nearest_step_exponent(fine, runs[1]);
    const Complex coarse = nearest_step_exponent(middle, runs[0]);
    ++seen;
    BOOST_TEST(std::log2(std::abs(coarse - middle) / std::abs(middle - fine)) == 2.0,
               tolerance(0.03));
  }
  BOOST_TEST(seen >= 9);
}

BOOST_AUTO_TEST_CASE(stiff_tower_tends_to_the_rigid_one) {
  // A tower 1e5 times as stiff as the paper's, whose first modes are at 0.71 per rev, gives way by
  // (frequency / its own)^2 times the share of the rotor's mass.
  const analysis::ModeSet rigid =
      floquet_of(lee("rigid_tower", mesh(false, 3, 1)).turbine, 300).set;
  const analysis::Floquet stiff =
      floquet_of(lee("baseline", with(mesh(true, 3, 1), {"tower.sections.0.stiffness.EI2=1e14",
                                                         "tower.sections.0.stiffness.EI3=1e14",
                                                         "tower.sections.0.stiffness.GJ=1e14"}))
                     .turbine,
                 300);
  for (const analysis::Mode& mode : rigid.modes) {
    if (!mode.resolved || is_defective(mode, rigid.rotor_speed)) continue;
    const double size = std::max(std::abs(mode.exponent), rigid.rotor_speed);
    const double give = std::pow(size / (0.71 * rigid.rotor_speed * std::sqrt(1e5)), 2);
    const double off = distance(mode.exponent, stiff.set) / size;
    BOOST_TEST(off < 0.1 * give, mode.label << " " << off << " of " << give);
  }
}
