// Floquet's modes are the same at every time step and damping, within their estimates: none is lost
// where a step annihilates a decay (lambda dt / 2 = -1), none is invented.
#include <algorithm>
#include <cstdlib>

#include <boost/test/unit_test.hpp>

#include "cases.hpp"

using namespace samara;
using namespace samara::test;

namespace {

constexpr double highest = 5.0;  // Hz, of the modes that are compared

struct ScanCase {
  std::string name;
  std::string path;
  std::vector<std::string> settings;
};

/// The turbines, on meshes that are coarse where the inputs have fine ones.
const std::vector<ScanCase>& scan_cases() {
  const std::string inputs = std::string(SAMARA_SOURCE_DIR) + "/inputs/";
  static const std::vector<ScanCase> cases{
      {"NREL 5 MW",
       inputs + "nrel5mw/land.yaml",
       {"blades.elements=3", "blades.element_lengths=[1, 1, 1]", "blades.order=3",
        "tower.order=4"}},
      {"AWT-27",
       std::string(SAMARA_SOURCE_DIR) + "/tests/verification/files/awt27.yaml",
       {"blades.elements=4", "tower.elements=3", "tower.order=3"}},
      {"ratio 1000 with gravity", inputs + "lee2002/ratio1000.yaml", {"gravity=9.81"}},
      {"two blades, teetering",
       inputs + "two_bladed/teetering.yaml",
       {"blades.order=3", "tower.order=4"}}};
  return cases;
}

/// Steps a revolution; with SAMARA_ALL_STEPS in the environment from 100 to 2000 (scripts/verify).
std::vector<int> scanned_steps() {
  std::vector<int> steps{100, 774};
  if (std::getenv("SAMARA_ALL_STEPS") == nullptr) return steps;
  for (int count = 150; count <= 2000; count += 100) steps.push_back(count);
  for (const int count : {251, 501, 726, 735, 741, 747, 756, 762, 768, 801, 861})
    steps.push_back(count);
  return steps;
}

/// Damping of the blades, mu [s].
std::vector<std::string> scanned_damping() {
  std::vector<std::string> damping{"0", "0.02"};
  if (std::getenv("SAMARA_ALL_STEPS") == nullptr) return damping;
  damping.emplace_back("0.0055");
  for (int i = 1; i < 20; ++i) damping.push_back(std::to_string(0.001 * i));
  return damping;
}

analysis::Floquet run(const ScanCase& scan, int steps, const std::vector<std::string>& more = {}) {
  const io::Case input = io::read_case(scan.path, with(with(scan.settings, more), {"aero=none"}));
  return floquet_of(input.turbine, steps, input.floquet.period, input.trim);
}

/// Error of an exponent by step and round-off [rad/s]: the mesh is the same in all runs.
double error_of(const analysis::Mode& mode) {
  return std::max((mode.step_error + mode.round_off_error) * std::abs(mode.exponent),
                  mode.growth_error);
}

/// Distance of two exponents; each is known modulo i Omega, and stands for its conjugate.
double distance(Complex a, Complex b, double speed) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Complex other : {b, std::conj(b)})
    nearest = std::min(
        nearest, std::hypot(a.real() - other.real(), std::remainder((a - other).imag(), speed)));
  return nearest;
}

/// Below `limit` [rad/s] each resolved mode of `from` is one of `to`, within the errors of both;
/// returns how many were compared. Decays that round-off hides in one of them are left out.
int compare(const analysis::ModeSet& from, const analysis::ModeSet& to, double limit) {
  const double slowest = std::min(from.deflated_rate, to.deflated_rate);
  int compared = 0;
  for (const analysis::Mode& mode : from.modes) {
    if (!mode.resolved || std::abs(mode.exponent) > limit || -mode.exponent.real() > slowest)
      continue;
    ++compared;
    const analysis::Mode* best = nullptr;
    for (const analysis::Mode& other : to.modes)
      if (other.resolved &&
          (best == nullptr || distance(mode.exponent, other.exponent, from.rotor_speed) <
                                  distance(mode.exponent, best->exponent, from.rotor_speed)))
        best = &other;
    BOOST_REQUIRE(best != nullptr);
    // A multiplier of one that round-off has split: 1e-6 of the rotor speed counts as zero.
    BOOST_TEST(distance(mode.exponent, best->exponent, from.rotor_speed) <
                   error_of(mode) + error_of(*best) + 2e-6 * from.rotor_speed,
               mode.label << " " << mode.exponent << " and " << best->exponent << ", errors "
                          << error_of(mode) << " and " << error_of(*best));
  }
  return compared;
}

/// All states are found or deflated, and the modes below the limit of both are the same.
void require_same(const analysis::Floquet& found, const analysis::Floquet& fine) {
  BOOST_TEST(found.set.found + found.set.deflated == 2 * found.set.degrees_of_freedom);
  const double limit = 0.99 * std::min(2.0 * pi * highest, 1.4 / found.step);
  BOOST_TEST(found.set.reach > limit);
  BOOST_TEST(compare(found.set, fine.set, limit) >= 4);
  BOOST_TEST(compare(fine.set, found.set, limit) >= 4);
}

}  // namespace

BOOST_AUTO_TEST_CASE(modes_are_the_same_at_every_time_step) {
  for (const ScanCase& scan : scan_cases()) {
    const analysis::Floquet fine = run(scan, 400);
    for (const int steps : scanned_steps())
      BOOST_TEST_CONTEXT(scan.name << ", " << steps << " steps") {
        require_same(run(scan, steps), fine);
      }
  }
}

BOOST_AUTO_TEST_CASE(modes_are_the_same_at_two_time_steps_with_any_damping) {
  for (const ScanCase& scan : scan_cases())
    for (const std::string& damping : scanned_damping())
      BOOST_TEST_CONTEXT(scan.name << ", mu " << damping) {
        const std::string setting = "blades.damping=" + damping;
        require_same(run(scan, 150, {setting}), run(scan, 250, {setting}));
      }
}

BOOST_AUTO_TEST_CASE(modes_that_a_coarse_step_mixes_are_not_resolved) {
  // One blade: modes have wide spectra of harmonics. With 36 steps three exponents that are next to
  // each other up to multiples of i Omega mix, and one of them had the harmonic of another.
  const ScanCase scan{
      "IEA 15 MW with one blade",
      std::string(SAMARA_SOURCE_DIR) + "/inputs/iea15mw/land.yaml",
      {"blades.count=1", "shaft.tilt_deg=20", "shaft.speed_rpm=12", "trim.harmonics=24"}};
  const auto below = [](const analysis::Floquet& floquet, double limit) {
    std::vector<const analysis::Mode*> modes;
    for (const analysis::Mode& mode : floquet.set.modes)
      if (mode.resolved && std::abs(mode.exponent) < limit) modes.push_back(&mode);
    std::sort(modes.begin(), modes.end(), [](const analysis::Mode* a, const analysis::Mode* b) {
      return std::abs(a->exponent) < std::abs(b->exponent);
    });
    return modes;
  };
  const auto run_with_order_6 = [&scan](int steps) {
    const io::Case input = io::read_case(scan.path, with(scan.settings, {"aero=none"}));
    return floquet_of(input.turbine, steps, input.floquet.period, input.trim, PETSC_COMM_SELF, 6);
  };
  const analysis::Floquet fine = run_with_order_6(200);
  for (const int steps : {36, 50, 72}) {
    const analysis::Floquet found = run_with_order_6(steps);
    const double limit = 0.97 * found.set.reach;
    const std::vector<const analysis::Mode*> modes = below(found, limit);
    const std::vector<const analysis::Mode*> wanted = below(fine, limit);
    BOOST_TEST_CONTEXT(steps << " steps, " << modes.size() << " modes") {
      BOOST_TEST(modes.size() >= 6u);
      BOOST_REQUIRE(modes.size() == wanted.size());
      for (std::size_t i = 0; i < modes.size(); ++i)
        BOOST_TEST(std::abs(modes[i]->exponent - wanted[i]->exponent) <
                       error_of(*modes[i]) + error_of(*wanted[i]),
                   modes[i]->label << " " << modes[i]->exponent << " and " << wanted[i]->exponent);
    }
  }
}

BOOST_AUTO_TEST_CASE(velocities_that_constraints_forbid_make_no_multiplier) {
  // Rigid strains and prescribed joints leave velocities that would change sign with every step,
  // multipliers (-1)^steps. An odd number of steps tells them from a free motion's.
  for (const char* joint :
       {"nacelle.yaw={joint: prescribed, harmonic: {per_rev: 2, amplitude_deg: 5}}",
        "hub.teeter={joint: prescribed, harmonic: {per_rev: 1, amplitude_deg: 3}}"})
    for (const char* period : {"blade", "full"}) {
      const analysis::Floquet floquet =
          run(scan_cases().back(), 202, {joint, std::string("floquet.period=") + period});
      int at_minus_one = 0;
      for (const analysis::Mode& mode : floquet.set.modes)
        for (const double sign : {1.0, -1.0})
          if (mode.resolved && std::abs(mode.multiplier - sign) < 1e-4) ++at_minus_one;
      BOOST_TEST(at_minus_one == 0, joint << " " << period);
    }
}
