// The functions of a system that one rank of a distributed mesh evaluates.
#pragma once

#include <memory>
#include <vector>

#include "samara/components/pattern.hpp"

namespace samara::components {

/// Every share of a function and every constant entry belongs to one rank: to the owner of its row,
/// to that of the arguments if the row is shared, and to the first rank if all are shared. The sums
/// over ranks are those of the whole system. Ports get their values on all ranks.
class Portion {
 public:
  /// Blocks that the values of ports depend on; every rank needs them.
  static std::vector<int> find_common_blocks(const TangentPlan& plan);

  /// `owners`: rank of each block, or PeriodicSystem::shared. Null if a share contains blocks of
  /// two ranks, or if a port depends on a block that is not shared.
  static std::shared_ptr<const Portion> find(const TangentPlan& plan, std::vector<int> owners,
                                             int rank);

  /// Whether this rank needs the function of a call, in the order of the plan.
  bool needs(std::size_t call) const { return is_needed_[call] != 0; }
  /// Whether a share of the function belongs to this rank.
  bool has_share(std::size_t call, int row) const;
  /// Whether an unknown and its row are shared or belong to this rank.
  bool has_unknown(int unknown) const;
  /// Whether a constant entry of K belongs to this rank.
  bool has_entry(int row, int column) const;

 private:
  bool is_own(int owner) const;

  std::vector<int> owners_;
  int rank_ = 0;
  std::vector<int> owner_of_arguments_;  ///< of each call
  std::vector<char> is_needed_;
};

}  // namespace samara::components
