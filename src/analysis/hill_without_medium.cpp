#include "hill_without_medium.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>

#include "samara/base/error.hpp"

#include "arnoldi.hpp"
#include "hill_groups.hpp"
#include "hill_refinement.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;
using Vector = Eigen::VectorXcd;

/// Relative tolerances of the eigenpairs of the linear problem, of its linear solves and of
/// corrected eigenpairs, and the relative norm of a new vector that is round-off.
constexpr double eigenpair_tolerance = 1e-4;
constexpr double linear_tolerance = 1e-7;
constexpr double round_off = 1e-9;
constexpr double corrected_tolerance = 1e-5;
/// Real part of the shift, relative to the rotor speed: there are no factors at an exponent.
constexpr double beside_axis = 0.05;
/// Krylov space: vectors, of each wanted pair and in addition, and those between two checks.
constexpr int vectors_of_pair = 4;
constexpr int more_vectors = 60;
constexpr int check_interval = 8;
/// Largest change of a vector by a coupling of harmonics that is left out.
constexpr double most_coupling = 0.2;
/// Half the height of the rectangle, relative to the radius of the disc in which all pairs were
/// found.
constexpr double part_of_radius = 0.8;
/// Height outside the rectangle from which pairs may enter it, relative to its height.
constexpr double part_outside = 0.1;
/// Correlation of equal series.
constexpr double same_series = 0.9;
/// Least part of a series in the harmonics of a copy.
constexpr double least_of_copy = 0.9;
/// Least cosine between an eigenvector and its correction: else the shift follows the exponent.
constexpr double least_overlap = 0.95;
/// Shifts that follow an exponent, the vectors of their Krylov spaces, and their distance from the
/// exponent and its change in the end, relative to the rotor speed.
constexpr int most_shifts = 12;
constexpr int few_vectors = 12;
constexpr double beside_exponent = 0.02;
constexpr double last_change = 0.02;

/// Arnoldi's method for (A + sigma B)^-1 B', where B' has no rows of the medium's states. Its
/// eigenvalues are 1 / (sigma - lambda).
class KrylovSpace {
 public:
  /// The pencil keeps the shift sigma. `is_coupled`: A and B are those of the pencil, else those
  /// that the preconditioner solves for: each vector takes one solve then.
  KrylovSpace(HillPencil& pencil, Complex shift, const Vector& start, Index most, bool is_coupled)
      : pencil_(pencil),
        shift_(shift),
        linear_(solver_at(pencil, shift, linear_tolerance)),
        is_coupled_(is_coupled),
        right_(pencil.size()),
        image_(pencil.size()),
        space_(image_of(start), most, pencil.ranks()) {}  // without infinite exponents

  Index size() const { return space_.size(); }
  /// Adds a vector. @returns false where it is in the space
  bool extend() {
    const Vector& image = image_of(space_.last());
    return space_.extend(
        image, (is_coupled_ ? 10.0 * linear_tolerance : round_off) * pencil_.ranks().norm(image));
  }

  struct Pair {
    Complex value;
    Vector in_basis;
    double residual;  ///< relative
  };
  /// Those next to the shift first. The first rank finds them for all.
  std::vector<Pair> pairs() const {
    const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(space_.projected());
    Eigen::MatrixXcd values = solver.eigenvalues();
    Eigen::MatrixXcd vectors = solver.eigenvectors();
    pencil_.ranks().share(0, values);
    pencil_.ranks().share(0, vectors);
    std::vector<Pair> pairs;
    for (Index i = 0; i < size(); ++i) {
      const Complex value = values(i);
      const Vector vector = vectors.col(i);
      double residual = space_.residual(vector) / std::abs(value);
      pencil_.ranks().share(0, residual);
      pairs.push_back({value, vector, residual});
    }
    std::ranges::sort(pairs, {}, [](const Pair& pair) { return -std::abs(pair.value); });
    return pairs;
  }
  Complex exponent_of(const Pair& pair) const { return shift_ - 1.0 / pair.value; }
  Vector vector_of(const Pair& pair) const {
    return pencil_.normalized(space_.vector_of(pair.in_basis));
  }
  /// Relative change of a vector by the coupling of the harmonics in the chains, next to the shift.
  double coupling_of(const Vector& vector) {
    pencil_.multiply(vector, shift_ * vector, right_);
    pencil_.precondition(right_, image_);
    return pencil_.ranks().norm(Vector(image_ - vector)) / pencil_.ranks().norm(vector);
  }
  /// Whether a vector belongs to an infinite exponent: it does not fulfil the linear problem.
  bool is_infinite(const Pair& pair, const Vector& vector) {
    Vector product(vector.size());
    if (is_coupled_)
      pencil_.multiply(vector, shift_ * vector, product);
    else
      pencil_.multiply_uncoupled(vector, shift_ * vector, product);
    multiply_mass(vector);
    const Complex distance =
        pencil_.product(right_, product)(0) / pencil_.product(right_, right_)(0);
    return std::abs(distance * pair.value - 1.0) > 0.5;
  }

 private:
  void multiply_mass(const Vector& x) {
    if (is_coupled_)
      pencil_.multiply_mass_of_others(x, right_);
    else
      pencil_.multiply_uncoupled_mass_of_others(x, right_);
  }
  const Vector& image_of(const Vector& x) {
    multiply_mass(x);
    if (is_coupled_)
      linear_.solve(right_, image_);
    else
      pencil_.precondition(right_, image_);
    return image_;
  }

  HillPencil& pencil_;
  Complex shift_;
  ComplexSolver linear_;
  bool is_coupled_;
  Vector right_, image_;
  Arnoldi space_;
};

/// The same for every distribution of the mesh.
Vector random_vector(const HillPencil& pencil) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Vector vector(pencil.size());
  PetscInt next = 0;  // of the system
  for (Index i = 0; i < pencil.unknowns(); ++i)
    for (const PetscInt unknown = pencil.unknown_of_system(i); next <= unknown; ++next)
      for (Complex& value : vector.segment(i * pencil.width(), pencil.width()))
        value = Complex(normal(generator), normal(generator));
  pencil.drop_absent(vector);
  return vector;
}

}  // namespace

HillRegion HillWithoutMedium::find(double frequency, int count, double known) {
  std::vector<Approximation> pairs;
  // The coupling of the harmonics in the chains is left out where it changes pairs by little.
  std::optional<HillRegion> found = find_linear(frequency, count, false, pairs);
  if (!found) found = find_linear(frequency, count, true, pairs);
  if (!found) throw ConvergenceError("floquet: Hill's method finds no modes");
  HillRegion& region = *found;
  const double outside = part_outside * (region.high - region.low);
  // Those next to it may have copies above it, or become a pair above it.
  const double lowest =
      std::max(region.low, known - static_cast<double>(pencil_.sectors()) * pencil_.speed());
  std::erase_if(pairs, [&](const Approximation& pair) {
    const double height = std::abs(pair.exponent.imag());
    return std::abs(pair.exponent.real()) > region.decay + outside ||
           height > region.high + outside || height < lowest - outside;
  });
  // Neighbours share factors.
  std::ranges::sort(pairs, {}, [](const Approximation& pair) { return pair.exponent.imag(); });
  for (const Approximation& pair : pairs)
    if (std::optional<HillPair> result = corrected(pair)) add(std::move(*result), region);
  add_copies(region);
  return std::move(*found);
}

/// Adds a pair or its conjugate, if it is not known.
void HillWithoutMedium::add(HillPair pair, HillRegion& region) const {
  if (std::abs(pair.exponent.imag()) < same_found * pencil_.speed()) pair.exponent.imag(0.0);
  if (pair.exponent.imag() < 0.0) pair = conjugate_of(pair);
  const bool is_known = std::ranges::any_of(region.pairs, [&](const HillPair& other) {
    return std::abs(other.exponent - pair.exponent) < same_found * pencil_.speed() &&
           pencil_.correlation(other.series, pair.series) > same_series;
  });
  if (!is_known) region.pairs.push_back(std::move(pair));
}

/// Adds copies in the rectangle: several of them may have become one by the correction.
void HillWithoutMedium::add_copies(HillRegion& region) {
  const Index sectors = pencil_.sectors();
  for (std::size_t i = 0; i < region.pairs.size(); ++i)  // also those that it adds
    for (const Index shift : {sectors, -sectors}) {
      const HillPair& pair = region.pairs[i];
      const Complex exponent =
          pair.exponent + Complex(0.0, static_cast<double>(shift) * pencil_.speed());
      const double height = std::abs(exponent.imag());
      if (height > region.high || height < region.low) continue;
      const Eigen::MatrixXcd series = shifted_series(pair.series, shift, pair.series.rows());
      const Ranks& ranks = pencil_.ranks();
      if (ranks.norm(series) < least_of_copy * ranks.norm(pair.series)) continue;
      Approximation copy{exponent, pencil_.normalized(pencil_.vector_of(series))};
      if (std::optional<HillPair> result = refined(copy)) add(std::move(*result), region);
    }
}

/// The eigenpairs of the linear problem, and the rectangle; none where there are no pairs, or where
/// harmonics that are not coupled should be.
std::optional<HillRegion> HillWithoutMedium::find_linear(double frequency, int count,
                                                         bool is_coupled,
                                                         std::vector<Approximation>& pairs) {
  pairs.clear();
  const Index most = std::min<Index>(pencil_.size_of_all(),
                                     vectors_of_pair * static_cast<Index>(count) + more_vectors);
  KrylovSpace space(pencil_, {beside_axis * pencil_.speed(), frequency}, random_vector(pencil_),
                    most, is_coupled);
  std::vector<KrylovSpace::Pair> converged;
  HillRegion region;
  while (!region.is_whole && static_cast<int>(converged.size()) < count && space.size() < most) {
    region.is_whole = !space.extend();
    if (!region.is_whole && space.size() % check_interval != 0 && space.size() < most) continue;
    converged = space.pairs();
    converged.erase(std::ranges::find_if(converged,
                                         [](const KrylovSpace::Pair& pair) {
                                           return !(pair.residual < eigenpair_tolerance);
                                         }),
                    converged.end());
  }
  if (converged.empty()) return std::nullopt;
  double radius = 0.0;
  for (const KrylovSpace::Pair& pair : converged) {
    Vector vector = space.vector_of(pair);
    if (space.is_infinite(pair, vector)) {
      region.is_whole = true;
      break;
    }
    if (!is_coupled && space.coupling_of(vector) > most_coupling) return std::nullopt;
    radius = std::abs(1.0 / pair.value);
    Complex exponent = space.exponent_of(pair);
    if (std::abs(exponent.imag()) < beside_axis * pencil_.speed()) exponent.imag(0.0);
    // Below the axis: it may become a real exponent, or that of a conjugate.
    if (exponent.imag() > -pencil_.speed()) pairs.push_back({exponent, std::move(vector)});
  }
  region.is_whole = region.is_whole || space.size() == pencil_.size_of_all();
  if (region.is_whole)
    radius = std::sqrt(HillRegion::beyond_all) * (radius + 10.0 * pencil_.speed());
  const double half_height = part_of_radius * radius;
  region.high = frequency + half_height;
  region.low = std::max(0.0, frequency - half_height);
  region.decay =
      std::sqrt(radius * radius - half_height * half_height) - beside_axis * pencil_.speed();
  region.growth = region.decay;
  return region;
}

/// The eigenpair of the pencil that an approximation becomes, if there is one.
std::optional<HillPair> HillWithoutMedium::corrected(const Approximation& pair) {
  if (std::optional<HillPair> result = refined(pair)) return result;
  Approximation next = pair;
  return approach(next) ? refined(next) : std::nullopt;
}

std::optional<HillPair> HillWithoutMedium::follow(const HillPair& pair) {
  Approximation approximation{pair.exponent, pencil_.normalized(pencil_.vector_of(pair.series))};
  return approach(approximation) ? refined(approximation) : std::nullopt;
}

/// By Newton's method, if it stays with the eigenvector.
std::optional<HillPair> HillWithoutMedium::refined(const Approximation& pair) {
  std::vector<HillPair> pairs{{pair.exponent, pencil_.series_of(pair.vector)}};
  const HillRefinement::Result result = HillRefinement(pencil_).refine(pairs, corrected_tolerance);
  if (result.residual > eigenpair_tolerance || result.overlap < least_overlap) return std::nullopt;
  return std::move(pairs.front());
}

/// Solves linear problems with the exponent of the one before as shift.
/// @returns false where the exponents do not converge
bool HillWithoutMedium::approach(Approximation& pair) {
  for (int i = 0; i < most_shifts; ++i) {
    const double beside = beside_exponent * pencil_.speed();
    Approximation next;
    try {
      KrylovSpace space(pencil_, pair.exponent + Complex(beside, beside), pair.vector, few_vectors,
                        true);
      while (space.size() < few_vectors && space.extend()) {
      }
      double largest = 0.0;
      for (const KrylovSpace::Pair& other : space.pairs()) {
        Vector vector = space.vector_of(other);
        const double overlap = pencil_.correlation(vector, pair.vector);
        if (overlap <= largest || space.is_infinite(other, vector)) continue;
        largest = overlap;
        next = {space.exponent_of(other), std::move(vector)};
      }
    } catch (const ConvergenceError&) {
      return false;  // no factors, or a linear solve
    }
    if (next.vector.size() == 0) return false;
    const double change = std::abs(next.exponent - pair.exponent);
    pair = std::move(next);
    if (change < last_change * pencil_.speed()) return true;
  }
  return false;
}

}  // namespace samara::analysis
