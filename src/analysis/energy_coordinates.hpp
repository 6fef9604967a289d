// Coordinates of reduced states in which the energy is half a sum of squares (docs/theory.md,
// section 5.2).
#pragma once

#include <Eigen/Core>

#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Reduced states (eta, eta_dot, xi), with eta and eta_dot in coordinates whose sum of squares is
/// twice the energy. A displacement also has the kinetic energy of its motion at `rate`, so that
/// those that nothing restores count. A map that conserves energy is orthogonal in these
/// coordinates: each of its eigenvalues is as accurate as round-off allows, even if some strains
/// are very stiff. First-order states have no energy: xi is not changed.
class EnergyCoordinates {
 public:
  EnergyCoordinates() = default;
  /// `basis`: states for a unit of each of d entries of eta, of d entries of eta_dot, and of the
  /// entries of xi; `rate` [rad/s].
  EnergyCoordinates(const system::PeriodicSystem& system, const Eigen::MatrixXd& basis,
                    Eigen::Index d, double rate);

  /// Directions of eta that have no kinetic energy, beyond round-off: d x their number. Their rates
  /// count as if they had some.
  const Eigen::MatrixXd& without_inertia() const { return without_inertia_; }

  /// Converts columns per unit of (eta, eta_dot, xi), in place, to columns per unit of these
  /// coordinates.
  void divide(Eigen::MatrixXd& columns) const;
  /// Energy coordinates of states (eta, eta_dot, xi), 2 d + n_1 x columns.
  Eigen::MatrixXd of(const Eigen::MatrixXd& states) const;
  /// The inverse of of().
  Eigen::MatrixXd states_of(const Eigen::MatrixXd& coordinates) const;

 private:
  Eigen::MatrixXd eta_, rate_;  ///< upper triangles
  Eigen::MatrixXd without_inertia_;
};

}  // namespace samara::analysis
