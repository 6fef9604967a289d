// Distribution of a mesh over ranks (docs/theory.md, section 4.2).
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "samara/analysis/ranks.hpp"
#include "samara/system/periodic_system.hpp"

#include "rotor_sector.hpp"
#include "tangent_pattern.hpp"

namespace samara::analysis {

/// Node blocks of a mesh by ranks. The chains between the border are cut into pieces of equal
/// work, one for each rank; the block behind a cut joins the border. Every rank has its own
/// piece and the border: no block of a piece is coupled to another piece. Where one of identical
/// blades stands for all, its chain is cut, and the others like it: a rank evaluates the same piece
/// of each blade.
///
/// A vector on this rank has the unknowns of its piece and of the border, in ascending order. The
/// first rank counts those of the border where a vector is summed or stored once.
class MeshPartition {
 public:
  struct Limits {
    Eigen::Index least_piece = 100;  ///< blocks of a piece, on average
    Eigen::Index of_cut = 0;         ///< more of them for each block that a cut adds to the border
    Eigen::Index free_of_cut = 0;    ///< but for so many of these
    bool is_for_all = false;         ///< no distribution over some of the ranks
    /// No distribution where unknowns of a medium that refer to each other would not be in one
    /// piece.
    bool keeps_medium = false;
  };
  /// With one rank, or where the mesh is too small to be worth a distribution or cannot be divided,
  /// every rank works for itself. The mesh is the whole one, or a sector of the rotor where
  /// `by_sector` holds and all held coordinates have a mean in it.
  MeshPartition(const system::PeriodicSystem& system, const Coordinates& held, bool by_sector,
                MPI_Comm comm, const Limits& limits);
  MeshPartition(const system::PeriodicSystem& system, const Coordinates& held, bool by_sector,
                MPI_Comm comm)
      : MeshPartition(system, held, by_sector, comm, Limits()) {}

  bool is_distributed() const { return ranks_.size > 1; }
  /// Of one rank, if the mesh is not distributed.
  const Ranks& ranks() const { return ranks_; }
  bool is_first() const { return ranks_.rank == 0; }
  /// What this rank evaluates.
  const system::PeriodicSystem& system() const { return part_ ? *part_ : whole_; }

  /// The unknowns on this rank, of one of identical blades where this stands for all.
  const RotorSector& sector() const { return sector_; }

  PetscInt block_size() const { return block_size_; }  ///< see block_size_of
  /// Unknowns of the system on this rank, ascending.
  const std::vector<PetscInt>& kept() const { return sector_.kept; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(sector_.kept.size()); }
  /// Number of unknowns on all ranks.
  Eigen::Index size_of_all() const { return size_of_all_; }
  /// Number of an unknown of the system among those on this rank; -1: another rank has it.
  PetscInt number_of(PetscInt unknown) const {
    return sector_.number[static_cast<std::size_t>(unknown)];
  }
  /// Numbers of the unknowns that this rank counts.
  const std::vector<PetscInt>& counted() const { return counted_; }
  /// Counted unknowns that follow each other in the system.
  struct Run {
    PetscInt unknown;  ///< of the system, the first one
    PetscInt counted;  ///< its place among those that this rank counts
    PetscInt count;
  };
  std::vector<Run> runs() const;
  /// The unknowns of the border, by their numbers in the system.
  std::vector<PetscInt> border_unknowns() const;
  /// Of a distributed mesh: the rank of each unknown of the system, or PeriodicSystem::shared.
  const std::vector<int>& owners() const { return owners_; }
  /// Of a distributed mesh: whether each block of the system belongs to the border.
  const std::vector<char>& border() const { return is_border_; }

  /// Adds up the columns of the border, each rank having a part of them. One column for each
  /// unknown on this rank.
  void sum_border(Eigen::Ref<Eigen::MatrixXd> values) const;
  /// From the coefficients of the unknowns on this rank, mean, cosine and sine of each harmonic by
  /// row, to those of the whole system; zero where another rank has the unknown.
  Eigen::MatrixXd own(const Eigen::Ref<const Eigen::MatrixXd>& coefficients) const;
  /// The same with the unknowns of all ranks.
  Eigen::MatrixXd whole(const Eigen::Ref<const Eigen::MatrixXd>& values) const;
  /// From the series, k = -H ... H by row, of the unknowns that this rank counts to those of the
  /// whole system; zero where another rank counts the unknown.
  Eigen::MatrixXcd own_series(const Eigen::MatrixXcd& counted) const;
  /// From the series of the whole system to the unknowns that this rank counts.
  Eigen::MatrixXcd counted_series(const Eigen::MatrixXcd& whole) const;
  /// From the columns of the whole system to those on this rank.
  Eigen::MatrixXd local(const Eigen::Ref<const Eigen::MatrixXd>& values) const;
  /// From the unknowns that the ranks count to those on this rank.
  void spread(const double* counted, Eigen::Ref<Eigen::MatrixXd> values) const;
  /// The unknowns that this rank counts, into `counted`.
  void collect(const Eigen::Ref<const Eigen::MatrixXd>& values, double* counted) const;

 private:
  bool distribute(const TangentPattern& pattern, const Coordinates& held, const RotorSector& sector,
                  const Limits& limits);
  RotorSector find_sector(const TangentPattern& pattern, const Coordinates& held) const;
  void work_alone(RotorSector sector);

  const system::PeriodicSystem& whole_;
  Ranks ranks_;
  PetscInt block_size_;
  std::unique_ptr<system::PeriodicSystem> part_;
  std::vector<int> owners_;
  std::vector<char> is_border_;
  Eigen::Index size_of_all_ = 0;
  RotorSector sector_;  ///< its numbers are those of the unknowns on this rank
  std::vector<PetscInt> counted_;
  std::vector<PetscInt> border_;  ///< numbers of its unknowns
};

}  // namespace samara::analysis
