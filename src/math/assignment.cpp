#include "samara/math/assignment.hpp"

#include <limits>

namespace samara::math {
namespace {

/// Row of each column, for at most as many rows as columns; -1: none. Adds the rows one after the
/// other, each by the cheapest path of alternating columns; `row_price` and `column_price` keep the
/// reduced costs of all pairs at zero or above.
std::vector<int> assign_rows(const Eigen::MatrixXd& costs) {
  const auto rows = static_cast<int>(costs.rows());
  const auto columns = static_cast<int>(costs.cols());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> row_price(static_cast<std::size_t>(rows), 0.0);
  std::vector<double> column_price(static_cast<std::size_t>(columns), 0.0);
  std::vector<int> row_of(static_cast<std::size_t>(columns), -1);
  for (int first = 0; first < rows; ++first) {
    std::vector<double> distance(static_cast<std::size_t>(columns), infinity);
    std::vector<int> before(static_cast<std::size_t>(columns), -1);  // column on the path
    std::vector<bool> visited(static_cast<std::size_t>(columns), false);
    int row = first;
    int last = -1;
    for (;;) {
      double least = infinity;
      int next = -1;
      for (int j = 0; j < columns; ++j) {
        const auto column = static_cast<std::size_t>(j);
        if (visited[column]) continue;
        const double reduced =
            costs(row, j) - row_price[static_cast<std::size_t>(row)] - column_price[column];
        if (reduced < distance[column]) {
          distance[column] = reduced;
          before[column] = last;
        }
        if (distance[column] < least) {
          least = distance[column];
          next = j;
        }
      }
      row_price[static_cast<std::size_t>(first)] += least;
      for (std::size_t j = 0; j < visited.size(); ++j) {
        if (visited[j]) {
          row_price[static_cast<std::size_t>(row_of[j])] += least;
          column_price[j] -= least;
        } else {
          distance[j] -= least;
        }
      }
      visited[static_cast<std::size_t>(next)] = true;
      last = next;
      row = row_of[static_cast<std::size_t>(next)];
      if (row < 0) break;
    }
    while (last >= 0) {
      const int previous = before[static_cast<std::size_t>(last)];
      row_of[static_cast<std::size_t>(last)] =
          previous < 0 ? first : row_of[static_cast<std::size_t>(previous)];
      last = previous;
    }
  }
  return row_of;
}

}  // namespace

std::vector<int> find_best_assignment(const Eigen::MatrixXd& values) {
  if (values.rows() > values.cols()) return assign_rows(-values.transpose());
  std::vector<int> column_of(static_cast<std::size_t>(values.rows()), -1);
  const std::vector<int> row_of = assign_rows(-values);
  for (std::size_t j = 0; j < row_of.size(); ++j)
    if (row_of[j] >= 0) column_of[static_cast<std::size_t>(row_of[j])] = static_cast<int>(j);
  return column_of;
}

}  // namespace samara::math
