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

/// A mode as an eigenpair next to its own harmonic.
struct Start {
  HillPair pair;
  int harmonic = 0;  ///< of the mode, from the exponent of the pair
  double change = std::numeric_limits<double>::quiet_NaN();  ///< of the exponent, the last one
};

}  // namespace

/// Eigenpairs of all modes, each in a pencil with as many harmonics as it needs.
class ExponentDerivatives::Basis {
 public:
  /// Neighbouring eigenpairs.
  struct Group {
    std::size_t level = 0;             ///< of its pencil
    std::vector<std::size_t> members;  ///< numbers of starts; beyond them: a conjugate
    Matrix X, T, mass;
    Matrix vectors;              ///< eigenvectors of T
    Eigen::VectorXcd exponents;  ///< eigenvalues of T
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
    Start start{{mode.exponent, {}}, 0};
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
      start = {{mode.exponent + Complex(0.0, shift * speed()), copy}, -shift};
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
        else if (change <= largest_change && distance <= largest_distance) {
          for (const std::size_t i : group)
            starts_[i].change = change * unit_of_change(starts_[i].pair.exponent, speed());
          add_group(group);
        }
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
      std::vector<HillPair> pairs = pairs_of(numbers);
      refinement.refine(pairs, pair_tolerance);
      // Eigenpairs come in any order: each mode takes the one that it resembles most.
      for (const std::size_t i : numbers) starts_[i].pair = closest(starts_[i].pair, pairs);
    }
  }

  /// Those of a group, with the conjugates of slow ones.
  std::vector<HillPair> pairs_of(const std::vector<std::size_t>& numbers) const {
    std::vector<HillPair> pairs;
    for (const std::size_t i : numbers) pairs.push_back(starts_[i].pair);
    return groups_of(pairs, speed()).front().pairs;
  }

  HillPair closest(const HillPair& given, const std::vector<HillPair>& pairs) const {
    const HillPencil::Vector own = pencil().vector_of(given.series).normalized();
    const auto likeness = [&](const HillPair& pair) {
      return std::abs(own.dot(pencil().vector_of(pair.series).normalized()));
    };
    return *std::ranges::max_element(pairs, {}, likeness);
  }

  void add_group(const std::vector<std::size_t>& numbers) {
    const std::vector<HillPair> pairs = pairs_of(numbers);
    const auto count = static_cast<Index>(pairs.size());
    Group group;
    group.level = pencils_.size() - 1;
    group.members.assign(pairs.size(), starts_.size());
    Matrix X(pencil().size(), count);
    Matrix T = Matrix::Zero(count, count);
    for (Index j = 0; j < count; ++j) {
      const HillPair& pair = pairs[static_cast<std::size_t>(j)];
      X.col(j) = pencil().vector_of(pair.series).normalized();
      T(j, j) = pair.exponent;
      // A conjugate is no member.
      for (const std::size_t i : numbers)
        if (starts_[i].pair.exponent == pair.exponent &&
            std::ranges::find(group.members, i) == group.members.end()) {
          group.members[static_cast<std::size_t>(j)] = i;
          break;
        }
    }
    // Of an orthonormal basis of the same subspace, X = Q R: T becomes R T R^-1, and the columns of
    // R are its eigenvectors.
    const Eigen::HouseholderQR<Matrix> qr(X);
    group.vectors = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>().toDenseMatrix();
    group.X = qr.householderQ() * Matrix::Identity(X.rows(), count);
    group.exponents = T.diagonal();
    group.T = group.vectors * T * group.vectors.inverse();
    group.mass.resize(group.X.rows(), count);
    pencil().multiply_mass(group.X, group.mass);
    groups_.push_back(std::move(group));
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
  std::vector<std::unique_ptr<HillPencil>> pencils(own.levels());
  for (const Basis::Group& group : own.groups()) {
    std::unique_ptr<HillPencil>& pencil = pencils[group.level];
    if (!pencil) {
      HillPencil& reference = own.pencil(group.level);
      pencil = std::make_unique<HillPencil>(other, solution, reference.harmonics(), by_sector);
      pencil->take_scales(reference);
    }
    residuals.speed = pencil->speed();
    Matrix product(group.X.rows(), group.X.cols());
    pencil->multiply(group.X, group.X * group.T, product);
    residuals.groups.push_back(std::move(product));
  }
  return residuals;
}

Eigen::VectorXd ExponentDerivatives::last_changes(bool by_sector) {
  const std::vector<Start>& starts = basis(by_sector).starts();
  Eigen::VectorXd changes(static_cast<Index>(starts.size()));
  for (std::size_t m = 0; m < starts.size(); ++m) changes(static_cast<Index>(m)) = starts[m].change;
  return changes;
}

Eigen::MatrixXcd ExponentDerivatives::derivatives(const std::vector<Residuals>& rates) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  Matrix result = Matrix::Constant(static_cast<Index>(set_.modes.size()),
                                   static_cast<Index>(rates.size()), Complex(none, none));
  for (const bool by_sector : {true, false}) {
    if (std::ranges::none_of(
            rates, [by_sector](const Residuals& one) { return one.by_sector == by_sector; }))
      continue;
    Basis& own = basis(by_sector);
    for (std::size_t g = 0; g < own.groups().size(); ++g) {
      const Basis::Group& group = own.groups()[g];
      HillBorderedSolver solver(own.pencil(group.level), group.X, group.T, group.mass,
                                solve_accuracy);
      for (std::size_t p = 0; p < rates.size(); ++p) {
        if (rates[p].by_sector != by_sector) continue;
        // In the basis of the eigenvectors, T is diagonal; the diagonal of its change is that of
        // the exponents, where these are different.
        const Matrix change =
            group.vectors.inverse() * solver.solve(-rates[p].groups[g]).D * group.vectors;
        for (std::size_t j = 0; j < group.members.size(); ++j) {
          const auto at = static_cast<Index>(j);
          const std::size_t member = group.members[j];
          if (member >= set_.modes.size() || !is_single(group.exponents, at, own.speed())) continue;
          result(static_cast<Index>(member), static_cast<Index>(p)) =
              change(at, at) + Complex(0.0, own.starts()[member].harmonic * rates[p].speed);
        }
      }
    }
  }
  return result;
}

ExponentDerivatives::Residuals combine(double a, const ExponentDerivatives::Residuals& R, double b,
                                       const ExponentDerivatives::Residuals& S) {
  ExponentDerivatives::Residuals sum;
  sum.by_sector = R.by_sector;
  sum.speed = a * R.speed + b * S.speed;
  for (std::size_t g = 0; g < R.groups.size(); ++g)
    sum.groups.push_back(a * R.groups[g] + b * S.groups[g]);
  return sum;
}

}  // namespace samara::analysis
