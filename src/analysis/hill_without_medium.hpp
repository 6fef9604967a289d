// Eigenpairs of Hill's eigenproblem beside those of a medium (docs/theory.md, section 5.10).
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "hill_pencil.hpp"
#include "hill_search.hpp"

namespace samara::analysis {

/// Finds eigenpairs of the parts in a medium whose own exponents, with states, are hundreds of
/// decays among the slow modes. The medium answers a motion as one with the exponent of the shift:
/// this linear problem has no exponents of the medium, and its eigenpairs next to the shift are
/// those of the pencil. Newton's method for the pencil corrects them. Where it leaves an eigenpair,
/// the shift follows the exponent (successive linear problems; Ruhe, SIAM J. Numer. Anal. 10
/// (1973) 674-689).
class HillWithoutMedium {
 public:
  explicit HillWithoutMedium(HillPencil& pencil) : pencil_(pencil) {}

  /// About `count` pairs next to i `frequency` [rad/s] > 0, and the rectangle in which they are all
  /// that Arnoldi's method has found.
  /// @throws ConvergenceError
  HillRegion find(double frequency, int count, double known);

  /// The eigenpair that one with other harmonics becomes; none where it cannot be followed.
  std::optional<HillPair> follow(const HillPair& pair);

 private:
  using Complex = std::complex<double>;
  using Vector = Eigen::VectorXcd;
  /// An eigenpair of the linear problem.
  struct Approximation {
    Complex exponent;
    Vector vector;
  };

  std::optional<HillRegion> find_linear(double frequency, int count, bool is_coupled,
                                        std::vector<Approximation>& pairs);
  void add(HillPair pair, HillRegion& region) const;
  void add_copies(HillRegion& region);
  std::optional<HillPair> corrected(const Approximation& pair);
  std::optional<HillPair> refined(const Approximation& pair);
  bool approach(Approximation& pair);

  HillPencil& pencil_;
};

}  // namespace samara::analysis
