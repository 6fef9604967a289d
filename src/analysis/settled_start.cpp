#include "settled_start.hpp"

#include <utility>
#include <vector>

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

struct Point {
  Eigen::VectorXd z;
  Eigen::VectorXd loads;  ///< that hold coordinates
  Eigen::VectorXd residual;
};

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

  /// The point after the medium has settled around the motion of z.
  Point settle(const Eigen::VectorXd& z, Eigen::VectorXd loads) {
    put(z);
    system_.settle(0.0, z_.get());
    Point point{values(z_.get()), std::move(loads), {}};
    system_.residual(0.0, z_.get(), rest_.get(), r_.get());
    point.residual = values(r_.get());
    for (std::size_t n = 0; n < held_.size(); ++n)
      point.residual(held_[n].row) += point.loads(static_cast<Eigen::Index>(n));
    return point;
  }

  /// The first point, with coordinates and loads that hold them at zero.
  Point begin(Eigen::VectorXd z) {
    for (const system::UnconstrainedCoordinate& coordinate : held_) z(coordinate.unknown) = 0.0;
    return settle(z, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(held_.size())));
  }

  /// Change of z and of the loads that hold coordinates, which take their places in z.
  Eigen::VectorXd step(const Point& point) {
    put(point.z);
    system_.tangents(0.0, z_.get(), rest_.get(), 0.0, jacobian_.get(), nullptr);
    hold_coordinates(jacobian_.get(), held_);
    solver_.factor(jacobian_.get());
    Eigen::MatrixXd change = -point.residual;
    solver_.solve(change);
    return change.col(0);
  }

  /// Norm of the residual, scaled like the rows of the first tangent.
  double norm(const Point& point) const {
    return point.residual.cwiseProduct(values(solver_.scaling().rows.get())).norm();
  }

  /// The point after the largest part of a step that reduces the norm; none where no part does.
  std::optional<Point> advance(const Point& point, const Eigen::VectorXd& change) {
    for (double part = 1.0; part >= least_part; part *= 0.5) {
      Eigen::VectorXd z = point.z + part * change;
      Eigen::VectorXd loads = point.loads;
      for (std::size_t n = 0; n < held_.size(); ++n) {
        loads(static_cast<Eigen::Index>(n)) += part * change(held_[n].unknown);
        z(held_[n].unknown) = 0.0;
      }
      try {
        Point next = settle(z, std::move(loads));
        if (norm(next) < norm(point)) return next;
      } catch (const DomainError&) {  // a shorter step may stay inside
      }
    }
    return std::nullopt;
  }

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
  try {
    Point point = equilibrium.begin(std::move(start));
    double first = 0.0;
    for (int n = 0; n < most_steps; ++n) {
      const Eigen::VectorXd change = equilibrium.step(point);
      const double size = equilibrium.norm(point);
      if (n == 0) first = size;
      if (size <= reduction * first) return PeriodicSolution(point.z, 0.0);
      std::optional<Point> next = equilibrium.advance(point, change);
      if (!next) return std::nullopt;
      point = std::move(*next);
    }
  } catch (const ConvergenceError&) {
  } catch (const DomainError&) {
  }
  return std::nullopt;
}

}  // namespace samara::analysis
