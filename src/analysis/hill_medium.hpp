// A medium's part of Hill's eigenproblem (docs/theory.md, section 5.10).
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "samara/analysis/ranks.hpp"

#include "harmonic_tangents.hpp"

namespace samara::analysis {

/// The block of A + s B in the rows and columns of a medium's unknowns (states and auxiliaries):
/// its answer to a motion of the other parts. It falls into one part for each station of a blade,
/// and those of the border (the wake of a whole rotor), by whose complement it is solved. Of a
/// distributed mesh, each rank has the stations of its piece, the border has no unknowns of the
/// medium (MeshPartition::Limits::keeps_medium), and all ranks call the same functions.
class HillMedium {
 public:
  using Complex = std::complex<double>;
  using Matrix = Eigen::MatrixXcd;

  /// `rows`, `columns`: factors of the coefficients of `tangents`, as in HillPencil. All of them
  /// are kept by reference.
  HillMedium(const HarmonicTangents& tangents, const Eigen::VectorXd& rows,
             const Eigen::VectorXd& columns);

  /// Whether no rank has parts.
  bool is_empty() const { return is_empty_; }

  /// Factors the block for solve(), exact. @returns false where it is singular
  bool factor(Complex s);
  /// Solves the block for its part of a vector of all unknowns of the tangents, in place; the
  /// others are not touched.
  void solve(Eigen::Ref<Matrix> x) const;
  /// Logarithm of the determinant of the block as it is in HarmonicPreconditioner: chains have the
  /// mean tangents in each harmonic. Up to multiples of 2 pi i.
  Complex log_determinant_of_means(Complex s) const;
  /// Exponents of the medium with the other parts at rest and mean tangents, up to multiples of
  /// i Omega [1/s]; of all ranks.
  std::vector<Complex> exponents() const;

 private:
  using Index = Eigen::Index;
  using Place = HarmonicTangents::Place;
  using Places = std::vector<Place>;
  using Factors = Eigen::PartialPivLU<Matrix>;
  /// Unknowns that refer to each other, but for those of the border.
  struct Part {
    std::vector<Index> unknowns;
    Places places;     ///< among them
    Places of_border;  ///< columns of the part in rows of the border
    Places to_border;  ///< rows of the part in columns of the border
    Factors factors;
    Matrix border_rows;     ///< its columns in rows of the border
    Matrix solved_columns;  ///< its rows in columns of the border, solved for
  };

  bool is_of_medium(Index unknown) const { return tangents_.unknown(unknown).is_of_medium(); }
  void list_parts();
  Index rows_of(const Part& part) const {
    return static_cast<Index>(part.unknowns.size()) * tangents_.width();
  }
  double scale(const Place& place) const;
  Matrix couplings(const Places& places, Complex s, Index rows, Index columns) const;
  Matrix block_of(const Part& part, Complex s) const;
  Matrix block_of_means(const Part& part, Complex s, int k) const;
  std::vector<Complex> exponents_of(const std::vector<const Part*>& parts) const;

  const HarmonicTangents& tangents_;
  const Eigen::VectorXd& rows_;
  const Eigen::VectorXd& columns_;
  Ranks ranks_;
  std::vector<Part> parts_;
  Part border_;  ///< its factors are those of the complement
  bool is_empty_ = true;
  std::vector<Index> number_in_part_;  ///< of each unknown; -1: not of the medium
};

}  // namespace samara::analysis
