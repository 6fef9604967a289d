// The chains of beam nodes in HarmonicPreconditioner: each harmonic of them has its own factors.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "block_factors.hpp"
#include "harmonic_tangents.hpp"
#include "local_unknowns.hpp"

namespace samara::analysis {

/// The mean tangents K + (s + i k Omega) M of the unknowns outside the border, whole blocks in the
/// order of the system, for each harmonic k. Local unknowns are eliminated first. A block is absent
/// from a harmonic that none of its unknowns has.
class HarmonicChains {
 public:
  using Complex = std::complex<double>;
  using Index = Eigen::Index;
  using Place = HarmonicTangents::Place;

  explicit HarmonicChains(const HarmonicTangents& tangents) : tangents_(tangents) {}

  /// `unknowns`: of the chains, which get the numbers of their order; `number`: of each unknown of
  /// the tangents in its group; `places`: with rows and columns in the chains; `coupled`: numbers
  /// of the unknowns that rows of the border refer to.
  void set(const std::vector<PetscInt>& unknowns, const std::vector<Index>& number,
           std::vector<Place> places, std::vector<Index> coupled);

  /// Factors the chains of all harmonics for the present samples, scaled by `rows` and `columns`.
  /// @returns false where a chain is singular
  bool factor(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns, Complex shift);

  /// Harmonics that have factors: for a real shift those of -k are conjugates.
  int first_harmonic() const { return shift_.imag() == 0.0 ? 0 : -tangents_.harmonics(); }

  /// `coefficients`: width x unknowns of each right-hand side; for a real shift only those of k >=
  /// 0 are found, for `only_coupled` those in blocks that rows of the border refer to. Absent
  /// coefficients stay as they are.
  void solve(Eigen::MatrixXcd& coefficients, bool only_coupled);

  /// Solves for columns of one harmonic. Rows are those of the blocks that have it.
  class Columns {
   public:
    /// `filled`: numbers of unknowns. The columns are zero outside their blocks.
    Columns(HarmonicChains& chains, int harmonic, const std::vector<Index>& filled);
    ~Columns();
    Columns(const Columns&) = delete;
    Columns& operator=(const Columns&) = delete;

    bool is_empty() const { return filled_.empty(); }
    /// Of an unknown; -1: absent.
    Index row_of(Index unknown) const;
    /// Sets `right` to columns of zeros in the blocks that are filled.
    void start(Index count, Eigen::MatrixXcd& right) const;
    /// In place; finds the rows of blocks that rows of the border refer to.
    void solve(Eigen::MatrixXcd& right);

   private:
    /// From a row of all unknowns to one of those that are left, or back.
    struct Transfer {
      Index from;
      Index to;
      Complex factor;
    };
    static void add(const std::vector<Transfer>& transfers, const Eigen::MatrixXcd& from,
                    Eigen::MatrixXcd& to);
    void list_transfers();

    HarmonicChains& all_;
    int harmonic_;
    std::vector<Index> filled_;       ///< blocks
    std::vector<Index> reached_;      ///< blocks that are filled without the local unknowns
    std::vector<Transfer> condense_;  ///< from the columns to those without local unknowns
    /// Of the blocks that rows of the border refer to: what is left, then the local unknowns.
    std::vector<Transfer> recover_;
    std::vector<Transfer> recover_local_;
    Eigen::MatrixXcd condensed_;
  };

  /// Of all harmonics, up to multiples of 2 pi i and a constant that does not depend on the shift.
  Complex log_determinant() const;

 private:
  /// Blocks that have a harmonic.
  struct Pattern {
    std::vector<Index> blocks;    ///< of all blocks
    std::vector<Index> local;     ///< number of each block among these; -1: none
    std::vector<PetscInt> begin;  ///< block pattern
    std::vector<PetscInt> columns;
    std::vector<Index> block_of;  ///< block of each place; -1: absent
    std::vector<char> has_both;   ///< whether row and column of each place have the harmonic
    std::vector<Index> target;    ///< of each place in the blocks' values; -1: none
    std::vector<Index> coupled;   ///< blocks that rows of the border refer to
    bool has(Index place) const { return has_both[static_cast<std::size_t>(place)] != 0; }
  };
  /// A local unknown, with the ends of its links.
  struct LinkedUnknown {
    Index unknown;
    Index diagonal;  ///< its own place
    double inverse;  ///< of its own entry
    std::ptrdiff_t row_end;
    std::ptrdiff_t column_end;
  };
  /// An entry of a local unknown's row or column, K and M divided by the unknown's own entry.
  struct Link {
    Index place;
    Index other;
    Index position;  ///< of the other in its block, without local unknowns
    double value;
    double rate;
    bool is_partial;  ///< one of both does not have all harmonics
    Complex at(Complex s) const { return value + s * rate; }
  };

  Index row_of(Index place) const {
    return number_[static_cast<std::size_t>(places_[static_cast<std::size_t>(place)].row)];
  }
  Index column_of(Index place) const {
    return number_[static_cast<std::size_t>(places_[static_cast<std::size_t>(place)].column)];
  }
  Complex rate_of(int harmonic) const { return shift_ + Complex(0.0, harmonic * tangents_.rate()); }
  Eigen::VectorXcd rates() const;
  /// The scaled entry at a place.
  Complex entry(Index place, Complex rate) const {
    return entries_(0, place) + rate * entries_(1, place);
  }
  bool has_all(PetscInt unknown) const {
    return tangents_.sectors() == 1 || tangents_.sector().is_moved(unknown);
  }
  bool have_both(Index one, Index other, Index row) const;
  BlockFactors<Complex>& factors_of(int harmonic) {
    return factors_[static_cast<std::size_t>(harmonic - first_harmonic())];
  }
  const Pattern& pattern_of(int harmonic) const;
  void find_pattern(int remainder);
  void scale_entries(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns);
  void list_links();
  bool factor(int harmonic);
  void condense(int harmonic, Eigen::VectorXcd& values) const;
  void condense(Eigen::MatrixXcd& coefficients) const;
  void recover(Eigen::MatrixXcd& coefficients) const;

  const HarmonicTangents& tangents_;
  Index block_ = 1;
  std::vector<PetscInt> unknowns_;
  std::vector<Index> number_;
  std::vector<Place> places_;
  std::vector<Index> coupled_;
  int samplings_ = 0;  ///< of the tangents, for which the local unknowns are
  LocalUnknowns locals_;
  std::vector<int> remainders_;    ///< of the unknowns' harmonics, for which the patterns are
  std::vector<Pattern> patterns_;  ///< for the remainders of the harmonics by the sectors
  Complex shift_;
  Eigen::MatrixXd entries_;                     ///< scaled means of K and of M at the places
  std::vector<LinkedUnknown> linked_;           ///< the local unknowns
  std::vector<Link> row_links_;                 ///< entries of their rows
  std::vector<Link> column_links_;              ///< of their columns
  std::vector<BlockFactors<Complex>> factors_;  ///< of each harmonic from first_harmonic()
};

}  // namespace samara::analysis
