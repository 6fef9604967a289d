// Assignment of rows to columns.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace samara::math {

/// The assignment of rows to different columns with the largest sum of values, by the Hungarian
/// method in O(n^3) (Kuhn, Naval Research Logistics Quarterly 2, 1955, with the shortest
/// augmenting paths of Jonker and Volgenant, Computing 38, 1987). Entry i is the column of row i;
/// -1: there are fewer columns than rows, and row i has none.
std::vector<int> find_best_assignment(const Eigen::MatrixXd& values);

}  // namespace samara::math
