#include "samara/elements/air_station.hpp"

#include <Eigen/LU>

#include "samara/math/autodiff.hpp"

namespace samara::elements {
namespace {

using Pair = math::Dual<2>;

/// A = D + d b^T + c d^T + c b^T/2 with D, b, c, d of the paper; n counts from 1.
FiniteStates make_finite_states() {
  constexpr int N = FiniteStates::count;
  using Matrix = Eigen::Matrix<double, N, N>;
  const auto factorial = [](int n) { return std::tgamma(n + 1.0); };
  Matrix D = Matrix::Zero();
  FiniteStates::Vector b;
  FiniteStates::Vector c;
  const FiniteStates::Vector d = 0.5 * FiniteStates::Vector::Unit(0);
  for (int n = 1; n <= N; ++n) {
    const double sign = n % 2 == 1 ? 1.0 : -1.0;
    b(n - 1) =
        n == N ? sign
               : sign * factorial(N + n - 1) / (factorial(N - n - 1) * factorial(n) * factorial(n));
    c(n - 1) = 2.0 / n;
    if (n == N) continue;
    D(n, n - 1) = 1.0 / (2.0 * (n + 1));
    D(n - 1, n) = -1.0 / (2.0 * n);
  }
  const Matrix A = D + d * b.transpose() + c * d.transpose() + 0.5 * c * b.transpose();
  FiniteStates states;
  states.inverse = A.inverse();
  states.feed = states.inverse * c;
  states.weights = 0.5 * b;
  return states;
}

/// The rows of the balance of momentum and their derivatives by Q.
Eigen::Vector2d balance(const AirRotor& rotor, const AirStation& station,
                        const StationMotion<double>& motion, const Eigen::Vector2d& Q,
                        Eigen::Matrix2d& slopes) {
  const Eigen::Matrix<Pair, 2, 1> rows =
      steady_momentum_rows<Pair>(rotor, station, constant_motion<Pair>(motion),
                                 math::independent<2>(Q(0), 0), math::independent<2>(Q(1), 1));
  for (int i = 0; i < 2; ++i) slopes.row(i) = rows(i).derivatives().transpose();
  return {rows(0).value(), rows(1).value()};
}

}  // namespace

const FiniteStates& finite_states() {
  static const FiniteStates states = make_finite_states();
  return states;
}

Eigen::Vector2d steady_induction(const AirRotor& rotor, const AirStation& station,
                                 const StationMotion<double>& motion) {
  constexpr int most_steps = 50;
  constexpr double enough = 1e-13;
  if (rotor.models.induction == Induction::none) return Eigen::Vector2d::Zero();
  Eigen::Vector2d Q(-0.25 * motion.wind_axial, -0.01 * motion.hub_speed * motion.radius);
  if (rotor.models.induction == Induction::axial) Q(1) = 0.0;
  Eigen::Matrix2d slopes;
  Eigen::Vector2d rows = balance(rotor, station, motion, Q, slopes);
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::Vector2d change = slopes.partialPivLu().solve(-rows);
    if (!change.allFinite()) break;
    double factor = 1.0;
    Eigen::Matrix2d next_slopes;
    Eigen::Vector2d next = balance(rotor, station, motion, Q + change, next_slopes);
    while (!(next.norm() < rows.norm()) && factor > 1e-4) {
      factor *= 0.5;
      next = balance(rotor, station, motion, Q + factor * change, next_slopes);
    }
    if (!(next.norm() < rows.norm())) break;
    Q += factor * change;
    rows = next;
    slopes = next_slopes;
    if (factor == 1.0 && change.norm() < enough * (Q.norm() + 1.0)) break;
  }
  return Q;
}

Eigen::Matrix<double, air::unknowns, 1> steady_air(const AirRotor& rotor, const AirStation& station,
                                                   const StationMotion<double>& motion) {
  using Rows = Eigen::Matrix<double, air::unknowns, 1>;
  const Eigen::Matrix<double, 10, 1> no_rates = Eigen::Matrix<double, 10, 1>::Zero();
  const AirModels& models = rotor.models;
  Rows z = Rows::Zero();
  const Eigen::Vector2d Q = steady_induction(rotor, station, motion);
  z.segment<2>(air::induced) = z.segment<2>(air::quasi_steady) = Q;
  if (models.inflow == Inflow::oye) z.segment<2>(air::reduced) = (1.0 - direct_share) * Q;
  // Each lag depends on those before it: four passes settle all.
  if (station.has_dynamics(models) && models.dynamics == AirfoilDynamics::peters) {
    // lambda = 0 in steady air.
    const SectionFlow<double> flow = station_air<double>(rotor, station, motion, z, no_rates).flow;
    const FiniteStates::Vector mu =
        -finite_states().feed * air::three_quarter_velocity(station, flow);
    z.segment<4>(air::wake) = mu.head<4>();
    z.segment<2>(air::reduced) = mu.tail<2>();
  } else if (station.has_dynamics(models)) {
    const auto& [A1, A2, b1, b2] = models.wake;
    for (int pass = 0; pass < 4; ++pass) {
      const Rows rows = air_station_rows<double>(rotor, station, motion, z, no_rates);
      z(air::wake) -= rows(air::wake) / b1;
      z(air::wake + 1) -= rows(air::wake + 1) / b2;
      z(air::lift) -= rows(air::lift);
      z(air::separation) -= rows(air::separation);
    }
  }
  const Rows rows = air_station_rows<double>(rotor, station, motion, z, no_rates);
  z.tail<6>() -= rows.tail<6>();
  return z;
}

}  // namespace samara::elements
