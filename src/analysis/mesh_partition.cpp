#include "mesh_partition.hpp"

#include <algorithm>
#include <numeric>

namespace samara::analysis {
namespace {

/// Largest border that a distribution may have, as a part of all blocks.
constexpr double largest_border = 0.1;

/// Blocks of a mesh that are cut: all of them, or those of one of identical blades and of the parts
/// that do not turn into another blade.
class Blocks {
 public:
  Blocks(const system::PeriodicSystem& system, const RotorSector& sector, PetscInt block_size)
      : symmetry_(system.symmetry()),
        size_(block_size),
        is_kept_(static_cast<std::size_t>(system.size() / block_size), 0),
        is_partly_kept_(is_kept_),
        is_of_medium_(is_kept_) {
    for (std::size_t i = 0; i < system.unknowns().size(); ++i)
      if (system.unknowns()[i].is_of_medium())
        is_of_medium_[i / static_cast<std::size_t>(size_)] = 1;
    std::vector<PetscInt> kept(is_kept_.size(), 0);
    for (const PetscInt i : sector.kept) ++kept[static_cast<std::size_t>(i / size_)];
    for (std::size_t block = 0; block < kept.size(); ++block) {
      is_kept_[block] = kept[block] > 0 ? 1 : 0;
      is_partly_kept_[block] = kept[block] > 0 && kept[block] < size_ ? 1 : 0;
    }
    if (sector.sectors > 1) find_images();
  }

  /// Work of a block, relative to that of others: the number of blades that it stands for, and of
  /// the harmonics that its unknowns have.
  std::vector<int> weights() const {
    std::vector<int> weights(is_kept_.size(), 1);
    for (std::size_t block = 0; block < images_.size(); ++block)
      if (images_[block].front() != block) weights[block] = symmetry_.sectors;
    return weights;
  }

  const std::vector<char>& kept() const { return is_kept_; }
  bool is_of_medium(std::size_t block) const { return is_of_medium_[block] != 0; }
  /// Those of which the sector has a part join the border, and all that turn into one of it.
  void complete(std::vector<char>& border) const {
    for (std::size_t block = 0; block < border.size(); ++block)
      border[block] = border[block] != 0 || is_partly_kept_[block] != 0 ? 1 : 0;
    for (int turn = 1; turn < symmetry_.sectors && !images_.empty(); ++turn) {
      const std::vector<char> before = border;
      for (std::size_t block = 0; block < border.size(); ++block)
        if (before[block])
          for (const std::size_t image : images_[block]) border[image] = 1;
    }
  }
  /// Gives the blocks of other blades the owners of those of the first one. @returns false where a
  /// block turns into several ones
  bool spread(std::vector<int>& owners) const {
    if (images_.empty()) return true;
    for (std::size_t first = 0; first < owners.size(); ++first) {
      if (!is_kept_[first] || owners[first] == system::PeriodicSystem::shared) continue;
      std::size_t block = first;
      for (int turn = 1; turn < symmetry_.sectors; ++turn) {
        if (images_[block].size() != 1) return false;
        block = images_[block].front();
        owners[block] = owners[first];
      }
    }
    return true;
  }

 private:
  /// The blocks with the sources of the unknowns of each block.
  void find_images() {
    images_.resize(is_kept_.size());
    for (std::size_t i = 0; i < symmetry_.source.size(); ++i) {
      std::vector<std::size_t>& images = images_[i / static_cast<std::size_t>(size_)];
      const auto image = static_cast<std::size_t>(symmetry_.source[i] / size_);
      // What fills up a block is its own source.
      const bool is_moved = symmetry_.source[i] != static_cast<PetscInt>(i);
      if (is_moved && std::ranges::find(images, image) == images.end()) images.push_back(image);
    }
    for (std::size_t block = 0; block < images_.size(); ++block)
      if (images_[block].empty()) images_[block].push_back(block);
  }

  const system::RotorSymmetry& symmetry_;
  PetscInt size_;
  std::vector<char> is_kept_;
  std::vector<char> is_partly_kept_;
  std::vector<char> is_of_medium_;
  std::vector<std::vector<std::size_t>> images_;  ///< empty: the mesh has no sectors
};

/// Owners of the blocks, whose pieces have equal weights. Of two blocks that a cut would part, one
/// joins the border: the one behind the cut, but for blocks of a medium. Blocks that are not kept
/// belong to the first rank.
std::vector<int> cut(const TangentPattern& pattern, PetscInt block_size, int pieces,
                     const Blocks& blocks, std::vector<char>& border) {
  const std::vector<char>& kept = blocks.kept();
  const std::vector<int> weights = blocks.weights();
  const auto is_inner = [&](std::size_t block) { return kept[block] && !border[block]; };
  Eigen::Index sum = 0;
  for (std::size_t block = 0; block < border.size(); ++block)
    if (is_inner(block)) sum += weights[block];
  std::vector<int> owners;
  Eigen::Index before = 0;
  for (std::size_t block = 0; block < border.size(); ++block) {
    owners.push_back(is_inner(block) ? static_cast<int>(before * pieces / sum)
                     : border[block] ? system::PeriodicSystem::shared
                                     : 0);
    if (is_inner(block)) before += weights[block];
  }
  for (PetscInt i = 0; i < static_cast<PetscInt>(pattern.rows()); ++i)
    for (TangentPattern::InnerIterator it(pattern, i); it; ++it) {
      const auto row = static_cast<std::size_t>(i / block_size);
      const auto column = static_cast<std::size_t>(it.col() / block_size);
      if (owners[row] == owners[column] || border[row] || border[column] || !kept[row] ||
          !kept[column])
        continue;
      std::size_t joins = std::max(row, column);
      if (const std::size_t other = std::min(row, column);
          blocks.is_of_medium(joins) && !blocks.is_of_medium(other))
        joins = other;
      border[joins] = 1;
      owners[joins] = system::PeriodicSystem::shared;
    }
  return owners;
}

/// Whether some blocks of a medium that refer to each other are not in one piece.
bool parts_medium(const TangentPattern& pattern, PetscInt block_size, const Blocks& blocks,
                  const std::vector<int>& owners) {
  for (PetscInt i = 0; i < static_cast<PetscInt>(pattern.rows()); ++i) {
    const auto row = static_cast<std::size_t>(i / block_size);
    if (!blocks.is_of_medium(row)) continue;
    if (owners[row] == system::PeriodicSystem::shared) return true;
    for (TangentPattern::InnerIterator it(pattern, i); it; ++it) {
      const auto column = static_cast<std::size_t>(it.col() / block_size);
      if (blocks.is_of_medium(column) && owners[column] != owners[row]) return true;
    }
  }
  return false;
}

}  // namespace

MeshPartition::MeshPartition(const system::PeriodicSystem& system, const Coordinates& held,
                             bool by_sector, MPI_Comm comm, const Limits& limits)
    : whole_(system),
      ranks_(comm),
      block_size_(block_size_of(system)),
      sector_(static_cast<PetscInt>(system.size())) {
  RotorSector sector = sector_;
  const bool may_be_sector = by_sector && system.symmetry().sectors > 1 && system.period() > 0.0;
  const bool may_be_distributed =
      ranks_.size > 1 && block_size_ > 1 && system.size() >= 2 * limits.least_piece * block_size_;
  if (may_be_sector || may_be_distributed) {
    const TangentPattern pattern = find_pattern(system, held);
    if (may_be_sector) sector = find_sector(pattern, held);
    if (may_be_distributed && distribute(pattern, held, sector, limits)) return;
  }
  work_alone(std::move(sector));
}

/// All unknowns where a held coordinate has no mean in a sector.
RotorSector MeshPartition::find_sector(const TangentPattern& pattern,
                                       const Coordinates& held) const {
  RotorSector sector(whole_, pattern, block_size_);
  for (const system::UnconstrainedCoordinate& coordinate : held)
    for (const PetscInt i : {coordinate.unknown, coordinate.row}) {
      const PetscInt number = sector.number[static_cast<std::size_t>(i)];
      if (number < 0 || sector.is_moved(number) || !sector.has(number, 0)) return sector_;
    }
  return sector;
}

/// @returns false where every rank has to keep the whole mesh
bool MeshPartition::distribute(const TangentPattern& pattern, const Coordinates& held,
                               const RotorSector& sector, const Limits& limits) {
  const Blocks blocks(whole_, sector, block_size_);
  std::vector<char> border = find_border(pattern, block_size_, held);
  for (const PetscInt i : whole_.common_unknowns())
    border[static_cast<std::size_t>(i / block_size_)] = 1;
  blocks.complete(border);
  const auto count = [&blocks](const std::vector<char>& flags, char value) {
    Eigen::Index number = 0;
    for (std::size_t block = 0; block < flags.size(); ++block)
      number += blocks.kept()[block] && flags[block] == value ? 1 : 0;
    return number;
  };
  const Eigen::Index inner = count(border, 0);
  const Eigen::Index before = count(border, 1);
  const auto pieces =
      static_cast<int>(std::min<Eigen::Index>(ranks_.size, inner / limits.least_piece));
  if (pieces < (limits.is_for_all ? std::max(ranks_.size, 2) : 2)) return false;
  std::vector<int> owners = cut(pattern, block_size_, pieces, blocks, border);
  const Eigen::Index of_cuts = count(border, 1) - before;
  const Eigen::Index of_a_cut =
      std::max<Eigen::Index>(of_cuts / (pieces - 1) - limits.free_of_cut, 0);
  if (inner < pieces * (limits.least_piece + limits.of_cut * of_a_cut)) return false;
  if (static_cast<double>(count(border, 1)) >
      largest_border * static_cast<double>(count(blocks.kept(), 1)))
    return false;
  blocks.complete(border);
  for (std::size_t block = 0; block < border.size(); ++block)
    if (border[block]) owners[block] = system::PeriodicSystem::shared;
  if (!blocks.spread(owners)) return false;
  if (limits.keeps_medium && parts_medium(pattern, block_size_, blocks, owners)) return false;
  std::vector<int> of_unknowns(static_cast<std::size_t>(whole_.size()));
  for (std::size_t i = 0; i < of_unknowns.size(); ++i)
    of_unknowns[i] = owners[i / static_cast<std::size_t>(block_size_)];
  part_ = whole_.part_of(ranks_.rank, of_unknowns);
  if (!part_) return false;
  is_border_ = std::move(border);
  sector_.sectors = sector.sectors;
  sector_.kept.clear();
  sector_.remainder.clear();
  sector_.number.assign(of_unknowns.size(), -1);
  for (std::size_t at = 0; at < sector.kept.size(); ++at) {
    const PetscInt i = sector.kept[at];
    const int owner = of_unknowns[static_cast<std::size_t>(i)];
    const bool is_shared = owner == system::PeriodicSystem::shared;
    if (!is_shared && owner != ranks_.rank) continue;
    const auto number = static_cast<PetscInt>(sector_.kept.size());
    sector_.number[static_cast<std::size_t>(i)] = number;
    if (is_shared) border_.push_back(number);
    if (!is_shared || is_first()) counted_.push_back(number);
    sector_.kept.push_back(i);
    sector_.remainder.push_back(sector.remainder[at]);
  }
  owners_ = std::move(of_unknowns);
  size_of_all_ = static_cast<Eigen::Index>(sector.kept.size());
  return true;
}

void MeshPartition::work_alone(RotorSector sector) {
  ranks_ = Ranks(MPI_COMM_SELF);
  sector_ = std::move(sector);
  size_of_all_ = size();
  counted_.resize(sector_.kept.size());
  std::iota(counted_.begin(), counted_.end(), 0);
}

std::vector<MeshPartition::Run> MeshPartition::runs() const {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < counted_.size(); ++i) {
    const PetscInt unknown = sector_.kept[static_cast<std::size_t>(counted_[i])];
    if (runs.empty() || runs.back().unknown + runs.back().count != unknown)
      runs.push_back({unknown, static_cast<PetscInt>(i), 0});
    ++runs.back().count;
  }
  return runs;
}

std::vector<PetscInt> MeshPartition::border_unknowns() const {
  std::vector<PetscInt> unknowns;
  for (const PetscInt number : border_)
    unknowns.push_back(sector_.kept[static_cast<std::size_t>(number)]);
  return unknowns;
}

void MeshPartition::sum_border(Eigen::Ref<Eigen::MatrixXd> values) const {
  if (!is_distributed()) return;
  Eigen::MatrixXd border = values(Eigen::all, border_);
  ranks_.sum(border);
  values(Eigen::all, border_) = border;
}

Eigen::MatrixXd MeshPartition::own(const Eigen::Ref<const Eigen::MatrixXd>& coefficients) const {
  return sector_.whole(whole_.symmetry(), coefficients);
}

Eigen::MatrixXd MeshPartition::whole(const Eigen::Ref<const Eigen::MatrixXd>& coefficients) const {
  if (!is_distributed()) return own(coefficients);
  Eigen::MatrixXd counted = Eigen::MatrixXd::Zero(coefficients.rows(), coefficients.cols());
  counted(Eigen::all, counted_) = coefficients(Eigen::all, counted_);
  Eigen::MatrixXd all = own(counted);
  ranks_.sum(all);
  return all;
}

Eigen::MatrixXcd MeshPartition::own_series(const Eigen::MatrixXcd& counted) const {
  Eigen::MatrixXcd series = Eigen::MatrixXcd::Zero(counted.rows(), size());
  series(Eigen::all, counted_) = counted;
  return sector_.whole(whole_.symmetry(), series);
}

Eigen::MatrixXcd MeshPartition::counted_series(const Eigen::MatrixXcd& whole) const {
  Eigen::MatrixXcd counted(whole.rows(), static_cast<Eigen::Index>(counted_.size()));
  for (std::size_t i = 0; i < counted_.size(); ++i)
    counted.col(static_cast<Eigen::Index>(i)) =
        whole.col(sector_.kept[static_cast<std::size_t>(counted_[i])]);
  return counted;
}

Eigen::MatrixXd MeshPartition::local(const Eigen::Ref<const Eigen::MatrixXd>& values) const {
  return values(Eigen::all, sector_.kept);
}

void MeshPartition::spread(const double* counted, Eigen::Ref<Eigen::MatrixXd> values) const {
  for (const PetscInt i : border_) values.col(i).setZero();
  values(Eigen::all, counted_) = Eigen::Map<const Eigen::MatrixXd>(
      counted, values.rows(), static_cast<Eigen::Index>(counted_.size()));
  sum_border(values);
}

void MeshPartition::collect(const Eigen::Ref<const Eigen::MatrixXd>& values,
                            double* counted) const {
  Eigen::Map<Eigen::MatrixXd>(counted, values.rows(), static_cast<Eigen::Index>(counted_.size())) =
      values(Eigen::all, counted_);
}

}  // namespace samara::analysis
