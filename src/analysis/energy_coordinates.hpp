// Coordinates of reduced states in which energy is half a sum of squares (docs/theory.md, section
// 5.2).
#pragma once

#include <Eigen/Core>

#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// (eta, eta_dot, xi), the first two in coordinates whose sum of squares is twice the energy; a
/// motion with `rate` counts where nothing is restored. A map that keeps energy is orthogonal in
/// them, so that each of its eigenvalues is as accurate as round-off allows, however stiff some
/// strains are. First-order states have no energy: xi stays as it is.
class EnergyCoordinates {
 public:
  EnergyCoordinates() = default;
  /// `basis`: states of a unit of each of d entries of eta, d of eta_dot, and of xi; `rate`
  /// [rad/s].
  EnergyCoordinates(const system::PeriodicSystem& system, const Eigen::MatrixXd& basis,
                    Eigen::Index d, double rate);

  /// From columns per unit of (eta, eta_dot, xi), in place, to columns per unit of these.
  void divide(Eigen::MatrixXd& columns) const;
  /// Energy coordinates of states (eta, eta_dot, xi), 2 d + n_1 x columns.
  Eigen::MatrixXd of(const Eigen::MatrixXd& states) const;
  /// Energy coordinates of eta_dot only, d x columns.
  Eigen::MatrixXd rates(const Eigen::MatrixXd& eta_dot) const {
    return rate_.triangularView<Eigen::Upper>() * eta_dot;
  }

 private:
  Eigen::MatrixXd eta_, rate_;  ///< upper triangles
};

}  // namespace samara::analysis
