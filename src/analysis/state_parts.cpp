#include "state_parts.hpp"

#include <algorithm>

#include <Eigen/LU>
#include <Eigen/QR>

namespace samara::analysis {
namespace {

/// Left eigenvectors by row. There are fewer eigenvectors than entries where directions without
/// inertia are left out.
Eigen::MatrixXcd left_vectors_of(const Eigen::MatrixXcd& right) {
  if (right.rows() == right.cols()) return right.partialPivLu().inverse();
  return right.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace

StateParts find_state_parts(const system::PeriodicSystem& system) {
  StateParts parts;
  for (const system::Unknown& unknown : system.unknowns()) {
    if (unknown.role != system::UnknownRole::state) continue;
    const auto found = std::ranges::find(parts.owners, unknown.owner.part, &system::Owner::part);
    parts.part_of.push_back(static_cast<std::size_t>(found - parts.owners.begin()));
    if (found == parts.owners.end()) parts.owners.push_back(unknown.owner);
  }
  return parts;
}

std::vector<int> leading_states(const Eigenpairs& pairs, Eigen::Index motion,
                                const StateParts& parts) {
  std::vector<int> leading(pairs.values.size(), -1);
  if (parts.owners.empty()) return leading;
  const Eigen::MatrixXcd left = left_vectors_of(pairs.vectors);
  for (std::size_t m = 0; m < leading.size(); ++m) {
    const auto column = static_cast<Eigen::Index>(m);
    Eigen::VectorXcd factors = left.row(column).transpose().cwiseProduct(pairs.vectors.col(column));
    // Defective exponents have no left eigenvectors of their own.
    if (!factors.allFinite()) factors = pairs.vectors.col(column).cwiseAbs2();
    Eigen::VectorXcd sums = Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(parts.owners.size()));
    for (std::size_t i = 0; i < parts.part_of.size(); ++i)
      sums(static_cast<Eigen::Index>(parts.part_of[i])) +=
          factors(motion + static_cast<Eigen::Index>(i));
    Eigen::Index largest = 0;
    if (sums.cwiseAbs().maxCoeff(&largest) > std::abs(factors.head(motion).sum()))
      leading[m] = static_cast<int>(largest);
  }
  return leading;
}

}  // namespace samara::analysis
