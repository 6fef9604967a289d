// Velocities that rates of consistent positions produce, and impulses of the reactions that lead to
// them (docs/theory.md, section 9.1).
#pragma once

#include <Eigen/Core>

#include "samara/analysis/impulse_equations.hpp"
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
  bool is_restricted() const { return equations_.is_restricted(); }

  /// True for an internal load that no elastic strain determines.
  bool is_reaction(Eigen::Index unknown) const { return equations_.is_reaction(unknown); }

  /// Two jumps at time t in the state z, whose positions are consistent: the first makes the
  /// velocities of z admissible, the second makes `jump`, a change of velocities, admissible.
  /// The velocity of a motion without inertia, which no impulse determines, is the one at which the
  /// elastic loads that act on it do not change.
  /// @throws ConvergenceError where a motion has neither inertia nor stiffness
  Jumps correct(double t, Vec z, const Eigen::VectorXd& jump);

 private:
  bool solve(Jumps& jumps);

  const system::PeriodicSystem& system_;
  double dt_;
  petsc::Handle<Vec> rates_;  ///< zero
  petsc::Handle<Vec> r_;
  petsc::Handle<Vec> jump_;
  ImpulseEquations equations_;
};

}  // namespace samara::analysis
