#include "hill_groups.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/QR>

#include "samara/base/error.hpp"

#include "hill_residual.hpp"
#include "hill_without_medium.hpp"

namespace samara::analysis {
namespace {

using Index = Eigen::Index;

/// Harmonics are missing where the residual in the time domain is larger than that in the truncated
/// series by a factor.
constexpr double of_missing_harmonics = 10.0;
/// Least cosine of the angle between the eigenvectors of a mode with two numbers of harmonics, and
/// the distance, relative to the rotor speed, in which other eigenpairs are searched where it is
/// less; their number.
constexpr double least_overlap = 0.95;
constexpr double least_overlap_with_medium = 0.8;
constexpr double neighbourhood = 1.0;
constexpr int most_neighbours = 12;
/// Least correlation of an eigenvector with one that is a mixture of several.
constexpr double part_of_mixture = 0.1;
/// Correlation of equal eigenvectors.
constexpr double same_vector = 0.9;
/// Relative to the rotor speed: distance of exponents that are refined together.
constexpr double same_group = 0.03;

/// Relative to the rotor speed: distance of an exponent from the copy of its conjugate.
constexpr double next_to_conjugate = 0.03;
/// Two motions of one frequency have equal parts of positive and negative frequencies. A pair with
/// a smaller part of negative ones is one motion.
constexpr double least_coupled = 0.3;

void share_pair(const Ranks& ranks, int owner, HillPair& pair) {
  ranks.share(owner, pair.exponent);
  ranks.share(owner, pair.series);
}

}  // namespace

HillPair conjugate_of(const HillPair& pair) {
  return {std::conj(pair.exponent), pair.series.colwise().reverse().conjugate()};
}

Eigen::MatrixXcd shifted_series(const Eigen::MatrixXcd& series, Index shift, Index rows) {
  Eigen::MatrixXcd shifted = Eigen::MatrixXcd::Zero(rows, series.cols());
  const Index offset = shift + (series.rows() - rows) / 2;  // from a row of `shifted`
  for (Index row = 0; row < rows; ++row)
    if (row + offset >= 0 && row + offset < series.rows())
      shifted.row(row) = series.row(row + offset);
  return shifted;
}

int neighbouring_conjugate(std::complex<double> exponent, int sectors, double speed) {
  const double twice = 2.0 * exponent.imag() / speed;
  const int shift = sectors * static_cast<int>(std::lround(twice / sectors));
  return std::abs(twice - shift) < next_to_conjugate ? shift : 0;
}

std::vector<HillGroup> groups_of(std::vector<HillPair> pairs, double speed) {
  // The conjugate of a slow motion belongs to its group: both may be a double zero.
  for (std::size_t i = 0, count = pairs.size(); i < count; ++i) {
    const HillPair pair = pairs[i];
    if (pair.exponent.imag() > 0.0 && std::abs(pair.exponent) < same_group * speed)
      pairs.push_back(conjugate_of(pair));
  }
  std::vector<HillGroup> groups;
  std::vector<char> taken(pairs.size(), 0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (taken[i]) continue;
    std::vector<std::size_t> group{i};
    taken[i] = 1;
    for (std::size_t g = 0; g < group.size(); ++g)
      for (std::size_t j = 0; j < pairs.size(); ++j)
        if (!taken[j] &&
            std::abs(pairs[j].exponent - pairs[group[g]].exponent) < same_group * speed) {
          taken[j] = 1;
          group.push_back(j);
        }
    groups.emplace_back();
    for (const std::size_t j : group) groups.back().pairs.push_back(pairs[j]);
  }
  return groups;
}

void share_groups(const Ranks& ranks, std::vector<HillGroup>& groups) {
  std::size_t count = groups.size();
  ranks.share(0, count);
  groups.resize(count);
  for (HillGroup& group : groups) {
    ranks.share(0, group.truncated_residual);
    ranks.share(0, group.before);
    ranks.share(0, group.is_neighbour);
    ranks.share(0, group.residuals);
    ranks.share(0, group.before_exponents);
    std::size_t pairs = group.pairs.size();
    ranks.share(0, pairs);
    group.pairs.resize(pairs);
    for (HillPair& pair : group.pairs) share_pair(ranks, 0, pair);
  }
}

/// Whether other eigenpairs may have been found.
bool HillGroups::is_other(const HillRefinement::Result& result) const {
  return !(result.overlap >= (pencil_.has_medium() ? least_overlap_with_medium : least_overlap));
}

/// Refines each group on one rank. Groups next to each other stay on one rank: they may use the
/// same factors.
/// @returns for each group whose eigenvectors changed much, its pairs as they were before
std::vector<std::vector<HillPair>> HillGroups::deal(const std::vector<HillGroup*>& groups,
                                                    double tolerance) {
  const auto rank_of = [&](std::size_t group) {
    return static_cast<int>(group * static_cast<std::size_t>(ranks_.size) / groups.size());
  };
  std::vector<HillRefinement::Result> results(groups.size());
  std::vector<std::vector<HillPair>> changed(groups.size());
  ranks_.attempt([&] {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (rank_of(g) != ranks_.rank) continue;
      changed[g] = groups[g]->pairs;
      pencil_.fit_scales(std::abs(groups[g]->pairs.front().exponent));
      results[g] = refinement_.refine(groups[g]->pairs, tolerance);
      if (!is_other(results[g])) changed[g].clear();
    }
  });
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const int owner = rank_of(g);
    ranks_.share(owner, results[g]);
    if (owner != ranks_.rank && is_other(results[g])) changed[g] = groups[g]->pairs;
    groups[g]->truncated_residual = results[g].residual;
    for (HillPair& pair : groups[g]->pairs) share_pair(ranks_, owner, pair);
  }
  return changed;
}

void HillGroups::refine(std::vector<HillGroup>& groups, double tolerance) {
  std::vector<HillGroup*> all;
  for (HillGroup& group : groups) all.push_back(&group);
  const std::vector<std::vector<HillPair>> changed = deal(all, tolerance);
  std::vector<HillGroup> kept;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (changed[g].empty()) kept.push_back(std::move(groups[g]));
  if (kept.size() < groups.size()) {
    ranks_.attempt([&] {
      if (ranks_.rank > 0) return;
      for (std::size_t g = 0; g < groups.size(); ++g)
        if (!changed[g].empty() && pencil_.has_medium())
          follow(kept, changed[g], tolerance);
        else if (!changed[g].empty())
          replace(kept, changed[g], std::move(groups[g]), tolerance);
    });
    share_groups(ranks_, kept);
  }
  groups = std::move(kept);
  if (pencil_.has_medium() && pencil_.harmonics() > 0) add_partners(groups, tolerance);
  all.clear();
  for (HillGroup& group : groups) all.push_back(&group);
  find_residuals(all);
}

/// A pair that is next to the copy of its conjugate: with fewer harmonics, which do not couple
/// both, the search has found one motion where there may be two of one frequency. Both are
/// combinations of the pair's part of positive frequencies and of the conjugate of this part.
void HillGroups::add_partners(std::vector<HillGroup>& groups, double tolerance) {
  std::vector<std::size_t> alone;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].pairs.size() != 1) continue;
    const std::complex<double> exponent = groups[g].pairs.front().exponent;
    const int shift = neighbouring_conjugate(exponent, pencil_.sectors(), speed_);
    if (shift == 0 || std::abs(shift) >= pencil_.harmonics()) continue;
    const auto is_near = [&](const HillPair& other) {
      return std::abs(other.exponent - exponent) < next_to_conjugate * speed_;
    };
    const auto count = std::ranges::count_if(
        groups, [&](const HillGroup& other) { return std::ranges::any_of(other.pairs, is_near); });
    if (count == 1) alone.push_back(g);
  }
  if (alone.empty()) return;
  ranks_.attempt([&] {
    if (ranks_.rank > 0) return;
    for (const std::size_t g : alone) {
      const HillPair& own = groups[g].pairs.front();
      const int shift = neighbouring_conjugate(own.exponent, pencil_.sectors(), speed_);
      HillPair positive = own;
      Eigen::MatrixXcd negative = own.series;
      const Index harmonics = (own.series.rows() - 1) / 2;
      for (Index row = 0; row < own.series.rows(); ++row)
        if (2 * (row - harmonics) < -shift)
          positive.series.row(row).setZero();
        else
          negative.row(row).setZero();
      const Ranks& parts = pencil_.ranks();
      if (parts.norm(pencil_.vector_of(negative)) <
          least_coupled * parts.norm(pencil_.vector_of(own.series)))
        continue;
      const HillPair conjugate = conjugate_of(positive);
      std::vector<HillPair> both{positive,
                                 {conjugate.exponent + std::complex<double>(0.0, shift * speed_),
                                  shifted_series(conjugate.series, shift, own.series.rows())}};
      const double residual = refinement_.refine(both, tolerance).residual;
      const bool is_found = std::ranges::all_of(both, [&](const HillPair& pair) {
        return std::abs(pair.exponent - own.exponent) < neighbourhood * speed_;
      });
      if (!is_found || !(residual <= std::max(groups[g].truncated_residual, tolerance))) continue;
      groups[g].pairs = std::move(both);
      groups[g].truncated_residual = residual;
    }
  });
  share_groups(ranks_, groups);
}

/// Adds the neighbours of eigenpairs, or where there are none, the group that came of them, to
/// those that are kept.
void HillGroups::replace(std::vector<HillGroup>& kept, const std::vector<HillPair>& before,
                         HillGroup after, double tolerance) {
  std::vector<HillGroup> neighbours = neighbours_of(before);
  if (neighbours.empty()) kept.push_back(std::move(after));
  for (HillGroup& near : neighbours) {
    near.truncated_residual = refinement_.refine(near.pairs, tolerance).residual;
    if (std::all_of(near.pairs.begin(), near.pairs.end(), [&](const HillPair& pair) {
          return std::any_of(kept.begin(), kept.end(),
                             [&](const HillGroup& other) { return has(other, pair); });
        }))
      continue;
    std::erase_if(kept, [&](const HillGroup& other) {
      return std::any_of(near.pairs.begin(), near.pairs.end(),
                         [&](const HillPair& pair) { return has(other, pair); });
    });
    kept.push_back(std::move(near));
  }
}

/// Adds the eigenpairs that the pairs of a group become to those that are kept; without a residual
/// where they cannot be followed.
void HillGroups::follow(std::vector<HillGroup>& kept, const std::vector<HillPair>& before,
                        double tolerance) {
  for (const HillPair& pair : before) {
    const std::optional<HillPair> followed = HillWithoutMedium(pencil_).follow(pair);
    HillGroup group;
    group.before_exponents = {pair.exponent};
    if (followed &&
        std::ranges::none_of(kept, [&](const HillGroup& other) { return has(other, *followed); })) {
      group.pairs = {*followed};
      group.truncated_residual = refinement_.refine(group.pairs, tolerance).residual;
    } else {
      group.pairs = {{pair.exponent, pencil_.series_of(pencil_.vector_of(pair.series))}};
    }
    kept.push_back(std::move(group));
  }
}

/// Eigenpairs next to some pairs that have a part in them; none where the search fails.
std::vector<HillGroup> HillGroups::neighbours_of(const std::vector<HillPair>& pairs) {
  const auto distance = [&pairs](const HillPair& pair) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const HillPair& own : pairs)
      nearest = std::min(nearest, std::abs(pair.exponent - own.exponent));
    return nearest;
  };
  const double frequency = std::max(pairs.front().exponent.imag(), neighbourhood * speed_);
  std::vector<HillPair> found;
  try {
    found = HillSearch(pencil_).find(frequency, most_neighbours).pairs;
  } catch (const ConvergenceError&) {
    return {};
  }
  if (found.empty()) return {};
  const auto part_of = [&](const HillPair& pair) {
    const Eigen::VectorXcd vector = pencil_.normalized(pencil_.vector_of(pair.series));
    double largest = 0.0;
    for (const HillPair& own : pairs)
      largest = std::max(
          largest,
          std::abs(pencil_.product(vector, pencil_.normalized(pencil_.vector_of(own.series)))(0)));
    return largest;
  };
  std::vector<HillPair> near;
  for (const HillPair& pair : found)
    if (distance(pair) < neighbourhood * speed_ && part_of(pair) > part_of_mixture)
      near.push_back(pair);
  if (near.empty())
    near.push_back(*std::max_element(
        found.begin(), found.end(),
        [&](const HillPair& a, const HillPair& b) { return part_of(a) < part_of(b); }));
  std::vector<HillGroup> groups = groups_of(std::move(near), speed_);
  for (HillGroup& one : groups) one.is_neighbour = true;
  return groups;
}

/// Whether a group has an eigenpair.
bool HillGroups::has(const HillGroup& group, const HillPair& pair) const {
  if (std::none_of(group.pairs.begin(), group.pairs.end(), [&](const HillPair& own) {
        return std::abs(own.exponent - pair.exponent) < same_found * speed_;
      }))
    return false;
  Eigen::MatrixXcd own(pair.series.size(), static_cast<Index>(group.pairs.size()));
  for (std::size_t j = 0; j < group.pairs.size(); ++j)
    own.col(static_cast<Index>(j)) = group.pairs[j].series.reshaped();
  const Eigen::VectorXcd vector = pair.series.reshaped();
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXcd> products(
      pencil_.product(own, own));
  const Eigen::VectorXcd projected = own * products.solve(pencil_.product(own, vector));
  return pencil_.ranks().norm(projected) > same_vector * pencil_.ranks().norm(vector);
}

void HillGroups::refine_further(std::vector<HillGroup>& groups, double tolerance) {
  std::vector<HillGroup*> chosen;
  for (HillGroup& group : groups)
    if (group.residual() <= of_missing_harmonics * group.truncated_residual)
      chosen.push_back(&group);
  if (chosen.empty()) return;
  deal(chosen, tolerance);
  find_residuals(chosen);
}

void HillGroups::find_changes(HillGroup& group) const {
  group.residuals.clear();
  for (const HillPair& pair : group.pairs) {
    double change = std::numeric_limits<double>::infinity();
    for (const std::complex<double> before : group.before_exponents)
      change = std::min(change, std::abs(pair.exponent - before));
    group.residuals.push_back(
        std::max(group.truncated_residual, change / unit_of_change(pair.exponent, speed_)));
  }
}

void HillGroups::find_residuals(const std::vector<HillGroup*>& groups) const {
  if (pencil_.has_medium() && pencil_.harmonics() > 0) {
    for (HillGroup* group : groups) find_changes(*group);
    return;
  }
  std::vector<const HillPair*> pairs;
  for (const HillGroup* group : groups)
    for (const HillPair& pair : group->pairs) pairs.push_back(&pair);
  const std::vector<double> residuals =
      find_hill_residuals(system_, solution_, pairs, ranks_, pencil_.mesh());
  auto next = residuals.begin();
  for (HillGroup* group : groups) {
    const auto end = next + static_cast<std::ptrdiff_t>(group->pairs.size());
    group->residuals.assign(next, end);
    next = end;
  }
}

}  // namespace samara::analysis
