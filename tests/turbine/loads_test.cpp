// Prescribed loads in the assembled balances: what they add to the residual, their tangents, and
// what they leave of the rotor's symmetry.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/math/quadrature.hpp"

#include "bodies.hpp"

namespace {

using namespace samara;
using Complex = std::complex<double>;

/// Sums of some hundred products, relative to the largest entry.
constexpr double round_off = 1e-12;

/// Tangents against the complex step, relative to the largest entry of the row.
constexpr double tangent_tolerance = 1e-11;
constexpr double complex_step = 1e-30;

model::LoadDefinition load_of(bool on_tower, int blade, double from, double to, bool follower) {
  model::LoadDefinition load;
  load.on_tower = on_tower;
  load.blade = blade;
  load.from = from;
  load.to = to;
  load.follower = follower;
  load.force = Vector3(30.0, -20.0, 50.0);
  load.moment = Vector3(-7.0, 11.0, 4.0);
  return load;
}

model::LoadVariation wave(int per_rev) {
  model::LoadVariation series;
  series.mean = 0.3;
  series.amplitude = 0.8;
  series.per_rev = per_rev;
  series.phase = 0.5;
  return series;
}

/// All kinds on every beam, at places that are no nodes, and at the ends.
std::vector<model::LoadDefinition> all_kinds(bool tower) {
  std::vector<model::LoadDefinition> loads;
  for (const bool follower : {false, true}) {
    for (const bool on_tower : {false, true}) {
      if (on_tower && !tower) continue;
      loads.push_back(load_of(on_tower, 0, 1.0, 1.0, follower));
      loads.push_back(load_of(on_tower, 0, 0.37, 0.37, follower));
      loads.push_back(load_of(on_tower, 0, 0.21, 0.83, follower));
      loads.back().variation = wave(2);
    }
    loads.push_back(load_of(false, 1, 0.6, 0.9, follower));
    loads.back().variation.table = {{0.0, 0.0}, {2.0, 1.0}};
  }
  return loads;
}

turbine::TurbineSystem build(const sample::Choice& choice,
                             const std::vector<model::LoadDefinition>& loads) {
  model::TurbineDefinition definition = sample::turbine_definition(choice);
  definition.loads = loads;
  return turbine::TurbineSystem(model::build_turbine(definition), PETSC_COMM_SELF);
}

/// Contribution of the loads to r.
Eigen::VectorXd load_rows(const sample::Choice& choice,
                          const std::vector<model::LoadDefinition>& loads, double t,
                          const sample::RandomState& state) {
  const turbine::TurbineSystem with = build(choice, loads);
  const turbine::TurbineSystem without = build(choice, {});
  return sample::residual_of(with, t, state.z, state.z_dot) -
         sample::residual_of(without, t, state.z, state.z_dot);
}

Eigen::VectorXcd complex_residual(const turbine::TurbineSystem& system, double t,
                                  const Eigen::VectorXcd& z, const Eigen::VectorXcd& z_dot) {
  const std::vector<Complex> state(z.data(), z.data() + z.size());
  const std::vector<Complex> rate(z_dot.data(), z_dot.data() + z_dot.size());
  std::vector<Complex> r(state.size());
  system.equations().evaluate<Complex>(t, state, rate, r);
  return Eigen::Map<const Eigen::VectorXcd>(r.data(), z.size());
}

/// First row of the force balance of node n, counted from the root.
int force_row(const components::PlacedBeam& placed, int n) {
  const int order = placed.beam->order;
  return n == 0 ? placed.force_rows(0, 0) : placed.force_rows(n - 1, (n - 1) % order + 1);
}

/// First rows of the force balances of a blade's nodes, root to tip.
std::vector<int> force_rows(const turbine::TurbineSystem& system, int blade) {
  const components::PlacedBeam& placed =
      system.equations().beams()[static_cast<std::size_t>(blade)];
  std::vector<int> rows;
  for (int n = 0; n <= placed.beam->point_count(); ++n) rows.push_back(force_row(placed, n));
  return rows;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(loads)

BOOST_AUTO_TEST_CASE(dead_loads_add_their_integral_to_the_nodes_and_nothing_else) {
  // Times any test function of degree s, zero at the root or not, the rows are the load's work.
  for (const int order : {1, 2, 3}) {
    const sample::Choice choice{2, order, true, true, true, true, false};
    const turbine::TurbineSystem system = build(choice, {});
    const sample::RandomState state = sample::random_state(system, 1);
    const model::LoadDefinition load = load_of(false, 2, 0.21, 0.83, false);
    const Eigen::VectorXd rows = load_rows(choice, {load}, 0.4, state);
    const std::vector<double> nodes = math::lobatto_nodes(order);
    const std::vector<int> first = force_rows(system, 1);
    const double length = 3.0;
    Vector6 work = Vector6::Zero();
    Eigen::VectorXd rest = rows;
    for (std::size_t n = 0; n < first.size(); ++n) {
      const int local = static_cast<int>(n) % order;
      const double element = std::floor(static_cast<double>(n) / order);
      const double place = (element + nodes[static_cast<std::size_t>(local)]) * 0.5 * length;
      work += std::pow(place, order) * rows.segment<6>(first[n]);
      rest.segment<6>(first[n]).setZero();
    }
    const double moment =
        (std::pow(0.83 * length, order + 1) - std::pow(0.21 * length, order + 1)) / (order + 1);
    Vector6 expected;
    expected << -moment * load.force, -moment * load.moment;
    BOOST_TEST((work - expected).norm() < 1e-10 * expected.norm());  // of residuals of some 1e3
    BOOST_TEST(rest.cwiseAbs().maxCoeff() == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(follower_loads_turn_with_the_deformed_section_and_its_twist) {
  for (const bool tower : {false, true}) {
    const sample::Choice choice{2, 1, true, true, true, true, false};  // s = 1: R of the one point
    const turbine::TurbineSystem system = build(choice, {});
    const sample::RandomState state = sample::random_state(system, 2);
    const model::LoadDefinition at_point = load_of(tower, tower ? 0 : 1, 0.25, 0.25, true);
    const model::LoadDefinition at_tip = load_of(tower, tower ? 0 : 1, 1.0, 1.0, true);
    const components::PlacedBeam& placed = system.equations().beams()[tower ? 2 : 0];
    const auto turned = [&](int first, double twist, const Vector3& v) {
      return Vector3(sample::turned(Vector3(state.z.segment<3>(first + 3))) *
                     sample::turned(Vector3::UnitX(), -twist) * v);
    };
    // The tower is of order 2: its points carry R by their polynomials.
    const Eigen::VectorXd tip = load_rows(choice, {at_tip}, 0.0, state);
    const int last = force_row(placed, placed.beam->point_count());
    BOOST_TEST((tip.segment<3>(last) + turned(placed.tip, 0.0, at_tip.force)).norm() < 1e-9);
    BOOST_TEST((tip.segment<3>(last + 3) + turned(placed.tip, 0.0, at_tip.moment)).norm() < 1e-9);
    if (tower) continue;
    const Eigen::VectorXd rows = load_rows(choice, {at_point}, 0.0, state);
    const double twist = 0.3 * (1.0 - 0.25);
    Vector6 sum = Vector6::Zero();
    for (int n = 0; n <= placed.beam->point_count(); ++n)
      sum += rows.segment<6>(force_row(placed, n));
    BOOST_TEST((sum.head<3>() + turned(placed.points[0], twist, at_point.force)).norm() < 1e-9);
    BOOST_TEST((sum.tail<3>() + turned(placed.points[0], twist, at_point.moment)).norm() < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(loads_follow_their_time) {
  const sample::Choice choice;
  const turbine::TurbineSystem system = build(choice, {});
  const sample::RandomState state = sample::random_state(system, 3);
  model::LoadDefinition load = load_of(false, 0, 0.2, 0.7, true);
  const Eigen::VectorXd constant = load_rows(choice, {load}, 0.0, state);
  load.variation = wave(2);
  const double factor = 0.3 + 0.8 * std::cos(2.0 * 3.0 * 0.9 + 0.5);  // 3 rad/s
  const Eigen::VectorXd later = load_rows(choice, {load}, 0.9, state);
  BOOST_TEST((later - factor * constant).norm() < 1e-10 * constant.norm());
}

BOOST_AUTO_TEST_CASE(K_is_the_complex_step_with_loads_of_all_kinds) {
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice, all_kinds(choice.tower));
    const sample::RandomState state = sample::random_state(system, 4);
    const Eigen::MatrixXd K = sample::tangents_of(system, 0.9, state.z, state.z_dot).K;
    const Eigen::MatrixXd bare =
        sample::tangents_of(build(choice, {}), 0.9, state.z, state.z_dot).K;
    BOOST_TEST((K - bare).cwiseAbs().maxCoeff() > 1.0);
    Eigen::MatrixXd expected(K.rows(), K.cols());
    Eigen::VectorXcd z = state.z.cast<Complex>();
    const Eigen::VectorXcd z_dot = state.z_dot.cast<Complex>();
    for (Eigen::Index j = 0; j < K.cols(); ++j) {
      z(j) += Complex(0.0, complex_step);
      expected.col(j) = complex_residual(system, 0.9, z, z_dot).imag() / complex_step;
      z(j) = state.z(j);
    }
    for (Eigen::Index i = 0; i < K.rows(); ++i)
      BOOST_TEST((K.row(i) - expected.row(i)).cwiseAbs().maxCoeff() <
                 tangent_tolerance * (1.0 + expected.row(i).cwiseAbs().maxCoeff()));
  }
}

BOOST_AUTO_TEST_CASE(the_rotor_repeats_where_its_loads_do) {
  const sample::Choice choice{3, 2, true, true, false, true, false};
  const auto sectors = [&](model::LoadDefinition load, int per_rev) {
    if (per_rev > 0) load.variation = wave(per_rev);
    return build(choice, {load}).symmetry().sectors;
  };
  const model::LoadDefinition blades = load_of(false, 0, 0.2, 0.7, true);
  const model::LoadDefinition tower = load_of(true, 0, 1.0, 1.0, false);
  BOOST_TEST(sectors(blades, 0) == 3);
  BOOST_TEST(sectors(tower, 0) == 3);
  BOOST_TEST(sectors(blades, 6) == 3);
  BOOST_TEST(sectors(tower, 3) == 3);
  BOOST_TEST(sectors(blades, 2) == 1);
  BOOST_TEST(sectors(tower, 1) == 1);
  BOOST_TEST(sectors(load_of(false, 2, 0.2, 0.7, false), 0) == 1);

  // r(t, P z, P z_dot) = P r(t + T/Q, z, z_dot)
  std::vector<model::LoadDefinition> loads{blades, tower, blades, tower};
  loads[2].variation = wave(3);
  loads[3].variation = wave(6);
  const turbine::TurbineSystem system = build(choice, loads);
  const system::RotorSymmetry& symmetry = system.symmetry();
  BOOST_TEST_REQUIRE(symmetry.sectors == 3);
  const sample::RandomState state = sample::random_state(system, 5);
  const auto renamed = [&symmetry](const Eigen::VectorXd& v) {
    Eigen::VectorXd result(v.size());
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      result(i) = symmetry.sign[at] * v(symmetry.source[at]);
    }
    return result;
  };
  const double t = 0.37;
  const Eigen::VectorXd later =
      sample::residual_of(system, t + system.period() / 3.0, state.z, state.z_dot);
  const Eigen::VectorXd now =
      sample::residual_of(system, t, renamed(state.z), renamed(state.z_dot));
  Eigen::VectorXd difference = now - renamed(later);
  difference(system.layout().teeter() + 1) = 0.0;  // the speed of a locked hinge
  BOOST_TEST(difference.cwiseAbs().maxCoeff() < round_off * now.cwiseAbs().maxCoeff());
}

BOOST_AUTO_TEST_CASE(only_loads_with_a_potential_are_conservative) {
  sample::Choice choice{3, 2, false, false, false, false, false};
  model::LoadDefinition force = load_of(false, 0, 0.2, 0.7, false);
  force.moment.setZero();
  const auto conservative = [&](const model::LoadDefinition& load) {
    model::TurbineDefinition definition = sample::turbine_definition(choice);
    definition.nacelle.yaw.damping = 0.0;
    definition.hub.teeter.damping = 0.0;
    definition.loads = {load};
    return turbine::TurbineSystem(model::build_turbine(definition), PETSC_COMM_SELF)
        .is_conservative();
  };
  BOOST_TEST(conservative(force));
  BOOST_TEST(!conservative(load_of(false, 0, 0.2, 0.7, false)));  // a dead moment
  force.follower = true;
  BOOST_TEST(!conservative(force));
  force.follower = false;
  choice.tower = true;  // the axes of a blade's root move with what the load does to them
  BOOST_TEST(!conservative(force));
  force.on_tower = true;
  BOOST_TEST(conservative(force));
}

BOOST_AUTO_TEST_SUITE_END()
