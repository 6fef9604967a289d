// Approximate inverse of K + M d/dt + sigma M on Fourier series: block-diagonal in the harmonics,
// with a border.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "dense_factors.hpp"
#include "harmonic_chains.hpp"
#include "harmonic_tangents.hpp"

namespace samara::analysis {

/// Approximates the tangents of harmonic balance (sigma = 0) and of Hill's method. Node blocks that
/// many others refer to (joints, the top of a tower) are the border; their rows and columns are
/// exact, with all couplings of the harmonics. Between the other blocks, chains of beam nodes in
/// their own axes, harmonics are not coupled: each has the mean tangents. Solved by the Schur
/// complement of the border. Of a distributed mesh, each rank factors its piece of the chains, and
/// all ranks solve for the border, whose values in right-hand sides are complete on every rank.
class HarmonicPreconditioner {
 public:
  using Complex = std::complex<double>;

  explicit HarmonicPreconditioner(const HarmonicTangents& tangents);

  /// Whether the tangents have blocks, and the border is a small part of them.
  bool is_useful() const;
  Eigen::Index border_size() const { return static_cast<Eigen::Index>(border_.size()); }

  /// Factors diag(`rows`) (J + `shift` M) diag(`columns`) for the present samples.
  /// @returns false where it is singular to working precision
  bool factor(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns, Complex shift = 0.0);

  /// For a real shift: real coefficients of right-hand side and solution, as HarmonicTangents has
  /// them.
  void solve(const double* right, double* solution);
  /// For every shift: coefficients of exp(i k Omega t), k = -H ... H, (2 H + 1) x unknowns, of one
  /// or several right-hand sides next to each other.
  void solve(const Eigen::Ref<const Eigen::MatrixXcd>& right,
             Eigen::Ref<Eigen::MatrixXcd> solution);

  /// Logarithm of the determinant of what it factors, up to multiples of 2 pi i and a constant that
  /// does not depend on the shift. For a shift with an imaginary part.
  Complex log_determinant() const;

 private:
  using Index = Eigen::Index;
  using Place = HarmonicTangents::Place;
  /// Places of one border unknown with the interior, and their blocks of coefficients: in the row
  /// of the unknown next to each other, in its column below each other.
  struct Couplings {
    std::vector<Place> places;
    std::vector<Index> interior;  ///< numbers in the interior
    Eigen::MatrixXcd blocks;
    Index count() const { return static_cast<Index>(interior.size()); }
  };

  void find_border();
  void list_places();
  bool is_real() const { return shift_.imag() == 0.0; }
  void find_present();
  void write_block(const Place& place, Eigen::Ref<Eigen::MatrixXcd> block) const;
  void write_border();
  void add_to_complement(Index border, Index column,
                         const Eigen::Ref<const Eigen::VectorXcd>& values);
  /// A coefficient of an unknown of the border.
  struct BorderColumn {
    Index border;
    Index number;
  };
  void eliminate_chains();
  void subtract_rows(const HarmonicChains::Columns& solver, int k,
                     const std::vector<BorderColumn>& columns, const Eigen::MatrixXcd& solved);

  const HarmonicTangents& tangents_;
  Index width_;
  std::vector<Index> number_;                 ///< of each unknown, in the border or between
  std::vector<PetscInt> border_;              ///< unknowns
  std::vector<PetscInt> interior_;            ///< unknowns, whole blocks in the order of the system
  HarmonicChains chains_;                     ///< of the interior
  std::vector<Couplings> rows_of_border_;     ///< interior columns, for each border unknown
  std::vector<Couplings> columns_of_border_;  ///< interior rows
  std::vector<Place> corner_;                 ///< border rows and columns
  const Eigen::VectorXd* row_factors_ = nullptr;
  const Eigen::VectorXd* column_factors_ = nullptr;
  Complex shift_;
  std::vector<Index> present_;   ///< coefficients that the border's unknowns have
  std::vector<Index> position_;  ///< of all coefficients among these; -1: absent
  Eigen::MatrixXcd schur_;       ///< complement of the border
  DenseFactors<Complex> complement_factors_;
};

}  // namespace samara::analysis
