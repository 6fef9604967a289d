// Newton's method for a group of eigenpairs of Hill's eigenproblem (docs/theory.md, section 5.10).
#pragma once

#include <complex>
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

  struct Result {
    double residual = 0.0;  ///< relative, in the pencil
    /// Smallest cosine of the angles between the subspaces before and after. Where it is small,
    /// another eigenpair may have been found.
    double overlap = 0.0;
  };
  /// Ends as soon as the relative residual in the pencil is below `tolerance`.
  Result refine(std::vector<HillPair>& pairs, double tolerance);

 private:
  using Complex = std::complex<double>;
  using Matrix = Eigen::MatrixXcd;
  struct Subspace {
    Matrix X, T;
    Matrix residual, mass;  ///< A X + B X T, B X
    double size = 0.0;      ///< of the residual, relative
  };

  void find_residual(Subspace& subspace);
  bool correct(Subspace& subspace, double tolerance);

  HillPencil& pencil_;
};

}  // namespace samara::analysis
