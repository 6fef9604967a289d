// Newton's method for a group of eigenpairs of Hill's eigenproblem (docs/theory.md, section 5.10).
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "hill_pencil.hpp"
#include "hill_search.hpp"

namespace samara::analysis {

/// Improves eigenpairs whose exponents are next to each other, with the harmonics of `pencil`, by
/// Newton's method for their invariant subspace: A X + B X T = 0 with an upper triangle T and
/// X^H X = I. Equal exponents, also of defective ones, are no special case. `pairs` may have other
/// harmonics.
class HillRefinement {
 public:
  explicit HillRefinement(HillPencil& pencil) : pencil_(pencil) {}

  /// @returns the relative residual that is left in the pencil
  double refine(std::vector<HillPair>& pairs);

 private:
  using Complex = std::complex<double>;

  bool take_shift(Complex exponent);

  HillPencil& pencil_;
  std::optional<Complex> shift_;
};

}  // namespace samara::analysis
