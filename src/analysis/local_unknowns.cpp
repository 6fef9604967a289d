#include "local_unknowns.hpp"

#include <algorithm>
#include <cmath>

namespace samara::analysis {
namespace {

/// Least factor of a local unknown, relative to the largest entry of its row of K.
constexpr double least_pivot = 1e-6;

}  // namespace

bool LocalUnknowns::find(const std::vector<Place>& places, const std::vector<Index>& number,
                         Index size, Index block, const Eigen::MatrixXd& means) {
  const auto row_of = [&](const Place& place) {
    return number[static_cast<std::size_t>(place.row)];
  };
  const auto column_of = [&](const Place& place) {
    return number[static_cast<std::size_t>(place.column)];
  };
  std::vector<double> largest(static_cast<std::size_t>(size), 0.0);
  for (const Place& place : places) {
    double& of_row = largest[static_cast<std::size_t>(row_of(place))];
    of_row = std::max(of_row, std::abs(means(0, place.number)));
  }
  // Candidates by their own rows.
  std::vector<char> is_local(static_cast<std::size_t>(size), 0);
  for (const Place& place : places)
    if (const auto row = static_cast<std::size_t>(row_of(place));
        place.row == place.column && means(1, place.number) == 0.0 && largest[row] > 0.0 &&
        std::abs(means(0, place.number)) >= least_pivot * largest[row])
      is_local[static_cast<std::size_t>(row_of(place))] = 1;
  const auto is_zero = [&](const Place& place) {
    return means(0, place.number) == 0.0 && means(1, place.number) == 0.0;
  };
  for (const Place& place : places) {
    const Index row = row_of(place);
    const Index column = column_of(place);
    if (row / block != column / block && !is_zero(place))
      is_local[static_cast<std::size_t>(row)] = 0;
  }
  // No row has another one of them.
  for (const Place& place : places)
    if (place.row != place.column && !is_zero(place) &&
        is_local[static_cast<std::size_t>(column_of(place))] != 0)
      is_local[static_cast<std::size_t>(row_of(place))] = 0;
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
  std::vector<Index> place_of(static_cast<std::size_t>(size), -1);
  std::vector<Local> all;
  for (Index i = 0; i < size; ++i)
    if (position[static_cast<std::size_t>(i)] < 0) {
      place_of[static_cast<std::size_t>(i)] = static_cast<Index>(all.size());
      all.push_back({i, -1, {}, {}});
    }
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (is_zero(places[n])) continue;
    const Index of_row = place_of[static_cast<std::size_t>(row_of(places[n]))];
    const Index of_column = place_of[static_cast<std::size_t>(column_of(places[n]))];
    const auto at = static_cast<Index>(n);
    if (of_row >= 0 && of_row == of_column)
      all[static_cast<std::size_t>(of_row)].diagonal = at;
    else if (of_row >= 0)
      all[static_cast<std::size_t>(of_row)].row.push_back(at);
    else if (of_column >= 0)
      all[static_cast<std::size_t>(of_column)].columns.push_back(at);
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
