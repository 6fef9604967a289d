// LU factorization of a sparse matrix of square blocks, for many right-hand sides at once.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <petscsys.h>

#include "blas.hpp"

namespace samara::analysis {

/// A sparse matrix of square blocks. Block row i has the blocks begin[i] to begin[i + 1] - 1.
template <class Scalar>
struct BlockMatrix {
  Eigen::Index size = 1;  ///< rows of a block
  Eigen::Index rows = 0;  ///< block rows
  const PetscInt* begin = nullptr;
  const PetscInt* columns = nullptr;  ///< block column of each block
  const Scalar* values = nullptr;     ///< blocks column by column
};

/// Factors A = (I + L) (D + U) block row by block row in the given order. Rows are interchanged in
/// the diagonal blocks D only, which are factored by LAPACK. A solve multiplies each block with all
/// right-hand sides. The unknowns of chains with a border at the end cause no fill-in. `Scalar` is
/// double or std::complex<double>.
template <class Scalar>
class BlockFactors {
 public:
  using Index = Eigen::Index;
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  /// Finds the fill-in of a pattern, which all matrices have.
  explicit BlockFactors(const BlockMatrix<Scalar>& pattern) : BlockFactors(pattern, pattern.rows) {}
  /// Only the first `eliminated` block rows are eliminated. The others are left with their
  /// complement A22 - A21 A11^-1 A12, for which solve_lower() and solve_upper() are.
  BlockFactors(const BlockMatrix<Scalar>& pattern, Index eliminated);

  /// @returns false where a diagonal block has a pivot below `least_pivot` times the largest entry
  /// of its row before elimination: by default, where the block is singular to working precision. A
  /// preconditioner whose solutions are checked may have smaller pivots.
  bool factor(const BlockMatrix<Scalar>& matrix, double least_pivot = 1e-13);

  /// Complement of the rows that are eliminated, in those that are left.
  Matrix complement() const;
  /// From the right-hand sides of all rows, in the rows that are left, to those of the complement.
  void solve_lower(Matrix& right);
  /// After solve_lower(): from the solution of the complement, in the rows that are left, to that
  /// of all rows.
  void solve_upper(Matrix& solution);

  /// Makes single right-hand sides faster: the inverses of the diagonal blocks take their place.
  void invert_diagonals();

  /// Solves for all columns of diag(`row_factors`) `right`.
  void solve(const Eigen::Ref<const Matrix>& right,
             const Eigen::Ref<const Eigen::VectorXd>& row_factors);

  /// Column c of the solution.
  Vector column(Index c) const;
  /// diag(`factors`) times the solution.
  void copy(const Eigen::Ref<const Eigen::VectorXd>& factors, Matrix& solution) const;

  /// Solves for all columns of `right`, in place.
  void solve(Matrix& right);
  /// The same for `right` that is zero outside the block rows `filled`. Only the block rows
  /// `wanted` are found; the others of the result have no meaning.
  void solve_part(Matrix& right, const std::vector<Index>& filled,
                  const std::vector<Index>& wanted);

  /// Frees the memory of right-hand sides.
  void release() { packed_ = work_ = {}; }

  /// Logarithm of the determinant, up to multiples of 2 pi i.
  std::complex<double> log_determinant() const;

 private:
  Scalar* block(Index entry) { return values_.data() + entry * size_ * size_; }
  const Scalar* block(Index entry) const { return values_.data() + entry * size_ * size_; }
  Scalar* rows_of(Index i) { return packed_.data() + i * size_ * right_sides_; }
  const Scalar* rows_of(Index i) const { return packed_.data() + i * size_ * right_sides_; }
  PetscBLASInt* interchanges(Index i) { return interchanges_.data() + i * size_; }
  const PetscBLASInt* interchanges(Index i) const { return interchanges_.data() + i * size_; }
  void find_filled(Index entry);
  void subtract_product(Index entry, const Scalar* b, Scalar* c, Index columns) const;
  void subtract_product(Index entry, Index upper, Scalar* c) const;
  bool factor_diagonal(Index i, double least);
  void divide(Index entry, Index k);
  void resize(Index right_sides);
  void eliminate(Index i);
  void substitute(Index i);
  void solve_diagonal(Index i);

  Index size_ = 1;  ///< rows of a block
  Index rows_ = 0;  ///< block rows
  Index eliminated_ = 0;
  Index right_sides_ = 0;
  std::vector<Index> begin_;     ///< of each block row in columns_, with fill-in; rows_ + 1 entries
  std::vector<Index> diagonal_;  ///< entry of the diagonal block of each row
  /// Of each row, the entry behind those of L: the diagonal one, or the first that is left.
  std::vector<Index> lower_end_;
  std::vector<Index> columns_;  ///< ascending in each row
  std::vector<Scalar> values_;  ///< L, factors of D, U; blocks column by column
  /// The first row or column of a block that is not zero, and the one behind the last.
  struct Range {
    Index first = 0;
    Index end = 0;
    bool is_empty() const { return end <= first; }
    Index count() const { return end - first; }
  };
  std::vector<Range> filled_rows_;  ///< of each block off the diagonal
  std::vector<Range> filled_columns_;
  std::vector<Scalar> packed_;              ///< right-hand sides, block row by block row
  std::vector<PetscBLASInt> interchanges_;  ///< of the rows of the diagonal blocks, from 1
  /// Of the diagonal blocks, for many right-hand sides; empty: not needed yet.
  std::vector<std::optional<blas::TriangleInverses<Scalar>>> inverses_;
  std::vector<Scalar> diagonal_inverses_;  ///< block by block; empty: the factors are used
  std::vector<Scalar> work_;
};

extern template class BlockFactors<double>;
extern template class BlockFactors<std::complex<double>>;

}  // namespace samara::analysis
