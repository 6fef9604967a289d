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
/// its answer to a motion of the other parts. The block falls into one group for each station of a
/// blade, or one for a rotor whose stations are coupled. Of a distributed mesh, each rank has the
/// groups of its piece (MeshPartition::Limits::keeps_medium), and all ranks call the same
/// functions.
class HillMedium {
 public:
  using Complex = std::complex<double>;
  using Matrix = Eigen::MatrixXcd;

  /// `rows`, `columns`: factors of the coefficients of `tangents`, as in HillPencil. All of them
  /// are kept by reference.
  HillMedium(const HarmonicTangents& tangents, const Eigen::VectorXd& rows,
             const Eigen::VectorXd& columns);

  /// Whether no rank has groups.
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
  struct Group {
    std::vector<Index> unknowns;
    std::vector<HarmonicTangents::Place> places;
    bool is_of_chains = true;  ///< none of its unknowns is in the border
    Eigen::PartialPivLU<Matrix> factors;
  };
  using Leaders = std::vector<Index>;  ///< of each unknown, the first one of its group

  bool is_of_medium(Index unknown) const { return tangents_.unknown(unknown).is_of_medium(); }
  Leaders find_leaders() const;
  bool is_of_chains(const HarmonicTangents::Place& place) const;
  void add_means(const HarmonicTangents::Place& place, Complex s, int k, Index first, Index stride,
                 Matrix& block) const;
  Matrix block_of(const Group& group, Complex s, bool only_means) const;
  Matrix block_of_means(const Group& group, Complex s, int k) const;
  std::vector<Complex> exponents_of(const Group& group) const;

  const HarmonicTangents& tangents_;
  const Eigen::VectorXd& rows_;
  const Eigen::VectorXd& columns_;
  Ranks ranks_;
  std::vector<Group> groups_;
  bool is_empty_ = true;
  std::vector<Index> place_in_group_;  ///< of each unknown; -1: not of the medium
};

}  // namespace samara::analysis
