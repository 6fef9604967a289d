#include "mesh_partition.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace samara::analysis {
namespace {

/// A block belongs to the border if more blocks than this refer to it, and some of them are far. (A
/// node of a chain has two neighbours, and is in the rows of joints and reactions. The blocks of an
/// element of a high order, with the air at its points, are many neighbours, but all of them are
/// near.)
constexpr std::size_t most_neighbours = 8;
/// Largest distance of near blocks, and the same as a part of all blocks.
constexpr PetscInt near = 40;
constexpr PetscInt near_part = 3;
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

TangentPattern find_pattern(const system::PeriodicSystem& system, const Coordinates& held) {
  std::vector<std::vector<PetscInt>> rows = system.pattern();
  if (rows.empty()) {  // the system does not declare a pattern
    std::vector<PetscInt> all(static_cast<std::size_t>(system.size()));
    std::iota(all.begin(), all.end(), PetscInt{0});
    rows.assign(all.size(), all);
  }
  for (const system::UnconstrainedCoordinate& coordinate : held) {
    std::vector<PetscInt>& row = rows[static_cast<std::size_t>(coordinate.row)];
    const auto place = std::lower_bound(row.begin(), row.end(), coordinate.unknown);
    if (place == row.end() || *place != coordinate.unknown) row.insert(place, coordinate.unknown);
  }
  TangentPattern pattern(system.size(), system.size());
  Eigen::VectorXi lengths(system.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    lengths(static_cast<Eigen::Index>(i)) = static_cast<int>(rows[i].size());
  pattern.reserve(lengths);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const PetscInt j : rows[i]) pattern.insert(static_cast<Eigen::Index>(i), j) = 1.0;
  pattern.makeCompressed();
  return pattern;
}

PetscInt block_size_of(const system::PeriodicSystem& system) {
  const petsc::Handle<Mat> matrix = system.make_jacobian();
  PetscBool is_blocked = PETSC_FALSE;
  PetscInt size = 1;
  petsc::check(
      PetscObjectTypeCompare(reinterpret_cast<PetscObject>(matrix.get()), MATSEQBAIJ, &is_blocked));
  if (is_blocked != PETSC_FALSE) petsc::check(MatGetBlockSize(matrix.get(), &size));
  return size;
}

std::vector<char> find_border(const TangentPattern& pattern, PetscInt block_size,
                              const Coordinates& held) {
  std::vector<std::set<PetscInt>> users(static_cast<std::size_t>(pattern.cols() / block_size));
  for (PetscInt i = 0; i < static_cast<PetscInt>(pattern.rows()); ++i)
    for (TangentPattern::InnerIterator it(pattern, i); it; ++it) {
      users[static_cast<std::size_t>(it.col() / block_size)].insert(i / block_size);
    }
  const PetscInt most = std::min(near, static_cast<PetscInt>(users.size()) / near_part);
  std::vector<char> border;
  for (std::size_t b = 0; b < users.size(); ++b) {
    const std::set<PetscInt>& own = users[b];
    const auto place = static_cast<PetscInt>(b);
    const bool is_border = own.size() > most_neighbours &&
                           std::max(place - *own.begin(), *own.rbegin() - place) > most;
    border.push_back(is_border ? 1 : 0);
  }
  for (const system::UnconstrainedCoordinate& coordinate : held)
    for (const PetscInt i : {coordinate.unknown, coordinate.row})
      border[static_cast<std::size_t>(i / block_size)] = 1;
  return border;
}

MeshPartition::MeshPartition(const system::PeriodicSystem& system, const Coordinates& held,
                             MPI_Comm comm)
    : whole_(system), ranks_(comm), block_size_(block_size_of(system)) {
  if (!distribute(held)) keep_all();
}

/// @returns false where every rank has to keep the whole mesh
bool MeshPartition::distribute(const Coordinates& held) {
  if (ranks_.size == 1 || block_size_ == 1 || whole_.size() < 2 * least_piece * block_size_)
    return false;
  const TangentPattern pattern = find_pattern(whole_, held);
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
  number_.assign(of_unknowns.size(), -1);
  for (std::size_t i = 0; i < of_unknowns.size(); ++i) {
    const bool is_shared = of_unknowns[i] == system::PeriodicSystem::shared;
    if (!is_shared && of_unknowns[i] != ranks_.rank) continue;
    number_[i] = static_cast<PetscInt>(kept_.size());
    if (is_shared) border_.push_back(number_[i]);
    if (!is_shared || is_first()) counted_.push_back(number_[i]);
    kept_.push_back(static_cast<PetscInt>(i));
  }
  return true;
}

void MeshPartition::keep_all() {
  ranks_ = Ranks(MPI_COMM_SELF);
  kept_.resize(static_cast<std::size_t>(whole_.size()));
  std::iota(kept_.begin(), kept_.end(), 0);
  number_ = kept_;
  counted_ = kept_;
}

void MeshPartition::sum_border(Eigen::Ref<Eigen::MatrixXd> values) const {
  if (!is_distributed()) return;
  Eigen::MatrixXd border = values(Eigen::all, border_);
  ranks_.sum(border);
  values(Eigen::all, border_) = border;
}

Eigen::MatrixXd MeshPartition::whole(const Eigen::Ref<const Eigen::MatrixXd>& values) const {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(values.rows(), whole_.size());
  for (const PetscInt i : counted_) all.col(kept_[static_cast<std::size_t>(i)]) = values.col(i);
  ranks_.sum(all);
  return all;
}

Eigen::MatrixXd MeshPartition::local(const Eigen::Ref<const Eigen::MatrixXd>& values) const {
  return values(Eigen::all, kept_);
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
