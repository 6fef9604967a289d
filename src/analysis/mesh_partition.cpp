#include "mesh_partition.hpp"

#include <algorithm>
#include <numeric>

namespace samara::analysis {
namespace {

/// Smallest piece of a chain, in blocks.
constexpr Eigen::Index least_piece = 100;
/// Largest border that a distribution may have, as a part of all blocks.
constexpr double largest_border = 0.1;

/// Owners of the blocks, whose pieces have equal lengths. Blocks behind a cut join the border.
std::vector<int> cut(const TangentPattern& pattern, PetscInt block_size, int pieces,
                     std::vector<char>& border) {
  const auto inner = std::max<Eigen::Index>(std::count(border.begin(), border.end(), 0), 1);
  std::vector<int> owners;
  Eigen::Index number = 0;
  for (const char is_border : border)
    owners.push_back(is_border ? system::PeriodicSystem::shared
                               : static_cast<int>(number++ * pieces / inner));
  for (PetscInt i = 0; i < static_cast<PetscInt>(pattern.rows()); ++i)
    for (TangentPattern::InnerIterator it(pattern, i); it; ++it) {
      const auto row = static_cast<std::size_t>(i / block_size);
      const auto column = static_cast<std::size_t>(it.col() / block_size);
      if (owners[row] == owners[column] || border[row] || border[column]) continue;
      const std::size_t behind = std::max(row, column);
      border[behind] = 1;
      owners[behind] = system::PeriodicSystem::shared;
    }
  return owners;
}

}  // namespace

MeshPartition::MeshPartition(const system::PeriodicSystem& system, const Coordinates& held,
                             bool by_sector, MPI_Comm comm)
    : whole_(system),
      ranks_(comm),
      block_size_(block_size_of(system)),
      sector_(static_cast<PetscInt>(system.size())) {
  RotorSector sector = sector_;
  const bool may_be_sector = by_sector && system.symmetry().sectors > 1 && system.period() > 0.0;
  const bool may_be_distributed =
      ranks_.size > 1 && block_size_ > 1 && system.size() >= 2 * least_piece * block_size_;
  if (may_be_sector || may_be_distributed) {
    const TangentPattern pattern = find_pattern(system, held);
    if (may_be_sector) sector = find_sector(pattern, held);
    const bool is_less = ranks_.size < sector.sectors;  // than a part on a rank
    if (may_be_distributed && !is_less && distribute(pattern, held)) return;
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
bool MeshPartition::distribute(const TangentPattern& pattern, const Coordinates& held) {
  std::vector<char> border = find_border(pattern, block_size_, held);
  for (const PetscInt i : whole_.common_unknowns())
    border[static_cast<std::size_t>(i / block_size_)] = 1;
  const auto inner = std::count(border.begin(), border.end(), 0);
  const auto pieces = static_cast<int>(std::min<Eigen::Index>(ranks_.size, inner / least_piece));
  if (pieces < 2) return false;
  const std::vector<int> owners = cut(pattern, block_size_, pieces, border);
  const auto border_blocks = std::count(border.begin(), border.end(), 1);
  if (static_cast<double>(border_blocks) > largest_border * static_cast<double>(border.size()))
    return false;
  std::vector<int> of_unknowns(static_cast<std::size_t>(whole_.size()));
  for (std::size_t i = 0; i < of_unknowns.size(); ++i)
    of_unknowns[i] = owners[i / static_cast<std::size_t>(block_size_)];
  part_ = whole_.part_of(ranks_.rank, of_unknowns);
  if (!part_) return false;
  is_border_ = std::move(border);
  std::vector<PetscInt> kept;
  sector_.number.assign(of_unknowns.size(), -1);
  for (std::size_t i = 0; i < of_unknowns.size(); ++i) {
    const bool is_shared = of_unknowns[i] == system::PeriodicSystem::shared;
    if (!is_shared && of_unknowns[i] != ranks_.rank) continue;
    const auto number = static_cast<PetscInt>(kept.size());
    sector_.number[i] = number;
    if (is_shared) border_.push_back(number);
    if (!is_shared || is_first()) counted_.push_back(number);
    kept.push_back(static_cast<PetscInt>(i));
  }
  sector_.kept = std::move(kept);
  sector_.remainder.resize(sector_.kept.size());
  return true;
}

void MeshPartition::work_alone(RotorSector sector) {
  ranks_ = Ranks(MPI_COMM_SELF);
  sector_ = std::move(sector);
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
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(coefficients.rows(), whole_.size());
  for (const PetscInt i : counted_)
    all.col(sector_.kept[static_cast<std::size_t>(i)]) = coefficients.col(i);
  ranks_.sum(all);
  return all;
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
