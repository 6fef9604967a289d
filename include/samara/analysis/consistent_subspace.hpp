// The states that a linearized system can have (docs/theory.md, section 5).
//
// Strain and joint constraints tie positions to each other and to the internal loads of elastic
// strains. Everything that moves is therefore a function of eta: the internal loads of the elastic
// strains, and the positions in no constraint. Their number is the number of degrees of freedom d;
// it is counted, not guessed from a rank.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

class ConsistentSubspace {
 public:
  /// The subspace of the linearization about `solution`.
  /// @throws InternalError where constraints and tied positions differ in number.
  ConsistentSubspace(const system::PeriodicSystem& system, const PeriodicSolution& solution);

  int degrees_of_freedom() const { return static_cast<int>(coordinates_.size()); }

  /// The unknowns that are eta.
  const std::vector<PetscInt>& coordinates() const { return coordinates_; }
  /// Entry i of eta is unknown coordinates()[i] divided by scale()[i].
  const std::vector<double>& scale() const { return scale_; }

  /// What constraint rows determine from eta: positions, and internal loads of beams held twice.
  const std::vector<PetscInt>& tied() const { return tied_; }
  const std::vector<PetscInt>& constraint_rows() const { return constraints_; }
  const std::vector<PetscInt>& kinematic_rows() const { return kinematic_; }
  /// What kinematic rows determine.
  const std::vector<PetscInt>& velocities() const { return velocities_; }

  /// eta of the columns of z, scaled: d x columns.
  Eigen::MatrixXd coordinates_of(const Eigen::MatrixXd& z) const;

  /// The consistent state next to each column of z at time t: eta, and below it the eta_dot that
  /// impulses of the reactions alone would leave of its velocities (2 d x columns; size x columns).
  /// Velocities that no rate of eta makes are orthogonal to the others in the metric of the kinetic
  /// energy and vanish. `rate_step` [s]: as for basis().
  /// @throws InternalError where velocities without inertia are left to the reactions
  Eigen::MatrixXd state_of(double t, const Eigen::MatrixXd& z, double rate_step) const;

  /// Unknowns whose values at a step's ends belong to the state: x, and internal loads in eta.
  const std::vector<bool>& carried() const { return carried_; }

  /// Basis of the consistent states at time t: n x 2 d, first eta = unit at eta_dot = 0, then
  /// eta_dot = unit at eta = 0. `rate_step` [s]: over which the change of the constraints in time
  /// is differenced.
  Eigen::MatrixXd basis(double t, double rate_step) const;

  /// The nonlinear state with the given eta and eta_dot: solves the constraint rows for the tied
  /// positions and the kinematic rows for the velocities, from `z` as a start, into `z`.
  /// @throws ConvergenceError
  void find_state(double t, const Eigen::VectorXd& eta, const Eigen::VectorXd& eta_dot,
                  Vec z) const;

 private:
  Eigen::MatrixXd positions(double t) const;
  std::vector<std::size_t> images_of(std::size_t coordinate) const;
  void tie_coordinates(const Eigen::SparseMatrix<double>& K);

  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  std::vector<PetscInt> coordinates_;
  std::vector<double> scale_;  ///< eta = z / scale
  std::vector<bool> carried_;
  std::vector<PetscInt> constraints_;  ///< rows
  std::vector<PetscInt> tied_;         ///< what constraint rows determine: positions
  std::vector<double> tied_scale_;     ///< of the last ones of these, which are internal loads
  std::vector<PetscInt> kinematic_;    ///< rows
  std::vector<PetscInt> velocities_;   ///< unknowns
  std::vector<PetscInt> balance_;      ///< rows
  std::vector<PetscInt> reactions_;    ///< internal loads that no constraint row contains
  bool fixed_constraints_ = false;
};

}  // namespace samara::analysis
