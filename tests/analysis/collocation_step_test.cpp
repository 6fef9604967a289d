// One step by collocation, and many.
#include "samara/analysis/collocation_step.hpp"

#include <array>
#include <cmath>
#include <memory>

#include <boost/test/unit_test.hpp>

#include "first_order_systems.hpp"
#include "small_systems.hpp"

using namespace samara;
using namespace samara::test;
using analysis::CollocationStep;
using analysis::ConsistentSubspace;
using analysis::PeriodicSolution;

namespace {

/// Runge-Kutta coefficients of the Gauss methods in their usual form (Hairer, Norsett and Wanner,
/// "Solving Ordinary Differential Equations I", section II.7), and of Radau IIA (Hairer and Wanner,
/// part II, section IV.5).
struct Tableau {
  std::vector<double> c;
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
};

Tableau tableau_of(int order) {
  const double r3 = std::sqrt(3.0);
  const double r15 = std::sqrt(15.0);
  Tableau tableau;
  if (order == 2) {
    tableau.c = {0.5};
    tableau.a = Eigen::MatrixXd::Constant(1, 1, 0.5);
    tableau.b = Eigen::VectorXd::Ones(1);
  } else if (order == 4) {
    tableau.c = {0.5 - r3 / 6.0, 0.5 + r3 / 6.0};
    tableau.a.resize(2, 2);
    tableau.a << 0.25, 0.25 - r3 / 6.0, 0.25 + r3 / 6.0, 0.25;
    tableau.b = Eigen::Vector2d(0.5, 0.5);
  } else if (order == 5) {
    const double r6 = std::sqrt(6.0);
    tableau.c = {(4.0 - r6) / 10.0, (4.0 + r6) / 10.0, 1.0};
    tableau.a.resize(3, 3);
    tableau.a << (88.0 - 7.0 * r6) / 360.0, (296.0 - 169.0 * r6) / 1800.0,
        (-2.0 + 3.0 * r6) / 225.0, (296.0 + 169.0 * r6) / 1800.0, (88.0 + 7.0 * r6) / 360.0,
        (-2.0 - 3.0 * r6) / 225.0, (16.0 - r6) / 36.0, (16.0 + r6) / 36.0, 1.0 / 9.0;
    tableau.b = tableau.a.row(2);
  } else {
    tableau.c = {0.5 - r15 / 10.0, 0.5, 0.5 + r15 / 10.0};
    tableau.a.resize(3, 3);
    tableau.a << 5.0 / 36.0, 2.0 / 9.0 - r15 / 15.0, 5.0 / 36.0 - r15 / 30.0,
        5.0 / 36.0 + r15 / 24.0, 2.0 / 9.0, 5.0 / 36.0 - r15 / 24.0, 5.0 / 36.0 + r15 / 30.0,
        2.0 / 9.0 + r15 / 15.0, 5.0 / 36.0;
    tableau.b = Eigen::Vector3d(5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0);
  }
  return tableau;
}

/// z' = A(t) z over one step by the tableau.
template <class Matrix>
Eigen::MatrixXd runge_kutta_step(const Tableau& tableau, const Matrix& A, double t, double dt,
                                 const Eigen::MatrixXd& start) {
  const Eigen::Index n = start.rows();
  const auto s = static_cast<Eigen::Index>(tableau.c.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Identity(s * n, s * n);
  Eigen::MatrixXd right(s * n, start.cols());
  for (Eigen::Index i = 0; i < s; ++i) {
    const Eigen::MatrixXd here = A(t + tableau.c[static_cast<std::size_t>(i)] * dt);
    right.middleRows(i * n, n) = here * start;
    for (Eigen::Index j = 0; j < s; ++j)
      system.block(i * n, j * n, n, n) -= dt * tableau.a(i, j) * here;
  }
  const Eigen::MatrixXd slopes = system.lu().solve(right);
  Eigen::MatrixXd end = start;
  for (Eigen::Index i = 0; i < s; ++i) end += dt * tableau.b(i) * slopes.middleRows(i * n, n);
  return end;
}

constexpr std::array<int, 4> orders{2, 4, 5, 6};

/// (eta, eta_dot, xi) after a span, from the columns of the identity.
Eigen::MatrixXd map_over(const system::PeriodicSystem& system, int order, int steps, double span) {
  const PeriodicSolution solution = rest(system);
  const ConsistentSubspace subspace(system, solution);
  CollocationStep step(system, solution, subspace, order, span / steps);
  Eigen::MatrixXd z = subspace.basis(0.0);
  for (long k = 0; k < steps; ++k) step.advance(k, z);
  return step.state();
}

/// Errors against `exact` fall with the order of the rule, until round-off.
void require_slopes(const system::PeriodicSystem& system, const Eigen::MatrixXd& exact, double span,
                    int least_steps) {
  for (const int order : orders) {
    const int first = order == 2 ? 8 * least_steps : order == 4 ? 2 * least_steps : least_steps;
    std::vector<double> errors;
    for (const int steps : {first, 2 * first, 4 * first})
      errors.push_back((map_over(system, order, steps, span) - exact).norm() / exact.norm());
    BOOST_TEST_CONTEXT("order " << order << ": " << errors[0] << ", " << errors[1] << ", "
                                << errors[2]) {
      BOOST_TEST(errors[2] < 1e-2);
      BOOST_TEST(errors[2] > 1e-13);  // above round-off
      BOOST_TEST(std::log2(errors[1] / errors[2]) > order - 0.25);
      BOOST_TEST(std::log2(errors[1] / errors[2]) < order + 0.4);
    }
  }
}

/// Columns of z' = A(t) z over `span` from the identity.
template <class Matrix>
Eigen::MatrixXd exact_map(const Matrix& A, Eigen::Index n, double span) {
  const auto rate = [&A](double t, const Eigen::MatrixXd& z) -> Eigen::MatrixXd {
    return A(t) * z;
  };
  return runge_kutta<Eigen::MatrixXd>(rate, Eigen::MatrixXd::Identity(n, n), 0.0, span, 20000);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_is_that_of_the_runge_kutta_methods) {
  const Mathieu system(2.5, 1.0);
  const PeriodicSolution solution = rest(system);
  const ConsistentSubspace subspace(system, solution);
  constexpr double dt = 0.3;
  const auto A = [&system](double t) { return Eigen::MatrixXd(system.explicit_form(t)); };
  for (const int order : orders) {
    CollocationStep step(system, solution, subspace, order, dt);
    for (const long k : {0L, 7L, 31L}) {
      Eigen::MatrixXd z = Eigen::MatrixXd::Random(2, 3);
      const Eigen::MatrixXd wanted =
          runge_kutta_step(tableau_of(order), A, static_cast<double>(k) * dt, dt, z);
      step.advance(k, z);
      BOOST_TEST((z - wanted).norm() < 1e-13 * wanted.norm());
    }
  }
}

BOOST_AUTO_TEST_CASE(samples_interpolate_start_stages_and_end) {
  const Mathieu system(2.5, 1.0);
  const PeriodicSolution solution = rest(system);
  const ConsistentSubspace subspace(system, solution);
  for (const int order : orders) {
    CollocationStep step(system, solution, subspace, order, 0.01);
    Eigen::MatrixXd z = Eigen::MatrixXd::Random(2, 3);
    const Eigen::MatrixXd start = z;
    step.advance(0, z);
    Eigen::MatrixXd values;
    step.sample(0.0, values);
    BOOST_TEST((values - start).norm() < 1e-14);
    step.sample(1.0, values);
    BOOST_TEST((values - z).norm() < 1e-14);
    step.sample(0.5, values);
    const Eigen::MatrixXd half = runge_kutta<Eigen::MatrixXd>(
        [&](double t, const Eigen::MatrixXd& x) -> Eigen::MatrixXd {
          return system.explicit_form(t) * x;
        },
        start, 0.0, 0.005, 10);
    BOOST_TEST((values - half).norm() < 1e-4 * start.norm());
  }
}

BOOST_AUTO_TEST_CASE(columns_do_not_see_each_other) {
  const GroundResonance system(3);
  const PeriodicSolution solution = rest(system);
  const ConsistentSubspace subspace(system, solution);
  for (const int order : orders) {
    CollocationStep together(system, solution, subspace, order, 0.01);
    CollocationStep alone(system, solution, subspace, order, 0.01);
    Eigen::MatrixXd z = Eigen::MatrixXd::Random(10, 4);
    Eigen::MatrixXd one = z.col(2);
    for (long k = 0; k < 5; ++k) {
      together.advance(k, z);
      alone.advance(k, one);
    }
    BOOST_TEST((z.col(2) - one).norm() < 1e-13);
  }
}

BOOST_AUTO_TEST_CASE(changing_rigid_constraint_and_its_rate_hold_at_the_end_of_every_step) {
  using Gear = ChangingGear;
  const Gear system;
  const PeriodicSolution solution = rest(system);
  const ConsistentSubspace subspace(system, solution);
  constexpr double dt = 0.02;
  for (const int order : orders) {
    CollocationStep step(system, solution, subspace, order, dt);
    Eigen::MatrixXd z = subspace.basis(0.0);
    for (long k = 0; k < 40; ++k) {
      step.advance(k, z);
      const double t = static_cast<double>(k + 1) * dt;
      for (Eigen::Index j = 0; j < z.cols(); ++j) {
        const double size = z.col(j).norm();
        BOOST_TEST(std::abs(z(1, j) - Gear::c(t) * z(0, j)) < 1e-13 * size);
        BOOST_TEST(std::abs(z(0, j) - Gear::f * z(4, j)) < 1e-13 * size);
        BOOST_TEST(std::abs(z(3, j) - Gear::c(t) * z(2, j) - Gear::c_rate(t) * z(0, j)) <
                   1e-11 * size);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_parasitic_velocity_vanishes_in_the_first_step) {
  // Velocities that obey no rate of the rigid gear; rows: w and u, their speeds.
  const ChangingGear system;
  const PeriodicSolution solution = rest(system);
  const ConsistentSubspace subspace(system, solution);
  for (const int order : orders) {
    CollocationStep step(system, solution, subspace, order, 0.02);
    Eigen::MatrixXd z = Eigen::MatrixXd::Zero(6, 1);
    // Mass-orthogonal to the admissible direction (1, c).
    z(2, 0) = ChangingGear::m2 * ChangingGear::c(0.0);
    z(3, 0) = -ChangingGear::m1;
    step.advance(0, z);
    const double c = ChangingGear::c(0.02);
    BOOST_TEST(std::abs(z(3, 0) - c * z(2, 0) - ChangingGear::c_rate(0.02) * z(0, 0)) < 1e-11);
    BOOST_TEST(z.middleRows(2, 2).norm() < 0.2);
  }
}

BOOST_AUTO_TEST_CASE(orders_with_periodic_coefficients) {
  const GroundResonance system(4);
  const auto A = [&system](double t) { return Eigen::MatrixXd(system.explicit_form(t)); };
  // (eta, eta_dot) are the positions and velocities in turn.
  const ConsistentSubspace subspace(system, rest(system));
  const Eigen::MatrixXd basis = subspace.basis(0.0);
  const Eigen::MatrixXd exact =
      basis.lu().solve(exact_map(A, system.size(), system.period()) * basis);
  require_slopes(system, exact, system.period(), 20);
}

BOOST_AUTO_TEST_CASE(orders_with_a_changing_rigid_constraint) {
  const ChangingGear system;
  const auto A = [](double t) { return ChangingGear::explicit_form(t); };
  const double span = 0.7 * system.period();
  // eta is F = w / f, divided by its scale.
  require_slopes(system, exact_map(A, 2, span), span, 10);
}

BOOST_AUTO_TEST_CASE(orders_with_one_first_order_state) {
  const PeriodicLag system;
  const double span = 2.0;
  const auto exact = [](double t) { return std::exp(-t + 2.0 * std::sin(t)); };
  require_slopes(system, Eigen::MatrixXd::Constant(1, 1, exact(span)), span, 2);
}

BOOST_AUTO_TEST_CASE(orders_with_states_in_constraint_rows) {
  // A joint that an actuator drives with a gain that changes in time: (u, u', x_1, x_2).
  const PeriodicJoint joint;
  const auto A = [&joint](double t) { return joint.explicit_form(t); };
  const double span = 0.6 * joint.period();
  require_slopes(joint, exact_map(A, 4, span), span, 10);
}

BOOST_AUTO_TEST_CASE(a_map_over_two_spans_is_the_product_of_their_maps) {
  // The state at the end of a step is all that the next steps depend on.
  const ChangingGear system;
  const PeriodicSolution solution = rest(system);
  const ConsistentSubspace subspace(system, solution);
  const double dt = system.period() / 12;
  for (const int order : orders) {
    CollocationStep step(system, solution, subspace, order, dt);
    Eigen::MatrixXd z = subspace.basis(0.0);
    for (long k = 0; k < 6; ++k) step.advance(k, z);
    const Eigen::MatrixXd first = step.state();
    for (long k = 6; k < 12; ++k) step.advance(k, z);
    const Eigen::MatrixXd both = step.state();
    z = subspace.basis(6.0 * dt);
    for (long k = 6; k < 12; ++k) step.advance(k, z);
    const Eigen::MatrixXd second = step.state();
    BOOST_TEST((second * first - both).norm() < 1e-11 * both.norm());
  }
}
