#include "settled_start.hpp"

#include <algorithm>
#include <cmath>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"

#include "held_columns.hpp"

namespace samara::analysis {
namespace {

constexpr int most_steps = 100;
/// Shortest part of a Newton step.
constexpr double least_part = 1.0 / 1024.0;
/// Reduction of the residual that suffices for a start.
constexpr double reduction = 1e-8;

class SettledEquilibrium {
 public:
  explicit SettledEquilibrium(const system::PeriodicSystem& system)
      : system_(system),
        held_(system.unconstrained_coordinates()),
        z_(system.make_state()),
        rest_(system.make_state()),
        r_(system.make_state()),
        jacobian_(system.make_jacobian()),
        solver_("trim_settled_", equilibrate) {}

  /// Sets z and settles the medium. `loads`: those that hold coordinates.
  Eigen::VectorXd residual(Eigen::VectorXd& z, const Eigen::VectorXd& loads) {
    put(z);
    system_.settle(0.0, z_.get());
    z = values(z_.get());
    system_.residual(0.0, z_.get(), rest_.get(), r_.get());
    Eigen::VectorXd r = values(r_.get());
    for (std::size_t n = 0; n < held_.size(); ++n)
      r(held_[n].row) += loads(static_cast<Eigen::Index>(n));
    return r;
  }

  /// Change of z and of the loads that hold coordinates, which take their places in z.
  Eigen::VectorXd step(const Eigen::VectorXd& z, const Eigen::VectorXd& r) {
    put(z);
    system_.tangents(0.0, z_.get(), rest_.get(), 0.0, jacobian_.get(), nullptr);
    hold_coordinates(jacobian_.get(), held_);
    solver_.factor(jacobian_.get());
    Eigen::MatrixXd change = -r;
    solver_.solve(change);
    return change.col(0);
  }

  /// Norm of a residual, scaled like the rows of the first tangent.
  double norm(const Eigen::VectorXd& r) const {
    return r.cwiseProduct(values(solver_.scaling().rows.get())).norm();
  }

  const std::vector<system::UnconstrainedCoordinate>& held() const { return held_; }

 private:
  Eigen::VectorXd values(Vec vector) const {
    const petsc::ReadView view(vector);
    return Eigen::Map<const Eigen::VectorXd>(view.data(), system_.size());
  }
  void put(const Eigen::VectorXd& z) {
    const petsc::WriteView view(z_.get());
    Eigen::Map<Eigen::VectorXd>(view.data(), system_.size()) = z;
  }

  const system::PeriodicSystem& system_;
  std::vector<system::UnconstrainedCoordinate> held_;
  petsc::Handle<Vec> z_;
  petsc::Handle<Vec> rest_;
  petsc::Handle<Vec> r_;
  petsc::Handle<Mat> jacobian_;
  DirectSolver solver_;
};

}  // namespace

std::optional<PeriodicSolution> find_settled_start(const system::PeriodicSystem& system,
                                                   Eigen::VectorXd start) {
  SettledEquilibrium equilibrium(system);
  const auto& held = equilibrium.held();
  Eigen::VectorXd loads = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(held.size()));
  Eigen::VectorXd z = std::move(start);
  for (const system::UnconstrainedCoordinate& coordinate : held) z(coordinate.unknown) = 0.0;
  try {
    Eigen::VectorXd r = equilibrium.residual(z, loads);
    double first = -1.0;
    for (int n = 0; n < most_steps; ++n) {
      const Eigen::VectorXd change = equilibrium.step(z, r);
      const double before = equilibrium.norm(r);
      if (first < 0.0) first = before;
      if (before <= reduction * first) return PeriodicSolution(z, 0.0);
      double part = 1.0;
      for (;; part *= 0.5) {
        if (part < least_part) return std::nullopt;
        Eigen::VectorXd next = z + part * change;
        Eigen::VectorXd next_loads = loads;
        for (std::size_t k = 0; k < held.size(); ++k) {
          next_loads(static_cast<Eigen::Index>(k)) += part * change(held[k].unknown);
          next(held[k].unknown) = 0.0;
        }
        try {
          Eigen::VectorXd next_r = equilibrium.residual(next, next_loads);
          if (!(equilibrium.norm(next_r) < before)) continue;
          z = std::move(next);
          loads = std::move(next_loads);
          r = std::move(next_r);
          break;
        } catch (const DomainError&) {
          continue;
        }
      }
    }
  } catch (const ConvergenceError&) {
  } catch (const DomainError&) {
  }
  return std::nullopt;
}

}  // namespace samara::analysis
