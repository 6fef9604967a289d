// Unknowns of the blocks of a sparse matrix that follow from others of their own block.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "harmonic_tangents.hpp"

namespace samara::analysis {

/// Unknowns whose rows of K + s M have other unknowns of their own block only, and a factor of
/// their own that does not depend on s: velocities of the points of a beam, f_P and f_H of
/// docs/theory.md, section 2.2. Their elimination couples no blocks that are not coupled without
/// it, and leaves smaller ones. Every block has the same number of them: none, where one block has
/// none.
class LocalUnknowns {
 public:
  using Index = Eigen::Index;
  using Place = HarmonicTangents::Place;

  struct Local {
    Index unknown = 0;
    Index diagonal = 0;          ///< number of its own place
    std::vector<Index> row;      ///< numbers of the other places of its row
    std::vector<Index> columns;  ///< of those of its column: rows that are left
  };

  /// Finds them. `places`: of the matrix of `size` unknowns, in blocks of `block`; `number`: of the
  /// rows and columns of places in it; `means`: of K and M at the places.
  /// @returns whether they are others than before
  bool find(const std::vector<Place>& places, const std::vector<Index>& number, Index size,
            Index block, const Eigen::MatrixXd& means);

  const std::vector<Local>& all() const { return all_; }
  /// Unknowns of a block that are left.
  Index block() const { return block_; }
  /// Number of an unknown in its block among those that are left; -1: eliminated.
  Index position(Index unknown) const { return position_[static_cast<std::size_t>(unknown)]; }

 private:
  Index block_ = 0;
  std::vector<Index> position_;
  std::vector<Local> all_;
};

}  // namespace samara::analysis
