#include "admissible_velocities.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "samara/base/error.hpp"

namespace samara::analysis {
namespace {

/// Step of the central difference quotient for constraints that change with time, relative to a
/// time step.
constexpr double difference_fraction = 0.01;

/// First value of tau relative to a time step, and its least value.
constexpr double first_tau = 1e-3;
constexpr double least_tau = 1e-7;
constexpr double tau_reduction = 0.1;
/// A fixed-point iteration that contracts less than this has too large a tau.
constexpr double slowest_contraction = 0.5;
constexpr int most_iterations = 20;
/// Residual of the scaled equations, relative to their right-hand sides and solution.
constexpr double iteration_tolerance = 1e-12;
/// The same where round-off of the right-hand side ends the contraction.
constexpr double largest_noise = 1e-10;

using system::RowRole;

}  // namespace

AdmissibleVelocities::AdmissibleVelocities(const system::PeriodicSystem& system, double dt)
    : system_(system),
      dt_(dt),
      rates_(system.make_state()),
      r_(system.make_state()),
      jump_(system.make_state()),
      equations_(system, "transient_impulse_") {
  petsc::check(VecSet(rates_.get(), 0.0));
}

Jumps AdmissibleVelocities::correct(double t, Vec z, const Eigen::VectorXd& jump) {
  const auto n = static_cast<Eigen::Index>(system_.size());
  Jumps right = Jumps::Zero(n, 2);
  const auto take = [&](Vec from, Eigen::Index into, RowRole role, double factor) {
    const petsc::ReadView view(from);
    for (Eigen::Index i = 0; i < n; ++i)
      if (system_.rows()[static_cast<std::size_t>(i)] == role)
        right(i, into) += factor * view[static_cast<PetscInt>(i)];
  };
  system_.residual(t, z, rates_.get(), r_.get());
  take(r_.get(), 0, RowRole::kinematic, -1.0);
  take(r_.get(), 0, RowRole::evolution, -1.0);
  const double interval = difference_fraction * dt_;
  if (!system_.constraints_are_autonomous())
    for (const double side : {-1.0, 1.0}) {
      system_.residual(t + side * interval, z, rates_.get(), r_.get());
      take(r_.get(), 0, RowRole::constraint, -side / (2.0 * interval));
    }
  {
    const petsc::WriteView view(jump_.get());
    Eigen::Map<Eigen::VectorXd>(view.data(), n) = jump;
  }
  equations_.evaluate(t, z, rates_.get());
  petsc::check(MatMult(equations_.stiffness(), jump_.get(), r_.get()));
  take(r_.get(), 1, RowRole::kinematic, -1.0);
  // A value that depended on the steps before would make a restarted run another one.
  for (double tau = first_tau * dt_; tau >= least_tau * dt_; tau *= tau_reduction) {
    try {
      equations_.factor(tau);
    } catch (const SingularError&) {
      throw ConvergenceError(
          "transient: the midpoint rule needs inertia or stiffness in every motion, and one has "
          "neither; hint: transient.method: bdf2");
    }
    Jumps jumps = right;
    if (solve(jumps)) return jumps;
    equations_.evaluate(t, z, rates_.get());
  }
  throw ConvergenceError(
      "transient: the velocities after a step of the midpoint rule are not found; hint: "
      "transient.method: bdf2");
}

/// A + B is factored, B the added terms. Fixed-point iteration for A x = b, from the solution with
/// B: x_k+1 = (A + B)^-1 (b + B x_k), whose residual is B (x_k - x_k+1). It contracts motions of
/// frequency w by (tau w)^2, and leaves motions without inertia as they are in the first solution.
/// (Round-off moves these by the same amount each time: the residual shows the end, the velocities
/// do not.)
/// @returns false where it does not contract
bool AdmissibleVelocities::solve(Jumps& jumps) {
  const Jumps right = jumps;
  equations_.solve(jumps);
  const petsc::ReadView rows(equations_.scaling().rows.get());
  const petsc::ReadView columns(equations_.scaling().columns.get());
  const Eigen::Map<const Eigen::ArrayXd> row_factors(rows.data(), right.rows());
  const Eigen::Map<const Eigen::ArrayXd> column_factors(columns.data(), right.rows());
  const auto largest = [](const auto& array) { return array.abs().maxCoeff(); };
  const double size = largest(right.array().colwise() * row_factors) +
                      largest(jumps.array().colwise() / column_factors);
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Jumps next = right + equations_.added() * jumps;
    equations_.solve(next);
    const double residual =
        largest((equations_.added() * (next - jumps)).eval().array().colwise() * row_factors);
    jumps.swap(next);
    if (residual <= iteration_tolerance * size) return true;
    if (!(residual <= slowest_contraction * last))
      return iteration > 0 && residual <= largest_noise * size;
    last = residual;
  }
  return false;
}

}  // namespace samara::analysis
