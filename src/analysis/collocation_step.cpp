#include "samara/analysis/collocation_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "samara/base/error.hpp"
#include "samara/math/quadrature.hpp"

#include "matrix_entries.hpp"

namespace samara::analysis {
namespace {

/// tau of ImpulseEquations relative to a step. The rates of elastic loads that these terms keep are
/// those of the polynomials, so that the terms change motions of frequency w by less than
/// (tau w)^2 times the error of these rates.
constexpr double relative_tau = 1e-8;

/// Lobatto points of [0, 1] without 0: s of them.
std::vector<double> lobatto_points(int stages) {
  switch (stages) {
    case 1:
      return {1.0};
    case 2:
      return {0.5, 1.0};
    case 3:
      return {0.5 - 0.5 / std::sqrt(5.0), 0.5 + 0.5 / std::sqrt(5.0), 1.0};
    default:
      throw InternalError("collocation with " + std::to_string(stages) + " stages");
  }
}

bool is_gauss(int order) { return order % 2 == 0; }

/// Points of Radau IIA in [0, 1]; the last one is 1.
std::vector<double> radau_points(int order) {
  if (order != 5) throw InternalError("Radau IIA of order " + std::to_string(order));
  return {0.4 - std::sqrt(0.06), 0.4 + std::sqrt(0.06), 1.0};
}

}  // namespace

CollocationStep::CollocationStep(const system::PeriodicSystem& system,
                                 const PeriodicSolution& solution,
                                 const ConsistentSubspace& subspace, int order, double step)
    : system_(system),
      solution_(solution),
      subspace_(subspace),
      stages_((order + 1) / 2),
      step_(step),
      points_(is_gauss(order) ? math::gauss_rule(order / 2).points : radau_points(order)),
      constrained_(is_gauss(order) ? lobatto_points(order / 2) : points_),
      rates_(stages_, stages_ + 1),
      at_constrained_(stages_, stages_ + 1),
      at_end_(stages_ + 1),
      rate_at_end_(stages_ + 1),
      z_(system.make_state()),
      z_dot_(system.make_state()),
      jacobian_(system.make_jacobian()),
      mass_(system.make_mass()),
      solver_("floquet_", [this](Mat matrix) { return scale(matrix); }),
      impulses_(system, "floquet_impulse_") {
  std::vector<double> nodes{0.0};
  nodes.insert(nodes.end(), points_.begin(), points_.end());
  for (int a = 0; a <= stages_; ++a) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto row = static_cast<Index>(i);
      rates_(row, a) = math::lagrange_derivative(nodes, a, points_[i]) / step_;
      at_constrained_(row, a) = math::lagrange(nodes, a, constrained_[i]);
    }
    at_end_(a) = math::lagrange(nodes, a, 1.0);
    rate_at_end_(a) = math::lagrange_derivative(nodes, a, 1.0) / step_;
  }
  carried_.resize(static_cast<Index>(system.size()));
  for (std::size_t i = 0; i < subspace.carried().size(); ++i)
    carried_(static_cast<Index>(i)) = subspace.carried()[i] ? 1.0 : 0.0;
  list_entries();
  make_matrix();
}

/// In each node block the rows of velocities of all stages come last. They contain next to no
/// unknowns of other nodes, so that blocks off the diagonal are zero there.
void CollocationStep::order_rows() {
  const auto n = static_cast<Index>(system_.size());
  row_places_.resize(static_cast<std::size_t>(n));
  row_strides_.resize(static_cast<std::size_t>(n));
  for (Index first = 0; first < n; first += block_) {
    std::array<Index, 2> counts{};
    const auto group_of = [this](Index i) {
      return system_.rows()[static_cast<std::size_t>(i)] == system::RowRole::kinematic ? 1U : 0U;
    };
    for (Index i = first; i < first + block_; ++i)
      row_places_[static_cast<std::size_t>(i)] = counts[group_of(i)]++;
    for (Index i = first; i < first + block_; ++i) {
      const unsigned group = group_of(i);
      row_places_[static_cast<std::size_t>(i)] +=
          first * stages_ + (group == 1U ? counts[0] * stages_ : 0);
      row_strides_[static_cast<std::size_t>(i)] = counts[group];
    }
  }
}

void CollocationStep::list_entries() {
  evaluate_at(0.0);  // patterns of K and M
  MatrixEntries stiffness(jacobian_.get());
  block_ = stiffness.has_blocks() ? stiffness.blocks().size : 1;
  const Index rows = block_ * stages_;
  order_rows();
  std::vector<Index> lengths(static_cast<std::size_t>(system_.size()), 0);
  stiffness.for_each([&](PetscInt i, PetscInt j, PetscScalar&) {
    entries_.push_back({i, j, 0, 0, 0});
    ++lengths[static_cast<std::size_t>(i)];
  });
  Index row_begin = 0;
  Index position = 0;
  PetscInt last_row = -1;
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    Entry& entry = entries_[e];
    if (stiffness.has_blocks()) {
      const Index block = static_cast<Index>(e) / (block_ * block_);
      entry.first = (block * rows + entry.column % block_) * rows + row_at(entry.row, 0) % rows;
      entry.row_stride = row_at(entry.row, 1) - row_at(entry.row, 0);
      entry.column_stride = block_ * rows;
      continue;
    }
    const Index length = lengths[static_cast<std::size_t>(entry.row)];
    if (entry.row != last_row) {
      if (last_row >= 0)
        row_begin += lengths[static_cast<std::size_t>(last_row)] * stages_ * stages_;
      position = 0;
      last_row = entry.row;
    }
    entry.first = row_begin + position++ * stages_;
    entry.row_stride = length * stages_;
    entry.column_stride = 1;
  }
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const system::RowRole role = system_.rows()[static_cast<std::size_t>(entries_[e].row)];
    const bool is_constraint = role == system::RowRole::constraint;
    (is_constraint ? constraint_entries_ : dynamic_entries_).push_back(e);
    if (role == system::RowRole::kinematic || role == system::RowRole::evolution)
      rate_entries_.push_back(e);
  }
  find_mass_entries();
}

/// Entries of K are sorted by row of blocks, then by column of blocks.
void CollocationStep::find_mass_entries() {
  std::vector<std::vector<std::pair<PetscInt, PetscInt>>> rows(
      static_cast<std::size_t>(system_.size()));
  for (std::size_t e = 0; e < entries_.size(); ++e)
    rows[static_cast<std::size_t>(entries_[e].row)].emplace_back(entries_[e].column,
                                                                 static_cast<PetscInt>(e));
  for (auto& row : rows) std::sort(row.begin(), row.end());
  MatrixEntries(mass_.get()).for_each([&](PetscInt i, PetscInt j, PetscScalar&) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    const auto found =
        std::lower_bound(row.begin(), row.end(), std::pair<PetscInt, PetscInt>(j, 0));
    if (found == row.end() || found->first != j)
      throw InternalError("M has an entry in row " + std::to_string(i) + ", column " +
                          std::to_string(j) + ", where K + M has none");
    mass_entries_.push_back(found->second);
  });
}

void CollocationStep::make_matrix() {
  const MatrixEntries stiffness(jacobian_.get());
  const BlockMatrix<double> blocks = stiffness.blocks();
  const auto n = static_cast<PetscInt>(system_.size() * stages_);
  petsc::check(MatCreate(PETSC_COMM_SELF, matrix_.fill()));
  petsc::check(MatSetSizes(matrix_.get(), n, n, n, n));
  if (stiffness.has_blocks()) {
    petsc::check(MatSetType(matrix_.get(), MATSEQBAIJ));
    petsc::check(MatSeqBAIJSetPreallocationCSR(matrix_.get(),
                                               static_cast<PetscInt>(block_ * stages_),
                                               blocks.begin, blocks.columns, nullptr));
    return;
  }
  std::vector<PetscInt> begin{0};
  std::vector<PetscInt> columns;
  const auto s = static_cast<PetscInt>(stages_);
  for (Index i = 0; i < blocks.rows; ++i)
    for (PetscInt stage = 0; stage < s; ++stage) {
      for (PetscInt e = blocks.begin[i]; e < blocks.begin[i + 1]; ++e)
        for (PetscInt other = 0; other < s; ++other)
          columns.push_back(blocks.columns[e] * s + other);
      begin.push_back(static_cast<PetscInt>(columns.size()));
    }
  petsc::check(MatSetType(matrix_.get(), MATSEQAIJ));
  petsc::check(MatSeqAIJSetPreallocationCSR(matrix_.get(), begin.data(), columns.data(), nullptr));
}

void CollocationStep::evaluate_at(double t) {
  solution_.evaluate(t, z_.get(), z_dot_.get());
  system_.tangents(t, z_.get(), z_dot_.get(), 0.0, jacobian_.get(), mass_.get());
}

void CollocationStep::factor(long k) {
  factored_.reset();
  has_impulses_ = false;
  const double start = static_cast<double>(k) * step_;
  end_time_ = static_cast<double>(k + 1) * step_;
  {
    MatrixEntries all(matrix_.get());
    std::fill_n(all.values(), entries_.size() * static_cast<std::size_t>(stages_ * stages_), 0.0);
    for (int stage = 0; stage < stages_; ++stage) {
      const auto point = static_cast<std::size_t>(stage);
      evaluate_at(start + points_[point] * step_);
      take_dynamics(stage, all.values());
      if (stage + 1 == stages_) continue;
      if (constrained_[point] != points_[point]) evaluate_at(start + constrained_[point] * step_);
      take_constraints(stage, MatrixEntries(jacobian_.get()).values(), all.values());
    }
    solution_.evaluate(end_time_, z_.get(), z_dot_.get());
    impulses_.evaluate(end_time_, z_.get(), z_dot_.get());
    take_constraints(static_cast<int>(stages_) - 1, MatrixEntries(impulses_.stiffness()).values(),
                     all.values());
  }
  right_of_.resize(system_.size() * stages_, system_.size());
  right_of_.setFromTriplets(start_terms_.begin(), start_terms_.end());
  start_terms_ = {};
  solver_.factor(matrix_.get());
  if (impulses_.is_restricted()) factor_impulses();
  factored_ = k;
}

/// K z + M z_dot = 0 at a stage, in all rows but those of constraints.
void CollocationStep::take_dynamics(int stage, PetscScalar* values) {
  const MatrixEntries stiffness(jacobian_.get());
  const MatrixEntries mass(mass_.get());
  const PetscScalar* K = stiffness.values();
  for (const std::size_t e : dynamic_entries_) {
    const Entry& entry = entries_[e];
    values[entry.first + stage * (entry.row_stride + entry.column_stride)] += K[e];
  }
  for (std::size_t m = 0; m < mass_entries_.size(); ++m) {
    const PetscScalar value = mass.values()[m];
    if (value == 0.0) continue;
    const Entry& entry = entries_[static_cast<std::size_t>(mass_entries_[m])];
    PetscScalar* row = values + entry.first + stage * entry.row_stride;
    for (Index other = 0; other < stages_; ++other)
      row[other * entry.column_stride] += rates_(stage, other + 1) * value;
    start_terms_.emplace_back(row_at(entry.row, stage), entry.column, -rates_(stage, 0) * value);
  }
}

/// K z = 0 at a point of constraints, in their rows.
void CollocationStep::take_constraints(int stage, const PetscScalar* stiffness,
                                       PetscScalar* values) {
  for (const std::size_t e : constraint_entries_) {
    const Entry& entry = entries_[e];
    if (stiffness[e] == 0.0) continue;
    PetscScalar* row = values + entry.first + stage * entry.row_stride;
    for (Index other = 0; other < stages_; ++other)
      row[other * entry.column_stride] += at_constrained_(stage, other + 1) * stiffness[e];
    start_terms_.emplace_back(row_at(entry.row, stage), entry.column,
                              -at_constrained_(stage, 0) * stiffness[e]);
  }
}

/// Column factors from the roles of unknowns, for rates as large as those of the polynomials. The
/// terms of a stage with itself have the size of (2/dt M + K) of order 2.
Equilibration CollocationStep::scale(Mat matrix) const {
  const double rate = rates_.rightCols(stages_).diagonal().cwiseAbs().maxCoeff();
  const auto n = static_cast<Index>(system_.size());
  std::vector<Eigen::Triplet<double>> own;
  const MatrixEntries values(matrix);
  for (const Entry& entry : entries_)
    own.emplace_back(entry.row, entry.column, values.values()[entry.first]);
  Eigen::SparseMatrix<double> first_stage(n, n);
  first_stage.setFromTriplets(own.begin(), own.end());
  const Equilibration of_roles = scaling_by_role(system_, first_stage, rate);
  const auto size = static_cast<PetscInt>(n * stages_);
  Equilibration scaling{petsc::make_vector(PETSC_COMM_SELF, size, size),
                        petsc::make_vector(PETSC_COMM_SELF, size, size)};
  const petsc::ReadView factors(of_roles.columns.get());
  const petsc::WriteView columns(scaling.columns.get());
  std::vector<double> largest(static_cast<std::size_t>(size), 0.0);
  for (Index j = 0; j < n; ++j)
    for (Index stage = 0; stage < stages_; ++stage)
      columns[static_cast<PetscInt>(at(j, stage))] = factors[static_cast<PetscInt>(j)];
  MatrixEntries(matrix).for_each([&](PetscInt i, PetscInt j, const PetscScalar& value) {
    double& row = largest[static_cast<std::size_t>(i)];
    row = std::max(row, std::abs(value) * columns[j]);
  });
  const petsc::WriteView rows(scaling.rows.get());
  for (PetscInt i = 0; i < size; ++i) {
    const double value = largest[static_cast<std::size_t>(i)];
    rows[i] = value > 0.0 ? 1.0 / value : 1.0;
  }
  return scaling;
}

/// values = weights(0) start + the sum of weights(1 + i) times stage i, in the carried rows.
void CollocationStep::combine(const Eigen::VectorXd& weights, Eigen::MatrixXd& values) const {
  values.resize(start_.rows(), start_.cols());
  for (Index c = 0; c < values.cols(); ++c)
    for (Index first = 0; first < values.rows(); first += block_) {
      const double* start = &start_(first, c);
      const double* stages = &middles_(first * stages_, c);
      double* result = &values(first, c);
      for (Index i = 0; i < block_; ++i) result[i] = weights(0) * start[i];
      for (Index stage = 0; stage < stages_; ++stage)
        for (Index i = 0; i < block_; ++i)
          result[i] += weights(stage + 1) * stages[stage * block_ + i];
    }
  values.array().colwise() *= carried_.array();
}

void CollocationStep::advance(long k, Eigen::MatrixXd& z) {
  if (factored_ != k) factor(k);
  start_ = z;
  multiply(right_of_, z, middles_);
  solver_.solve(middles_);
  combine(at_end_, end_);
  if (impulses_.is_restricted()) project();
  z = end_;
}

/// Of the impulse equations at the end of the step.
void CollocationStep::factor_impulses() {
  const auto n = static_cast<Index>(system_.size());
  std::vector<Eigen::Triplet<double>> terms;
  const MatrixEntries stiffness(impulses_.stiffness());
  for (const std::size_t e : rate_entries_)
    if (const double value = stiffness.values()[e]; value != 0.0)
      terms.emplace_back(entries_[e].row, entries_[e].column, -value);
  const Sparse change = subspace_.constraint_rates(end_time_);
  for (Index j = 0; j < change.outerSize(); ++j)
    for (Sparse::InnerIterator it(change, j); it; ++it)
      terms.emplace_back(subspace_.constraint_rows()[static_cast<std::size_t>(it.row())], j,
                         -it.value());
  rates_of_.resize(n, n);
  rates_of_.setFromTriplets(terms.begin(), terms.end());
  impulses_.factor(relative_tau * step_);
  has_impulses_ = true;
}

/// Finds the rates of eta at the end of the step and makes the velocities admissible.
void CollocationStep::project() {
  combine(rate_at_end_, rate_);
  multiply(rates_of_, end_, impulse_);
  multiply(impulses_.added(), rate_, impulse_, 1.0);
  impulses_.solve(impulse_);
  for (Index c = 0; c < end_.cols(); ++c)
    for (const PetscInt velocity : subspace_.velocities())
      end_(velocity, c) += impulse_(velocity, c);
}

void CollocationStep::sample(double fraction, Eigen::MatrixXd& values) const {
  sample(std::vector{fraction}, std::span(&values, 1));
}

/// All samples of a node and a column at once: the polynomials are read once.
void CollocationStep::sample(const std::vector<double>& fractions,
                             std::span<Eigen::MatrixXd> values) const {
  std::vector<double> nodes{0.0};
  nodes.insert(nodes.end(), points_.begin(), points_.end());
  if (nodes.back() < 1.0) nodes.push_back(1.0);
  const auto count = static_cast<std::size_t>(stages_);
  struct Weights {
    std::vector<double> carried;  // start, stages, end
    std::vector<double> others;   // stages
  };
  std::vector<Weights> all;
  for (const double fraction : fractions) {
    Weights one{std::vector<double>(count + 2, 0.0), std::vector<double>(count)};
    for (std::size_t a = 0; a < nodes.size(); ++a)
      one.carried[a] = math::lagrange(nodes, static_cast<int>(a), fraction);
    for (std::size_t a = 0; a < count; ++a)
      one.others[a] = math::lagrange(points_, static_cast<int>(a), fraction);
    all.push_back(std::move(one));
  }
  for (Eigen::MatrixXd& one : values) one.resize(start_.rows(), start_.cols());
  for (Index c = 0; c < start_.cols(); ++c)
    for (Index first = 0; first < start_.rows(); first += block_) {
      const double* start = &start_(first, c);
      const double* end = &end_(first, c);
      const double* stages = &middles_(first * stages_, c);
      const double* is_carried = &carried_(first);
      for (std::size_t n = 0; n < all.size(); ++n) {
        const auto& [carried, others] = all[n];
        double* result = &values[n](first, c);
        for (Index i = 0; i < block_; ++i)
          result[i] = is_carried[i] * (carried.front() * start[i] + carried.back() * end[i]);
        for (std::size_t stage = 0; stage < count; ++stage) {
          const double* middle = stages + static_cast<Index>(stage) * block_;
          const double difference = carried[stage + 1] - others[stage];
          for (Index i = 0; i < block_; ++i)
            result[i] += (others[stage] + is_carried[i] * difference) * middle[i];
        }
      }
    }
}

Eigen::MatrixXd CollocationStep::state() {
  if (!has_impulses_) factor_impulses();
  if (!impulses_.is_restricted()) project();
  Eigen::MatrixXd state(subspace_.size(), end_.cols());
  const Index d = subspace_.degrees_of_freedom();
  state.topRows(d) = subspace_.coordinates_of(end_);
  state.middleRows(d, d) = subspace_.coordinates_of(impulse_);
  state.bottomRows(subspace_.first_order()) = subspace_.states_of(end_);
  return state;
}

}  // namespace samara::analysis
