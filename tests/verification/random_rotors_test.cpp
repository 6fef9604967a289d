// Rotors at random: trim, modes and Floquet's modes succeed, agree where the coefficients are
// constant, and have the names that their kinetic energies ask for.
//
// The seed is fixed, so that a run repeats; SAMARA_ROTORS=200 SAMARA_SEED=20261122 in the
// environment take other rotors (scripts/verify: 200 of them, seeded by the date).
#include <cstdlib>
#include <random>

#include <boost/test/unit_test.hpp>

#include "cases.hpp"

using namespace samara;
using namespace samara::test;

namespace {

constexpr double weight = 9.81;
/// Relative to the critical own weight of an upright cantilever, m g l^3 / EI = 7.84: blades bend
/// under their weight, but do not buckle.
constexpr double most_weight = 0.4 * 7.84;
constexpr int steps = 300;
constexpr double clear_share = 0.8;
constexpr double most_damping = 0.7;

int from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

struct Rotor {
  model::TurbineDefinition definition;
  std::string words;
};

class Draw {
 public:
  explicit Draw(unsigned seed) : generator_(seed) {}

  Rotor rotor(bool has_gravity) {
    const double length = between_logarithms(2.0, 90.0);
    const double line_mass = between_logarithms(1.0, 500.0);
    // First flap frequency of the uniform blade at rest [rad/s]: omega^2 = 12.36 EI / (m l^4).
    const double least = std::sqrt(12.36 * weight / (length * most_weight));
    const double omega = least * between_logarithms(has_gravity ? 1.0 : 0.3, 8.0);
    const double flap = line_mass * std::pow(length, 4) * omega * omega / 12.36;
    const double lag = flap * between_logarithms(1.2, 8.0);
    const double chord = length * between(0.02, 0.08);
    const double polar = line_mass * chord * chord / 12.0;
    const double taper = coin() ? 1.0 : between(0.3, 1.0);
    const double twist = coin() ? 0.0 : between(-0.2, 0.3);

    Rotor result;
    model::TurbineDefinition& definition = result.definition;
    definition.gravity = has_gravity ? weight : 0.0;
    definition.shaft.speed = omega * between_logarithms(0.15, 1.2);
    definition.hub.radius = length * between(0.0, 0.08);
    definition.blades.count = whole(1, 5);
    definition.blades.precone = coin() ? 0.0 : between(-0.08, 0.08);
    definition.blades.pitch = coin() ? 0.0 : between(-0.1, 0.4);
    model::BeamDefinition& beam = definition.blades.beam;
    beam.length = length;
    beam.elements = whole(1, 3);
    beam.order = whole(2, 4);
    const double tip_mass = coin() ? 0.0 : line_mass * length * between(0.0, 0.1);
    beam.tip_mass = tip_mass;
    const double damping = coin() ? 0.0 : between(0.0, 0.02);
    beam.damping = Vector6::Constant(damping);
    const bool is_inextensible = coin();
    for (const double at : {0.0, 1.0}) {
      const double left = at == 0.0 ? 1.0 : taper;
      model::SectionDefinition section;
      section.at = at;
      section.twist = at == 0.0 ? twist : 0.0;
      section.mass.diagonal() << line_mass * left, line_mass * left, line_mass * left,
          1.1 * polar * left, 0.1 * polar * left, polar * left;
      const double stretch = 12.0 * lag / (chord * chord);
      section.stiffness.diagonal() << stretch, 0.1 * stretch, 0.1 * stretch, 0.3 * (flap + lag),
          flap, lag;
      section.stiffness *= left;
      for (std::size_t i = 0; i < 3; ++i) section.rigid[i] = is_inextensible;
      if (is_inextensible) section.stiffness.topLeftCorner<3, 3>().setZero();
      beam.sections.push_back(section);
    }
    result.words = std::to_string(definition.blades.count) + " blades of " +
                   std::to_string(length) + " m, " + std::to_string(beam.elements) + " x " +
                   std::to_string(beam.order) + ", omega " + std::to_string(omega) + ", Omega " +
                   std::to_string(definition.shaft.speed) + ", mu " + std::to_string(damping) +
                   ", taper " + std::to_string(taper) + ", tip mass " + std::to_string(tip_mass) +
                   ", gravity " + std::to_string(definition.gravity);
    return result;
  }

 private:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  double between_logarithms(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }
  bool coin() { return whole(0, 1) == 1; }

  std::mt19937 generator_;
};

/// Shares of the blades' motion by direction of the section's axes, from positions and masses.
struct Shares {
  double axial = 0.0, lag = 0.0, flap = 0.0, torsion = 0.0;
};

Shares shares_of(const model::TurbineDefinition& definition, const turbine::TurbineSystem& system,
                 const Eigen::MatrixXcd& shape) {
  Shares shares;
  const model::Turbine& turbine = system.turbine();
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
    const model::Beam& beam = turbine.blades[k];
    const auto add = [&](int first, const Matrix6& mass, const Matrix3& axes) {
      const Eigen::Vector3cd u = axes.transpose().cast<Complex>() * shape.block<3, 1>(first, 0);
      const Eigen::Vector3cd theta =
          axes.transpose().cast<Complex>() * shape.block<3, 1>(first + 3, 0);
      shares.axial += mass(0, 0) * std::norm(u(0));
      shares.lag += mass(1, 1) * std::norm(u(1)) + mass(5, 5) * std::norm(theta(2));
      shares.flap += mass(2, 2) * std::norm(u(2)) + mass(4, 4) * std::norm(theta(1));
      shares.torsion += mass(3, 3) * std::norm(theta(0));
    };
    for (int p = 0; p < beam.point_count(); ++p) {
      const auto at = static_cast<std::size_t>(p);
      const double twist =
          model::interpolate_section(definition.blades.beam, beam.fractions[at]).twist;
      add(system.layout().blade_point(static_cast<int>(k), p),
          beam.point_length(p) * beam.points[at].mass,
          math::turn_about<double>(Vector3::UnitX(), -twist));
    }
    add(system.layout().blade_tip(static_cast<int>(k)), beam.tip_mass, Matrix3::Identity());
  }
  const double sum = shares.axial + shares.lag + shares.flap + shares.torsion;
  return {shares.axial / sum, shares.lag / sum, shares.flap / sum, shares.torsion / sum};
}

struct Runs {
  analysis::ModeSet modes;  ///< of the rotor as it turns; parked under gravity
  analysis::ModeSet floquet;
};

Runs run(const model::TurbineDefinition& definition) {
  Runs runs;
  model::TurbineDefinition still = definition;
  if (definition.gravity > 0.0) still.shaft.speed = 0.0;
  runs.modes = constant_modes_of(still);
  runs.floquet = floquet_of(definition, steps).set;
  return runs;
}

/// Error of an exponent by step and round-off [rad/s].
double error_of(const analysis::Mode& mode) {
  return std::max((mode.step_error + mode.round_off_error) * std::abs(mode.exponent),
                  mode.growth_error - mode.mesh_growth_error);
}

/// Each resolved mode of the steps is one of `modes`, within the errors of both.
void check_agreement(const Runs& runs) {
  const double speed = runs.floquet.rotor_speed;
  for (const analysis::Mode& mode : runs.floquet.modes) {
    if (!mode.resolved) continue;
    double apart = std::numeric_limits<double>::infinity();
    double error = 0.0;
    for (const analysis::Mode& other : runs.modes.modes)
      for (const Complex exponent : {other.exponent, std::conj(other.exponent)}) {
        const Complex off = mode.exponent - exponent;
        const double turned = std::hypot(off.real(), std::remainder(off.imag(), speed));
        if (turned >= apart) continue;
        apart = turned;
        error = error_of(other);
      }
    BOOST_TEST(apart < error_of(mode) + error + 2e-6 * speed,
               mode.label << " " << mode.exponent << " is " << apart << " off, errors "
                          << error_of(mode) << " and " << error);
  }
}

void check_names(const model::TurbineDefinition& definition, const analysis::ModeSet& set) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  for (std::size_t m = 0; m < set.modes.size(); ++m) {
    const analysis::Mode& mode = set.modes[m];
    if (!mode.resolved || set.shapes[m].size() == 0) continue;
    if (mode.damping_ratio > most_damping) continue;  // little of its energy is kinetic
    const Shares shares = shares_of(definition, system, set.shapes[m]);
    const auto check = [&](double share, const std::string& name) {
      if (share > clear_share)
        BOOST_TEST(mode.name.starts_with(name),
                   mode.label << " " << mode.exponent << " has " << share << " of " << name);
    };
    check(shares.axial, "blade axial");
    check(shares.lag, "blade lead-lag");
    check(shares.flap, "blade flap");
    check(shares.torsion, "blade torsion");
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(rotors_at_random_have_the_modes_that_they_ought_to_have) {
  const int count = from_environment("SAMARA_ROTORS", 20);
  const auto seed = static_cast<unsigned>(from_environment("SAMARA_SEED", 11));
  BOOST_TEST_MESSAGE(count << " rotors, seed " << seed);
  int failed = 0;
  for (int i = 0; i < count; ++i) {
    Draw draw(seed * 1000003U + static_cast<unsigned>(i));
    const Rotor rotor = draw.rotor(i % 2 == 1);
    BOOST_TEST_CONTEXT("rotor " << i << " of seed " << seed << ": " << rotor.words) {
      try {
        const Runs runs = run(rotor.definition);
        const double reach = std::min(1.4 / runs.floquet.step, runs.floquet.deflated_rate);
        BOOST_TEST(runs.floquet.reach > 0.95 * reach);
        BOOST_TEST(runs.floquet.found + runs.floquet.deflated == runs.floquet.states);
        if (rotor.definition.gravity == 0.0) check_agreement(runs);
        check_names(rotor.definition, runs.modes);
      } catch (const std::exception& error) {
        ++failed;
        BOOST_TEST_MESSAGE("rotor " << i << " failed: " << error.what() << "; " << rotor.words);
      }
    }
  }
  BOOST_TEST(failed <= count / 100);
}
