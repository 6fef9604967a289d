#include "samara/simulation/edge_search.hpp"

#include <algorithm>
#include <cmath>

namespace samara::simulation {
namespace {

constexpr int none = -1;

bool has_growing(const CampbellPoint& point, int mode) {
  return mode != none && is_growing(point.modes[static_cast<std::size_t>(mode)]);
}

/// Two places next to each other, and their modes.
struct Interval {
  double from = 0.0;
  double to = 0.0;
  int growing_from = 0;
  int growing_to = 0;
  std::vector<int> next;    ///< the mode at `to` of each one at `from`
  std::vector<int> before;  ///< the mode at `from` of each one at `to`
  std::vector<int> begin;   ///< modes at `to` that grow there only
  std::vector<int> cease;   ///< modes at `from` that grow there only

  Interval(const CampbellPoint& a, const CampbellPoint& b)
      : from(a.place.value),
        to(b.place.value),
        growing_from(count_growing(a)),
        growing_to(count_growing(b)),
        next(a.modes.size(), none),
        before(b.modes.size(), none) {
    for (const analysis::ModeLink& link : analysis::link_modes(a.signatures, b.signatures)) {
      if (link.likeness < analysis::ModeTracker::least_likeness) continue;
      const std::size_t mode = a.signatures.modes[link.from];
      const std::size_t other = b.signatures.modes[link.to];
      next[mode] = static_cast<int>(other);
      before[other] = static_cast<int>(mode);
    }
    for (int i = 0; i < static_cast<int>(next.size()); ++i)
      if (has_growing(a, i) && !has_growing(b, next[static_cast<std::size_t>(i)]))
        cease.push_back(i);
    for (int i = 0; i < static_cast<int>(before.size()); ++i)
      if (has_growing(b, i) && !has_growing(a, before[static_cast<std::size_t>(i)]))
        begin.push_back(i);
  }

  bool has_change() const { return !begin.empty() || !cease.empty(); }
};

class EdgeSearch {
 public:
  EdgeSearch(const CampbellPoint& from, const CampbellPoint& to,
             const std::function<CampbellPoint(double)>& point_at)
      : accuracy_(edge_accuracy * std::max(std::abs(from.place.value), std::abs(to.place.value))),
        point_at_(point_at) {
    divide(from, to);
  }

  std::vector<StabilityEdge> edges(double second) const {
    std::vector<StabilityEdge> edges;
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
      const Interval& interval = intervals_[i];
      if (interval.growing_from == interval.growing_to) continue;
      StabilityEdge edge{interval.from, interval.to, second, interval.growing_from,
                         interval.growing_to};
      const std::vector<int> modes = interval.growing_to > interval.growing_from
                                         ? at_end(i, interval.begin)
                                         : at_start(i, interval.cease);
      std::copy_n(modes.begin(), std::min(modes.size(), edge.modes.size()), edge.modes.begin());
      edges.push_back(edge);
    }
    return edges;
  }

 private:
  void divide(const CampbellPoint& from, const CampbellPoint& to) {
    const Interval interval(from, to);
    if (interval.has_change() && std::abs(interval.to - interval.from) > accuracy_) {
      const CampbellPoint middle = point_at_(0.5 * (interval.from + interval.to));
      if (middle.failure.empty()) {
        divide(from, middle);
        divide(middle, to);
        return;
      }
    }
    intervals_.push_back(interval);
  }

  /// Modes at the end of interval i, followed to the last point.
  std::vector<int> at_end(std::size_t i, std::vector<int> modes) const {
    for (std::size_t j = i + 1; j < intervals_.size(); ++j)
      for (int& mode : modes)
        if (mode != none) mode = intervals_[j].next[static_cast<std::size_t>(mode)];
    return modes;
  }
  /// Modes at the start of interval i, followed back to the first point.
  std::vector<int> at_start(std::size_t i, std::vector<int> modes) const {
    for (std::size_t j = i; j-- > 0;)
      for (int& mode : modes)
        if (mode != none) mode = intervals_[j].before[static_cast<std::size_t>(mode)];
    return modes;
  }

  double accuracy_;
  const std::function<CampbellPoint(double)>& point_at_;
  std::vector<Interval> intervals_;  ///< in the order of the sweep
};

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> find_changes(
    const std::vector<CampbellPoint>& points, const std::vector<CampbellLine>& lines) {
  std::vector<std::pair<std::size_t, std::size_t>> changes;
  for (const auto& [first, second] : find_neighbours(points)) {
    const auto grows = [&points](const CampbellLine& line, std::size_t point) {
      const auto found = std::ranges::find(line.modes, point, &analysis::TrackedMode::point);
      return found != line.modes.end() && is_growing(points[point].modes[found->mode]);
    };
    if (std::ranges::any_of(lines, [&, a = first, b = second](const CampbellLine& line) {
          return grows(line, a) != grows(line, b);
        }))
      changes.emplace_back(first, second);
  }
  return changes;
}

std::vector<StabilityEdge> find_edges(const CampbellPoint& from, const CampbellPoint& to,
                                      const std::function<CampbellPoint(double)>& point_at) {
  return EdgeSearch(from, to, point_at).edges(from.place.second);
}

}  // namespace samara::simulation
