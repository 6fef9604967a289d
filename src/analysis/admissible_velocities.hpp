// Velocities that rates of consistent positions produce, and impulses of the reactions that lead to
// them (docs/theory.md, section 9.1).
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Jumps of the velocities with the impulses that cause them: n x columns, with velocities in the
/// rows of velocities and impulses in the rows of reactions. Other rows have no meaning.
using Jumps = Eigen::MatrixXd;

class AdmissibleVelocities {
 public:
  /// `dt` [s]: length of the steps; a fraction of it is the step of the difference quotient for
  /// changes of the constraints.
  AdmissibleVelocities(const system::PeriodicSystem& system, double dt);

  /// False where every velocity is admissible.
  bool is_restricted() const { return is_restricted_; }

  /// True for an internal load that no elastic strain determines.
  bool is_reaction(Eigen::Index unknown) const {
    return columns_[static_cast<std::size_t>(unknown)] == Column::reaction;
  }

  /// Two jumps at time t in the state z, whose positions are consistent: the first makes the
  /// velocities of z admissible, the second makes `jump`, a change of velocities, admissible.
  /// The velocity of a motion without inertia, which no impulse determines, is the one at which the
  /// elastic loads that act on it do not change.
  /// @throws ConvergenceError where a motion has neither inertia nor stiffness
  Jumps correct(double t, Vec z, const Eigen::VectorXd& jump);

 private:
  enum class Column { none, position, velocity, elastic, reaction, state, auxiliary };
  /// The columns of K and of M that a row keeps.
  struct Kept {
    Column of_K = Column::none;
    Column of_M = Column::none;
  };
  static Kept kept_by(system::RowRole row);

  void classify(double t, Vec z);
  void build();
  bool solve(Jumps& jumps);

  const system::PeriodicSystem& system_;
  double dt_;
  double tau_ = 0.0;  ///< [s], of (9.1b)
  bool is_restricted_ = false;
  std::vector<Column> columns_;
  petsc::Handle<Vec> rates_;  ///< zero
  petsc::Handle<Vec> r_;
  petsc::Handle<Vec> jump_;
  petsc::Handle<Mat> matrix_;
  petsc::Handle<Mat> mass_;
  Eigen::SparseMatrix<double> added_;  ///< tau^2 K_e
  DirectSolver solver_;
};

}  // namespace samara::analysis
