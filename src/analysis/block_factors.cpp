#include "block_factors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <type_traits>

#include "samara/petsc/handle.hpp"

namespace samara::analysis {
namespace {

/// From here on, the inverses of triangles save time.
constexpr blas::Integer many_columns = 64;

/// Largest real or imaginary part, without the square roots of the absolute values.
template <class Scalar>
double largest_part(const Scalar* values, Eigen::Index count) {
  const Eigen::Index reals = std::is_same_v<Scalar, double> ? count : 2 * count;
  return Eigen::Map<const Eigen::VectorXd>(reinterpret_cast<const double*>(values), reals)
      .lpNorm<Eigen::Infinity>();
}

}  // namespace

template <class Scalar>
BlockFactors<Scalar>::BlockFactors(const BlockMatrix<Scalar>& pattern, Index eliminated)
    : size_(pattern.size), rows_(pattern.rows), eliminated_(eliminated) {
  begin_.push_back(0);
  // Row i gets the columns of U of each row k that it eliminates.
  for (Index i = 0; i < rows_; ++i) {
    std::set<Index> row;
    row.insert(i);
    for (PetscInt k = pattern.begin[i]; k < pattern.begin[i + 1]; ++k)
      row.insert(pattern.columns[k]);
    for (auto k = row.begin(); *k < std::min(i, eliminated_); ++k)
      for (Index entry = diagonal_[static_cast<std::size_t>(*k)] + 1;
           entry < begin_[static_cast<std::size_t>(*k) + 1]; ++entry)
        row.insert(columns_[static_cast<std::size_t>(entry)]);
    const auto first = static_cast<Index>(columns_.size());
    diagonal_.push_back(first + std::distance(row.begin(), row.find(i)));
    lower_end_.push_back(first +
                         std::distance(row.begin(), row.lower_bound(std::min(i, eliminated_))));
    columns_.insert(columns_.end(), row.begin(), row.end());
    begin_.push_back(static_cast<Index>(columns_.size()));
  }
  values_.resize(columns_.size() * static_cast<std::size_t>(size_ * size_));
  interchanges_.resize(static_cast<std::size_t>(rows_ * size_));
  filled_rows_.resize(columns_.size());
  filled_columns_.resize(columns_.size());
}

/// Finds the rows and columns of a block that are not zero throughout. The division by a diagonal
/// block fills columns, but no rows.
template <class Scalar>
void BlockFactors<Scalar>::find_filled(Index entry) {
  const Scalar* value = block(entry);
  Range& rows = filled_rows_[static_cast<std::size_t>(entry)];
  Range& columns = filled_columns_[static_cast<std::size_t>(entry)];
  rows = columns = {size_, 0};
  for (Index c = 0; c < size_; ++c)
    for (Index r = 0; r < size_; ++r, ++value) {
      if (*value == Scalar(0.0)) continue;
      rows = {std::min(rows.first, r), std::max(rows.end, r + 1)};
      columns = {std::min(columns.first, c), c + 1};
    }
}

/// C = C - A B with the block A of an entry, without its rows and columns of zeros; B and C of size
/// x columns.
template <class Scalar>
void BlockFactors<Scalar>::subtract_product(Index entry, const Scalar* b, Scalar* c,
                                            Index columns) const {
  const Range rows = filled_rows_[static_cast<std::size_t>(entry)];
  const Range between = filled_columns_[static_cast<std::size_t>(entry)];
  if (rows.is_empty()) return;
  const auto size = static_cast<blas::Integer>(size_);
  blas::subtract_product(static_cast<blas::Integer>(rows.count()),
                         static_cast<blas::Integer>(columns),
                         static_cast<blas::Integer>(between.count()),
                         block(entry) + between.first * size_ + rows.first, size, b + between.first,
                         size, c + rows.first, size);
}

/// The same with the block B of an entry of U, without its rows and columns of zeros.
template <class Scalar>
void BlockFactors<Scalar>::subtract_product(Index entry, Index upper, Scalar* c) const {
  const Range rows = filled_rows_[static_cast<std::size_t>(entry)];
  const Range between = filled_rows_[static_cast<std::size_t>(upper)];
  const Range columns = filled_columns_[static_cast<std::size_t>(upper)];
  if (rows.is_empty() || columns.is_empty()) return;
  const auto size = static_cast<blas::Integer>(size_);
  const Index first = columns.first * size_;
  blas::subtract_product(static_cast<blas::Integer>(rows.count()),
                         static_cast<blas::Integer>(columns.count()),
                         static_cast<blas::Integer>(between.count()),
                         block(entry) + between.first * size_ + rows.first, size,
                         block(upper) + first + between.first, size, c + first + rows.first, size);
}

template <class Scalar>
bool BlockFactors<Scalar>::factor_diagonal(Index i, double least) {
  Scalar* values = block(diagonal_[static_cast<std::size_t>(i)]);
  if (blas::factor(static_cast<blas::Integer>(size_), values, interchanges(i)) != 0) return false;
  for (Index k = 0; k < size_; ++k)
    if (!(std::abs(values[k * (size_ + 1)]) > least)) return false;
  return true;
}

/// The block A of an entry becomes A D^-1 with the diagonal block D = P^T L U of row k.
template <class Scalar>
void BlockFactors<Scalar>::divide(Index entry, Index k) {
  const Range rows = filled_rows_[static_cast<std::size_t>(entry)];
  if (rows.is_empty()) return;
  Scalar* a = block(entry);
  const auto n = static_cast<blas::Integer>(size_);
  const auto count = static_cast<blas::Integer>(rows.count());
  const Scalar* factors = block(diagonal_[static_cast<std::size_t>(k)]);
  blas::divide_by_triangle('U', n, factors, count, a + rows.first);
  blas::divide_by_triangle('L', n, factors, count, a + rows.first);
  filled_columns_[static_cast<std::size_t>(entry)] = {0, size_};
  for (Index c = size_ - 1; c >= 0; --c)
    if (const Index other = interchanges(k)[c] - 1; other != c)
      std::swap_ranges(a + c * size_, a + (c + 1) * size_, a + other * size_);
}

template <class Scalar>
bool BlockFactors<Scalar>::factor(const BlockMatrix<Scalar>& matrix, double least_pivot) {
  const Index area = size_ * size_;
  std::fill(values_.begin(), values_.end(), Scalar(0.0));
  inverses_.clear();
  diagonal_inverses_.clear();
  std::vector<Index> place(static_cast<std::size_t>(rows_), -1);
  for (Index i = 0; i < rows_; ++i) {
    const Index first = begin_[static_cast<std::size_t>(i)];
    const Index last = begin_[static_cast<std::size_t>(i) + 1];
    for (Index entry = first; entry < last; ++entry)
      place[static_cast<std::size_t>(columns_[static_cast<std::size_t>(entry)])] = entry;
    double largest = 0.0;
    for (PetscInt k = matrix.begin[i]; k < matrix.begin[i + 1]; ++k) {
      const Scalar* one = matrix.values + k * area;
      largest = std::max(largest, largest_part(one, area));
      std::copy_n(one, area, block(place[static_cast<std::size_t>(matrix.columns[k])]));
    }
    for (Index entry = first; entry < lower_end_[static_cast<std::size_t>(i)]; ++entry) {
      const auto k = static_cast<std::size_t>(columns_[static_cast<std::size_t>(entry)]);
      find_filled(entry);
      divide(entry, columns_[static_cast<std::size_t>(entry)]);
      for (Index other = diagonal_[k] + 1; other < begin_[k + 1]; ++other)
        subtract_product(
            entry, other,
            block(place[static_cast<std::size_t>(columns_[static_cast<std::size_t>(other)])]));
    }
    if (i >= eliminated_) continue;
    for (Index entry = diagonal_[static_cast<std::size_t>(i)] + 1; entry < last; ++entry)
      find_filled(entry);
    if (!factor_diagonal(i, least_pivot * largest)) return false;
  }
  return true;
}

template <class Scalar>
void BlockFactors<Scalar>::resize(Index right_sides) {
  right_sides_ = right_sides;
  packed_.resize(static_cast<std::size_t>(rows_ * size_ * right_sides_));
}

/// Row i of (I + L)^-1, from the rows before it.
template <class Scalar>
void BlockFactors<Scalar>::eliminate(Index i) {
  for (Index entry = begin_[static_cast<std::size_t>(i)];
       entry < lower_end_[static_cast<std::size_t>(i)]; ++entry)
    subtract_product(entry, rows_of(columns_[static_cast<std::size_t>(entry)]), rows_of(i),
                     right_sides_);
}

/// Row i of (D + U)^-1, from the rows after it.
template <class Scalar>
void BlockFactors<Scalar>::substitute(Index i) {
  const Index diagonal = diagonal_[static_cast<std::size_t>(i)];
  for (Index entry = diagonal + 1; entry < begin_[static_cast<std::size_t>(i) + 1]; ++entry)
    subtract_product(entry, rows_of(columns_[static_cast<std::size_t>(entry)]), rows_of(i),
                     right_sides_);
  solve_diagonal(i);
}

/// Row i of D^-1.
template <class Scalar>
void BlockFactors<Scalar>::solve_diagonal(Index i) {
  const Scalar* factors = block(diagonal_[static_cast<std::size_t>(i)]);
  const auto size = static_cast<blas::Integer>(size_);
  const auto columns = static_cast<blas::Integer>(right_sides_);
  if (columns == 1 && !diagonal_inverses_.empty()) {
    work_.assign(rows_of(i), rows_of(i) + size_);
    Eigen::Map<Vector>(rows_of(i), size_).noalias() =
        Eigen::Map<const Matrix>(diagonal_inverses_.data() + i * size_ * size_, size_, size_) *
        Eigen::Map<const Vector>(work_.data(), size_);
    return;
  }
  if (columns >= many_columns) {
    inverses_.resize(static_cast<std::size_t>(rows_));
    auto& inverses = inverses_[static_cast<std::size_t>(i)];
    if (!inverses) inverses.emplace(size, factors);
    if (inverses->is_accurate())
      return inverses->solve(columns, factors, interchanges(i), rows_of(i), work_);
  }
  blas::solve(size, columns, factors, interchanges(i), rows_of(i));
}

template <class Scalar>
void BlockFactors<Scalar>::invert_diagonals() {
  const Index area = size_ * size_;
  diagonal_inverses_.resize(static_cast<std::size_t>(eliminated_ * area));
  for (Index i = 0; i < eliminated_; ++i) {
    Scalar* inverse = diagonal_inverses_.data() + i * area;
    std::copy_n(block(diagonal_[static_cast<std::size_t>(i)]), area, inverse);
    blas::invert(static_cast<blas::Integer>(size_), inverse, interchanges(i));
  }
}

template <class Scalar>
typename BlockFactors<Scalar>::Matrix BlockFactors<Scalar>::complement() const {
  const Index left = (rows_ - eliminated_) * size_;
  Matrix complement = Matrix::Zero(left, left);
  for (Index i = eliminated_; i < rows_; ++i)
    for (Index entry = lower_end_[static_cast<std::size_t>(i)];
         entry < begin_[static_cast<std::size_t>(i) + 1]; ++entry) {
      const Index column = columns_[static_cast<std::size_t>(entry)];
      complement.block((i - eliminated_) * size_, (column - eliminated_) * size_, size_, size_) =
          Eigen::Map<const Matrix>(block(entry), size_, size_);
    }
  return complement;
}

template <class Scalar>
void BlockFactors<Scalar>::solve_lower(Matrix& right) {
  resize(right.cols());
  for (Index i = 0; i < rows_; ++i) {
    Eigen::Map<Matrix> rows(rows_of(i), size_, right_sides_);
    rows = right.middleRows(i * size_, size_);
    eliminate(i);
    if (i >= eliminated_) right.middleRows(i * size_, size_) = rows;
  }
}

template <class Scalar>
void BlockFactors<Scalar>::solve_upper(Matrix& solution) {
  for (Index i = rows_ - 1; i >= 0; --i) {
    Eigen::Map<Matrix> rows(rows_of(i), size_, right_sides_);
    if (i >= eliminated_) {
      rows = solution.middleRows(i * size_, size_);
      continue;
    }
    substitute(i);
    solution.middleRows(i * size_, size_) = rows;
  }
}

template <class Scalar>
void BlockFactors<Scalar>::solve(const Eigen::Ref<const Matrix>& right,
                                 const Eigen::Ref<const Eigen::VectorXd>& row_factors) {
  resize(right.cols());
  for (Index i = 0; i < rows_; ++i) {
    Eigen::Map<Matrix>(rows_of(i), size_, right_sides_) =
        right.middleRows(i * size_, size_).array().colwise() *
        row_factors.segment(i * size_, size_).array().template cast<Scalar>();
    eliminate(i);
  }
  for (Index i = rows_ - 1; i >= 0; --i) substitute(i);
}

template <class Scalar>
void BlockFactors<Scalar>::solve(Matrix& right) {
  resize(right.cols());
  for (Index i = 0; i < rows_; ++i) {
    Eigen::Map<Matrix>(rows_of(i), size_, right_sides_) = right.middleRows(i * size_, size_);
    eliminate(i);
  }
  for (Index i = rows_ - 1; i >= 0; --i) {
    substitute(i);
    right.middleRows(i * size_, size_) = Eigen::Map<Matrix>(rows_of(i), size_, right_sides_);
  }
}

template <class Scalar>
void BlockFactors<Scalar>::solve_part(Matrix& right, const std::vector<Index>& filled,
                                      const std::vector<Index>& wanted) {
  resize(right.cols());
  // Rows of (I + L)^-1 `right` that are not zero.
  std::vector<char> is_filled(static_cast<std::size_t>(rows_), 0);
  for (const Index i : filled) is_filled[static_cast<std::size_t>(i)] = 1;
  const auto is_in_row = [this](Index first, Index end, const std::vector<char>& rows) {
    return std::any_of(columns_.begin() + first, columns_.begin() + end, [&rows](Index column) {
      return rows[static_cast<std::size_t>(column)] != 0;
    });
  };
  for (Index i = 0; i < rows_; ++i) {
    const auto at = static_cast<std::size_t>(i);
    Eigen::Map<Matrix> rows(rows_of(i), size_, right_sides_);
    if (is_filled[at])
      rows = right.middleRows(i * size_, size_);
    else if (is_in_row(begin_[at], diagonal_[at], is_filled))
      rows.setZero();
    else
      continue;
    is_filled[at] = 1;
    for (Index entry = begin_[at]; entry < diagonal_[at]; ++entry)
      if (const Index k = columns_[static_cast<std::size_t>(entry)];
          is_filled[static_cast<std::size_t>(k)])
        subtract_product(entry, rows_of(k), rows_of(i), right_sides_);
  }
  // Rows on which the wanted ones depend.
  std::vector<char> is_wanted(static_cast<std::size_t>(rows_), 0);
  for (const Index i : wanted) is_wanted[static_cast<std::size_t>(i)] = 1;
  for (std::size_t i = 0; i < is_wanted.size(); ++i)
    if (is_wanted[i])
      for (Index entry = diagonal_[i] + 1; entry < begin_[i + 1]; ++entry)
        is_wanted[static_cast<std::size_t>(columns_[static_cast<std::size_t>(entry)])] = 1;
  std::vector<char>& is_found = is_filled;  // of the solution that is not zero
  for (Index i = rows_ - 1; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    if (!is_wanted[at]) continue;
    Eigen::Map<Matrix> rows(rows_of(i), size_, right_sides_);
    if (!is_found[at]) {
      if (!is_in_row(diagonal_[at] + 1, begin_[at + 1], is_found)) {
        right.middleRows(i * size_, size_).setZero();
        continue;
      }
      rows.setZero();
      is_found[at] = 1;
    }
    for (Index entry = diagonal_[at] + 1; entry < begin_[at + 1]; ++entry)
      if (const Index k = columns_[static_cast<std::size_t>(entry)];
          is_found[static_cast<std::size_t>(k)])
        subtract_product(entry, rows_of(k), rows_of(i), right_sides_);
    solve_diagonal(i);
    right.middleRows(i * size_, size_) = rows;
  }
}

template <class Scalar>
typename BlockFactors<Scalar>::Vector BlockFactors<Scalar>::column(Index c) const {
  Vector values(rows_ * size_);
  for (Index i = 0; i < rows_; ++i)
    values.segment(i * size_, size_) = Eigen::Map<const Vector>(rows_of(i) + c * size_, size_);
  return values;
}

template <class Scalar>
void BlockFactors<Scalar>::copy(const Eigen::Ref<const Eigen::VectorXd>& factors,
                                Matrix& solution) const {
  solution.resize(rows_ * size_, right_sides_);
  for (Index i = 0; i < rows_; ++i)
    solution.middleRows(i * size_, size_) =
        Eigen::Map<const Matrix>(rows_of(i), size_, right_sides_).array().colwise() *
        factors.segment(i * size_, size_).array().template cast<Scalar>();
}

template <class Scalar>
std::complex<double> BlockFactors<Scalar>::log_determinant() const {
  std::complex<double> sum = 0.0;
  for (Index i = 0; i < rows_; ++i) {
    const Scalar* values = block(diagonal_[static_cast<std::size_t>(i)]);
    for (Index k = 0; k < size_; ++k) {
      sum += std::log(std::complex<double>(values[k * (size_ + 1)]));
      if (interchanges(i)[k] != k + 1) sum += std::complex<double>(0.0, std::numbers::pi);
    }
  }
  return sum;
}

template class BlockFactors<double>;
template class BlockFactors<std::complex<double>>;

}  // namespace samara::analysis
