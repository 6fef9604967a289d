#include "samara/analysis/shooting.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>

#include <Eigen/LU>

#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/harmonic_balance.hpp"
#include "samara/analysis/linearized_step.hpp"
#include "samara/base/error.hpp"
#include "samara/base/format.hpp"

namespace samara::analysis {
namespace {

constexpr int most_revolutions = 40;
constexpr int most_step_iterations = 20;
constexpr double step_tolerance = 1e-12;
/// Largest part of the defect that a solved correction may leave.
constexpr double unsolved = 1e-6;
/// Largest number of harmonics of the series; higher harmonics are far below the error by the step.
constexpr int most_harmonics = 24;

Eigen::VectorXd values_of(Vec z) {
  PetscInt n = 0;
  petsc::check(VecGetSize(z, &n));
  const petsc::ReadView view(z);
  return Eigen::Map<const Eigen::VectorXd>(view.data(), n);
}

void put(const Eigen::VectorXd& values, Vec z) {
  const petsc::WriteView view(z);
  Eigen::Map<Eigen::VectorXd>(view.data(), values.size()) = values;
}

class Shooting {
 public:
  Shooting(const system::PeriodicSystem& system, int steps, double tolerance, Observer& observer)
      : system_(system),
        steps_(steps),
        tolerance_(tolerance),
        dt_(system.period() / steps),
        speed_(2.0 * std::numbers::pi / system.period()),
        observer_(observer),
        z_(system.make_state()),
        z_dot_(system.make_state()),
        z_end_(system.make_state()),
        z_dot_end_(system.make_state()),
        r_(system.make_state()),
        r_end_(system.make_state()),
        loads_(Eigen::VectorXd::Zero(
            static_cast<Eigen::Index>(system.unconstrained_coordinates().size()))) {}

  Trim run() {
    system_.reference_state(0.0, z_.get());
    start_ = values_of(z_.get());
    const ConsistentSubspace& space = subspace();
    eta_ = space.coordinates_of(start_);
    eta_rate_ = Eigen::VectorXd::Zero(eta_.size());
    xi_ = space.states_of(start_);
    for (int revolution = 1; revolution <= most_revolutions; ++revolution) {
      put(start_, z_.get());
      Eigen::VectorXd reduced(2 * eta_.size() + xi_.size());
      reduced << eta_, eta_rate_ * speed_, xi_;
      subspace().find_state(0.0, reduced, z_.get());
      start_ = values_of(z_.get());
      const double change = revolve_and_correct();
      std::ostringstream text;
      text << "trim: shooting, revolution " << revolution << ", correction " << change;
      observer_.note(text.str());
      if (change < tolerance_ * std::max({1.0, eta_.norm(), xi_.norm()})) return result(revolution);
    }
    throw ConvergenceError("trim: shooting does not converge in " +
                           std::to_string(most_revolutions) +
                           " revolutions; hint: trim.method: harmonic_balance, or more trim.steps");
  }

 private:
  /// The subspace about the present start. The Jacobian leaves out the change of the steady state:
  /// the iteration becomes a little slower, its result does not change.
  ConsistentSubspace& subspace() {
    solution_ = std::make_unique<PeriodicSolution>(start_, system_.period());
    subspace_ = std::make_unique<ConsistentSubspace>(system_, *solution_);
    return *subspace_;
  }

  /// One revolution from start_; corrects eta_, eta_rate_, xi_ and the loads; returns the
  /// correction.
  double revolve_and_correct() {
    ConsistentSubspace& space = subspace();
    const Eigen::Index d = space.degrees_of_freedom();
    const Eigen::Index n_1 = space.first_order();
    const Eigen::Index reduced = space.size();
    const auto& unconstrained = system_.unconstrained_coordinates();
    const auto held = static_cast<Eigen::Index>(unconstrained.size());
    const Eigen::Index n = system_.size();
    LinearizedStep linearized(system_, space.carried(), dt_, false, "shooting_");
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, reduced + held);
    columns.leftCols(reduced) = space.basis(0.0);
    columns.middleCols(d, d) *= speed_;
    Eigen::MatrixXd forcing = Eigen::MatrixXd::Zero(n, reduced + held);
    for (Eigen::Index h = 0; h < held; ++h)
      forcing(unconstrained[static_cast<std::size_t>(h)].row, reduced + h) = -1.0;

    Eigen::VectorXd z = start_;
    Eigen::VectorXd middle = start_;
    ends_.resize(n, steps_);
    middles_.resize(n, steps_);
    Eigen::MatrixXd eta_columns[2];
    Eigen::VectorXd eta_states[2];
    eta_columns[0] = space.coordinates_of(columns);
    eta_states[0] = space.coordinates_of(z);
    const Eigen::MatrixXd xi_columns = space.states_of(columns);
    const Eigen::VectorXd xi_start = space.states_of(z);
    Eigen::VectorXd means = Eigen::VectorXd::Zero(held);
    Eigen::MatrixXd mean_columns = Eigen::MatrixXd::Zero(held, reduced + held);
    Eigen::MatrixXd last_columns;
    Eigen::MatrixXd last_xi_columns;
    Eigen::VectorXd last_state;
    Eigen::VectorXd last_xi;
    for (int k = 0; k <= steps_; ++k) {
      if (k < steps_) ends_.col(k) = z;
      advance(k, z, middle, linearized);
      const Eigen::MatrixXd& middle_columns = linearized.advance(columns, forcing);
      if (k < steps_) {
        middles_.col(k) = middle;
        for (Eigen::Index h = 0; h < held; ++h) {
          const PetscInt unknown = unconstrained[static_cast<std::size_t>(h)].unknown;
          means(h) += middle(unknown) / steps_;
          mean_columns.row(h) += middle_columns.row(unknown) / steps_;
        }
      }
      if (k == 0) {
        eta_columns[1] = space.coordinates_of(columns);
        eta_states[1] = space.coordinates_of(z);
      }
      if (k == steps_ - 1) {
        last_columns = space.coordinates_of(columns);
        last_state = space.coordinates_of(z);
        last_xi_columns = space.states_of(columns);
        last_xi = space.states_of(z);
      }
      observer_.progress("shooting", k + 1, steps_ + 1);
    }
    // Conditions: eta repeats at two consecutive instants and xi at one, and the means of the
    // unconstrained coordinates are zero.
    const Eigen::MatrixXd rate_columns =
        (space.coordinates_of(columns) - last_columns - eta_columns[1] + eta_columns[0]) /
        (dt_ * speed_);
    const Eigen::VectorXd rate_state =
        (space.coordinates_of(z) - last_state - eta_states[1] + eta_states[0]) / (dt_ * speed_);
    Eigen::MatrixXd jacobian(reduced + held, reduced + held);
    Eigen::VectorXd defect(reduced + held);
    jacobian << last_columns - eta_columns[0], rate_columns, last_xi_columns - xi_columns,
        mean_columns;
    defect << last_state - eta_states[0], rate_state, last_xi - xi_start, means;
    const Eigen::VectorXd correction = jacobian.fullPivLu().solve(-defect);
    // A singular Jacobian admits a correction only where the defect lies in its range.
    const double left = (jacobian * correction + defect).norm();
    const double scale = std::max({1.0, eta_.norm(), xi_.norm()});
    if (!(left <= std::max(tolerance_ * scale, unsolved * defect.norm())))
      throw ConvergenceError(
          "trim: shooting: the matrix of the correction is singular, and no correction makes the "
          "revolution periodic (defect " +
          general(defect.norm(), 3) + ", after the best correction " + general(left, 3) +
          "); hint: check the balance of the torques and the limits of the actuators");
    eta_ += correction.head(d);
    eta_rate_ += correction.segment(d, d);
    xi_ += correction.segment(2 * d, n_1);
    loads_ += correction.tail(held);
    return correction.head(reduced).norm();
  }

  /// Newton's method for one step of the nonlinear equations: rows with rates at the middle, rows
  /// without rates at the end. Leaves `linearized` factored at the step.
  void advance(int k, Eigen::VectorXd& z, Eigen::VectorXd& middle, LinearizedStep& linearized) {
    const double t_middle = (k + 0.5) * dt_;
    const double t_end = (k + 1.0) * dt_;
    const std::vector<bool>& carried = subspace_->carried();
    for (Eigen::Index i = 0; i < z.size(); ++i)
      if (carried[static_cast<std::size_t>(i)]) middle(i) = z(i);
    put(Eigen::VectorXd::Zero(z.size()), z_dot_end_.get());
    for (int iteration = 0;; ++iteration) {
      Eigen::VectorXd rate = Eigen::VectorXd::Zero(z.size());
      Eigen::VectorXd end = middle;
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        if (!carried[static_cast<std::size_t>(i)]) continue;
        end(i) = 2.0 * middle(i) - z(i);
        rate(i) = 2.0 * (middle(i) - z(i)) / dt_;
      }
      put(middle, z_.get());
      put(rate, z_dot_.get());
      put(end, z_end_.get());
      system_.residual(t_middle, z_.get(), z_dot_.get(), r_.get());
      system_.residual(t_end, z_end_.get(), z_dot_end_.get(), r_end_.get());
      linearized.factor(t_middle, z_.get(), z_dot_.get(), t_end, z_end_.get(), z_dot_end_.get());
      Eigen::MatrixXd change = -values_of(r_.get());
      const Eigen::VectorXd at_end = values_of(r_end_.get());
      for (Eigen::Index i = 0; i < z.size(); ++i)
        if (system_.rows()[static_cast<std::size_t>(i)] == system::RowRole::constraint)
          change(i, 0) = -0.5 * at_end(i);
      const auto& unconstrained = system_.unconstrained_coordinates();
      for (std::size_t h = 0; h < unconstrained.size(); ++h)
        change(unconstrained[h].row, 0) -= loads_(static_cast<Eigen::Index>(h));
      linearized.solve(change);
      middle += change.col(0);
      double largest = 0.0;
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        const system::Unknown& unknown = system_.unknowns()[static_cast<std::size_t>(i)];
        if (unknown.is_coordinate())
          largest = std::max(largest, std::abs(change(i, 0)) / unknown.scale);
      }
      if (largest < step_tolerance) break;
      if (iteration == most_step_iterations)
        throw ConvergenceError("trim: shooting, step " + std::to_string(k) +
                               " does not converge; hint: more trim.steps");
    }
    linearized.to_end(z, middle);
  }

  Trim result(int revolutions) const {
    const int harmonics = shooting_harmonics(steps_);
    Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(system_.size(), 2 * harmonics + 1);
    const std::vector<bool>& carried = subspace_->carried();
    for (int k = 0; k < steps_; ++k) {
      Eigen::VectorXd at_start =
          2.0 / steps_ * PeriodicSolution::basis(harmonics, system_.period(), k * dt_);
      Eigen::VectorXd at_middle =
          2.0 / steps_ * PeriodicSolution::basis(harmonics, system_.period(), (k + 0.5) * dt_);
      at_start(0) *= 0.5;
      at_middle(0) *= 0.5;
      for (Eigen::Index i = 0; i < coefficients.rows(); ++i) {
        if (carried[static_cast<std::size_t>(i)])
          coefficients.row(i) += ends_(i, k) * at_start.transpose();
        else
          coefficients.row(i) += middles_(i, k) * at_middle.transpose();
      }
    }
    std::ostringstream words;
    words << "shooting: " << steps_ << " steps return to the initial state";
    Trim trim{PeriodicSolution(coefficients, system_.period()),
              TrimMethod::shooting,
              revolutions,
              words.str(),
              0.0,
              0.0,
              0.0,
              {},
              {}};
    for (Eigen::Index h = 0; h < loads_.size(); ++h) {
      const auto& unconstrained = system_.unconstrained_coordinates()[static_cast<std::size_t>(h)];
      trim.held.push_back(
          {unconstrained.name, unconstrained.unit, loads_(h), unconstrained.unknown});
    }
    finish_trim(system_, trim);
    return trim;
  }

  const system::PeriodicSystem& system_;
  int steps_;
  double tolerance_;
  double dt_;
  double speed_;
  Observer& observer_;
  petsc::Handle<Vec> z_, z_dot_, z_end_, z_dot_end_, r_, r_end_;
  Eigen::VectorXd loads_;           ///< that hold the unconstrained coordinates
  Eigen::VectorXd start_;           ///< z at t = 0
  Eigen::VectorXd eta_, eta_rate_;  ///< rate per radian of rotor azimuth
  Eigen::VectorXd xi_;
  Eigen::MatrixXd ends_, middles_;  ///< z at the steps' starts and middles
  std::unique_ptr<PeriodicSolution> solution_;
  std::unique_ptr<ConsistentSubspace> subspace_;
};

}  // namespace

int shooting_harmonics(int steps) { return std::min(most_harmonics, (steps - 1) / 3); }

Trim solve_shooting(const system::PeriodicSystem& system, int steps, double tolerance,
                    Observer& observer) {
  if (system.period() == 0.0)
    throw InputError("trim.method: shooting needs a rotor that turns; hint: harmonic_balance");
  return Shooting(system, steps, tolerance, observer).run();
}

}  // namespace samara::analysis
