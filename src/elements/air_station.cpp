#include "samara/elements/air_station.hpp"

#include <Eigen/LU>

#include "samara/math/autodiff.hpp"

namespace samara::elements {
namespace {

using Pair = math::Dual<2>;

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
  if (station.has_dynamics(models)) {
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
