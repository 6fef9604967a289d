// Damping in proportion to the mass: forces on the sections against the rigid frame of the root,
// and their reaction on it, by what they do at random states of turning rotors.
#include <map>

#include <Eigen/QR>
#include <boost/test/unit_test.hpp>

#include "../elements/jet.hpp"
#include "sample_turbine.hpp"

using namespace samara;

namespace {

using JetVector = Eigen::Matrix<Jet<double>, 3, 1>;

JetVector jets(const Eigen::VectorXd& z, const Eigen::VectorXd& z_dot, Eigen::Index first) {
  JetVector v;
  for (Eigen::Index i = 0; i < 3; ++i) v(i) = Jet<double>(z(first + i), z_dot(first + i));
  return v;
}

/// Components in turned axes of a vector: the rotation of Rodrigues parameters theta, undone.
JetVector unturned(const JetVector& theta, const JetVector& v) {
  const auto cross = [](const JetVector& a, const JetVector& b) {
    JetVector c;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Index j = (i + 1) % 3;
      const Eigen::Index k = (i + 2) % 3;
      c(i) = a(j) * b(k) - a(k) * b(j);
    }
    return c;
  };
  // v - (theta x v - theta x (theta x v)/2)/(1 + theta.theta/4)
  Jet<double> scale(1.0);
  for (Eigen::Index i = 0; i < 3; ++i) scale += Jet<double>(0.25) * theta(i) * theta(i);
  const JetVector once = cross(theta, v);
  const JetVector twice = cross(theta, once);
  JetVector result;
  for (Eigen::Index i = 0; i < 3; ++i)
    result(i) = v(i) - (once(i) - Jet<double>(0.5) * twice(i)) / scale;
  return result;
}

Vector3 values_of(const JetVector& v) { return {v(0).value, v(1).value, v(2).value}; }
Vector3 rates_of(const JetVector& v) { return {v(0).rate, v(1).rate, v(2).rate}; }

/// Contribution of the damping to the residual of a beam, against its closed form.
void check_beam(const components::PlacedBeam& placed, const sample::RandomState& state,
                const Eigen::VectorXd& added, const Vector3& alpha) {
  const model::Beam& beam = *placed.beam;
  const auto count = static_cast<Eigen::Index>(beam.point_count());
  // Rows of force of the nodes, linear in the forces on the points; the root has the reactions.
  std::map<int, Eigen::Index> nodes;
  for (int p = 0; p < beam.point_count(); ++p)
    for (int node = 0; node <= beam.order; ++node)
      nodes.try_emplace(placed.force_rows(p, node), static_cast<Eigen::Index>(nodes.size()));
  const auto rows = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(rows, count);
  Eigen::MatrixXd found(rows, 3);
  for (const auto& [row, at] : nodes) found.row(at) = added.segment<3>(row).transpose();
  for (int p = 0; p < beam.point_count(); ++p) {
    for (int node = 0; node <= beam.order; ++node)
      weights(nodes.at(placed.force_rows(p, node)), p) -= placed.node_weights(node, p)[1];
    weights(nodes.at(placed.force_rows(0, 0)), p) += beam.point_length(p);
  }
  const Eigen::MatrixXd forces = weights.colPivHouseholderQr().solve(found);
  const double level = found.cwiseAbs().maxCoeff();
  BOOST_TEST(level > 0.0);
  BOOST_TEST((weights * forces - found).cwiseAbs().maxCoeff() < 1e-10 * level);

  JetVector root_u = JetVector::Constant(Jet<double>(0.0));
  JetVector root_theta = root_u;
  if (beam.has_support) {
    root_u = jets(state.z, state.z_dot, placed.masses.front());
    root_theta = jets(state.z, state.z_dot, placed.masses.front() + 3);
  }
  // A frame that moves anyhow carries the root: forces and reactions are in equilibrium.
  const Vector3 carried(3.0, -7.0, 2.0);
  const Vector3 spin(-1.0, 4.0, 2.5);
  Vector3 root_moment = added.segment<3>(placed.force_rows(0, 0) + 3);
  Vector3 force_sum = Vector3::Zero();
  double power = 0.0;
  double dissipated = 0.0;
  for (int p = 0; p < beam.point_count(); ++p) {
    const elements::BeamPoint& point = beam.points[static_cast<std::size_t>(p)];
    const JetVector u = jets(state.z, state.z_dot, placed.points[static_cast<std::size_t>(p)]);
    JetVector arm;
    for (Eigen::Index i = 0; i < 3; ++i) arm(i) = Jet<double>(point.x(i)) + u(i) - root_u(i);
    const Vector3 motion = rates_of(unturned(root_theta, arm));  // against the root's own axes
    const double mass = point.mass(0, 0) * beam.point_length(p);
    const Vector3 along = point.C_ab.transpose() * motion;
    dissipated -= mass * along.dot(alpha.cwiseProduct(along));
    const Vector3 force = forces.row(p).transpose() * beam.point_length(p);
    root_moment -= values_of(arm).cross(force);
    force_sum += force;
    const Vector3 place = point.x + values_of(u);
    power += force.dot(carried + spin.cross(place) + rates_of(u));
  }
  // The root's reaction: -force_sum at its place, and the moment of the row, with its motion.
  const Vector3 moment = -added.segment<3>(placed.force_rows(0, 0) + 3);
  Vector3 turning = spin;
  if (beam.has_support) {
    JetVector axis = JetVector::Constant(Jet<double>(0.0));
    // omega of the root's axes from the rates of their unit vectors: sum e x e_dot / 2.
    const JetVector minus = -root_theta;
    for (Eigen::Index i = 0; i < 3; ++i) {
      axis.setConstant(Jet<double>(0.0));
      axis(i) = Jet<double>(1.0);
      const JetVector unit = unturned(minus, axis);
      turning += 0.5 * values_of(unit).cross(rates_of(unit));
    }
  }
  const Vector3 root_place = values_of(root_u);
  power -= force_sum.dot(carried + spin.cross(root_place) + rates_of(root_u));
  power += moment.dot(turning);
  BOOST_TEST(root_moment.norm() < 1e-10 * level * beam.length);
  BOOST_TEST(dissipated < 0.0);
  BOOST_TEST(std::abs(power - dissipated) < 1e-10 * std::abs(dissipated));
}

model::SupportDefinition springs() {
  model::SupportDefinition support;
  support.rigid = {};
  support.stiffness = sample::section_stiffness(Vector6::Constant(3e3), 0.1);
  support.mass = 1.3;
  support.inertia = Vector3(0.3, 0.4, 0.5);
  return support;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(mass_damping)

BOOST_AUTO_TEST_CASE(forces_and_reactions_dissipate_by_the_motion_against_the_root) {
  for (const bool on_springs : {false, true})
    for (const Vector3& alpha : {Vector3(0.3, 0.3, 0.3), Vector3(0.1, 0.4, 0.7)})
      for (const sample::Choice& choice : sample::choices()) {
        model::TurbineDefinition definition = sample::turbine_definition(choice);
        if (on_springs) definition.tower.support = definition.blades.beam.support = springs();
        definition.tower.mass_damping = definition.blades.beam.mass_damping = Vector3::Zero();
        const turbine::TurbineSystem without(model::build_turbine(definition), PETSC_COMM_SELF);
        definition.tower.mass_damping = definition.blades.beam.mass_damping = alpha;
        const turbine::TurbineSystem damped(model::build_turbine(definition), PETSC_COMM_SELF);
        BOOST_TEST(!damped.is_conservative());
        const sample::RandomState state = sample::random_state(damped, 11);
        const Eigen::VectorXd added = sample::residual_of(damped, 0.4, state.z, state.z_dot) -
                                      sample::residual_of(without, 0.4, state.z, state.z_dot);
        for (const components::PlacedBeam& placed : damped.equations().beams())
          check_beam(placed, state, added, alpha);
        BOOST_TEST(sample::tangent_error(damped, 0.4, state) < 1e-11);
      }
}

BOOST_AUTO_TEST_SUITE_END()
