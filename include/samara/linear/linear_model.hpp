// The linear model about a steady state, at one instant (docs/theory.md, section 10; Lee, Hodges &
// Patil (2002), eq. (16), (17)).
//
// Descriptor form: all unknowns, M dz_dot + K dz + R du + R' du_dot = 0. State-space form: the
// independent states (eta, eta_dot), two for each degree of freedom. Constraints and reactions are
// eliminated without a step in time.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/system/input_output.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::linear {

/// M dz_dot + K dz + R du + R_rate du_dot = 0, dy = C dz + C_rate dz_dot + D du.
struct DescriptorForm {
  Eigen::SparseMatrix<double> M, K;
  Eigen::MatrixXd R, R_rate;  ///< size x inputs
  Eigen::MatrixXd C, C_rate;  ///< outputs x size
  Eigen::MatrixXd D;          ///< outputs x inputs
};

/// x_dot = A x + B u, y = C x + D u.
struct StateSpace {
  Eigen::MatrixXd A, B, C, D;
};

/// The matrices of a state-space form by name, with their rows and columns.
struct StateSpacePart {
  const char* name;
  Eigen::MatrixXd StateSpace::*matrix;
  const char* row;
  const char* column;
};

inline constexpr std::array<StateSpacePart, 4> state_space_parts{
    {{"A", &StateSpace::A, "row", "state"},
     {"B", &StateSpace::B, "row", "input"},
     {"C", &StateSpace::C, "output", "state"},
     {"D", &StateSpace::D, "output", "input"}}};

/// Meaning of a column of B and D: an input, its rate or its acceleration.
struct InputColumn {
  std::size_t input = 0;
  int derivative = 0;
};

/// Stands behind the name of a coordinate in the name of its rate.
inline constexpr char rate_word[] = " rate";

/// A state: unknown = scale times state.
struct ModelState {
  std::string name;  ///< of the unknown, with rate_word behind it for its rate
  std::string unit;  ///< of the unknown
  double scale = 1.0;
};

class LinearModel {
 public:
  /// All arguments must outlive the model.
  LinearModel(const system::PeriodicSystem& system, const system::InputOutput& input_output,
              const analysis::PeriodicSolution& solution);

  /// x = (eta, eta_dot, xi), as ConsistentSubspace has them.
  const std::vector<ModelState>& states() const { return states_; }
  const std::vector<InputColumn>& input_columns() const { return columns_; }
  const system::PeriodicSystem& system() const { return system_; }
  const system::InputOutput& input_output() const { return input_output_; }
  const analysis::PeriodicSolution& solution() const { return solution_; }
  const analysis::ConsistentSubspace& subspace() const { return subspace_; }

  DescriptorForm descriptor(double t) const;
  /// @throws InternalError where the rows do not determine accelerations and reactions
  StateSpace state_space(double t) const;
  /// The outputs on the steady state.
  Eigen::VectorXd operating_outputs(double t) const;

 private:
  struct Columns;
  struct Tangents;
  struct Motion;
  Tangents tangents_at(double t) const;
  Motion motion_at(double t) const;

  const system::PeriodicSystem& system_;
  const system::InputOutput& input_output_;
  const analysis::PeriodicSolution& solution_;
  analysis::ConsistentSubspace subspace_;
  std::vector<PetscInt> dynamic_;    ///< rows: balances, evolutions and definitions
  std::vector<PetscInt> algebraic_;  ///< auxiliaries, and loads that constraints do not determine
  std::vector<ModelState> states_;
  std::vector<InputColumn> columns_;
};

}  // namespace samara::linear
