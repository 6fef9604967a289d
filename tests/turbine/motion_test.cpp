// Turning and moving turbines: steady rotation in closed form, and what a free motion conserves.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "bodies.hpp"

namespace {

using namespace samara;

/// Sums over a turbine after a solve with a condition of some 1e6.
constexpr double balance_tolerance = 1e-9;

/// Sums of some ten products.
constexpr double round_off = 1e-12;

turbine::TurbineSystem build(const model::TurbineDefinition& definition) {
  return turbine::TurbineSystem(model::build_turbine(definition), PETSC_COMM_SELF);
}

/// A rotor on the ground that spins without gravity, all sections rigid.
model::TurbineDefinition rigid_rotor(int blades, int order) {
  model::TurbineDefinition definition =
      sample::turbine_definition({blades, order, false, false, false, false, false});
  definition.gravity = 0.0;
  for (model::SectionDefinition& section : definition.blades.beam.sections) {
    section.rigid.fill(true);
    section.stiffness.setZero();
  }
  return definition;
}

/// z with r(t, z, 0) = 0 where that is linear in what is unknown.
Eigen::VectorXd solve_once(const system::PeriodicSystem& system, double t) {
  Eigen::VectorXd z = sample::reference_state_of(system, t);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  const Eigen::VectorXd r = sample::residual_of(system, t, z, zero);
  const Eigen::MatrixXd K = sample::tangents_of(system, t, z, zero).K;
  z -= Eigen::PartialPivLU<Eigen::MatrixXd>(K).solve(r);
  const double scale = (K.cwiseAbs() * z.cwiseAbs()).maxCoeff();
  const double left = sample::residual_of(system, t, z, zero).cwiseAbs().maxCoeff();
  BOOST_TEST(left < balance_tolerance * scale);
  return z;
}

/// Steps of the implicit mid-point rule, differential unknowns at the ends of a step and algebraic
/// ones constant over it. Hands z at each mid-step to `see(t, z)`.
template <class See>
void run_midpoint(const system::PeriodicSystem& system, double duration, int steps, See see) {
  const double dt = duration / steps;
  const int n = system.size();
  const std::vector<bool>& differential = system.differential();
  Eigen::VectorXd start = sample::reference_state_of(system, 0.0);
  Eigen::VectorXd end = start;
  Eigen::VectorXd middle(n);
  Eigen::VectorXd rate(n);
  for (int step = 0; step < steps; ++step) {
    const double t = (step + 0.5) * dt;
    double change = 1.0;
    for (int iteration = 0; change > 1e-11; ++iteration) {
      BOOST_TEST_REQUIRE(iteration < 20, "the step at " << t << " s does not converge");
      for (int i = 0; i < n; ++i) {
        const bool moves = differential[static_cast<std::size_t>(i)];
        middle(i) = moves ? 0.5 * (start(i) + end(i)) : end(i);
        rate(i) = moves ? (end(i) - start(i)) / dt : 0.0;
      }
      const Eigen::VectorXd r = sample::residual_of(system, t, middle, rate);
      sample::Tangents tangents = sample::tangents_of(system, t, middle, rate);
      for (int i = 0; i < n; ++i) {
        if (!differential[static_cast<std::size_t>(i)]) continue;
        tangents.K.col(i) = 0.5 * tangents.K.col(i) + tangents.M.col(i) / dt;
      }
      const Eigen::VectorXd update = Eigen::PartialPivLU<Eigen::MatrixXd>(tangents.K).solve(r);
      end -= update;
      change = update.norm() / (1.0 + end.norm());
    }
    for (int i = 0; i < n; ++i)
      middle(i) = differential[static_cast<std::size_t>(i)] ? 0.5 * (start(i) + end(i)) : end(i);
    see(t, middle);
    start = end;
  }
}

/// How far a conserved quantity strays from its value at the start, and how much energy moves.
struct Drift {
  double largest = 0.0;
  double exchanged = 0.0;
};

/// A small turbine with soft beams, so that few steps resolve all of its motions. Masses, offsets
/// and couplings stay; dampers go. The nodes' balances take virtual rotations as polynomials and
/// the curvature rows take theta so: at large rotations the energy of the cut beams is conserved to
/// O(L^(2 s)) only, hence s = 3, where that is far below the error of the steps.
model::TurbineDefinition soft_turbine(const sample::Choice& choice) {
  model::TurbineDefinition definition = sample::turbine_definition(choice);
  definition.nacelle.yaw.damping = 0.0;
  definition.hub.teeter.damping = 0.0;
  for (model::BeamDefinition* beam : {&definition.tower, &definition.blades.beam}) {
    beam->elements = 1;
    beam->order = 3;
    for (model::SectionDefinition& section : beam->sections)
      section.stiffness.topLeftCorner<3, 3>() *= 0.2;
  }
  definition.blades.each[2].mass_factor = 1.3;
  definition.blades.each[2].stiffness_factor = 1.2;
  return definition;
}

/// T + V of a turbine that is let go from its undeformed state at rest under gravity.
Drift released(const model::TurbineDefinition& definition, int steps) {
  const turbine::TurbineSystem system = build(definition);
  const Eigen::VectorXd start = sample::reference_state_of(system, 0.0);
  const double before =
      sample::bodies_at(definition, system, 0.0, start).potential(definition.gravity);
  Drift drift;
  run_midpoint(system, 0.4, steps, [&](double t, const Eigen::VectorXd& z) {
    const sample::Bodies bodies = sample::bodies_at(definition, system, t, z);
    const double energy = bodies.kinetic() + bodies.strain() + bodies.potential(definition.gravity);
    drift.largest = std::max(drift.largest, std::abs(energy - before));
    drift.exchanged = std::max(drift.exchanged, bodies.kinetic());
  });
  return drift;
}

/// T + V of a turbine with a free generator that starts undeformed, and what its generator has
/// taken: the torque by its law times its speed, both behind the gear.
Drift braked(const model::TurbineDefinition& definition, int steps) {
  constexpr double duration = 0.4;
  const turbine::TurbineSystem system = build(definition);
  const double gear = std::abs(definition.shaft.gear_ratio);
  const model::TorqueLaw& law = definition.shaft.generator.law;
  double before = 0.0;
  double taken = 0.0;
  double last_power = 0.0;
  bool begun = false;
  Drift drift;
  run_midpoint(system, duration, steps, [&](double t, const Eigen::VectorXd& z) {
    const sample::Bodies bodies = sample::bodies_at(definition, system, t, z);
    const double energy = bodies.kinetic() + bodies.strain() + bodies.potential(definition.gravity);
    const double speed = gear * bodies.gear_rate;
    const double power = (law.torque + law.slope * (speed - gear * definition.shaft.speed)) * speed;
    if (begun)
      taken += 0.5 * (last_power + power) * duration / steps;
    else
      before = energy;
    begun = true;
    last_power = power;
    drift.largest = std::max(drift.largest, std::abs(energy + taken - before));
    drift.exchanged = std::max(drift.exchanged, std::abs(taken));
  });
  return drift;
}

/// T - Omega L + V of a rotor on the ground without gravity, L its moment of momentum about the
/// shaft (Jacobi's integral of steadily turning axes).
Drift spun_up(const model::TurbineDefinition& definition, int steps) {
  const turbine::TurbineSystem system = build(definition);
  const double speed = definition.shaft.speed;
  const Vector3 s2(0.0, std::cos(definition.shaft.tilt), std::sin(definition.shaft.tilt));
  const Vector3 on_shaft(0.0, 0.0, definition.shaft.height);
  const auto jacobi = [&](double t, const Eigen::VectorXd& z) {
    const sample::Bodies bodies = sample::bodies_at(definition, system, t, z);
    double value = bodies.kinetic() + bodies.strain();
    for (const sample::Piece& piece : bodies.pieces)
      value -= speed * s2.dot(piece.moment_of_momentum - on_shaft.cross(piece.momentum));
    return value;
  };
  const double before = jacobi(0.0, sample::reference_state_of(system, 0.0));
  Drift drift;
  run_midpoint(system, 0.5, steps, [&](double t, const Eigen::VectorXd& z) {
    drift.largest = std::max(drift.largest, std::abs(jacobi(t, z) - before));
    drift.exchanged =
        std::max(drift.exchanged, sample::bodies_at(definition, system, t, z).strain());
  });
  return drift;
}

/// The mid-point rule leaves an error of second order in the step.
void check_second_order(const Drift& coarse, const Drift& fine) {
  BOOST_TEST(fine.largest < 0.02 * fine.exchanged);
  const double slope = std::log2(coarse.largest / fine.largest);
  BOOST_TEST(std::abs(slope - 2.0) < 0.2,
             "drift " << coarse.largest << " and " << fine.largest << " of " << fine.exchanged);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(reference_state)

BOOST_AUTO_TEST_CASE(reference_state_is_undeformed_and_satisfies_constraints_and_kinematics) {
  for (const sample::Choice& choice : sample::choices()) {
    const model::TurbineDefinition definition = sample::turbine_definition(choice);
    const turbine::TurbineSystem system = build(definition);
    for (const double t : {0.0, 0.7}) {
      const Eigen::VectorXd z = sample::reference_state_of(system, t);
      const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
      const Eigen::VectorXd r = sample::residual_of(system, t, z, zero);
      for (int i = 0; i < system.size(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        const system::Unknown& unknown = system.unknowns()[at];
        const bool prescribed = choice.prescribed &&
                                (unknown.name() == "yaw angle" || unknown.name() == "teeter angle");
        if (unknown.role != system::UnknownRole::velocity && !prescribed)
          BOOST_TEST(z(i) == 0.0, unknown.name());
        if (system.rows()[at] != system::RowRole::balance)
          BOOST_TEST(std::abs(r(i)) < round_off, unknown.name());
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_straight_blade_in_the_rotor_plane_moves_with_its_radius) {
  model::TurbineDefinition definition =
      sample::turbine_definition({2, 2, true, true, true, true, false});
  definition.blades.precone = 0.0;
  definition.blades.pitch = 0.0;
  for (model::SectionDefinition& section : definition.blades.beam.sections) section.twist = 0.0;
  const turbine::TurbineSystem system = build(definition);
  const Eigen::VectorXd z = sample::reference_state_of(system, 0.4);
  for (int k = 0; k < 2; ++k) {
    for (int p = 0; p < 4; ++p) {
      const int first = system.layout().blade_point(k, p);
      const double fraction = system.turbine().blades[0].fractions[static_cast<std::size_t>(p)];
      const double radius = definition.hub.radius + fraction * definition.blades.beam.length;
      Vector6 expected;
      expected << 0.0, definition.shaft.speed * radius, 0.0, 0.0, 0.0, definition.shaft.speed;
      BOOST_TEST((z.segment<6>(first + 6) - expected).norm() < round_off);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(steady_rotation)

BOOST_AUTO_TEST_CASE(a_straight_blade_pulls_at_its_root_with_its_centrifugal_force) {
  // Uniform, without cone: F1 = m Omega^2 (R^2 - r0^2) / 2; with pitch beta the sections want to
  // lie flat: M1 = (I3 - I2) Omega^2 sin(beta) cos(beta) L (the propeller moment).
  for (int order = 1; order <= 3; ++order) {
    model::TurbineDefinition definition = rigid_rotor(2, order);
    definition.blades.precone = 0.0;
    definition.blades.beam.tip_mass = 0.7;
    model::SectionDefinition section = definition.blades.beam.sections[0];
    section.twist = 0.0;
    section.mass = sample::section_mass(2.0, 0.0, 0.0, Vector3(0.5, 0.2, 0.3));
    definition.blades.beam.sections = {section};
    const turbine::TurbineSystem system = build(definition);
    const Eigen::VectorXd z = solve_once(system, 0.3);
    const double Omega = definition.shaft.speed;
    const double r0 = 0.35;
    const double R = 3.35;
    const double force = 2.0 * Omega * Omega * (R * R - r0 * r0) / 2.0 + 0.7 * Omega * Omega * R;
    const double moment = (0.3 - 0.2) * Omega * Omega * std::sin(0.2) * std::cos(0.2) * 3.0;
    for (int k = 0; k < 2; ++k) {
      const Vector6 root = z.segment<6>(system.layout().blade_root(k));
      BOOST_TEST(std::abs(root(0) - force) < round_off * force);
      BOOST_TEST(root.segment<2>(1).norm() < round_off * force);
      BOOST_TEST(std::abs(root(3) - moment) < round_off * force);
      BOOST_TEST(root.tail<2>().norm() < round_off * force * R);
    }
    // Half-way along the span the axial force is that of the outer half.
    const int inner = system.layout().blade_point(0, 0);
    BOOST_TEST(z(inner + 12) < force);
    BOOST_TEST(z(inner + 12) > 0.8 * force);
  }
}

BOOST_AUTO_TEST_CASE(root_loads_of_a_coned_twisted_rotor_are_the_centrifugal_integrals) {
  // F = sum m Omega^2 r and its moment about the root, and - omega x J omega of each section.
  for (int order = 1; order <= 3; ++order) {
    const model::TurbineDefinition definition = rigid_rotor(3, order);
    const turbine::TurbineSystem system = build(definition);
    const double t = 0.3;
    const Eigen::VectorXd z = solve_once(system, t);
    const sample::Bodies bodies = sample::bodies_at(definition, system, t, z);
    const double Omega = definition.shaft.speed;
    const Vector3 spin = Omega * bodies.R_H.col(1);
    const Vector3 on_shaft(0.0, 0.0, definition.shaft.height);
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k);
      // Momentum and its moment turn with the rotor: their rates are Omega x them.
      Vector3 momentum = Vector3::Zero();
      Vector3 moment_of_momentum = Vector3::Zero();
      for (const sample::Piece& piece : bodies.pieces) {
        if (piece.blade != k) continue;
        momentum += piece.momentum;
        moment_of_momentum += piece.moment_of_momentum - on_shaft.cross(piece.momentum);
      }
      const Vector3 force = -spin.cross(momentum);
      const Vector3 about_axis = -spin.cross(moment_of_momentum);
      const Vector3 moment = about_axis - (bodies.roots[at] - on_shaft).cross(force);
      const int root = system.layout().blade_root(k);
      const Vector3 found_force = bodies.axes[at] * z.segment<3>(root);
      const Vector3 found_moment = bodies.axes[at] * z.segment<3>(root + 3);
      const double scale = force.norm();
      BOOST_TEST(found_force.dot(bodies.axes[at].col(0)) > 0.0);
      BOOST_TEST((found_force - force).norm() < round_off * scale);
      BOOST_TEST((found_moment - moment).norm() < round_off * scale);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(free_motion)

BOOST_AUTO_TEST_CASE(a_turbine_let_go_under_gravity_conserves_its_energy) {
  for (const bool joints : {true, false}) {
    model::TurbineDefinition definition = soft_turbine({2, 2, true, joints, joints, false, false});
    definition.shaft.speed = 0.0;
    check_second_order(released(definition, 30), released(definition, 60));
  }
}

BOOST_AUTO_TEST_CASE(a_generator_behind_a_gear_takes_its_torque_times_its_speed) {
  for (const double ratio : {6.0, -6.0}) {
    model::TurbineDefinition definition = soft_turbine({2, 2, true, true, true, false, false});
    definition.shaft.torsion = {model::JointKind::free, 250.0, 0.0};
    definition.shaft.generator = {model::JointKind::free, 0.3, {4.0, 0.4, {}}};
    definition.shaft.gear_ratio = ratio;
    definition.tower.elements = definition.blades.beam.elements = 2;
    check_second_order(braked(definition, 40), braked(definition, 80));
  }
}

BOOST_AUTO_TEST_CASE(a_rotor_that_starts_undeformed_conserves_jacobis_integral) {
  model::TurbineDefinition definition = soft_turbine({2, 2, false, false, true, false, false});
  definition.gravity = 0.0;
  check_second_order(spun_up(definition, 60), spun_up(definition, 120));
}

BOOST_AUTO_TEST_SUITE_END()
