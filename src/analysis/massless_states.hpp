// Reduced states in which no inertia, or no inertia and no damper, has a part (docs/theory.md,
// section 5.2).
#pragma once

#include <string>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/linear_algebra.hpp"

#include "energy_coordinates.hpp"

namespace samara::analysis {

/// Directions of eta without inertia: the bending of an elastic blade behind a hinge that all Gauss
/// points are the nodes of. Such a coordinate follows from the motion of the others. Its rate has
/// no part in M z_dot + K z = 0; nor has its value before, unless a damper has a part in it. These
/// states therefore have no exponents. A step of Gauss collocation maps them onto themselves, with
/// multipliers of plus or minus 1.
class MasslessStates {
 public:
  MasslessStates() = default;
  /// `K`, `M`: tangents; `basis`: states for a unit of each entry of (eta, eta_dot, xi).
  MasslessStates(const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& M,
                 const Eigen::MatrixXd& basis, const EnergyCoordinates& coordinates);

  /// Number of states.
  int count() const { return count_; }
  /// Number of directions.
  int directions() const { return directions_; }

  /// Eigenpairs, without those of these states, of a map of states in energy coordinates that maps
  /// them onto themselves. The vectors have no part in them. `conditions`: of the eigenvalues.
  Eigenpairs eigenpairs_of(const Eigen::MatrixXd& map, const std::string& prefix,
                           Eigen::VectorXd* conditions = nullptr) const;
  /// The map of the other states.
  Eigen::MatrixXd without(const Eigen::MatrixXd& map) const;

 private:
  int count_ = 0;
  int directions_ = 0;
  Eigen::MatrixXd others_;  ///< orthonormal basis of what is left, in energy coordinates
};

}  // namespace samara::analysis
