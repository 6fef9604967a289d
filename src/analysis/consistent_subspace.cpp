#include "samara/analysis/consistent_subspace.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <Eigen/QR>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/sparse_parts.hpp"
#include "samara/base/error.hpp"

namespace samara::analysis {
namespace {

/// Smallest pivot: below it no strain yields in a direction in which a beam is held twice.
constexpr double least_pivot = 1e-9;
/// Step of the differences in time, relative to the period, and their weights at 1 and 2 steps. At
/// 10 harmonics the error is 3e-12, at 30 harmonics 3e-10.
constexpr double relative_step = 5e-5;
constexpr std::array<double, 2> difference_weights{2.0 / 3.0, -1.0 / 12.0};

}  // namespace

ConsistentSubspace::ConsistentSubspace(const system::PeriodicSystem& system,
                                       const PeriodicSolution& solution)
    : system_(system), solution_(solution) {
  require_roles(system);
  const auto n = static_cast<std::size_t>(system.size());
  const SparseTangents at_start = tangents_on(system, solution, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    if (system.rows()[i] == system::RowRole::constraint)
      constraints_.push_back(static_cast<PetscInt>(i));
  carried_ = system.differential();
  std::vector<PetscInt> free;
  for (std::size_t j = 0; j < n; ++j) {
    double largest = 0.0;
    for (Sparse::InnerIterator it(at_start.K, static_cast<Eigen::Index>(j)); it; ++it)
      if (system.rows()[static_cast<std::size_t>(it.row())] == system::RowRole::constraint)
        largest = std::max(largest, std::abs(it.value()));
    const auto column = static_cast<PetscInt>(j);
    const system::UnknownRole role = system.unknowns()[j].role;
    if (role == system::UnknownRole::position) {
      const bool is_tied = largest > 0.0 && !system.unknowns()[j].is_free;
      (is_tied ? tied_ : free).push_back(column);
    }
    if (largest > 0.0 && role == system::UnknownRole::internal) {
      coordinates_.push_back(column);
      scale_.push_back(1.0 / largest);
      carried_[j] = true;
    }
  }
  for (const PetscInt column : free) {
    coordinates_.push_back(column);
    scale_.push_back(1.0);
  }
  tie_coordinates(at_start.K);
  if (tied_.size() != constraints_.size())
    throw InternalError(std::to_string(constraints_.size()) + " constraints for " +
                        std::to_string(tied_.size()) + " positions");
  for (const PetscInt column : tied_) carried_[static_cast<std::size_t>(column)] = true;
  for (std::size_t i = 0; i < n; ++i) {
    if (system.rows()[i] == system::RowRole::kinematic)
      kinematic_.push_back(static_cast<PetscInt>(i));
    if (system.unknowns()[i].role == system::UnknownRole::velocity)
      velocities_.push_back(static_cast<PetscInt>(i));
    if (system.unknowns()[i].role == system::UnknownRole::position)
      positions_.push_back(static_cast<PetscInt>(i));
  }
  find_states(at_start);
  fixed_constraints_ = solution.is_constant() && system.constraints_are_autonomous();
}

/// The evolution row of a state has the number of the state. Definition rows have no rates.
void ConsistentSubspace::find_states(const SparseTangents& at_start) {
  for (std::size_t i = 0; i < system_.rows().size(); ++i) {
    if (system_.rows()[i] != system::RowRole::evolution) continue;
    states_.push_back(static_cast<PetscInt>(i));
    state_scale_.push_back(system_.unknowns()[i].scale);
  }
  if (states_.empty() && !std::ranges::count(system_.rows(), system::RowRole::definition)) return;
  const std::vector<std::vector<PetscInt>> pattern = system_.pattern();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const auto contains_it = [&](PetscInt row) {
      return std::ranges::binary_search(pattern[static_cast<std::size_t>(row)], states_[i]);
    };
    if (std::ranges::none_of(constraints_, contains_it)) continue;
    driving_.push_back(states_[i]);
    driving_places_.push_back(static_cast<Eigen::Index>(i));
  }
  const SparseSolver regular(part(at_start.M, states_, states_), "evolution rows");
  require_no_rates(at_start.M);
  if (system_.period() > 0.0)
    for (const double turn : {0.12, 0.31, 0.47, 0.78})
      require_no_rates(tangents_on(system_, solution_, turn * system_.period()).M);
}

/// Checks that constraint and definition rows contain no rates, and kinematic rows no rates of
/// states.
void ConsistentSubspace::require_no_rates(const Eigen::SparseMatrix<double>& M) const {
  for (Eigen::Index j = 0; j < M.outerSize(); ++j)
    for (Sparse::InnerIterator it(M, j); it; ++it) {
      const auto row = static_cast<std::size_t>(it.row());
      const system::RowRole role = system_.rows()[row];
      const bool is_state =
          system_.unknowns()[static_cast<std::size_t>(j)].role == system::UnknownRole::state;
      if (it.value() != 0.0 &&
          (role == system::RowRole::definition || role == system::RowRole::constraint ||
           (role == system::RowRole::kinematic && is_state)))
        throw InternalError(std::string("the ") + word_of(role) + " row of \"" +
                            name_of(static_cast<PetscInt>(it.row())) +
                            "\" contains the rate of \"" + name_of(static_cast<PetscInt>(j)) + '"');
    }
}

/// Rates of xi in the states that are the columns of z: only those of states that constraint rows
/// contain, the others are zero here. They come from their own evolution rows, which contain no
/// velocities or loads (require_roles). They are therefore known before the velocities.
Eigen::MatrixXd ConsistentSubspace::driving_rates(const Eigen::SparseMatrix<double>& K,
                                                  const Eigen::SparseMatrix<double>& M,
                                                  const Eigen::MatrixXd& z) const {
  std::vector<PetscInt> others = positions_;
  others.insert(others.end(), states_.begin(), states_.end());
  const Sparse inertia = rows_of(M, driving_);
  for (Eigen::Index j = 0; j < inertia.outerSize(); ++j)
    for (Sparse::InnerIterator it(inertia, j); it; ++it)
      if (it.value() != 0.0 && !std::ranges::binary_search(driving_, static_cast<PetscInt>(j)))
        throw InternalError("the evolution row of \"" +
                            name_of(driving_[static_cast<std::size_t>(it.row())]) +
                            "\", a state in a constraint row, contains the rate of \"" +
                            name_of(static_cast<PetscInt>(j)) + '"');
  return spread_rates(SparseSolver(part(M, driving_, driving_), "evolution rows")
                          .solve(-(part(K, driving_, others) * z(others, Eigen::all))));
}

Eigen::MatrixXd ConsistentSubspace::spread_rates(const Eigen::MatrixXd& rates) const {
  Eigen::MatrixXd xi_dot = Eigen::MatrixXd::Zero(first_order(), rates.cols());
  for (std::size_t i = 0; i < driving_.size(); ++i)
    xi_dot.row(driving_places_[i]) = rates.row(static_cast<Eigen::Index>(i)) /
                                     state_scale_[static_cast<std::size_t>(driving_places_[i])];
  return xi_dot;
}

std::string ConsistentSubspace::name_of(PetscInt unknown) const {
  return system_.unknowns()[static_cast<std::size_t>(unknown)].name();
}

/// Places in eta of a coordinate and of all its images under the rotor's symmetry, in ascending
/// order.
std::vector<std::size_t> ConsistentSubspace::images_of(std::size_t coordinate) const {
  const system::RotorSymmetry& symmetry = system_.symmetry();
  std::vector<std::size_t> places{coordinate};
  if (symmetry.sectors < 2) return places;
  PetscInt unknown = coordinates_[coordinate];
  for (int q = 1; q < symmetry.sectors; ++q) {
    unknown = symmetry.source[static_cast<std::size_t>(unknown)];
    const auto found = std::find(coordinates_.begin(), coordinates_.end(), unknown);
    const auto place = static_cast<std::size_t>(found - coordinates_.begin());
    if (found == coordinates_.end()) throw InternalError("a coordinate without its image");
    if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
  }
  std::sort(places.begin(), places.end());
  return places;
}

void ConsistentSubspace::tie_coordinates(const Eigen::SparseMatrix<double>& K) {
  if (constraints_.size() <= tied_.size()) return;
  // Beams held at both ends: the tied positions satisfy as many constraints as there are tied
  // positions. The remaining constraints, W^T D p = 0 with W^T D_tied = 0, tie the coordinates of
  // their pivots.
  const auto excess = static_cast<Eigen::Index>(constraints_.size() - tied_.size());
  const Eigen::MatrixXd D_tied = part(K, constraints_, tied_);
  const Eigen::MatrixXd D_free =
      part(K, constraints_, coordinates_) *
      Eigen::Map<const Eigen::VectorXd>(scale_.data(), degrees_of_freedom()).asDiagonal();
  const Eigen::HouseholderQR<Eigen::MatrixXd> tied_qr(D_tied);
  const Eigen::MatrixXd W = Eigen::MatrixXd(tied_qr.householderQ()).rightCols(excess);
  Eigen::MatrixXd rest = W.transpose() * D_free;
  // Coordinates that the rotor's symmetry maps onto each other are tied together; otherwise P would
  // not map eta onto eta. The image with the shortest remaining column decides the choice of
  // pivots.
  std::vector<bool> chosen(coordinates_.size(), false);
  for (Eigen::Index count = 0; count < excess;) {
    std::vector<std::size_t> best;
    double largest = 0.0;
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const std::vector<std::size_t> alike = images_of(i);
      if (chosen[i] || alike.front() != i) continue;
      if (count + static_cast<Eigen::Index>(alike.size()) > excess) continue;
      double shortest = rest.col(static_cast<Eigen::Index>(i)).norm();
      for (const std::size_t j : alike)
        shortest = std::min(shortest, rest.col(static_cast<Eigen::Index>(j)).norm());
      if (shortest > largest) {
        largest = shortest;
        best = alike;
      }
    }
    for (const std::size_t i : best) {
      const Eigen::VectorXd column = rest.col(static_cast<Eigen::Index>(i));
      // Columns of D are scaled to entries of about one.
      if (column.norm() < least_pivot) best.clear();
      if (best.empty()) break;
      const Eigen::VectorXd direction = column.normalized();
      rest -= direction * (direction.transpose() * rest);
      chosen[i] = true;
      ++count;
    }
    if (best.empty())
      throw InputError(
          "the supports of a beam hold it twice in a direction in which it is rigid; hint: a "
          "spring instead of a rigid direction of the support");
  }
  std::vector<PetscInt> coordinates;
  std::vector<double> scale;
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    if (chosen[i]) {
      tied_.push_back(coordinates_[i]);
      tied_scale_.push_back(scale_[i]);
      continue;
    }
    coordinates.push_back(coordinates_[i]);
    scale.push_back(scale_[i]);
  }
  coordinates_ = coordinates;
  scale_ = scale;
}

Eigen::MatrixXd ConsistentSubspace::coordinates_of(const Eigen::MatrixXd& z) const {
  Eigen::MatrixXd eta(degrees_of_freedom(), z.cols());
  for (std::size_t i = 0; i < coordinates_.size(); ++i)
    eta.row(static_cast<Eigen::Index>(i)) = z.row(coordinates_[i]) / scale_[i];
  return eta;
}

Eigen::MatrixXd ConsistentSubspace::states_of(const Eigen::MatrixXd& z) const {
  Eigen::MatrixXd xi(first_order(), z.cols());
  for (std::size_t i = 0; i < states_.size(); ++i)
    xi.row(static_cast<Eigen::Index>(i)) = z.row(states_[i]) / state_scale_[i];
  return xi;
}

/// Columns for a unit of each entry of eta and of xi: positions, internal loads in eta, and states.
Eigen::MatrixXd ConsistentSubspace::positions(const Sparse& K, const SparseSolver& tied) const {
  const auto d = static_cast<Eigen::Index>(degrees_of_freedom());
  const auto n_1 = static_cast<Eigen::Index>(first_order());
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(system_.size(), d + n_1);
  for (Eigen::Index i = 0; i < d; ++i)
    z(coordinates_[static_cast<std::size_t>(i)], i) = scale_[static_cast<std::size_t>(i)];
  for (Eigen::Index i = 0; i < n_1; ++i)
    z(states_[static_cast<std::size_t>(i)], d + i) = state_scale_[static_cast<std::size_t>(i)];
  Eigen::MatrixXd strained(static_cast<Eigen::Index>(constraints_.size()), d + n_1);
  strained.leftCols(d) = part(K, constraints_, coordinates_) *
                         Eigen::Map<const Eigen::VectorXd>(scale_.data(), d).asDiagonal();
  strained.rightCols(n_1) =
      part(K, constraints_, states_) *
      Eigen::Map<const Eigen::VectorXd>(state_scale_.data(), n_1).asDiagonal();
  z(tied_, Eigen::all) = tied.solve(-strained);
  return z;
}

Sparse ConsistentSubspace::constraint_rates(double t) const {
  Sparse rates(static_cast<Eigen::Index>(constraints_.size()), system_.size());
  if (fixed_constraints_ || system_.period() == 0.0) return rates;
  const double step = relative_step * system_.period();
  for (std::size_t n = 0; n < difference_weights.size(); ++n)
    for (const double side : {-1.0, 1.0}) {
      const double shift = side * static_cast<double>(n + 1) * step;
      rates += side * difference_weights[n] / step *
               rows_of(tangents_on(system_, solution_, t + shift).K, constraints_);
    }
  return rates;
}

Eigen::MatrixXd ConsistentSubspace::basis(double t) const {
  const auto d = static_cast<Eigen::Index>(degrees_of_freedom());
  const auto n_1 = static_cast<Eigen::Index>(first_order());
  const Eigen::Index n = system_.size();
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(n, 2 * d + n_1);
  Eigen::MatrixXd z_dot = Eigen::MatrixXd::Zero(n, 2 * d + n_1);  // of positions
  const SparseTangents tangents = tangents_on(system_, solution_, t);
  const SparseSolver tied(part(tangents.K, constraints_, tied_), "constraints");
  const Eigen::MatrixXd Z = positions(tangents.K, tied);
  z.leftCols(d) = Z.leftCols(d);
  z.rightCols(n_1) = Z.rightCols(n_1);
  z_dot.middleCols(d, d) = Z.leftCols(d);
  // D p_dot + D_dot p = 0, where eta and xi do not change.
  if (const Sparse change = constraint_rates(t); change.nonZeros() > 0) {
    const Eigen::MatrixXd Z_dot = tied.solve(-(change * Z));
    z_dot(tied_, Eigen::seqN(0, d)) = Z_dot.leftCols(d);
    z_dot(tied_, Eigen::seqN(2 * d, n_1)) = Z_dot.rightCols(n_1);
  }
  if (!driving_.empty()) z_dot += Z.rightCols(n_1) * driving_rates(tangents.K, tangents.M, z);
  const Eigen::MatrixXd p = z(positions_, Eigen::all);
  const Eigen::MatrixXd p_dot = z_dot(positions_, Eigen::all);
  Eigen::MatrixXd right = part(tangents.K, kinematic_, positions_) * p +
                          part(tangents.M, kinematic_, positions_) * p_dot;
  if (n_1 > 0) right += part(tangents.K, kinematic_, states_) * z(states_, Eigen::all);
  const Eigen::MatrixXd v =
      SparseSolver(part(tangents.K, kinematic_, velocities_), "kinematic rows").solve(-right);
  for (std::size_t i = 0; i < velocities_.size(); ++i)
    z.row(velocities_[i]) = v.row(static_cast<Eigen::Index>(i));
  return z;
}

/// Writes the rates of the states that constraint rows contain into `rates`. The evolution rows of
/// these states are linear in the rates.
void ConsistentSubspace::find_driving_rates(double t, Vec z, Eigen::MatrixXd& rates) const {
  const petsc::Handle<Vec> z_dot = system_.make_state();
  const petsc::Handle<Vec> r = system_.make_state();
  const petsc::Handle<Mat> jacobian = system_.make_jacobian();
  const petsc::Handle<Mat> mass = system_.make_mass();
  system_.residual(t, z, z_dot.get(), r.get());
  system_.tangents(t, z, z_dot.get(), 0.0, jacobian.get(), mass.get());
  Eigen::VectorXd right(static_cast<Eigen::Index>(driving_.size()));
  {
    const petsc::ReadView view(r.get());
    for (std::size_t i = 0; i < driving_.size(); ++i)
      right(static_cast<Eigen::Index>(i)) = -view[driving_[i]];
  }
  rates(driving_, 0) =
      SparseSolver(part(to_sparse(mass.get()), driving_, driving_), "evolution rows").solve(right);
}

void ConsistentSubspace::find_state(double t, const Eigen::VectorXd& reduced, Vec z) const {
  const Eigen::Index d = degrees_of_freedom();
  const Eigen::VectorXd eta = reduced.head(d);
  const Eigen::VectorXd eta_dot = reduced.segment(d, d);
  const Eigen::VectorXd xi = reduced.tail(first_order());
  constexpr int most_steps = 30;
  constexpr double tolerance = 1e-13;
  const auto n = static_cast<Eigen::Index>(system_.size());
  const petsc::Handle<Vec> z_dot = system_.make_state();
  const petsc::Handle<Vec> r = system_.make_state();
  const petsc::Handle<Mat> jacobian = system_.make_jacobian();
  const auto rows_of = [&r](const std::vector<PetscInt>& rows) {
    const petsc::ReadView view(r.get());
    Eigen::VectorXd values(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
      values(static_cast<Eigen::Index>(i)) = view[rows[i]];
    return values;
  };
  {
    const petsc::WriteView view(z);
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      view[coordinates_[i]] = scale_[i] * eta(static_cast<Eigen::Index>(i));
    for (std::size_t i = 0; i < states_.size(); ++i)
      view[states_[i]] = state_scale_[i] * xi(static_cast<Eigen::Index>(i));
  }
  Eigen::SparseMatrix<double> K;
  for (int step = 0;; ++step) {
    system_.residual(t, z, z_dot.get(), r.get());
    system_.tangents(t, z, z_dot.get(), 0.0, jacobian.get(), nullptr);
    K = to_sparse(jacobian.get());
    const Eigen::VectorXd change =
        SparseSolver(part(K, constraints_, tied_), "constraints").solve(-rows_of(constraints_));
    const petsc::WriteView view(z);
    for (std::size_t i = 0; i < tied_.size(); ++i)
      view[tied_[i]] += change(static_cast<Eigen::Index>(i));
    Eigen::VectorXd scaled = change;
    for (std::size_t i = 0; i < tied_scale_.size(); ++i)
      scaled(scaled.size() - static_cast<Eigen::Index>(tied_scale_.size() - i)) /= tied_scale_[i];
    if (change.size() == 0 || scaled.norm() < tolerance) break;
    if (step == most_steps)
      throw ConvergenceError("no consistent state: the constraints do not converge");
  }
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(n, 1);
  for (std::size_t i = 0; i < coordinates_.size(); ++i)
    rates(coordinates_[i], 0) = scale_[i] * eta_dot(static_cast<Eigen::Index>(i));
  if (!driving_.empty()) find_driving_rates(t, z, rates);
  Eigen::MatrixXd strained =
      part(K, constraints_, coordinates_) *
      (Eigen::Map<const Eigen::VectorXd>(scale_.data(), eta_dot.size()).cwiseProduct(eta_dot));
  if (!driving_.empty()) strained += part(K, constraints_, states_) * rates(states_, Eigen::all);
  const Eigen::MatrixXd tied =
      SparseSolver(part(K, constraints_, tied_), "constraints").solve(-strained);
  for (std::size_t i = 0; i < tied_.size(); ++i)
    rates(tied_[i], 0) = tied(static_cast<Eigen::Index>(i), 0);
  {
    const petsc::WriteView view(z_dot.get());
    Eigen::Map<Eigen::VectorXd>(view.data(), n) = rates.col(0);
  }
  system_.residual(t, z, z_dot.get(), r.get());
  const Eigen::VectorXd change =
      SparseSolver(part(K, kinematic_, velocities_), "kinematic rows").solve(-rows_of(kinematic_));
  const petsc::WriteView view(z);
  for (std::size_t i = 0; i < velocities_.size(); ++i)
    view[velocities_[i]] += change(static_cast<Eigen::Index>(i));
}

}  // namespace samara::analysis
