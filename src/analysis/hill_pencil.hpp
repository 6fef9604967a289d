// Hill's eigenproblem of a linearized periodic system, truncated (docs/theory.md, section 5.10).
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/analysis/ranks.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/system/periodic_system.hpp"

#include "harmonic_preconditioner.hpp"
#include "harmonic_tangents.hpp"
#include "hill_medium.hpp"
#include "mesh_partition.hpp"

namespace samara::analysis {

/// z(t) = exp(lambda t) sum_k z_k exp(i k Omega t), k = -H ... H, fulfils K z + M z_dot = 0 where
/// (A + lambda B) z = 0: A is K + M d/dt on Fourier series, B is M on them. Vectors have the
/// coefficients of all unknowns of HarmonicTangents (of one blade among identical ones), (2 H + 1)
/// x unknowns by column, from k = -H. Rows and unknowns are scaled by their roles. A matrix has a
/// vector in each column; all of them are multiplied, or solved for, at once. Of a distributed
/// mesh, each rank has the unknowns that it counts, and all ranks call the same functions.
class HillPencil {
 public:
  using Index = Eigen::Index;
  using Complex = std::complex<double>;
  using Vector = Eigen::VectorXcd;
  using Matrix = Eigen::MatrixXcd;
  /// Columns are next to each other in memory.
  using Input = const Eigen::Ref<const Matrix>&;
  using Output = Eigen::Ref<Matrix>;

  /// `by_sector`: of one blade among identical ones, if there are such. `may_defer`: as in
  /// HarmonicTangents; such a pencil can only be multiplied with.
  HillPencil(const system::PeriodicSystem& system, const PeriodicSolution& solution, int harmonics,
             bool by_sector = true, bool may_defer = false);
  /// Of a distributed mesh, which must outlive the object.
  HillPencil(const MeshPartition& mesh, const PeriodicSolution& solution, int harmonics);
  HillPencil(const HillPencil&) = delete;
  HillPencil& operator=(const HillPencil&) = delete;
  ~HillPencil() = default;

  /// Tangents at other instants, see HarmonicTangents::sample(). Scales remain.
  void sample(const PeriodicSolution& solution, double offset);

  int harmonics() const { return tangents_.harmonics(); }
  Eigen::Index width() const { return tangents_.width(); }
  /// Of a vector on this rank.
  Eigen::Index unknowns() const {
    return mesh() != nullptr ? static_cast<Eigen::Index>(mesh()->counted().size())
                             : tangents_.size();
  }
  Eigen::Index size() const { return width() * unknowns(); }
  /// Of the whole system.
  PetscInt unknown_of_system(Index unknown) const {
    return tangents_.sector().kept[static_cast<std::size_t>(number_of(unknown))];
  }
  /// Of a vector on all ranks.
  Eigen::Index size_of_all() const {
    return mesh() != nullptr ? width() * mesh()->size_of_all() : size();
  }
  double speed() const { return tangents_.rate(); }
  /// The ranks that have the parts of a vector; one rank, if the mesh is not distributed.
  const Ranks& ranks() const { return ranks_; }
  /// Null: the mesh is not distributed.
  const MeshPartition* mesh() const { return tangents_.partition(); }
  /// A^H B.
  Matrix product(Input a, Input b) const {
    Matrix product = multiply_adjoint(a, b);
    ranks_.sum(product);
    return product;
  }
  Vector normalized(const Vector& x) const { return x / ranks_.norm(x); }
  /// Cosine of the angle between two vectors, or between two series as series_of() gives them.
  double correlation(const Matrix& a, const Matrix& b) const {
    const Matrix between = product(a.reshaped(), b.reshaped());
    return std::abs(between(0)) / (ranks_.norm(a) * ranks_.norm(b));
  }
  /// Whether the tangents have the structure that precondition() needs.
  bool is_solvable() const { return preconditioner_.is_useful(); }

  /// y = A x + B w.
  void multiply(Input x, Input w, Output y);
  /// y = B w.
  void multiply_mass(Input w, Output y);
  /// The same for the pencil A' + s B' that precondition() solves for, but for the smallest
  /// couplings of the border: in the chains, harmonics are not coupled.
  void multiply_uncoupled(Input x, Input w, Output y);
  /// Whether there is a medium, and y = B w without the evolution rows of its states. With it in
  /// the place of B, and A + s B in that of A, the medium answers motions of all exponents as
  /// those of the exponent s, and has no exponents of its own.
  bool has_medium() const { return !medium_.is_empty(); }
  void multiply_mass_of_others(Input w, Output y);
  void multiply_uncoupled_mass_of_others(Input w, Output y);
  /// The map of the unknowns that are not the medium's, whose unknowns follow from their own rows,
  /// times the inverse of that of the preconditioner: both at the shift. x has zeros for the
  /// medium. @returns false where the medium's rows are singular
  bool prepare_elimination() { return shift_ && medium_.factor(*shift_); }
  void multiply_eliminated(const Vector& x, Vector& y);
  std::vector<Complex> exponents_of_medium() const { return medium_.exponents(); }
  void drop_medium(Vector& x) const { drop(of_medium_, x); }
  /// The exponent that fits a vector best: (A + lambda B) x is least in the 2-norm.
  Complex exponent_of(const Vector& x);
  /// Without harmonics: scales for motions of this rate [rad/s] from now on, which changes all
  /// vectors. Loads of fast motions are much larger than those of slow ones.
  void fit_scales(double rate);
  /// Takes the scales of another pencil, of a system with the same unknowns, with any number of
  /// harmonics.
  void take_scales(const HillPencil& other);

  /// Approximates (A + s B)^-1 from now on.
  /// @returns false where it is singular to working precision
  bool set_shift(Complex s);
  /// The shift of precondition(), if there is one.
  std::optional<Complex> shift() const { return shift_; }
  void precondition(Input right, Output x);
  /// Of the approximation at a complex shift, up to a constant and multiples of 2 pi i; with a
  /// medium, divided by the determinant of the medium's rows and columns. (Each exponent
  /// of the medium with the other parts at rest then is a pole.)
  Complex log_determinant() const;

  /// Harmonics between two copies of an eigenpair, exponents lambda and lambda + i Q Omega.
  int sectors() const { return tangents_.sectors(); }
  /// Sets the coefficients that an unknown does not have to zero.
  void drop_absent(Output x) const;
  /// Sets the rows that HarmonicTangents defers to zero.
  void drop_deferred(Output y) const;
  /// Series of all unknowns of the system without scaling, (2 H + 1) x system size; of a
  /// distributed mesh, those that this rank counts, the unknowns of a vector.
  Eigen::MatrixXcd series_of(const Vector& x) const;
  /// The inverse, for a series of any number of harmonics: others are zero or left out.
  Vector vector_of(const Eigen::MatrixXcd& whole) const;

 private:
  Index number_of(Index unknown) const;
  Eigen::Map<const Matrix> spread(Input x, Matrix& storage) const;
  void give_products(Output y);
  void collect(const Matrix& all, Output y) const;
  /// Adds the coefficients of mean, cosines and sines, unscaled, of x or its rate d/dt x to
  /// those of `to`.
  void to_coefficients(Input x, bool is_rate, Eigen::MatrixXd& to) const;
  void to_series(const Eigen::MatrixXd& coefficients, Output y) const;
  void take_coefficients(Input x, Input w);
  void take_rate(double rate);
  void list_medium();
  void drop(const std::vector<Index>& unknowns, Output y) const;
  void solve_medium(Vector& x);

  HarmonicTangents tangents_;
  Ranks ranks_;
  HarmonicPreconditioner preconditioner_;
  std::optional<Complex> shift_;
  double rate_ = 0.0;  ///< of the scales [rad/s]
  Eigen::VectorXd rows_, columns_;
  HillMedium medium_;
  std::vector<Index> of_medium_;               ///< its unknowns in a vector
  std::vector<Index> states_of_medium_;        ///< its states
  Eigen::MatrixXd values_, rates_, products_;  ///< real parts, then imaginary parts
  Matrix spread_x_, spread_w_;                 ///< with the unknowns of the border on all ranks
};

}  // namespace samara::analysis
