// Eigenpairs of Hill's eigenproblem near the imaginary axis (docs/theory.md, section 5.10).
#pragma once

#include <complex>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/ranks.hpp"

#include "complex_solver.hpp"
#include "hill_pencil.hpp"

namespace samara::analysis {

/// Distance, relative to the rotor speed, of one exponent that two searches find.
constexpr double same_found = 1e-3;

/// An exponent and the series of its motion, (2 H + 1) x unknowns.
struct HillPair {
  std::complex<double> exponent;
  Eigen::MatrixXcd series;
};

/// The eigenpairs in a rectangle of the upper half plane, -decay <= Re <= growth, low <= Im <=
/// high.
struct HillRegion {
  /// Factor of a region beyond all finite exponents.
  static constexpr double beyond_all = 25.0;

  double low = 0.0;     ///< [rad/s]; 0 includes the real exponents
  double high = 0.0;    ///< [rad/s]
  double decay = 0.0;   ///< [1/s]; not above zero where too few pairs were found for a width
  double growth = 0.0;  ///< [1/s]
  /// True where all others are as good as infinite.
  bool is_whole = false;
  /// Exponents with Im >= 0, also some outside the rectangle.
  std::vector<HillPair> pairs;
};

/// Solves (A + sigma B) y = x with the shift sigma, which the pencil keeps (options prefix
/// `hill_`). `tolerance`: relative residual.
/// @throws ConvergenceError where there are no factors
ComplexSolver solver_at(HillPencil& pencil, std::complex<double> shift, double tolerance);

/// Finds eigenpairs next to shifts on the imaginary axis by Krylov-Schur with shift and invert
/// (SLEPc, options prefix `hill_`). Real vectors serve a complex shift sigma: the imaginary part of
/// (A + sigma B)^-1 B is a real map with the eigenvalues
/// -Im(sigma) / ((sigma - lambda) (conj(sigma) - lambda)). In a medium, HillWithoutMedium takes its
/// place.
class HillSearch {
 public:
  explicit HillSearch(HillPencil& pencil) : pencil_(pencil) {}

  /// At least `count` pairs next to i `frequency` [rad/s] > 0, and the rectangle in which they are
  /// all that the eigensolver has found. Pairs below i `known` [rad/s] may be left out.
  /// @throws ConvergenceError
  HillRegion find(double frequency, int count, double known = 0.0);

  /// Number of eigenvalues in a region, and below the real axis in the mirror image of one that
  /// starts there, less those of `found`. By the argument principle for the determinant of the
  /// preconditioner. The pencil has the same number where `contraction` is less than one on the
  /// edge: on the way from one matrix to the other, none is singular there. Empty where the
  /// phase of the determinant is not followed by `most_points` points. Every rank calls it with the
  /// same arguments, takes some of the points and gets the same result. Regions may share points.
  struct Missing {
    std::optional<int> eigenvalues;
    /// Largest |1 - eigenvalue| of the preconditioned pencil, where none is missing: estimates and
    /// their residuals.
    double contraction = 0.0;
    int points = 0;  ///< of the edge
  };
  Missing count_missing(const HillRegion& region, const std::vector<std::complex<double>>& found,
                        const Ranks& ranks);

 private:
  HillRegion find_all(double frequency, int count);
  std::vector<std::complex<double>> logs_at(const std::vector<std::complex<double>>& points,
                                            const Ranks& ranks);
  double contraction_at(std::complex<double> s);
  double find_contraction(std::complex<double> s);

  HillPencil& pencil_;
  /// By real and imaginary part of a point.
  template <class Value>
  using Values = std::map<std::pair<double, double>, Value>;
  Values<std::complex<double>> logs_;  ///< of the determinant
  Values<double> contractions_;        ///< at the points of this rank
};

}  // namespace samara::analysis
