#include "hill_medium.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <Eigen/Eigenvalues>

namespace samara::analysis {

using Index = Eigen::Index;

namespace {

/// Unknowns of a group whose exponents are found.
constexpr Index largest_group = 100;
/// Relative to the largest: the inverse of a finite exponent.
constexpr double least_inverse = 1e-10;

Index leader_of(const std::vector<Index>& leaders, Index i) {
  while (leaders[static_cast<std::size_t>(i)] != i) i = leaders[static_cast<std::size_t>(i)];
  return i;
}

void join(std::vector<Index>& leaders, Index i, Index j) {
  const Index a = leader_of(leaders, i);
  const Index b = leader_of(leaders, j);
  leaders[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

}  // namespace

HillMedium::HillMedium(const HarmonicTangents& tangents, const Eigen::VectorXd& rows,
                       const Eigen::VectorXd& columns)
    : tangents_(tangents),
      rows_(rows),
      columns_(columns),
      ranks_(tangents.partition() != nullptr ? tangents.partition()->ranks()
                                             : Ranks(MPI_COMM_SELF)) {
  const auto size = static_cast<std::size_t>(tangents.size());
  place_in_group_.assign(size, -1);
  const Leaders leaders = find_leaders();
  std::vector<Index> group_of(size, -1);
  for (Index i = 0; i < tangents.size(); ++i) {
    if (!is_of_medium(i)) continue;
    const auto first = static_cast<std::size_t>(leaders[static_cast<std::size_t>(i)]);
    if (group_of[first] < 0) {
      group_of[first] = static_cast<Index>(groups_.size());
      groups_.emplace_back();
    }
    group_of[static_cast<std::size_t>(i)] = group_of[first];
    Group& group = groups_[static_cast<std::size_t>(group_of[first])];
    place_in_group_[static_cast<std::size_t>(i)] = static_cast<Index>(group.unknowns.size());
    group.unknowns.push_back(i);
    group.is_of_chains = group.is_of_chains && !tangents_.is_border(i);
  }
  for (const HarmonicTangents::Place& place : tangents.places())
    if (is_of_medium(place.row) && is_of_medium(place.column))
      groups_[static_cast<std::size_t>(group_of[static_cast<std::size_t>(place.row)])]
          .places.push_back(place);
  is_empty_ = ranks_.all(groups_.empty());
}

/// Unknowns that refer to each other are one group: the smallest number among them leads it.
HillMedium::Leaders HillMedium::find_leaders() const {
  Leaders leaders(static_cast<std::size_t>(tangents_.size()));
  std::iota(leaders.begin(), leaders.end(), Index{0});
  for (const HarmonicTangents::Place& place : tangents_.places())
    if (is_of_medium(place.row) && is_of_medium(place.column))
      join(leaders, place.row, place.column);
  for (Index i = 0; i < tangents_.size(); ++i)
    leaders[static_cast<std::size_t>(i)] = leader_of(leaders, i);
  return leaders;
}

/// Adds mean tangents in the harmonic k to a square block, whose rows and columns are `stride`
/// apart.
void HillMedium::add_means(const HarmonicTangents::Place& place, Complex s, int k, Index first,
                           Index stride, Matrix& block) const {
  if (!tangents_.has(place.row, k) || !tangents_.has(place.column, k)) return;
  const Eigen::MatrixXd& means = tangents_.means();
  block(place_in_group_[static_cast<std::size_t>(place.row)] * stride + first,
        place_in_group_[static_cast<std::size_t>(place.column)] * stride + first) =
      rows_(place.row * tangents_.width()) * columns_(place.column * tangents_.width()) *
      (means(0, place.number) + (s + Complex(0.0, k * tangents_.rate())) * means(1, place.number));
}

bool HillMedium::is_of_chains(const HarmonicTangents::Place& place) const {
  return !tangents_.is_border(place.row) && !tangents_.is_border(place.column);
}

/// All harmonics; `only_means`: those of chains are not coupled.
HillMedium::Matrix HillMedium::block_of(const Group& group, Complex s, bool only_means) const {
  const Index width = tangents_.width();
  const int harmonics = tangents_.harmonics();
  const auto size = static_cast<Index>(group.unknowns.size()) * width;
  Matrix block = Matrix::Zero(size, size);
  for (const HarmonicTangents::Place& place : group.places) {
    if (only_means && is_of_chains(place)) {
      for (int k = -harmonics; k <= harmonics; ++k)
        add_means(place, s, k, k + harmonics, width, block);
      continue;
    }
    auto part =
        block.block(place_in_group_[static_cast<std::size_t>(place.row)] * width,
                    place_in_group_[static_cast<std::size_t>(place.column)] * width, width, width);
    tangents_.coupling(place, s, part);
    part *= rows_(place.row * width) * columns_(place.column * width);
  }
  for (std::size_t i = 0; i < group.unknowns.size(); ++i)
    for (Index k = 0; k < width; ++k)
      if (!tangents_.has(group.unknowns[i], static_cast<int>(k) - harmonics)) {
        const Index at = static_cast<Index>(i) * width + k;
        block(at, at) = 1.0;
      }
  return block;
}

/// Of a group in the chains, in one harmonic.
HillMedium::Matrix HillMedium::block_of_means(const Group& group, Complex s, int k) const {
  const auto size = static_cast<Index>(group.unknowns.size());
  Matrix block = Matrix::Zero(size, size);
  for (const HarmonicTangents::Place& place : group.places) add_means(place, s, k, 0, 1, block);
  for (Index i = 0; i < size; ++i)
    if (!tangents_.has(group.unknowns[static_cast<std::size_t>(i)], k)) block(i, i) = 1.0;
  return block;
}

bool HillMedium::factor(Complex s) {
  bool is_regular = true;
  for (Group& group : groups_) {
    group.factors.compute(block_of(group, s, false));
    is_regular = is_regular && group.factors.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0;
  }
  return ranks_.all(is_regular);
}

void HillMedium::solve(Eigen::Ref<Matrix> x) const {
  const Index width = tangents_.width();
  for (const Group& group : groups_) {
    Matrix part(static_cast<Index>(group.unknowns.size()) * width, x.cols());
    for (std::size_t i = 0; i < group.unknowns.size(); ++i)
      part.middleRows(static_cast<Index>(i) * width, width) =
          x.middleRows(group.unknowns[i] * width, width);
    part = group.factors.solve(part).eval();
    for (std::size_t i = 0; i < group.unknowns.size(); ++i)
      x.middleRows(group.unknowns[i] * width, width) =
          part.middleRows(static_cast<Index>(i) * width, width);
  }
}

HillMedium::Complex HillMedium::log_determinant_of_means(Complex s) const {
  Matrix sum = Matrix::Zero(1, 1);
  const auto add = [&sum](const Matrix& block) {
    const Eigen::PartialPivLU<Matrix> factors(block);
    sum(0) += factors.matrixLU().diagonal().array().log().sum() +
              std::log(Complex(static_cast<double>(factors.permutationP().determinant())));
  };
  for (const Group& group : groups_) {
    if (!group.is_of_chains) {
      add(block_of(group, s, true));
      continue;
    }
    for (int k = -tangents_.harmonics(); k <= tangents_.harmonics(); ++k)
      add(block_of_means(group, s, k));
  }
  ranks_.sum(sum);
  return sum(0);
}

/// Of a group: those of its mean tangents with the other parts at rest. A group that is too large
/// for dense eigenvalues has none.
std::vector<HillMedium::Complex> HillMedium::exponents_of(const Group& group) const {
  const auto size = static_cast<Index>(group.unknowns.size());
  if (size > largest_group) return {};
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd mass = stiffness;
  for (const HarmonicTangents::Place& place : group.places) {
    const Index row = place_in_group_[static_cast<std::size_t>(place.row)];
    const Index column = place_in_group_[static_cast<std::size_t>(place.column)];
    stiffness(row, column) = tangents_.means()(0, place.number);
    mass(row, column) = tangents_.means()(1, place.number);
  }
  // 1 / lambda are the eigenvalues of -K^-1 M; those of auxiliaries are zero.
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(stiffness);
  const Eigen::MatrixXd product = -factors.solve(mass);
  if (!product.allFinite()) return {};
  const Eigen::VectorXcd inverses = product.eigenvalues();
  const double largest = inverses.cwiseAbs().maxCoeff();
  std::vector<Complex> exponents;
  for (const Complex inverse : inverses)
    if (std::abs(inverse) > least_inverse * largest) exponents.push_back(1.0 / inverse);
  return exponents;
}

std::vector<HillMedium::Complex> HillMedium::exponents() const {
  std::vector<Complex> all;
  for (const Group& group : groups_)
    std::ranges::copy(exponents_of(group), std::back_inserter(all));
  ranks_.gather(all);
  return all;
}

}  // namespace samara::analysis
