#include "samara/components/registry.hpp"

#include <numeric>

#include "samara/base/error.hpp"
#include "samara/base/index.hpp"
#include "samara/components/block_matrix.hpp"

namespace samara::components {
namespace {

constexpr int block = BlockMatrix::block;
/// Blocks that several components share are filled in slots of six unknowns: a force and a moment.
constexpr int slot = 6;

}  // namespace

Registry Registry::placing(const Registry& counted) {
  Registry registry;
  int size = 0;
  for (const auto& [number, rank] : counted.ranks_) {
    registry.ranks_[number].start = size;
    size += block * rank.blocks;
  }
  registry.declared_.unknowns.resize(at(size));
  registry.declared_.rows.assign(at(size), system::RowRole::constraint);
  registry.is_described_.assign(at(size), false);
  return registry;
}

int Registry::add_block(int rank) {
  Rank& own = ranks_[rank];
  own.free_slots = 0;
  return own.start + block * own.blocks++;
}

int Registry::add_shared(int rank, int count) {
  const int slots = (count + slot - 1) / slot;
  if (count < 1 || slot * slots > block)
    throw InternalError("the number of unknowns does not fit in a block");
  Rank& own = ranks_[rank];
  if (own.free_slots < slots) {
    add_block(rank);
    own.free_slots = block / slot;
  }
  const int first = own.start + block * own.blocks - slot * own.free_slots;
  own.free_slots -= slots;
  return first;
}

int Registry::add_port(int values) {
  declared_.port_sizes.push_back(values);
  return static_cast<int>(declared_.port_sizes.size()) - 1;
}

void Registry::describe(int unknown, const system::Unknown& what, system::RowRole row) {
  declared_.unknowns[at(unknown)] = what;
  declared_.rows[at(unknown)] = row;
  if (is_described_[at(unknown)]) throw InternalError(what.name() + " is declared twice");
  is_described_[at(unknown)] = true;
  if (what.owner.instance > 0) instances_[what.owner.part][what.owner.instance].push_back(unknown);
}

void Registry::set_free(int unknown) {
  system::Unknown& what = declared_.unknowns[at(unknown)];
  what.is_free = true;
  set_row(unknown, system::RowRole::balance);
  add_free({what.name(), unknown, unknown, what.load_unit()});
}

void Registry::add_free(const system::UnconstrainedCoordinate& free) {
  declared_.free.push_back(free);
}

void Registry::set_row(int unknown, system::RowRole row) { declared_.rows[at(unknown)] = row; }

void Registry::add(const system::EnergyGroup& group) { declared_.energies.push_back(group); }

void Registry::add(const system::UnconstrainedCoordinate& unconstrained) {
  declared_.unconstrained.push_back(unconstrained);
}

void Registry::add(const system::MeshError& error) { declared_.mesh_errors.push_back(error); }

void Registry::add(const system::Motion& motion) { declared_.motions.push_back(motion); }

void Registry::add(const Channel& channel) { declared_.channels.push_back(channel); }

void Registry::reverse(int unknown) { reversed_.push_back(unknown); }

Declarations Registry::finish() {
  for (std::size_t i = 0; i < is_described_.size(); ++i) {
    if (is_described_[i]) continue;
    declared_.unknowns[i] = {{system::PartKind::law, "padding"}, "", "", ""};
    declared_.padding.push_back(static_cast<int>(i));
  }
  return declared_;
}

system::RotorSymmetry Registry::symmetry(int blades) const {
  system::RotorSymmetry symmetry;
  symmetry.sectors = blades;
  symmetry.source.resize(declared_.unknowns.size());
  std::iota(symmetry.source.begin(), symmetry.source.end(), 0);
  symmetry.sign.assign(declared_.unknowns.size(), 1.0);
  if (blades < 2) return symmetry;
  for (const auto& [part, numbered] : instances_)
    for (const auto& [number, own] : numbered) {
      const std::vector<int>& before = numbered.at(number == 1 ? blades : number - 1);
      if (before.size() != own.size())
        throw InternalError("the number of unknowns differs between parts " + part);
      for (std::size_t i = 0; i < own.size(); ++i) symmetry.source[at(own[i])] = before[i];
    }
  for (const int unknown : reversed_) symmetry.sign[at(unknown)] = -1.0;
  return symmetry;
}

}  // namespace samara::components
