// Equations for velocities that rates of consistent positions produce, and for the impulses of the
// reactions that lead to them (docs/theory.md, sections 5.2 and 9.1).
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// The unknowns, in the places of z: rates of positions, rates of elastic loads, velocities,
/// impulses of reactions, rates of states, auxiliaries (not used). The rows, in those of r:
///     constraint   K_p     K_e     0     0   K_x    0
///     kinematic    M_p      0     K_v    0    0     0
///     balance       0   tau^2 K_e M_v   K_r   0     0
///     evolution     0       0      0     0   M_x    0
///     definition    0       0      0     0    0    K_a
/// The terms with tau determine motions without inertia: their elastic loads do not change.
class ImpulseEquations {
 public:
  /// `prefix` of the solver's options.
  ImpulseEquations(const system::PeriodicSystem& system, const std::string& prefix);

  /// False where every velocity is admissible.
  bool is_restricted() const { return is_restricted_; }

  /// True for an internal load that no elastic strain determines.
  bool is_reaction(Eigen::Index unknown) const {
    return columns_[static_cast<std::size_t>(unknown)] == Column::reaction;
  }

  /// Evaluates K and M.
  void evaluate(double t, Vec z, Vec z_dot);
  /// K, until the next factor().
  Mat stiffness() const { return matrix_.get(); }

  /// Factors the equations for `tau` [s], which replace K.
  /// @throws SingularError
  void factor(double tau);
  void solve(Eigen::MatrixXd& right) { solver_.solve(right); }
  /// The terms with tau.
  const Eigen::SparseMatrix<double, Eigen::RowMajor>& added() const { return added_; }
  /// Of the factored matrix.
  const Equilibration& scaling() const { return solver_.scaling(); }

 private:
  enum class Column { none, position, velocity, elastic, reaction, state, auxiliary };
  /// The columns of K and of M that a row keeps.
  struct Kept {
    Column of_K = Column::none;
    Column of_M = Column::none;
  };
  static Kept kept_by(system::RowRole row);
  void classify();

  const system::PeriodicSystem& system_;
  bool is_restricted_ = false;
  std::vector<Column> columns_;
  petsc::Handle<Mat> matrix_;
  petsc::Handle<Mat> mass_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> added_;
  DirectSolver solver_;
};

}  // namespace samara::analysis
