// The states that a linearized system can have (docs/theory.md, section 5).
//
// Strain and joint constraints tie positions to each other and to the internal loads of elastic
// strains. All positions are therefore functions of eta, which consists of the internal loads of
// the elastic strains and the positions in no constraint. The number of entries of eta is the
// number of degrees of freedom d; it is counted, not estimated from a numerical rank. There are n_1
// first-order states xi besides: a reduced state is (eta, eta_dot, xi).
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/periodic_solution.hpp"
#include "samara/analysis/sparse_parts.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

class ConsistentSubspace {
 public:
  /// The subspace of the linearization about `solution`.
  /// @throws InternalError where constraints and tied positions differ in number.
  ConsistentSubspace(const system::PeriodicSystem& system, const PeriodicSolution& solution);

  int degrees_of_freedom() const { return static_cast<int>(coordinates_.size()); }

  /// n_1
  int first_order() const { return static_cast<int>(states_.size()); }
  /// 2 d + n_1
  int size() const { return 2 * degrees_of_freedom() + first_order(); }

  /// Unknowns that form eta.
  const std::vector<PetscInt>& coordinates() const { return coordinates_; }
  /// Entry i of eta is unknown coordinates()[i] divided by scale()[i].
  const std::vector<double>& scale() const { return scale_; }

  /// Unknowns that form xi, each divided by its Unknown::scale.
  const std::vector<PetscInt>& states() const { return states_; }
  const std::vector<double>& state_scale() const { return state_scale_; }
  /// Unknowns of states() that constraint rows contain.
  const std::vector<PetscInt>& driving() const { return driving_; }
  /// Rates of xi (n_1 x columns): the rows of `rates` [unknown per second] are those of driving(),
  /// the rates of the other states are zero.
  Eigen::MatrixXd spread_rates(const Eigen::MatrixXd& rates) const;

  /// Unknowns that constraint rows determine from eta and xi: positions, and internal loads of
  /// beams held at both ends.
  const std::vector<PetscInt>& tied() const { return tied_; }
  const std::vector<PetscInt>& constraint_rows() const { return constraints_; }
  const std::vector<PetscInt>& kinematic_rows() const { return kinematic_; }
  /// Unknowns that kinematic rows determine.
  const std::vector<PetscInt>& velocities() const { return velocities_; }

  /// eta of the columns of z, scaled: d x columns.
  Eigen::MatrixXd coordinates_of(const Eigen::MatrixXd& z) const;
  /// xi of the columns of z, scaled: n_1 x columns.
  Eigen::MatrixXd states_of(const Eigen::MatrixXd& z) const;

  /// Unknowns whose values at a step's ends belong to the state: x, and internal loads in eta.
  const std::vector<bool>& carried() const { return carried_; }

  /// Basis of the consistent states at time t: n x (2 d + n_1), one column for a unit of each entry
  /// of eta, of eta_dot and of xi, with all other entries 0.
  Eigen::MatrixXd basis(double t) const;

  /// Rate of K along the solution in the rows constraint_rows(), by differences of order 4 whose
  /// error is some 1e-12 of K times the rotor speed. Empty where the rows are constant.
  Sparse constraint_rates(double t) const;

  /// The nonlinear state with the given (eta, eta_dot, xi): solves the constraint rows for the tied
  /// positions and the kinematic rows for the velocities, from `z` as a start, into `z`.
  /// @throws ConvergenceError
  void find_state(double t, const Eigen::VectorXd& reduced, Vec z) const;

 private:
  Eigen::MatrixXd positions(const Sparse& K, const SparseSolver& tied) const;
  Eigen::MatrixXd driving_rates(const Eigen::SparseMatrix<double>& K,
                                const Eigen::SparseMatrix<double>& M,
                                const Eigen::MatrixXd& z) const;
  void find_states(const SparseTangents& at_start);
  void require_no_rates(const Eigen::SparseMatrix<double>& M) const;
  void find_driving_rates(double t, Vec z, Eigen::MatrixXd& rates) const;
  std::string name_of(PetscInt unknown) const;
  std::vector<std::size_t> images_of(std::size_t coordinate) const;
  void tie_coordinates(const Eigen::SparseMatrix<double>& K);

  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  std::vector<PetscInt> coordinates_;
  std::vector<double> scale_;  ///< eta = z / scale
  std::vector<bool> carried_;
  std::vector<PetscInt> constraints_;  ///< rows
  std::vector<PetscInt> tied_;         ///< unknowns that constraint rows determine
  std::vector<double> tied_scale_;     ///< of the last entries of tied_, which are internal loads
  std::vector<PetscInt> kinematic_;    ///< rows
  std::vector<PetscInt> velocities_;   ///< unknowns
  std::vector<PetscInt> positions_;    ///< unknowns
  std::vector<PetscInt> states_;       ///< unknowns of first order
  std::vector<double> state_scale_;    ///< xi = z / scale
  std::vector<PetscInt> driving_;      ///< states that constraint rows contain
  std::vector<Eigen::Index> driving_places_;  ///< of driving_ in xi
  bool fixed_constraints_ = false;
};

}  // namespace samara::analysis
