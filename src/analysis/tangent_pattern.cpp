#include "tangent_pattern.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "samara/petsc/handle.hpp"

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

}  // namespace samara::analysis
