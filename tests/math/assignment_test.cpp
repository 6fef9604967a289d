// The assignment with the largest sum, against all permutations.
#include "samara/math/assignment.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include <boost/test/unit_test.hpp>

using samara::math::find_best_assignment;

namespace {

/// The largest sum over all ways to give the rows different columns, or the columns different rows.
double best_sum(const Eigen::MatrixXd& values) {
  const Eigen::MatrixXd wide =
      values.rows() > values.cols() ? Eigen::MatrixXd(values.transpose()) : values;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(wide.cols()));
  std::iota(order.begin(), order.end(), 0);
  double best = -1e300;
  do {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < wide.rows(); ++i)
      sum += wide(i, order[static_cast<std::size_t>(i)]);
    best = std::max(best, sum);
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(assignment)

BOOST_AUTO_TEST_CASE(the_sum_is_that_of_the_best_permutation) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const auto rows = static_cast<Eigen::Index>(random() % 6 + 1);
    const auto columns = static_cast<Eigen::Index>(random() % 6 + 1);
    Eigen::MatrixXd values(rows, columns);
    // Every second matrix has many equal sums.
    for (double& value : values.reshaped())
      value = trial % 2 == 0 ? real(random) : static_cast<double>(random() % 3);
    const std::vector<int> column_of = find_best_assignment(values);
    BOOST_TEST_REQUIRE(column_of.size() == static_cast<std::size_t>(rows));
    double sum = 0.0;
    std::set<int> taken;
    for (Eigen::Index i = 0; i < rows; ++i) {
      const int column = column_of[static_cast<std::size_t>(i)];
      if (column < 0) continue;
      BOOST_TEST(taken.insert(column).second);
      sum += values(i, column);
    }
    BOOST_TEST(taken.size() == static_cast<std::size_t>(std::min(rows, columns)));
    BOOST_TEST(std::abs(sum - best_sum(values)) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(nothing_is_assigned_to_nothing) {
  BOOST_TEST(find_best_assignment(Eigen::MatrixXd(0, 3)).empty());
  const std::vector<int> none{-1, -1};
  BOOST_TEST(find_best_assignment(Eigen::MatrixXd(2, 0)) == none);
}

BOOST_AUTO_TEST_SUITE_END()
