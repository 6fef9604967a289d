#include "local_unknowns.hpp"

#include <algorithm>
#include <cmath>

namespace samara::analysis {
namespace {

using Index = Eigen::Index;

/// Least factor of a local unknown, relative to the largest entry of its row of K.
constexpr double least_pivot = 1e-6;

/// Of the mean tangents, K and M.
struct Entry {
  Index row;
  Index column;
  Index place;
  Eigen::Vector2d value;
  bool is_diagonal() const { return row == column; }
};

/// Unknowns whose rows have only their own block, a factor of their own without a rate, and no
/// other of these unknowns.
std::vector<char> candidates(const std::vector<Entry>& entries, Index size, Index block) {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(size);
  for (const Entry& entry : entries)
    largest(entry.row) = std::max(largest(entry.row), std::abs(entry.value(0)));
  std::vector<char> is_local(static_cast<std::size_t>(size), 0);
  const auto at = [&is_local](Index unknown) -> char& {
    return is_local[static_cast<std::size_t>(unknown)];
  };
  for (const Entry& entry : entries)
    if (entry.is_diagonal() && entry.value(1) == 0.0 &&
        std::abs(entry.value(0)) >= least_pivot * largest(entry.row))
      at(entry.row) = 1;
  for (const Entry& entry : entries)
    if (entry.row / block != entry.column / block) at(entry.row) = 0;
  for (const Entry& entry : entries)
    if (!entry.is_diagonal() && at(entry.column) != 0) at(entry.row) = 0;
  return is_local;
}

}  // namespace

bool LocalUnknowns::find(const std::vector<Place>& places, const std::vector<Index>& number,
                         Index size, Index block, const Eigen::MatrixXd& means) {
  const auto row_of = [&](const Place& place) {
    return number[static_cast<std::size_t>(place.row)];
  };
  const auto column_of = [&](const Place& place) {
    return number[static_cast<std::size_t>(place.column)];
  };
  std::vector<Entry> entries;
  for (std::size_t n = 0; n < places.size(); ++n)
    if (const auto mean = means.col(places[n].number); !mean.isZero(0.0))
      entries.push_back({row_of(places[n]), column_of(places[n]), static_cast<Index>(n), mean});
  const std::vector<char> is_local = candidates(entries, size, block);
  Index least = size > 0 ? block - 1 : 0;
  for (Index first = 0; first < size; first += block)
    least = std::min<Index>(
        least, std::count(is_local.begin() + first, is_local.begin() + first + block, 1));
  std::vector<Index> position(static_cast<std::size_t>(size), -1);
  for (Index first = 0; first < size; first += block) {
    Index taken = 0;
    Index next = 0;
    for (Index i = first; i < first + block; ++i) {
      const bool is_taken = is_local[static_cast<std::size_t>(i)] != 0 && taken < least;
      if (is_taken)
        ++taken;
      else
        position[static_cast<std::size_t>(i)] = next++;
    }
  }
  std::vector<Index> local_of(static_cast<std::size_t>(size), -1);
  std::vector<Local> all;
  for (Index i = 0; i < size; ++i)
    if (position[static_cast<std::size_t>(i)] < 0) {
      local_of[static_cast<std::size_t>(i)] = static_cast<Index>(all.size());
      all.push_back({i, -1, {}, {}});
    }
  for (const Entry& entry : entries) {
    const Index of_row = local_of[static_cast<std::size_t>(entry.row)];
    const Index of_column = local_of[static_cast<std::size_t>(entry.column)];
    if (of_row >= 0 && of_row == of_column)
      all[static_cast<std::size_t>(of_row)].diagonal = entry.place;
    else if (of_row >= 0)
      all[static_cast<std::size_t>(of_row)].row.push_back(entry.place);
    else if (of_column >= 0)
      all[static_cast<std::size_t>(of_column)].columns.push_back(entry.place);
  }
  const auto same = [](const Local& a, const Local& b) {
    return a.unknown == b.unknown && a.row == b.row && a.columns == b.columns;
  };
  const bool is_same = position == position_ && std::ranges::equal(all, all_, same);
  block_ = block - least;
  position_ = std::move(position);
  all_ = std::move(all);
  return !is_same;
}

}  // namespace samara::analysis
