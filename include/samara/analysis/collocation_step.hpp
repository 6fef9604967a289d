// One step of the linearized periodic system by collocation (docs/theory.md, section 5.1).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/impulse_equations.hpp"
#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Advances columns of small motions about a periodic solution by polynomials with s stages. Even
/// orders 2 s: Gauss points; s = 1 is (19) of Lee, Hodges & Patil (2002). No motion is damped by
/// these steps, however fast it is. Odd order 2 s - 1: the points of Radau IIA; motions that are
/// too fast for the step decay. Unknowns that are carried from step to step are polynomials of
/// degree s, others (reactions, auxiliaries) of degree s - 1. Rows with rates and definition rows
/// hold at the s points of a step. Constraint rows hold at its s + 1 Lobatto points, the first of
/// which is the end of the step before, or at the Radau points. At the end of each step impulses of
/// the reactions make the velocities admissible.
class CollocationStep {
 public:
  /// `order`: 2, 4, 6 or 5; `step` [s].
  CollocationStep(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                  const ConsistentSubspace& subspace, int order, double step);

  /// Advances columns of consistent states from the start of step k (t = k step) to its end. The
  /// factors of the last step are kept, so that columns may be advanced in groups.
  /// @throws ConvergenceError from the linear solver
  void advance(long k, Eigen::MatrixXd& z);

  /// Values of the last columns at a fraction of the step, from 0 to 1, or at several.
  void sample(double fraction, Eigen::MatrixXd& values) const;
  void sample(const std::vector<double>& fractions, std::span<Eigen::MatrixXd> values) const;

  /// (eta, eta_dot, xi) of the last columns at the end of the step, 2 d + n_1 x columns.
  Eigen::MatrixXd state();

 private:
  using Index = Eigen::Index;
  /// An entry of K, and the place of its stages in the values of the matrix of all stages.
  struct Entry {
    PetscInt row = 0;
    PetscInt column = 0;
    Index first = 0;          ///< place of the first stage's row and column
    Index row_stride = 0;     ///< from a stage's row to the next one
    Index column_stride = 0;  ///< from a stage's column to the next one
  };

  void order_rows();
  void list_entries();
  void make_matrix();
  void find_mass_entries();
  void evaluate_at(double t);
  void factor(long k);
  void take_dynamics(int stage, PetscScalar* values);
  void take_constraints(int stage, const PetscScalar* stiffness, PetscScalar* values);
  void combine(const Eigen::VectorXd& weights, Eigen::MatrixXd& values) const;
  void factor_impulses();
  void project();
  Equilibration scale(Mat matrix) const;
  /// Number of an unknown of a stage.
  Index at(Index unknown, Index stage) const {
    return (unknown / block_ * stages_ + stage) * block_ + unknown % block_;
  }
  Index row_at(Index row, Index stage) const {
    const auto place = static_cast<std::size_t>(row);
    return row_places_[place] + stage * row_strides_[place];
  }

  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  const ConsistentSubspace& subspace_;
  Index stages_;
  double step_;
  Index block_ = 1;                  ///< rows of a node block of K
  std::vector<Index> row_places_;    ///< of the first stage's rows
  std::vector<Index> row_strides_;   ///< from a stage's row to the next one
  std::vector<double> points_;       ///< of the stages, in a step of length 1
  std::vector<double> constrained_;  ///< points of constraint rows
  Eigen::MatrixXd rates_;            ///< s x (s + 1): rate at a stage by start and stages
  Eigen::MatrixXd at_constrained_;   ///< s x (s + 1): value at such a point by start and stages
  Eigen::VectorXd at_end_;           ///< s + 1: value at the end by start and stages
  Eigen::VectorXd rate_at_end_;      ///< s + 1
  petsc::Handle<Vec> z_, z_dot_;
  petsc::Handle<Mat> jacobian_;
  petsc::Handle<Mat> mass_;
  petsc::Handle<Mat> matrix_;   ///< of all stages: a node block holds its stages one after another
  std::vector<Entry> entries_;  ///< of K, in the order of MatrixEntries
  std::vector<std::size_t> dynamic_entries_;     ///< numbers of those not in constraint rows
  std::vector<std::size_t> constraint_entries_;  ///< of those in constraint rows
  std::vector<std::size_t> rate_entries_;        ///< in rows of velocities and of states
  std::vector<PetscInt> mass_entries_;           ///< for each entry of M the number of that of K
  std::vector<Eigen::Triplet<double>> start_terms_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> right_of_;  ///< right-hand sides of all stages
  DirectSolver solver_;
  ImpulseEquations impulses_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> rates_of_;  ///< right-hand sides of impulses_
  std::optional<long> factored_;                           ///< the step that has factors
  bool has_impulses_ = false;                              ///< factors of impulses_ for its end
  double end_time_ = 0.0;
  Eigen::VectorXd carried_;  ///< 1 for unknowns that are carried, else 0
  Eigen::MatrixXd start_;    ///< the last columns
  Eigen::MatrixXd middles_;  ///< at all stages
  Eigen::MatrixXd end_;
  Eigen::MatrixXd rate_;     ///< of the polynomials at the end
  Eigen::MatrixXd impulse_;  ///< solution of the impulse equations
};

}  // namespace samara::analysis
