#include "samara/linear/linear_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include <Eigen/LU>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/sparse_parts.hpp"
#include "samara/base/error.hpp"

namespace samara::linear {
namespace {

using analysis::multiply;
using analysis::part;
using analysis::rows_of;
using analysis::Sparse;
using analysis::SparseSolver;
using analysis::SparseTangents;
using analysis::tangents_on;
using Dense = Eigen::MatrixXd;

/// Central differences of order 8 over four steps on each side.
constexpr std::array<double, 4> first_weights{4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
constexpr double second_middle = -205.0 / 72.0;
constexpr std::array<double, 4> second_weights{8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0};
/// Least number of steps of these differences in a revolution, and for each harmonic of the steady
/// state. The error is (k Omega h)^8/630 of a harmonic k, and round-off over (Omega h)^2.
constexpr int least_steps = 256;
constexpr int steps_a_harmonic = 32;

/// A value and its first two derivatives in time.
template <class Matrix>
struct Jet {
  Matrix value, first, second;
};

/// Error of accelerations by round-off above which a motion has no inertia that could be known.
/// (Turbines have 1e-13 to 1e-10, motions with next to no inertia 1e-4 and more.) And the part of
/// the largest acceleration below which others are round-off.
constexpr double largest_error = 1e-5;
constexpr double least_size = 1e-12;

/// Largest change of an acceleration by a coordinate, the first `d` rows and columns of x, relative
/// to the geometric mean of the largest ones of its row and column. What is zero but for round-off,
/// as the column of a free yaw, is compared with all others.
double relative_change(const Dense& change, const Dense& x, Eigen::Index d) {
  if (d == 0) return 0.0;
  const Dense sizes = x.topLeftCorner(d, d).cwiseAbs();
  const double least = least_size * sizes.maxCoeff();
  if (least == 0.0) return 0.0;
  const Eigen::VectorXd of_row = sizes.rowwise().maxCoeff().cwiseMax(least).cwiseSqrt();
  const Eigen::RowVectorXd of_column = sizes.colwise().maxCoeff().cwiseMax(least).cwiseSqrt();
  return change.topLeftCorner(d, d).cwiseAbs().cwiseQuotient(of_row * of_column).maxCoeff();
}

/// `moved`: states whose accelerations the first columns belong to.
/// @throws InputError with the name of the one that moves most in the direction that the matrix
/// almost maps to zero
[[noreturn]] void refuse_singular(const Eigen::PartialPivLU<Dense>& lu,
                                  std::span<const ModelState> moved) {
  // Inverse iteration; a pivot that is zero stands for one of round-off.
  Dense U = lu.matrixLU();
  const double tiny = std::numeric_limits<double>::epsilon() * U.diagonal().cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < U.rows(); ++i)
    if (!(std::abs(U(i, i)) > tiny)) U(i, i) = tiny;
  Eigen::VectorXd null = Eigen::VectorXd::Ones(U.rows());
  for (int iteration = 0; iteration < 2; ++iteration) {
    null = U.triangularView<Eigen::Upper>().transpose().solve(null).normalized();
    null = U.triangularView<Eigen::Upper>().solve(null).normalized();
  }
  Eigen::Index largest = 0;
  null.cwiseAbs().maxCoeff(&largest);
  if (largest >= static_cast<Eigen::Index>(moved.size()))
    throw InternalError("the balances do not determine accelerations and reactions");
  throw InputError(
      "linearize: a motion of \"" + moved[static_cast<std::size_t>(largest)].name +
      "\" has no inertia or almost none (so it is with an elastic blade behind a hinge, or with "
      "blades on a hub without inertia behind shaft torsion): its acceleration does not follow "
      "from the state; hint: samara modes and samara floquet leave such a motion out, "
      "hub.inertia gives a hub its own inertia");
}

/// Dense solve with rows and columns of size one, refined once: the change is about the error by
/// round-off that is left. `moved`: see refuse_singular.
Dense solve_scaled(const Dense& matrix, const Dense& right, std::span<const ModelState> moved) {
  if (matrix.rows() == 0) return right;
  Eigen::VectorXd rows = matrix.cwiseAbs().rowwise().maxCoeff();
  if (rows.minCoeff() == 0.0)
    throw InternalError("the balances do not determine accelerations and reactions");
  rows = rows.cwiseInverse();
  Dense scaled = rows.asDiagonal() * matrix;
  Eigen::VectorXd columns = scaled.cwiseAbs().colwise().maxCoeff();
  if (columns.minCoeff() == 0.0)
    throw InternalError("the balances do not determine accelerations and reactions");
  columns = columns.cwiseInverse();
  scaled = scaled * columns.asDiagonal();
  const Eigen::PartialPivLU<Dense> lu(scaled);
  if (!(lu.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0)) refuse_singular(lu, moved);
  const Dense b = rows.asDiagonal() * right;
  Dense x = lu.solve(b);
  const Dense change = lu.solve(b - multiply(scaled, x));
  x += change;
  if (!x.allFinite())
    throw InternalError("the balances do not determine accelerations and reactions");
  if (relative_change(change, x, static_cast<Eigen::Index>(moved.size())) > largest_error)
    refuse_singular(lu, moved);
  return columns.asDiagonal() * x;
}

}  // namespace

/// Columns of quantities that are linear in (eta, eta_dot, eta_ddot, xi, xi_dot, u, u_dot, u_ddot).
struct LinearModel::Columns {
  Eigen::Index d, n_1, inputs;

  Eigen::Index xi() const { return 3 * d; }
  Eigen::Index xi_dot() const { return 3 * d + n_1; }
  Eigen::Index u() const { return 3 * d + 2 * n_1; }
  Eigen::Index all() const { return u() + 3 * inputs; }
};

struct LinearModel::Tangents {
  Sparse K, M;
  Dense R, R_rate;
};

/// z and z_dot without reactions and auxiliaries, in the columns of Columns; and the tangents.
struct LinearModel::Motion {
  Dense z, z_dot;
  Sparse K, M;
  Dense R, R_rate;
};

LinearModel::LinearModel(const system::PeriodicSystem& system,
                         const system::InputOutput& input_output,
                         const analysis::PeriodicSolution& solution)
    : system_(system),
      input_output_(input_output),
      solution_(solution),
      subspace_(system, solution) {
  std::vector<bool> is_known(static_cast<std::size_t>(system.size()), false);
  for (const PetscInt i : subspace_.coordinates()) is_known[static_cast<std::size_t>(i)] = true;
  for (const PetscInt i : subspace_.tied()) is_known[static_cast<std::size_t>(i)] = true;
  for (std::size_t i = 0; i < system.rows().size(); ++i) {
    const auto at = static_cast<PetscInt>(i);
    const system::RowRole row = system.rows()[i];
    const system::UnknownRole role = system.unknowns()[i].role;
    if (row == system::RowRole::balance || row == system::RowRole::evolution ||
        row == system::RowRole::definition)
      dynamic_.push_back(at);
    if (role == system::UnknownRole::auxiliary ||
        (role == system::UnknownRole::internal && !is_known[i]))
      algebraic_.push_back(at);
  }
  const auto d = static_cast<std::size_t>(subspace_.degrees_of_freedom());
  const auto n_1 = static_cast<std::size_t>(subspace_.first_order());
  if (dynamic_.size() != d + n_1 + algebraic_.size())
    throw InternalError("balances, degrees of freedom and reactions differ in number");
  for (const char* behind : {"", rate_word})
    for (std::size_t i = 0; i < d; ++i) {
      const system::Unknown& unknown =
          system.unknowns()[static_cast<std::size_t>(subspace_.coordinates()[i])];
      states_.push_back({unknown.name() + behind, unknown.unit + (*behind == '\0' ? "" : "/s"),
                         subspace_.scale()[i]});
    }
  for (std::size_t i = 0; i < n_1; ++i) {
    const system::Unknown& unknown =
        system.unknowns()[static_cast<std::size_t>(subspace_.states()[i])];
    states_.push_back({unknown.name(), unknown.unit, unknown.scale});
  }
  for (std::size_t i = 0; i < input_output.inputs().size(); ++i) {
    const bool is_motion = input_output.inputs()[i].is_motion;
    for (int derivative = 0; derivative < (is_motion ? 3 : 1); ++derivative)
      columns_.push_back({i, derivative});
  }
}

LinearModel::Tangents LinearModel::tangents_at(double t) const {
  const petsc::Handle<Vec> z = system_.make_state();
  const petsc::Handle<Vec> z_dot = system_.make_state();
  solution_.evaluate(t, z.get(), z_dot.get());
  const system::InputTangents inputs = input_output_.input_tangents(t, z.get(), z_dot.get());
  const SparseTangents tangents = tangents_on(system_, solution_, t);
  return {tangents.K, tangents.M, inputs.by_value, inputs.by_rate};
}

DescriptorForm LinearModel::descriptor(double t) const {
  const Tangents tangents = tangents_at(t);
  const petsc::Handle<Vec> z = system_.make_state();
  const petsc::Handle<Vec> z_dot = system_.make_state();
  solution_.evaluate(t, z.get(), z_dot.get());
  const system::OutputTangents outputs = input_output_.output_tangents(t, z.get(), z_dot.get());
  return {tangents.M,       tangents.K,      tangents.R,      tangents.R_rate,
          outputs.by_state, outputs.by_rate, outputs.by_input};
}

Eigen::VectorXd LinearModel::operating_outputs(double t) const {
  const petsc::Handle<Vec> z = system_.make_state();
  const petsc::Handle<Vec> z_dot = system_.make_state();
  solution_.evaluate(t, z.get(), z_dot.get());
  return input_output_.output_values(t, z.get(), z_dot.get());
}

/// Positions follow from the constraint rows, velocities from the kinematic rows, and their rates
/// from the time derivatives of these rows. No solution is differenced. Rates of first-order states
/// have columns of their own beside the states. Where these states are in constraint rows, their
/// second rates follow from their differentiated evolution rows.
LinearModel::Motion LinearModel::motion_at(double t) const {
  const Tangents now = tangents_at(t);
  Jet<Sparse> K{now.K, 0.0 * now.K, 0.0 * now.K};
  Sparse M_first = 0.0 * now.M;
  Dense R_first = Dense::Zero(now.R.rows(), now.R.cols());
  Dense R_rate_first = R_first;
  if (system_.period() > 0.0) {
    const double h =
        system_.period() / std::max(least_steps, steps_a_harmonic * solution_.harmonics());
    K.second = (second_middle / (h * h)) * now.K;
    for (std::size_t m = 0; m < first_weights.size(); ++m)
      for (const double side : {1.0, -1.0}) {
        const Tangents other = tangents_at(t + side * static_cast<double>(m + 1) * h);
        const double weight = side * first_weights[m] / h;
        K.first += weight * other.K;
        K.second += (second_weights[m] / (h * h)) * other.K;
        M_first += weight * other.M;
        R_first += weight * other.R;
        R_rate_first += weight * other.R_rate;
      }
  }

  const auto d = static_cast<Eigen::Index>(subspace_.degrees_of_freedom());
  const auto n_1 = static_cast<Eigen::Index>(subspace_.first_order());
  const Eigen::Index m = now.R.cols();
  const Eigen::Index n = system_.size();
  const Columns at{d, n_1, m};
  const std::vector<PetscInt>& coordinates = subspace_.coordinates();
  const std::vector<PetscInt>& tied = subspace_.tied();
  const std::vector<PetscInt>& constraints = subspace_.constraint_rows();
  const std::vector<PetscInt>& kinematic = subspace_.kinematic_rows();
  const std::vector<PetscInt>& velocities = subspace_.velocities();

  // Z, Z_dot, Z_ddot of positions = Z (eta, xi).
  Jet<Dense> Z{Dense::Zero(n, d + n_1), Dense::Zero(n, d + n_1), Dense::Zero(n, d + n_1)};
  for (Eigen::Index i = 0; i < d; ++i)
    Z.value(coordinates[static_cast<std::size_t>(i)], i) =
        subspace_.scale()[static_cast<std::size_t>(i)];
  const std::vector<PetscInt>& states = subspace_.states();
  for (Eigen::Index i = 0; i < n_1; ++i)
    Z.value(states[static_cast<std::size_t>(i)], d + i) =
        subspace_.state_scale()[static_cast<std::size_t>(i)];
  const Jet<Sparse> D{rows_of(K.value, constraints), rows_of(K.first, constraints),
                      rows_of(K.second, constraints)};
  const SparseSolver positions(part(K.value, constraints, tied), "constraints");
  Z.value(tied, Eigen::all) = positions.solve(-(D.value * Z.value));
  Z.first(tied, Eigen::all) = positions.solve(-(D.first * Z.value));
  Z.second(tied, Eigen::all) = positions.solve(-(2.0 * (D.first * Z.first) + D.second * Z.value));

  Motion motion{
      Dense::Zero(n, at.all()), Dense::Zero(n, at.all()), now.K, now.M, now.R, now.R_rate};
  Dense& z = motion.z;
  Dense& z_dot = motion.z_dot;
  z.leftCols(d) = Z.value.leftCols(d);
  z_dot.leftCols(d) = Z.first.leftCols(d);
  z_dot.middleCols(d, d) = Z.value.leftCols(d);
  z.middleCols(at.xi(), n_1) = Z.value.rightCols(n_1);
  z_dot.middleCols(at.xi(), n_1) = Z.first.rightCols(n_1);
  z_dot.middleCols(at.xi_dot(), n_1) = Z.value.rightCols(n_1);
  Dense z_ddot = Dense::Zero(n, at.all());
  z_ddot.leftCols(d) = Z.second.leftCols(d);
  z_ddot.middleCols(d, d) = 2.0 * Z.first.leftCols(d);
  z_ddot.middleCols(2 * d, d) = Z.value.leftCols(d);
  z_ddot.middleCols(at.xi(), n_1) = Z.second.rightCols(n_1);
  z_ddot.middleCols(at.xi_dot(), n_1) = 2.0 * Z.first.rightCols(n_1);
  const std::vector<PetscInt>& driving = subspace_.driving();
  if (!driving.empty()) {
    // E x_ddot + E_dot x_dot + (K z)' + (R u)' = 0; K has entries for positions and states only.
    Dense right = rows_of(M_first, driving) * z_dot + rows_of(K.first, driving) * z +
                  rows_of(K.value, driving) * z_dot;
    right.middleCols(at.u(), m) += R_first(driving, Eigen::all);
    right.middleCols(at.u() + m, m) +=
        now.R(driving, Eigen::all) + R_rate_first(driving, Eigen::all);
    right.middleCols(at.u() + 2 * m, m) += now.R_rate(driving, Eigen::all);
    const Dense second =
        SparseSolver(part(now.M, driving, driving), "evolution rows").solve(-right);
    z_ddot += Z.value.rightCols(n_1) * subspace_.spread_rates(second);
  }

  // K z + M z_dot + R u + R' u_dot = 0 in the kinematic rows, and its rate.
  const SparseSolver speeds(part(K.value, kinematic, velocities), "kinematic rows");
  const Sparse K_rows = rows_of(K.value, kinematic);
  const Sparse M_rows = rows_of(now.M, kinematic);
  const auto input = [&](const Dense& matrix) { return Dense(matrix(kinematic, Eigen::all)); };
  Dense right = K_rows * z + M_rows * z_dot;
  right.middleCols(at.u(), m) += input(now.R);
  right.middleCols(at.u() + m, m) += input(now.R_rate);
  z(velocities, Eigen::all) = speeds.solve(-right);
  right = rows_of(K.first, kinematic) * z + K_rows * z_dot + rows_of(M_first, kinematic) * z_dot +
          M_rows * z_ddot;
  right.middleCols(at.u(), m) += input(R_first);
  right.middleCols(at.u() + m, m) += input(now.R) + input(R_rate_first);
  right.middleCols(at.u() + 2 * m, m) += input(now.R_rate);
  z_dot(velocities, Eigen::all) = speeds.solve(-right);
  return motion;
}

StateSpace LinearModel::state_space(double t) const {
  const Motion motion = motion_at(t);
  const auto d = static_cast<Eigen::Index>(subspace_.degrees_of_freedom());
  const auto n_1 = static_cast<Eigen::Index>(subspace_.first_order());
  const Eigen::Index m = motion.R.cols();
  const Columns at{d, n_1, m};

  // Balances, evolutions and definitions: a square system for the accelerations of eta, the
  // algebraic unknowns and the rates of xi.
  Dense known = rows_of(motion.K, dynamic_) * motion.z + rows_of(motion.M, dynamic_) * motion.z_dot;
  known.middleCols(at.u(), m) += motion.R(dynamic_, Eigen::all);
  known.middleCols(at.u() + m, m) += motion.R_rate(dynamic_, Eigen::all);
  const auto algebraic = static_cast<Eigen::Index>(algebraic_.size());
  Dense matrix(known.rows(), known.rows());
  matrix.leftCols(d) = known.middleCols(2 * d, d);
  matrix.middleCols(d, algebraic) = part(motion.K, dynamic_, algebraic_);
  matrix.rightCols(n_1) = known.middleCols(at.xi_dot(), n_1);
  const auto without = [&](const Dense& all) {  // (eta, eta_dot, xi, u, u_dot, u_ddot)
    Dense rest(all.rows(), 2 * d + n_1 + 3 * m);
    rest << all.leftCols(2 * d), all.middleCols(at.xi(), n_1), all.rightCols(3 * m);
    return rest;
  };
  const Dense found =
      solve_scaled(matrix, -without(known), std::span(states_).first(static_cast<std::size_t>(d)));
  const Dense acceleration = found.topRows(d);
  const Dense xi_dot = found.bottomRows(n_1);

  Dense z = without(motion.z);
  Dense z_dot = without(motion.z_dot) + multiply(motion.z_dot.middleCols(2 * d, d), acceleration);
  if (n_1 > 0) {
    z += multiply(motion.z.middleCols(at.xi_dot(), n_1), xi_dot);
    z_dot += multiply(motion.z_dot.middleCols(at.xi_dot(), n_1), xi_dot);
  }
  z(algebraic_, Eigen::all) = found.middleRows(d, algebraic);

  const petsc::Handle<Vec> state = system_.make_state();
  const petsc::Handle<Vec> rate = system_.make_state();
  solution_.evaluate(t, state.get(), rate.get());
  const system::OutputTangents slopes = input_output_.output_tangents(t, state.get(), rate.get());
  Dense y = multiply(slopes.by_state, z) + multiply(slopes.by_rate, z_dot);
  const Eigen::Index size = 2 * d + n_1;
  y.middleCols(size, m) += slopes.by_input;

  StateSpace result;
  result.A = Dense::Zero(size, size);
  result.A.block(0, d, d, d).setIdentity();
  result.A.middleRows(d, d) = acceleration.leftCols(size);
  result.A.bottomRows(n_1) = xi_dot.leftCols(size);
  result.C = y.leftCols(size);
  const auto count = static_cast<Eigen::Index>(columns_.size());
  result.B = Dense::Zero(size, count);
  result.D.resize(y.rows(), count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const InputColumn& column = columns_[static_cast<std::size_t>(j)];
    const Eigen::Index from =
        size + column.derivative * m + static_cast<Eigen::Index>(column.input);
    result.B.col(j).segment(d, d) = acceleration.col(from);
    result.B.col(j).tail(n_1) = xi_dot.col(from);
    result.D.col(j) = y.col(from);
  }
  return result;
}

}  // namespace samara::linear
