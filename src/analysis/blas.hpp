// BLAS and LAPACK for real and complex blocks under one name each. They count operations for
// PETSc's -log_view.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>
#include <vector>

// The second one needs the first one.
// clang-format off
#include <petscsys.h>
#include <petscblaslapack.h>
// clang-format on

namespace samara::analysis::blas {

using Integer = PetscBLASInt;
using Complex = std::complex<double>;

// PETSc's headers declare the routines of its own scalar type only, which is real here.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" {
void zgemm_(const char*, const char*, const Integer*, const Integer*, const Integer*,
            const Complex*, const Complex*, const Integer*, const Complex*, const Integer*,
            const Complex*, Complex*, const Integer*);
void ztrsm_(const char*, const char*, const char*, const char*, const Integer*, const Integer*,
            const Complex*, const Complex*, const Integer*, Complex*, const Integer*);
void zgetrf_(const Integer*, const Integer*, Complex*, const Integer*, Integer*, Integer*);
void zgemv_(const char*, const Integer*, const Integer*, const Complex*, const Complex*,
            const Integer*, const Complex*, const Integer*, const Complex*, Complex*,
            const Integer*);
void dtrsv_(const char*, const char*, const char*, const Integer*, const double*, const Integer*,
            double*, const Integer*);
void zgetrs_(const char*, const Integer*, const Integer*, const Complex*, const Integer*,
             const Integer*, Complex*, const Integer*, Integer*);
void dtrtri_(const char*, const char*, const Integer*, double*, const Integer*, Integer*);
void ztrtri_(const char*, const char*, const Integer*, Complex*, const Integer*, Integer*);
void dlaswp_(const Integer*, double*, const Integer*, const Integer*, const Integer*,
             const Integer*, const Integer*);
void zlaswp_(const Integer*, Complex*, const Integer*, const Integer*, const Integer*,
             const Integer*, const Integer*);
void zgetri_(const Integer*, Complex*, const Integer*, const Integer*, Complex*, const Integer*,
             Integer*);
}
// NOLINTEND(readability-identifier-naming)

/// Multiplications and additions of two numbers each.
template <class Scalar>
void count_operations(double pairs) {
  constexpr double in_reals = sizeof(Scalar) == sizeof(double) ? 2.0 : 8.0;
  PetscLogFlops(in_reals * pairs);
}

/// C = `a_factor` A B + `c_factor` C; A: m x k, B: k x n.
inline void multiply(Integer m, Integer n, Integer k, double a_factor, const double* a, Integer lda,
                     const double* b, Integer ldb, double c_factor, double* c, Integer ldc) {
  BLASgemm_("N", "N", &m, &n, &k, &a_factor, a, &lda, b, &ldb, &c_factor, c, &ldc);
}
inline void multiply(Integer m, Integer n, Integer k, Complex a_factor, const Complex* a,
                     Integer lda, const Complex* b, Integer ldb, Complex c_factor, Complex* c,
                     Integer ldc) {
  zgemm_("N", "N", &m, &n, &k, &a_factor, a, &lda, b, &ldb, &c_factor, c, &ldc);
}

/// C = A^T B (`how` 'T') or A^H B ('C'); A: k x m, B: k x n.
inline void multiply_turned(char how, Integer m, Integer n, Integer k, const Complex* a,
                            Integer lda, const Complex* b, Integer ldb, Complex* c, Integer ldc) {
  count_operations<Complex>(1.0 * m * n * k);
  const Complex one = 1.0;
  const Complex zero = 0.0;
  const Integer step = 1;
  if (n == 1)
    zgemv_(&how, &k, &m, &one, a, &lda, b, &step, &zero, c, &step);
  else
    zgemm_(&how, "N", &m, &n, &k, &one, a, &lda, b, &ldb, &zero, c, &ldc);
}

// Products with one column, and solves for one, do not pay for the copies that those with many
// make.

/// C = C - A B; A: m x k, B: k x n.
inline void subtract_product(Integer m, Integer n, Integer k, const double* a, Integer lda,
                             const double* b, Integer ldb, double* c, Integer ldc) {
  count_operations<double>(1.0 * m * n * k);
  const double minus = -1.0;
  const double one = 1.0;
  const Integer step = 1;
  if (n == 1)
    BLASgemv_("N", &m, &k, &minus, a, &lda, b, &step, &one, c, &step);
  else
    multiply(m, n, k, minus, a, lda, b, ldb, one, c, ldc);
}
inline void subtract_product(Integer m, Integer n, Integer k, const Complex* a, Integer lda,
                             const Complex* b, Integer ldb, Complex* c, Integer ldc) {
  count_operations<Complex>(1.0 * m * n * k);
  const Complex minus = -1.0;
  const Complex one = 1.0;
  const Integer step = 1;
  if (n == 1)
    zgemv_("N", &m, &k, &minus, a, &lda, b, &step, &one, c, &step);
  else
    multiply(m, n, k, minus, a, lda, b, ldb, one, c, ldc);
}

/// B = B T^-1 with the upper (`part` 'U') or the unit lower ('L') triangle T of the n x n matrix
/// `a`; `count` rows of B, which is stored with n rows.
inline void divide_by_triangle(char part, Integer n, const double* a, Integer count, double* b) {
  count_operations<double>(0.5 * n * n * count);
  const double one = 1.0;
  const char* diagonal = part == 'L' ? "U" : "N";
  BLAStrsm_("R", &part, "N", diagonal, &count, &n, &one, a, &n, b, &n);
}
inline void divide_by_triangle(char part, Integer n, const Complex* a, Integer count, Complex* b) {
  count_operations<Complex>(0.5 * n * n * count);
  const Complex one = 1.0;
  const char* diagonal = part == 'L' ? "U" : "N";
  ztrsm_("R", &part, "N", diagonal, &count, &n, &one, a, &n, b, &n);
}

/// B = R^-1 B (`side` 'L') or B R^-1 ('R') with the upper triangle R of a square matrix; B: m x n.
inline void divide_by_upper(char side, Integer m, Integer n, const double* r, Integer ldr,
                            double* b, Integer ldb) {
  count_operations<double>(0.5 * m * n * (side == 'L' ? m : n));
  const double one = 1.0;
  BLAStrsm_(&side, "U", "N", "N", &m, &n, &one, r, &ldr, b, &ldb);
}

/// Factors an n x n matrix. @returns 0 unless a pivot is zero
inline Integer factor(Integer n, double* a, Integer* interchanges) {
  count_operations<double>(1.0 / 3.0 * n * n * n);
  Integer status = 0;
  LAPACKgetrf_(&n, &n, a, &n, interchanges, &status);
  return status;
}
inline Integer factor(Integer n, Complex* a, Integer* interchanges) {
  count_operations<Complex>(1.0 / 3.0 * n * n * n);
  Integer status = 0;
  zgetrf_(&n, &n, a, &n, interchanges, &status);
  return status;
}

inline void invert(Integer n, double* factors, const Integer* interchanges, double* work,
                   Integer length) {
  Integer status = 0;
  LAPACKgetri_(&n, factors, &n, interchanges, work, &length, &status);
}
inline void invert(Integer n, Complex* factors, const Integer* interchanges, Complex* work,
                   Integer length) {
  Integer status = 0;
  zgetri_(&n, factors, &n, interchanges, work, &length, &status);
}
/// The inverse of an n x n matrix, in place of the result of factor().
template <class Scalar>
void invert(Integer n, Scalar* factors, const Integer* interchanges) {
  count_operations<Scalar>(2.0 / 3.0 * n * n * n);
  constexpr Integer block = 32;
  std::vector<Scalar> work(static_cast<std::size_t>(block * n));
  invert(n, factors, interchanges, work.data(), static_cast<Integer>(work.size()));
}

inline void solve_triangle(char part, Integer n, const double* a, double* b) {
  const Integer step = 1;
  dtrsv_(&part, "N", part == 'L' ? "U" : "N", &n, a, &n, b, &step);
}
/// With loops over real numbers: zaxpy, by which ztrsv solves, costs more than its operations here.
inline void solve_triangle(char part, Integer n, const Complex* a, Complex* b) {
  auto* x = reinterpret_cast<double*>(b);
  const bool is_lower = part == 'L';
  for (Integer k = 0; k < n; ++k) {
    const Integer j = is_lower ? k : n - 1 - k;
    const Complex* column = a + static_cast<std::ptrdiff_t>(j) * n;
    if (!is_lower) b[j] *= std::conj(column[j]) / std::norm(column[j]);
    const double re = x[2 * j];
    const double im = x[2 * j + 1];
    const auto* values = reinterpret_cast<const double*>(column);
    const Integer end = 2 * (is_lower ? n : j);
    for (Integer i = is_lower ? 2 * (j + 1) : 0; i < end; i += 2) {
      x[i] -= values[i] * re - values[i + 1] * im;
      x[i + 1] -= values[i] * im + values[i + 1] * re;
    }
  }
}
inline void solve_columns(Integer n, Integer m, const double* factors, const Integer* interchanges,
                          double* b) {
  Integer status = 0;
  LAPACKgetrs_("N", &n, &m, const_cast<double*>(factors), &n, const_cast<Integer*>(interchanges), b,
               &n, &status);
}
inline void solve_columns(Integer n, Integer m, const Complex* factors, const Integer* interchanges,
                          Complex* b) {
  Integer status = 0;
  zgetrs_("N", &n, &m, factors, &n, interchanges, b, &n, &status);
}

/// The inverse of the upper (`part` 'U') or unit lower ('L') triangle of `a`, in its place.
inline void invert_triangle(char part, Integer n, double* a, Integer lda) {
  Integer status = 0;
  dtrtri_(&part, part == 'L' ? "U" : "N", &n, a, &lda, &status);
}
inline void invert_triangle(char part, Integer n, Complex* a, Integer lda) {
  Integer status = 0;
  ztrtri_(&part, part == 'L' ? "U" : "N", &n, a, &lda, &status);
}

inline void interchange_rows(Integer n, Integer m, const Integer* interchanges, double* b) {
  const Integer one = 1;
  dlaswp_(&m, b, &n, &one, &n, interchanges, &one);
}
inline void interchange_rows(Integer n, Integer m, const Integer* interchanges, Complex* b) {
  const Integer one = 1;
  zlaswp_(&m, b, &n, &one, &n, interchanges, &one);
}

/// Solves for many columns with products of matrices only, whose kernels are two to three times as
/// fast as those of triangular solves (OpenBLAS, 54 rows): the triangles on the diagonal are
/// inverted in groups of rows. The residual of the solution is larger than that of a triangular
/// solve by their condition number; so is_accurate() is to be asked.
template <class Scalar>
class TriangleInverses {
 public:
  /// `factors`: n x n, of factor().
  TriangleInverses(Integer n, const Scalar* factors) : n_(n) {
    for (Integer first = 0; first < n; first += group)
      for (const char part : {'L', 'U'}) {
        inverses_.push_back({});
        std::array<Scalar, group* group>& inverse = inverses_.back();
        const Integer rows = rows_at(first);
        for (Integer c = 0; c < rows; ++c)
          for (Integer r = 0; r < rows; ++r)
            inverse[static_cast<std::size_t>(c * rows + r)] = value(factors, part, first, r, c);
        const auto largest = [&] {
          double value = 0.0;
          for (Integer i = 0; i < rows * rows; ++i)
            value = std::max(value, std::norm(inverse[static_cast<std::size_t>(i)]));
          return std::sqrt(value);
        };
        const double of_triangle = largest();
        invert_triangle(part, rows, inverse.data(), rows);
        is_accurate_ = is_accurate_ && of_triangle * largest() <= largest_condition;
      }
  }

  bool is_accurate() const { return is_accurate_; }

  /// Solves for the columns of the n x m matrix b with the result of factor(). `work` is any
  /// vector.
  void solve(Integer m, const Scalar* factors, const Integer* interchanges, Scalar* b,
             std::vector<Scalar>& work) const {
    count_operations<Scalar>(1.0 * n_ * n_ * m);
    work.resize(static_cast<std::size_t>(n_ * std::min(m, columns_at_once)));
    for (Integer first = 0; first < m; first += columns_at_once) {
      const Integer columns = std::min(columns_at_once, m - first);
      Scalar* some = b + static_cast<std::ptrdiff_t>(first) * n_;
      interchange_rows(n_, columns, interchanges, some);
      solve_some(columns, factors, some, work.data());
    }
  }

 private:
  static constexpr Integer group = 18;
  /// The values of so many columns of small blocks stay in the cache.
  static constexpr Integer columns_at_once = 128;
  static constexpr double largest_condition = 1e4;  ///< largest entries, of triangle and inverse

  [[nodiscard]] Integer rows_at(Integer first) const { return std::min(group, n_ - first); }
  Scalar value(const Scalar* factors, char part, Integer first, Integer r, Integer c) const {
    if (part == 'L' && r == c) return 1.0;
    return (part == 'L') == (r > c) ? factors[(first + c) * n_ + first + r] : 0.0;
  }
  [[nodiscard]] const Scalar* inverse(char part, Integer first) const {
    return inverses_[static_cast<std::size_t>(2 * (first / group) + (part == 'L' ? 0 : 1))].data();
  }

  void solve_some(Integer m, const Scalar* factors, Scalar* b, Scalar* y) const {
    for (Integer first = 0; first < n_; first += group) {
      const Integer rows = rows_at(first);
      const Integer next = first + rows;
      multiply(rows, m, rows, 1.0, inverse('L', first), rows, b + first, n_, 0.0, y + first, n_);
      if (next < n_)
        multiply(n_ - next, m, rows, -1.0, factors + first * n_ + next, n_, y + first, n_, 1.0,
                 b + next, n_);
    }
    for (Integer first = (n_ - 1) / group * group; first >= 0; first -= group) {
      const Integer rows = rows_at(first);
      multiply(rows, m, rows, 1.0, inverse('U', first), rows, y + first, n_, 0.0, b + first, n_);
      if (first > 0)
        multiply(first, m, rows, -1.0, factors + first * n_, n_, b + first, n_, 1.0, y, n_);
    }
  }

  Integer n_;
  std::vector<std::array<Scalar, group * group>> inverses_;  ///< 'L', 'U' of each group
  bool is_accurate_ = true;
};

/// Solves for the columns of the n x m matrix b with the result of factor().
template <class Scalar>
void solve(Integer n, Integer m, const Scalar* factors, const Integer* interchanges, Scalar* b) {
  count_operations<Scalar>(1.0 * n * n * m);
  if (m != 1) return solve_columns(n, m, factors, interchanges, b);
  for (Integer i = 0; i < n; ++i)
    if (const Integer other = interchanges[i] - 1; other != i) std::swap(b[i], b[other]);
  solve_triangle('L', n, factors, b);
  solve_triangle('U', n, factors, b);
}

}  // namespace samara::analysis::blas
