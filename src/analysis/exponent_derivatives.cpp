#include "samara/analysis/exponent_derivatives.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "samara/analysis/identification.hpp"
#include "samara/base/error.hpp"

#include "hill_bordered_solver.hpp"
#include "hill_groups.hpp"
#include "hill_pencil.hpp"
#include "hill_refinement.hpp"
#include "shape_series.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;
using Matrix = Eigen::MatrixXcd;

/// Harmonics of the series with which the refinement starts, at most.
constexpr int most_start_harmonics = 8;
/// Harmonics of the first attempt, the factor of the next one, and the most.
constexpr int least_harmonics = 6;
constexpr double increase = 1.5;
constexpr int most_harmonics = 32;
/// Change of an exponent from one attempt to the next that is small enough, also in a medium, whose
/// answer to a motion has a long series, and the largest one of a mode that was found; relative to
/// the exponent or to the rotor speed.
constexpr double wanted_change = 1e-8;
constexpr double wanted_in_medium = 1e-5;
constexpr double largest_change = 1e-4;
/// Largest distance of an exponent from that of the set, in the same measure.
constexpr double largest_distance = 1e-2;
/// Relative residuals of eigenpairs and of the solves for derivatives.
constexpr double pair_tolerance = 1e-11;
constexpr double solve_accuracy = 1e-9;
/// Exponents closer than this, relative to the rotor speed, count as equal.
constexpr double equal_exponents = 1e-6;

/// Whether no other exponent is equal to exponent i.
bool is_single(const Eigen::VectorXcd& exponents, Index i, double speed) {
  for (Index j = 0; j < exponents.size(); ++j)
    if (j != i && std::abs(exponents(j) - exponents(i)) < equal_exponents * speed) return false;
  return true;
}

/// Times that the tangents are sampled with a medium, each time between the instants before.
/// Curves of airfoils have kinks in their second derivatives, and tangents differentiated by a
/// number have them in time: what these leave in a derivative falls with the second power of the
/// number of samples.
constexpr int passes_in_medium = 8;
/// Columns that are multiplied together.
constexpr Index columns_at_once = 8;

/// A mode as an eigenpair next to its own harmonic.
struct Start {
  HillPair pair;
  HillPair before;   ///< with fewer harmonics
  int harmonic = 0;  ///< of the mode, from the exponent of the pair
};

/// The coefficients of vectors of one pencil in those of another with as many or more harmonics.
Matrix with_harmonics(const Matrix& vectors, Index width, Index wanted) {
  const Index unknowns = vectors.rows() / width;
  Matrix result = Matrix::Zero(unknowns * wanted, vectors.cols());
  for (Index i = 0; i < unknowns; ++i)
    result.middleRows(i * wanted + (wanted - width) / 2, width) =
        vectors.middleRows(i * width, width);
  return result;
}

/// The inverse of with_harmonics(), of the harmonics that the other pencil has.
Matrix without_harmonics(const Matrix& vectors, Index width, Index wanted) {
  const Index unknowns = vectors.rows() / width;
  Matrix result(unknowns * wanted, vectors.cols());
  for (Index i = 0; i < unknowns; ++i)
    result.middleRows(i * wanted, wanted) =
        vectors.middleRows(i * width + (width - wanted) / 2, wanted);
  return result;
}

void append(Matrix& to, const Matrix& columns) {
  to.conservativeResize(columns.rows(), to.cols() + columns.cols());
  to.rightCols(columns.cols()) = columns;
}

}  // namespace

/// Eigenpairs of all modes, each in a pencil with as many harmonics as it needs.
class ExponentDerivatives::Basis {
 public:
  /// Neighbouring eigenpairs of a pencil.
  struct Subspace {
    std::size_t level = 0;             ///< of its pencil
    std::vector<std::size_t> members;  ///< numbers of starts; beyond them: a conjugate
    Matrix X, T, mass;
    Matrix vectors;              ///< eigenvectors of T
    Eigen::VectorXcd exponents;  ///< eigenvalues of T
  };
  /// With the last number of harmonics, and with the one before.
  struct Group {
    Subspace now, before;
  };

  Basis(const system::PeriodicSystem& system, const PeriodicSolution& solution, const ModeSet& set,
        bool by_sector)
      : system_(system), solution_(solution), by_sector_(by_sector) {
    add_pencil(std::max(least_harmonics, solution.harmonics()));
    if (!pencil().is_solvable())
      throw InputError(
          "floquet: derivatives of exponents need a turbine whose blades are chains of elements; "
          "hint: blades.elements of 2 or more");
    for (std::size_t m = 0; m < set.modes.size(); ++m) starts_.push_back(start_of(set, m));
    refine();
  }

  HillPencil& pencil(std::size_t level) { return *pencils_[level]; }
  std::size_t levels() const { return pencils_.size(); }
  const std::vector<Group>& groups() const { return groups_; }
  /// The subspaces of a level.
  struct Place {
    std::size_t group = 0;
    bool is_now = true;
  };
  std::vector<Place> places(std::size_t level) const {
    std::vector<Place> places;
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (const bool is_now : {true, false})
        if (subspace({g, is_now}).level == level) places.push_back({g, is_now});
    return places;
  }
  const Subspace& subspace(const Place& place) const {
    const Group& group = groups_[place.group];
    return place.is_now ? group.now : group.before;
  }
  const std::vector<Start>& starts() const { return starts_; }
  double speed() const { return pencils_.front()->speed(); }

 private:
  HillPencil& pencil() { return *pencils_.back(); }
  const HillPencil& pencil() const { return *pencils_.back(); }
  void add_pencil(int harmonics) {
    pencils_.push_back(std::make_unique<HillPencil>(system_, solution_, harmonics, by_sector_));
  }

  /// The copy of a mode's motion next to its own harmonic that the pencil has; none of a mode at
  /// rest or without a shape.
  Start start_of(const ModeSet& set, std::size_t m) const {
    const Mode& mode = set.modes[m];
    Start start{{mode.exponent, {}}, {}, 0};
    if (set.shapes[m].size() == 0 || std::abs(mode.exponent) < zero_exponent * speed())
      return start;
    const int harmonics = harmonics_of_samples(set.shape_times.size(), most_start_harmonics);
    const Matrix series =
        (centred_shape(set, m) * harmonics_fit(set.shape_times, speed(), harmonics)).transpose();
    // Copies that the pencil has are `sectors` harmonics apart.
    const int sectors = pencil().sectors();
    double least = std::numeric_limits<double>::infinity();
    for (int shift = -(sectors / 2); shift < sectors - sectors / 2; ++shift) {
      const Matrix copy = shifted_series(series, shift, 2 * pencil().harmonics() + 1);
      const double missing =
          (pencil().series_of(pencil().vector_of(copy)) - copy).norm() / copy.norm();
      if (missing >= least) continue;
      least = missing;
      start = {{mode.exponent + Complex(0.0, shift * speed()), copy}, {}, -shift};
    }
    return start;
  }

  /// Refines the pairs with more and more harmonics. Groups whose exponents do not change any more
  /// stay with their pencil; modes whose exponents do not settle have no group.
  void refine() {
    std::vector<Complex> given;
    std::vector<std::size_t> active;
    for (std::size_t i = 0; i < starts_.size(); ++i) {
      given.push_back(starts_[i].pair.exponent);
      if (starts_[i].pair.series.size() > 0) active.push_back(i);
    }
    const double wanted = pencil().has_medium() ? wanted_in_medium : wanted_change;
    std::vector<Complex> before(starts_.size(), std::numeric_limits<double>::infinity());
    while (true) {
      for (const std::size_t i : active) starts_[i].before = starts_[i].pair;
      refine_once(active);
      const bool is_last = pencil().harmonics() >= most_harmonics;
      std::vector<std::size_t> left;
      for (const std::vector<std::size_t>& group : groups_among(active)) {
        double change = 0.0;
        double distance = 0.0;
        for (const std::size_t i : group) {
          const Complex exponent = starts_[i].pair.exponent;
          const double unit = unit_of_change(exponent, speed());
          change = std::max(change, std::abs(exponent - before[i]) / unit);
          distance = std::max(distance, std::abs(exponent - given[i]) / unit);
          before[i] = exponent;
        }
        if (change > wanted && !is_last)
          left.insert(left.end(), group.begin(), group.end());
        else if (change <= largest_change && distance <= largest_distance)
          groups_.push_back({subspace_of(group, &Start::pair, pencils_.size() - 1),
                             subspace_of(group, &Start::before, pencils_.size() - 2)});
      }
      active = left;
      if (active.empty()) return;
      add_pencil(
          std::min(most_harmonics, static_cast<int>(std::ceil(increase * pencil().harmonics()))));
    }
  }

  /// Numbers of starts with neighbouring exponents.
  std::vector<std::vector<std::size_t>> groups_among(const std::vector<std::size_t>& active) const {
    std::vector<HillPair> pairs;
    for (const std::size_t i : active) pairs.push_back(starts_[i].pair);
    std::vector<std::vector<std::size_t>> groups;
    std::vector<char> is_taken(active.size(), 0);
    for (const HillGroup& group : groups_of(pairs, speed())) {
      std::vector<std::size_t> numbers;
      for (const HillPair& pair : group.pairs)
        for (std::size_t a = 0; a < active.size(); ++a)
          if (!is_taken[a] && pair.exponent == starts_[active[a]].pair.exponent) {
            is_taken[a] = 1;
            numbers.push_back(active[a]);
            break;
          }
      if (!numbers.empty()) groups.push_back(std::move(numbers));
    }
    return groups;
  }

  void refine_once(const std::vector<std::size_t>& active) {
    HillRefinement refinement(pencil());
    for (const std::vector<std::size_t>& numbers : groups_among(active)) {
      std::vector<HillPair> pairs = pairs_of(numbers, &Start::pair);
      refinement.refine(pairs, pair_tolerance);
      // Eigenpairs come in any order: each mode takes the one that it resembles most.
      for (const std::size_t i : numbers) starts_[i].pair = closest(starts_[i].pair, pairs);
    }
  }

  /// Those of a group, with the conjugates of slow ones.
  std::vector<HillPair> pairs_of(const std::vector<std::size_t>& numbers,
                                 HillPair Start::*which) const {
    std::vector<HillPair> pairs;
    for (const std::size_t i : numbers) pairs.push_back(starts_[i].*which);
    return groups_of(pairs, speed()).front().pairs;
  }

  HillPair closest(const HillPair& given, const std::vector<HillPair>& pairs) const {
    const HillPencil::Vector own = pencil().vector_of(given.series).normalized();
    const auto likeness = [&](const HillPair& pair) {
      return std::abs(own.dot(pencil().vector_of(pair.series).normalized()));
    };
    return *std::ranges::max_element(pairs, {}, likeness);
  }

  Subspace subspace_of(const std::vector<std::size_t>& numbers, HillPair Start::*which,
                       std::size_t level) {
    HillPencil& own = pencil(level);
    const std::vector<HillPair> pairs = pairs_of(numbers, which);
    const auto count = static_cast<Index>(pairs.size());
    Subspace subspace;
    subspace.level = level;
    subspace.members.assign(pairs.size(), starts_.size());
    Matrix X(own.size(), count);
    Matrix T = Matrix::Zero(count, count);
    for (Index j = 0; j < count; ++j) {
      const HillPair& pair = pairs[static_cast<std::size_t>(j)];
      X.col(j) = own.vector_of(pair.series).normalized();
      T(j, j) = pair.exponent;
      // A conjugate is no member.
      for (const std::size_t i : numbers)
        if ((starts_[i].*which).exponent == pair.exponent &&
            std::ranges::find(subspace.members, i) == subspace.members.end()) {
          subspace.members[static_cast<std::size_t>(j)] = i;
          break;
        }
    }
    // Of an orthonormal basis of the same subspace, X = Q R: T becomes R T R^-1, and the columns of
    // R are its eigenvectors.
    const Eigen::HouseholderQR<Matrix> qr(X);
    subspace.vectors = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>().toDenseMatrix();
    subspace.X = qr.householderQ() * Matrix::Identity(X.rows(), count);
    subspace.exponents = T.diagonal();
    subspace.T = subspace.vectors * T * subspace.vectors.inverse();
    subspace.mass.resize(subspace.X.rows(), count);
    own.multiply_mass(subspace.X, subspace.mass);
    return subspace;
  }

  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  bool by_sector_;
  std::vector<std::unique_ptr<HillPencil>> pencils_;
  std::vector<Start> starts_;
  std::vector<Group> groups_;
};

ExponentDerivatives::ExponentDerivatives(const system::PeriodicSystem& system,
                                         const PeriodicSolution& solution, const ModeSet& set)
    : system_(system), solution_(solution), set_(set) {}

ExponentDerivatives::~ExponentDerivatives() = default;

ExponentDerivatives::Basis& ExponentDerivatives::basis(bool by_sector) {
  std::unique_ptr<Basis>& own = by_sector ? sector_ : whole_;
  if (!own) own = std::make_unique<Basis>(system_, solution_, set_, by_sector);
  return *own;
}

ExponentDerivatives::Residuals ExponentDerivatives::residuals(const system::PeriodicSystem& other,
                                                              const PeriodicSolution& solution,
                                                              bool by_sector) {
  Basis& own = basis(by_sector);
  Residuals residuals;
  residuals.by_sector = by_sector;
  const HillPencil& last = own.pencil(own.levels() - 1);
  HillPencil pencil(other, solution, last.harmonics(), by_sector, true);
  residuals.speed = pencil.speed();
  // The motions of each level and their residuals, with the harmonics of the last one.
  struct Level {
    Matrix X, W;  ///< A X + B W
    Matrix of_all, of_half;
  };
  std::vector<Level> levels;
  for (std::size_t level = 0; level < own.levels(); ++level) {
    const Index width = own.pencil(level).width();
    Matrix X, W;
    for (const Basis::Place& place : own.places(level)) {
      const Basis::Subspace& subspace = own.subspace(place);
      append(X, subspace.X);
      append(W, subspace.X * subspace.T);
    }
    const Matrix none = Matrix::Zero(pencil.size(), X.cols());
    levels.push_back({with_harmonics(X, width, pencil.width()),
                      with_harmonics(W, width, pencil.width()), none, none});
  }
  const int passes = pencil.has_medium() ? passes_in_medium : 1;
  Matrix product;
  for (int pass = 0; pass < passes; ++pass) {
    if (pass > 0) pencil.sample(solution, static_cast<double>(pass) / passes);
    for (std::size_t level = 0; level < levels.size(); ++level) {
      pencil.take_scales(own.pencil(level));
      auto& [X, W, of_all, of_half] = levels[level];
      for (Index first = 0; first < X.cols(); first += columns_at_once) {
        const Index count = std::min(columns_at_once, X.cols() - first);
        product.resize(X.rows(), count);
        pencil.multiply(X.middleCols(first, count), W.middleCols(first, count), product);
        pencil.drop_deferred(product);
        of_all.middleCols(first, count) += product / passes;
        if (pass % 2 == 0) of_half.middleCols(first, count) += 2.0 * product / passes;
      }
    }
  }
  residuals.groups.resize(own.groups().size());
  residuals.before.resize(own.groups().size());
  if (pencil.has_medium()) residuals.of_half.resize(own.groups().size());
  for (std::size_t level = 0; level < levels.size(); ++level) {
    Index first = 0;
    for (const auto& [group, is_now] : own.places(level)) {
      const Index count = own.subspace({group, is_now}).X.cols();
      const auto part = [&](const Matrix& all) {
        return without_harmonics(all.middleCols(first, count), pencil.width(),
                                 own.pencil(level).width());
      };
      (is_now ? residuals.groups : residuals.before)[group] = part(levels[level].of_all);
      if (is_now && pencil.has_medium()) residuals.of_half[group] = part(levels[level].of_half);
      first += count;
    }
  }
  return residuals;
}

std::vector<ExponentDerivatives::Derivatives> ExponentDerivatives::derivatives(
    const std::vector<Residuals>& rates) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto count = static_cast<Index>(set_.modes.size());
  std::vector<Derivatives> result(
      rates.size(),
      {Eigen::VectorXcd::Constant(count, Complex(none, none)), Eigen::VectorXd::Zero(count)});
  for (const bool by_sector : {true, false}) {
    if (std::ranges::none_of(
            rates, [by_sector](const Residuals& one) { return one.by_sector == by_sector; }))
      continue;
    Basis& own = basis(by_sector);
    const double speed = own.speed();
    // Of the members of a group, from a residual.
    const auto find = [&](HillBorderedSolver& solver, const Basis::Subspace& subspace,
                          const Matrix& rate) {
      // In the basis of the eigenvectors, T is diagonal; the diagonal of its change is that of
      // the exponents, where these are different.
      const Matrix change = subspace.vectors.inverse() * solver.solve(-rate).D * subspace.vectors;
      Eigen::VectorXcd found = Eigen::VectorXcd::Constant(count, Complex(none, none));
      for (std::size_t j = 0; j < subspace.members.size(); ++j) {
        const auto at = static_cast<Index>(j);
        const auto member = static_cast<Index>(subspace.members[j]);
        if (member < count && is_single(subspace.exponents, at, speed))
          found(member) = change(at, at);
      }
      return found;
    };
    const auto solver_of = [&](const Basis::Subspace& subspace) {
      return HillBorderedSolver(own.pencil(subspace.level), subspace.X, subspace.T, subspace.mass,
                                solve_accuracy);
    };
    for (std::size_t g = 0; g < own.groups().size(); ++g) {
      const Basis::Group& group = own.groups()[g];
      HillBorderedSolver now = solver_of(group.now);
      HillBorderedSolver before = solver_of(group.before);
      for (std::size_t p = 0; p < rates.size(); ++p) {
        const Residuals& rate = rates[p];
        if (rate.by_sector != by_sector) continue;
        const Eigen::VectorXcd found = find(now, group.now, rate.groups[g]);
        for (const std::size_t member : group.now.members) {
          const auto m = static_cast<Index>(member);
          if (m >= count || std::isnan(found(m).real())) continue;
          result[p].values(m) = found(m) + Complex(0.0, own.starts()[member].harmonic * rate.speed);
        }
        const auto add_errors = [&](const Eigen::VectorXcd& other) {
          for (const std::size_t member : group.now.members)
            if (const auto m = static_cast<Index>(member); m < count)
              result[p].errors(m) +=
                  std::isnan(other(m).real()) ? std::abs(found(m)) : std::abs(found(m) - other(m));
        };
        if (!rate.of_half.empty()) add_errors(find(now, group.now, rate.of_half[g]));
        if (!rate.before.empty()) add_errors(find(before, group.before, rate.before[g]));
      }
    }
  }
  return result;
}

ExponentDerivatives::Residuals combine(double a, const ExponentDerivatives::Residuals& R, double b,
                                       const ExponentDerivatives::Residuals& S) {
  using Residuals = ExponentDerivatives::Residuals;
  Residuals sum;
  sum.by_sector = R.by_sector;
  sum.speed = a * R.speed + b * S.speed;
  const auto add = [a, b](const Residuals::Groups& r, const Residuals::Groups& s) {
    Residuals::Groups groups;
    for (std::size_t g = 0; g < r.size(); ++g) groups.push_back(a * r[g] + b * s[g]);
    return groups;
  };
  sum.groups = add(R.groups, S.groups);
  sum.of_half = add(R.of_half, S.of_half);
  sum.before = add(R.before, S.before);
  return sum;
}

}  // namespace samara::analysis
