#include "samara/components/portion.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "samara/base/index.hpp"
#include "samara/components/block_matrix.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::components {
namespace {

constexpr int shared = system::PeriodicSystem::shared;

}  // namespace

std::vector<int> Portion::find_common_blocks(const TangentPlan& plan) {
  std::set<int> blocks;
  for (const TangentPlan::Call& call : plan.calls)
    if (!call.provisions.empty())
      blocks.insert(call.argument_blocks.begin(), call.argument_blocks.end());
  return {blocks.begin(), blocks.end()};
}

std::shared_ptr<const Portion> Portion::find(const TangentPlan& plan, std::vector<int> owners,
                                             int rank) {
  auto portion = std::make_shared<Portion>();
  portion->owners_ = std::move(owners);
  portion->rank_ = rank;
  for (const TangentPlan::Call& call : plan.calls) {
    std::set<int> of_arguments;
    std::set<int> of_rows;
    for (const int block : call.argument_blocks) of_arguments.insert(portion->owners_[at(block)]);
    for (const int block : call.row_blocks) of_rows.insert(portion->owners_[at(block)]);
    of_arguments.erase(shared);
    if (of_arguments.size() > 1 || (!of_arguments.empty() && !call.provisions.empty()))
      return nullptr;
    const int owner = of_arguments.empty() ? shared : *of_arguments.begin();
    bool is_needed = !call.provisions.empty();
    for (const int of_row : of_rows) {
      if (owner != shared && of_row != shared && of_row != owner) return nullptr;
      is_needed = is_needed || portion->is_own(of_row != shared ? of_row : owner);
    }
    portion->owner_of_arguments_.push_back(owner);
    portion->is_needed_.push_back(is_needed ? 1 : 0);
  }
  return portion;
}

bool Portion::is_own(int owner) const { return owner == rank_ || (owner == shared && rank_ == 0); }

bool Portion::has_unknown(int unknown) const {
  const int owner = owners_[at(unknown / BlockMatrix::block)];
  return owner == rank_ || owner == shared;
}

bool Portion::has_share(std::size_t call, int row) const {
  const int of_row = owners_[at(row / BlockMatrix::block)];
  return is_own(of_row != shared ? of_row : owner_of_arguments_[call]);
}

bool Portion::has_entry(int row, int column) const {
  const int of_row = owners_[at(row / BlockMatrix::block)];
  return is_own(of_row != shared ? of_row : owners_[at(column / BlockMatrix::block)]);
}

}  // namespace samara::components
