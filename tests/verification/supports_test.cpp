// Ends of beams on springs, hinges and held at both ends, against closed forms.
#include <Eigen/Eigenvalues>
#include <boost/test/unit_test.hpp>

#include "samara/analysis/static_path.hpp"
#include "samara/base/error.hpp"

#include "cases.hpp"

using namespace samara;
using namespace samara::test;
using boost::test_tools::tolerance;

namespace {

/// Directions, in the order u1 u2 u3 theta1 theta2 theta3: r rigid, f free, s a spring.
model::SupportDefinition support(const std::string& directions, double stiffness = 0.0) {
  model::SupportDefinition result;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    result.rigid[i] = directions[i] == 'r';
    result.free[i] = directions[i] == 'f';
    if (directions[i] == 's') result.stiffness(k, k) = stiffness;
  }
  return result;
}

/// A beam that only bends about b2, EI = m = L = 1, with ends held in that plane.
model::TurbineDefinition beam_between(const std::string& root, const std::string& end) {
  BeamCase beam;
  beam.stiffness << 0.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  beam.elements = 10;
  model::TurbineDefinition definition = definition_of(beam);
  definition.blades.beam.support = support(root);
  definition.blades.beam.support.mass = 1e-6;  // too small to tell
  definition.blades.beam.support.inertia.setConstant(1e-9);
  definition.blades.beam.end_support = support(end);
  return definition;
}

/// An upright rigid turbine on springs, all its mass in the tower, a rod of mass m and height l.
struct Rod {
  double mass = 3.0;
  double height = 2.0;
  double lateral = 50.0;    ///< of the springs [N/m]
  double rotation = 400.0;  ///< [N m/rad]
  double gravity = 9.81;
  double damping = 0.0;
};

model::TurbineDefinition rod_on_springs(const Rod& rod) {
  BeamCase light;
  light.mass = 1e-9;
  light.length = 1e-3;
  light.stiffness.setZero();
  model::TurbineDefinition definition = definition_of(light);
  BeamCase beam;
  beam.mass = rod.mass / rod.height;
  beam.length = rod.height;
  beam.stiffness.setZero();
  definition.has_tower = true;
  definition.tower = definition_of(beam).blades.beam;
  definition.tower.support = support("ssssss");
  definition.tower.support.stiffness.diagonal() << rod.lateral, rod.lateral, rod.lateral,
      rod.rotation, rod.rotation, rod.rotation;
  definition.tower.support.mass = 0.7;
  definition.tower.support.inertia = Vector3(0.2, 0.3, 0.4);
  definition.tower.support.damping.setConstant(rod.damping);
  definition.gravity = rod.gravity;
  return definition;
}

/// Sway and rocking of the rod in the plane of n3 and the lateral axis, whose inertia about the
/// foot is `own` more than the rod's: M x'' + K x = 0 for the displacement of the foot and the
/// rotation. The weight of the rod pushes it over.
Eigen::Vector2d rod_frequencies(const Rod& rod, double own) {
  const double arm = 0.5 * rod.height;
  Eigen::Matrix2d M;
  M << rod.mass + 0.7, rod.mass * arm, rod.mass * arm,
      rod.mass * rod.height * rod.height / 3.0 + own;
  const Eigen::Matrix2d K =
      Eigen::Vector2d(rod.lateral, rod.rotation - rod.mass * rod.gravity * arm).asDiagonal();
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d>(K, M).eigenvalues().cwiseSqrt();
}

/// A beam of weight W on a hinge about b2, with a dead force F across its end: a pendulum that
/// turns by atan(2 F/W) from its hanging position. `azimuth` 180: hangs; 0: stands upright.
struct Pendulum {
  double force = 5.0;
  double azimuth = pi;
  double bending = 0.0;  ///< EI; 0: rigid
  double gravity = 9.81;
  static constexpr double mass = 3.0;
  static constexpr double length = 2.0;

  double weight() const { return mass * gravity; }
  double angle() const { return std::atan2(2.0 * force, weight()); }
};

model::TurbineDefinition definition_of(const Pendulum& pendulum) {
  BeamCase beam;
  beam.mass = Pendulum::mass / Pendulum::length;
  beam.length = Pendulum::length;
  beam.stiffness << 0.0, 0.0, 0.0, 0.0, pendulum.bending, pendulum.bending;
  beam.elements = 4;
  model::TurbineDefinition definition = definition_of(beam);
  definition.gravity = pendulum.gravity;
  definition.shaft.azimuth = pendulum.azimuth;
  definition.blades.beam.support = support("rrrrfr");
  definition.blades.beam.support.mass = 1e-6;  // too small to tell
  definition.blades.beam.support.inertia.setConstant(1e-9);
  model::LoadDefinition load;
  load.from = load.to = 1.0;
  load.force = Vector3(0.0, 0.0, pendulum.force);
  if (pendulum.force != 0.0) definition.loads = {load};
  return definition;
}

analysis::StaticPath static_path_of(const model::TurbineDefinition& definition,
                                    analysis::StaticMethod method = analysis::StaticMethod::load) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  return find_static_path(system, {method, 5, 1e-10, 1000}, observer);
}

/// Displacement of the blade's end.
Vector3 end_of(const model::TurbineDefinition& definition, const Eigen::VectorXd& z) {
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  return z.segment<3>(system.layout().blade_tip(0));
}

std::string refusal_of(const model::TurbineDefinition& definition) {
  try {
    static_path_of(definition);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(supports)

BOOST_AUTO_TEST_CASE(a_beam_on_a_free_hinge_hangs_as_its_loads_bring_it) {
  // Weight and force grow together: the angle is that of any load factor but 0.
  for (const double force : {0.0, 0.3, 5.0, 200.0})
    for (const analysis::StaticMethod method :
         {analysis::StaticMethod::load, analysis::StaticMethod::arc_length}) {
      const Pendulum pendulum{force};
      const model::TurbineDefinition definition = definition_of(pendulum);
      const analysis::StaticPath path = static_path_of(definition, method);
      BOOST_TEST(path.states.front().factor == 0.0);
      BOOST_TEST(path.states.back().factor == 1.0);
      BOOST_TEST(path.states.front().z.cwiseAbs().maxCoeff() < 1e-12);
      for (std::size_t i = 1; i < path.states.size(); ++i) {
        const Vector3 end = end_of(definition, path.states[i].z);
        const double angle = pendulum.angle();
        BOOST_TEST(std::abs(end.x() - 2.0 * (std::cos(angle) - 1.0)) < 1e-8);
        BOOST_TEST(std::abs(end.z() - 2.0 * std::sin(angle)) < 1e-8);
        BOOST_TEST(path.states[i].residual < 1e-8);
      }
    }
}

BOOST_AUTO_TEST_CASE(a_beam_that_stands_on_its_hinge_is_pushed_over) {
  const Pendulum pendulum{5.0, 0.0};
  const model::TurbineDefinition definition = definition_of(pendulum);
  const Vector3 end = end_of(definition, static_path_of(definition).states.back().z);
  BOOST_TEST(end.x() == -2.0 * (1.0 + std::cos(pendulum.angle())), tolerance(1e-8));
  BOOST_TEST(end.z() == 2.0 * std::sin(pendulum.angle()), tolerance(1e-8));
}

BOOST_AUTO_TEST_CASE(without_weight_the_beam_turns_into_the_force) {
  const model::TurbineDefinition definition = definition_of(Pendulum{5.0, pi, 0.0, 0.0});
  const Vector3 end = end_of(definition, static_path_of(definition).states.back().z);
  BOOST_TEST((end - Vector3(-2.0, 0.0, 2.0)).norm() < 1e-8);
}

BOOST_AUTO_TEST_CASE(a_beam_that_bends_keeps_the_balance_of_moments_about_its_hinge) {
  // Weight and force have no moment about the hinge, whatever the shape of the beam.
  const Pendulum pendulum{5.0, pi, 20.0};
  const model::TurbineDefinition definition = definition_of(pendulum);
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  const Eigen::VectorXd z = static_path_of(definition).states.back().z;
  const model::Beam& blade = system.turbine().blades[0];
  double moment = -pendulum.force * (Pendulum::length + z(system.layout().blade_tip(0)));
  for (int p = 0; p < blade.point_count(); ++p)
    moment += pendulum.weight() / Pendulum::length * blade.point_length(p) *
              z(system.layout().blade_point(0, p) + 2);
  BOOST_TEST(std::abs(moment) < 1e-8);
  BOOST_TEST(z.segment<6>(system.layout().blade_root(0))(4) < 1e-8);
  const double turned = std::abs(z(system.layout().blade_tip(0) + 4));
  BOOST_TEST(turned > 2.0 * std::tan(0.5 * pendulum.angle()) + 0.05);  // bent beyond the chord
}

BOOST_AUTO_TEST_CASE(a_pendulum_swings_about_the_direction_of_its_loads) {
  // (m l^2/3) theta'' = -l hypot(W/2, F) theta.
  for (const double force : {0.0, 5.0, 60.0}) {
    const Pendulum pendulum{force};
    const double stiffness = std::hypot(0.5 * pendulum.weight(), force);
    const double omega = std::sqrt(stiffness / (Pendulum::mass * Pendulum::length / 3.0));
    const std::vector<double> found = frequencies(constant_modes_of(definition_of(pendulum)));
    BOOST_TEST_REQUIRE(found.size() == 1u);
    BOOST_TEST(found[0] == omega, tolerance(1e-6));
  }
  // Nothing restores it, nothing moves it: a rigid-body motion.
  for (const double omega :
       frequencies(constant_modes_of(definition_of(Pendulum{0.0, pi, 0.0, 0.0}))))
    BOOST_TEST(omega == 0.0);
}

BOOST_AUTO_TEST_CASE(what_nothing_restores_is_named) {
  const auto names = [](const model::TurbineDefinition& definition, const std::string& what) {
    const std::string words = refusal_of(definition);
    BOOST_TEST(words.find("nothing restores blade 1 support " + what + ",") != std::string::npos,
               words);
    BOOST_TEST(words.find("hint: ") != std::string::npos);
  };
  names(definition_of(Pendulum{0.0, pi, 0.0, 0.0}), "theta2");   // no loads at all
  names(definition_of(Pendulum{0.0, 0.5 * pi, 0.0}), "theta2");  // the hinge's axis is vertical
  model::TurbineDefinition slides = definition_of(Pendulum{});
  slides.blades.beam.support = support("rrfrrr");
  names(slides, "u3");
  model::TurbineDefinition spins = definition_of(Pendulum{0.0});
  spins.blades.beam.support = support("rrrfff");
  names(spins, "theta1");
  BOOST_CHECK_THROW(constant_modes_of(slides), InputError);
}

BOOST_AUTO_TEST_CASE(a_blade_on_a_flap_hinge_turns_into_the_plane_of_its_rotation) {
  // A rigid blade, hinged at e from the axis and coned: the centrifugal force has no moment where
  // sin(beta) (cos(beta) l/3 + e/2) = 0 for the angle beta to the plane, and swings it with
  // omega^2 = Omega^2 (1 + 3 e/(2 l)). The hinge moves out with the cone, not with the blade.
  Pendulum none{0.0, 0.0, 0.0, 0.0};
  model::TurbineDefinition definition = definition_of(none);
  definition.shaft.speed = 3.0;
  definition.hub.radius = 0.4;
  definition.blades.precone = 0.05;
  const double offset = 0.4 * std::cos(0.05);
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, {}, observer);
  const Eigen::VectorXd z = trim.solution.coefficients().col(0);
  BOOST_TEST(z(system.layout().blade_tip(0) + 2) == -2.0 * std::sin(0.05), tolerance(1e-8));
  const std::vector<double> found =
      frequencies(analysis::find_constant_modes(system, trim.solution));
  BOOST_TEST(found[0] == 3.0 * std::sqrt(1.0 + 1.5 * offset / Pendulum::length), tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(beams_between_two_supports_vibrate_as_in_the_books) {
  // (beta L)^2 of cos cosh = 1, tan = tanh, sin = 0 (Blevins, Formulas for Natural Frequency and
  // Mode Shape, 1979, table 8-1), and of a hinged beam with a free end.
  struct Ends {
    const char* root;
    const char* end;
    double first, second;
  };
  const auto square = [](double x) { return x * x; };
  for (const Ends& ends : {Ends{"rrrrfr", "ffrfff", square(pi), square(2.0 * pi)},
                           Ends{"rrrrrr", "ffrfff", square(3.92660231), square(7.06858275)},
                           Ends{"rrrrfr", "ffrfrf", square(3.92660231), square(7.06858275)},
                           Ends{"rrrrrr", "ffrfrf", square(4.73004074), square(7.85320462)}}) {
    const model::TurbineDefinition definition = beam_between(ends.root, ends.end);
    const std::vector<double> found = frequencies(constant_modes_of(definition));
    BOOST_TEST_REQUIRE(found.size() > 2u);
    BOOST_TEST(found[0] == ends.first, tolerance(1e-5));
    BOOST_TEST(found[1] == ends.second, tolerance(1e-5));
    const model::Turbine turbine = model::build_turbine(definition);
    BOOST_TEST(static_cast<int>(found.size()) == turbine.degrees_of_freedom);
  }
}

BOOST_AUTO_TEST_CASE(a_beam_turns_with_its_held_end_and_keeps_its_energy) {
  // Floquet's analysis of a turning beam held at its end finds the modes of its own axes.
  model::TurbineDefinition definition = beam_between("rrrrfr", "ffrfff");
  definition.blades.beam.elements = 4;
  definition.shaft.speed = 2.0;
  const std::vector<double> constant = frequencies(constant_modes_of(definition));
  constexpr int steps = 800;
  const analysis::Floquet floquet = floquet_of(definition, steps);
  int resolved = 0;
  for (const analysis::Mode& mode : floquet.set.modes) {
    if (!mode.resolved) continue;
    ++resolved;
    BOOST_TEST(std::abs(std::abs(mode.multiplier) - 1.0) < 1e-7, mode.label);
    const double omega = mode.exponent.imag();
    BOOST_TEST(std::abs(nearest(constant, omega) / omega - 1.0) < 1e-7, mode.label);
  }
  BOOST_TEST(resolved >= 4);
}

BOOST_AUTO_TEST_CASE(supports_that_hold_a_direction_twice_are_refused) {
  BOOST_CHECK_THROW(constant_modes_of(beam_between("rrrrrr", "rfffff")), InputError);
}

BOOST_AUTO_TEST_CASE(springs_carry_a_cantilever_like_flexibilities_in_a_row) {
  // F across the end: the beam's F l^3 / 3 EI, the root's F / k and F l^2 / k_r, all with a spring
  // at the end beside them.
  BeamCase beam;
  beam.stiffness << 0.0, 0.0, 0.0, 0.0, 1e3, 0.0;
  beam.length = 2.0;
  beam.elements = 2;
  model::TurbineDefinition definition = definition_of(beam);
  definition.blades.beam.support = support("rrsrsr");
  definition.blades.beam.support.stiffness.diagonal() << 0.0, 0.0, 700.0, 0.0, 900.0, 0.0;
  model::LoadDefinition load;
  load.from = load.to = 1.0;
  constexpr double force = 1e-3;
  load.force = Vector3(0.0, 0.0, force);
  definition.loads = {load};
  const double flexibility = 8.0 / 3e3 + 1.0 / 700.0 + 4.0 / 900.0;
  for (const double spring : {0.0, 80.0}) {
    definition.blades.beam.end_support = support("ffsfff", spring);
    if (spring == 0.0) definition.blades.beam.end_support = model::free_end();
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    analysis::Observer observer;
    const Eigen::VectorXd z =
        find_static_path(system, {analysis::StaticMethod::load, 1, 1e-12, 10}, observer)
            .states.back()
            .z;
    const double expected = force / (1.0 / flexibility + spring);
    BOOST_TEST(z(system.layout().blade_tip(0) + 2) == expected, tolerance(1e-8));
    const int root = system.layout().blade_root(0);
    const double held = force - spring * expected;
    BOOST_TEST(z(root + 2) == held, tolerance(1e-8));
    BOOST_TEST(z(root + 4) == -held * 2.0, tolerance(1e-8));
  }
}

BOOST_AUTO_TEST_CASE(a_rigid_turbine_sways_and_rocks_on_its_foundation) {
  const Rod rod;
  const std::vector<double> found = frequencies(constant_modes_of(rod_on_springs(rod)));
  // Rotation about b2 (inertia 0.3) moves the tower along b3, about b3 (0.4) along b2.
  for (const double own : {0.3, 0.4}) {
    const Eigen::Vector2d expected = rod_frequencies(rod, own);
    for (const double omega : expected) BOOST_TEST(nearest(found, omega) == omega, tolerance(1e-6));
  }
  BOOST_TEST(nearest(found, std::sqrt(rod.lateral / (rod.mass + 0.7))) ==
                 std::sqrt(rod.lateral / (rod.mass + 0.7)),
             tolerance(1e-6));
  BOOST_TEST(nearest(found, std::sqrt(rod.rotation / 0.2)) == std::sqrt(rod.rotation / 0.2),
             tolerance(1e-6));
  // The weight matters.
  Rod light = rod;
  light.gravity = 0.0;
  BOOST_TEST(std::abs(nearest(found, rod_frequencies(light, 0.3)(0)) -
                      rod_frequencies(light, 0.3)(0)) > 1e-3);
}

BOOST_AUTO_TEST_CASE(damping_of_the_foundation_gives_each_mode_mu_omega_over_two) {
  Rod rod;
  rod.gravity = 0.0;
  rod.damping = 0.004;
  int seen = 0;
  for (const analysis::Mode& mode : constant_modes_of(rod_on_springs(rod)).modes) {
    if (mode.exponent.imag() == 0.0) continue;
    ++seen;
    BOOST_TEST(mode.damping_ratio == 0.5 * rod.damping * std::abs(mode.exponent), tolerance(1e-6));
  }
  BOOST_TEST(seen == 6);
}

BOOST_AUTO_TEST_CASE(unequal_springs_that_have_turned_neither_feed_nor_take) {
  // A coned and pitched blade pulls its springs out of line; they keep a potential, root and end.
  for (const bool at_end : {false, true}) {
    BeamCase beam;
    beam.length = 10.0;
    beam.hub_radius = 1.0;
    beam.inertia = Vector3(2e-2, 1e-2, 1e-2);
    beam.stiffness << 1e9, 0.0, 0.0, 1e5, 2e5, 4e5;
    beam.elements = 2;
    beam.order = 5;
    beam.speed = at_end ? 4.0 : 6.0;
    model::TurbineDefinition definition = definition_of(beam);
    definition.blades.precone = (at_end ? 25.0 : 15.0) * pi / 180.0;
    definition.blades.pitch = 25.0 * pi / 180.0;
    model::SupportDefinition& springs =
        at_end ? definition.blades.beam.end_support : definition.blades.beam.support;
    springs = support(at_end ? "fffsss" : "rrrsss", 1.0);
    springs.stiffness.diagonal() << 0.0, 0.0, 0.0, 3e3, 6e3, 3e4;
    springs.mass = at_end ? 0.0 : 1.0;
    springs.inertia.setConstant(at_end ? 0.0 : 0.5);
    const analysis::ModeSet set = constant_modes_of(definition);
    BOOST_TEST(set.conservative);
    for (std::size_t m = 0; m < 4; ++m)
      BOOST_TEST(std::abs(set.modes[m].exponent.real()) < 1e-6, set.modes[m].label);
  }
}

BOOST_AUTO_TEST_CASE(a_damped_foundation_is_not_conservative) {
  Rod rod;
  BOOST_TEST(constant_modes_of(rod_on_springs(rod)).conservative);
  rod.damping = 1e-3;
  BOOST_TEST(!constant_modes_of(rod_on_springs(rod)).conservative);
}

BOOST_AUTO_TEST_CASE(held_ends_of_three_blades_keep_the_symmetry) {
  model::TurbineDefinition definition = beam_between("rrrrrr", "ffrfff");
  definition.blades.count = 3;
  definition.blades.beam.elements = 2;
  definition.blades.pitch = 0.3;
  definition.shaft.speed = 2.0;
  definition.gravity = 0.5;
  analysis::TrimOptions options;
  options.harmonics = 3;
  const analysis::Floquet blade =
      floquet_of(definition, 300, analysis::FloquetPeriod::automatic, options);
  const analysis::Floquet full =
      floquet_of(definition, 300, analysis::FloquetPeriod::full, options);
  BOOST_TEST(blade.sectors == 3);
  BOOST_TEST_REQUIRE(blade.set.modes.size() == full.set.modes.size());
  int resolved = 0;
  for (const analysis::Mode& mode : blade.set.modes) {
    if (!mode.resolved) continue;
    ++resolved;
    double nearest_one = 1.0;
    for (const analysis::Mode& other : full.set.modes)
      nearest_one = std::min(nearest_one, std::abs(other.exponent - mode.exponent));
    BOOST_TEST(nearest_one < 1e-6 * std::abs(mode.exponent), mode.label);
  }
  BOOST_TEST(resolved >= 3);
}

BOOST_AUTO_TEST_CASE(a_stiff_foundation_is_a_clamp) {
  io::Case input = lee("baseline", {"shaft.speed=0"});
  const std::vector<double> clamped = frequencies(constant_modes_of(input.turbine));
  input.turbine.tower.support = support("ssssss", 1e15);
  input.turbine.tower.support.mass = 10.0;
  input.turbine.tower.support.inertia.setConstant(10.0);
  const std::vector<double> stiff = frequencies(constant_modes_of(input.turbine));
  BOOST_TEST(stiff.size() == clamped.size() + 6u);
  for (std::size_t i = 0; i < 12; ++i)
    if (clamped[i] > 0.1) BOOST_TEST(stiff[i] == clamped[i], tolerance(1e-6));
}

BOOST_AUTO_TEST_SUITE_END()
