// Preconditioner of harmonic balance: block-diagonal in the harmonics, with a border.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "block_factors.hpp"
#include "harmonic_tangents.hpp"

namespace samara::analysis {

/// Approximates the tangents of harmonic balance. Node blocks that many others refer to (joints,
/// the top of a tower) are the border; their rows and columns are exact, with all couplings of the
/// harmonics. Between the other blocks, chains of beam nodes in their own axes, harmonics are not
/// coupled. Solved by the Schur complement of the border.
class HarmonicPreconditioner {
 public:
  explicit HarmonicPreconditioner(const HarmonicTangents& tangents);

  /// Whether the tangents have blocks, and the border is a small part of them.
  bool is_useful() const;
  Eigen::Index border_size() const { return static_cast<Eigen::Index>(border_.size()); }

  /// Factors diag(`rows`) J diag(`columns`) for the present samples.
  /// @returns false where it is singular to working precision
  bool factor(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns);

  /// All coefficients of right-hand side and solution.
  void solve(const double* right, double* solution);

 private:
  using Index = Eigen::Index;
  using Place = HarmonicTangents::Place;
  /// A block of coefficients in a border row and a column between the borders.
  struct Coupling {
    Index border = 0;    ///< number in the border
    Index interior = 0;  ///< number in the interior
    Eigen::MatrixXd block;
  };

  void find_border();
  void list_places();
  bool factor_harmonic(int harmonic);
  Eigen::MatrixXd scaled_block(const Place& place) const;
  Index first_row(int harmonic, Index interior) const;
  void solve_interior(Eigen::MatrixXd& coefficients);
  void solve_harmonic(int harmonic, Eigen::MatrixXd& right);

  const HarmonicTangents& tangents_;
  Index width_;
  Index block_;                ///< unknowns of a node
  std::vector<Index> number_;  ///< of each unknown, in the border or between
  std::vector<char> in_border_;
  std::vector<PetscInt> border_;    ///< unknowns
  std::vector<PetscInt> interior_;  ///< unknowns, whole blocks in the order of the system
  std::vector<PetscInt> begin_;     ///< block pattern of the interior
  std::vector<PetscInt> columns_;
  std::vector<Place> inner_;                           ///< interior rows and columns
  std::vector<Index> block_of_;                        ///< block of each inner place
  std::vector<std::vector<Place>> columns_of_border_;  ///< interior rows, for each border unknown
  std::vector<Place> all_columns_of_border_;
  std::vector<Place> rows_of_border_;  ///< interior columns
  std::vector<Place> corner_;          ///< border rows and columns
  const Eigen::VectorXd* row_factors_ = nullptr;
  const Eigen::VectorXd* column_factors_ = nullptr;
  std::vector<BlockFactors> factors_;  ///< of each harmonic
  std::vector<Coupling> couplings_;
  Eigen::VectorXd schur_rows_;  ///< factors of the border's complement
  Eigen::VectorXd schur_columns_;
  Eigen::PartialPivLU<Eigen::MatrixXd> schur_;
};

}  // namespace samara::analysis
