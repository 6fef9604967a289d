// Arnoldi's method for a complex linear map.
#pragma once

#include <Eigen/Core>

#include "samara/analysis/ranks.hpp"

namespace samara::analysis {

/// An orthonormal basis v_0 ... v_n of a Krylov space of a map S, and the map on it:
/// S v_k = sum_j v_j h_jk. The caller applies the map. Each rank has a part of all vectors.
class Arnoldi {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::VectorXcd;
  using Matrix = Eigen::MatrixXcd;

  /// `most`: images that are added. The start is not zero. `ranks`: those that have the parts.
  Arnoldi(const Vector& start, Index most, const Ranks& ranks);

  Index size() const { return basis_.cols() - 1; }  ///< number of images
  /// The vector whose image is next.
  auto last() const { return basis_.col(size()); }
  /// Adds the image of last().
  /// @returns false where it is in the space but for `least`: the space is invariant then
  bool extend(Vector image, double least);
  /// The map on the space, size() x size().
  auto projected() const { return small_.topLeftCorner(size(), size()); }
  /// Norm of the residual of an eigenvector of projected() with the norm 1.
  double residual(const Vector& in_basis) const;
  Vector vector_of(const Vector& in_basis) const { return basis_.leftCols(size()) * in_basis; }

 private:
  Ranks ranks_;
  Matrix basis_, small_;
};

}  // namespace samara::analysis
