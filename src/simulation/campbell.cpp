#include "samara/simulation/campbell.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "samara/analysis/constant_modes.hpp"
#include "samara/analysis/floquet.hpp"
#include "samara/analysis/identification.hpp"
#include "samara/analysis/ranks.hpp"
#include "samara/simulation/held_air.hpp"

namespace samara::simulation {
namespace {

using analysis::Mode;
using analysis::ModeSet;
using analysis::TrackedMode;

std::vector<double> participation_of(const ModeSet& set, std::size_t m) {
  std::vector<double> shares(2 * campbell_harmonics + 1, 0.0);
  if (set.participation.size() == 0) {
    shares[campbell_harmonics] = 1.0;
    return shares;
  }
  for (int k = -campbell_harmonics; k <= campbell_harmonics; ++k) {
    const Eigen::Index column = k + set.modes[m].harmonic - set.first_harmonic;
    if (column >= 0 && column < set.participation.cols())
      shares[static_cast<std::size_t>(k + campbell_harmonics)] =
          set.participation(static_cast<Eigen::Index>(m), column);
  }
  return shares;
}

const CampbellMode& mode_of(const std::vector<CampbellPoint>& points, const TrackedMode& tracked) {
  return points[tracked.point].modes[tracked.mode];
}

/// The shapes of `set` are on the first rank.
void take_modes(const turbine::TurbineSystem& system, const ModeSet& set, CampbellPoint& point) {
  const StabilityAssessment assessment = assess_stability(set);
  point.stability = assessment.stability;
  point.signatures = analysis::find_signatures(system, set);
  for (std::size_t& m : point.signatures.modes) {
    const Mode& mode = set.modes[m];
    point.modes.push_back({mode.exponent, mode.fixed_frame_frequency, total_error(mode),
                           mode.growth_error, assessment.motions[m], is_rough(mode), mode.name,
                           mode.number, participation_of(set, m)});
    m = point.modes.size() - 1;
  }
}

void share_modes(const analysis::Ranks& ranks, CampbellPoint& point) {
  struct Part {
    std::complex<double> exponent;
    double fixed_frame_frequency;
    Motion motion;
    bool is_rough;
  };
  std::vector<Part> parts;
  for (const CampbellMode& mode : point.modes)
    parts.push_back({mode.exponent, mode.fixed_frame_frequency, mode.motion, mode.is_rough});
  ranks.share(0, point.rotor_speed);
  ranks.share(0, point.pitch);
  ranks.share(0, point.stability);
  ranks.share(0, parts);
  analysis::ModeSignatures& signatures = point.signatures;
  ranks.share(0, signatures.rotor_speed);
  ranks.share(0, signatures.modes);
  ranks.share(0, signatures.exponents);
  signatures.shapes.resize(signatures.modes.size());
  for (Eigen::MatrixXcf& shape : signatures.shapes) ranks.share(0, shape);
  if (ranks.rank == 0) return;
  for (const Part& part : parts) {
    CampbellMode mode;
    mode.exponent = part.exponent;
    mode.fixed_frame_frequency = part.fixed_frame_frequency;
    mode.motion = part.motion;
    mode.is_rough = part.is_rough;
    point.modes.push_back(mode);
  }
}

/// The place of the refined edge between two points where a mode begins to grow, that of index
/// `mode` at b, or ceases, that at a. Where no edge has the mode, the only edge counts if the
/// numbers of growing modes beside it are those of the points.
std::optional<double> edge_between(const CampbellPoint& a, const CampbellPoint& b, bool begins,
                                   std::size_t mode, const std::vector<StabilityEdge>& edges) {
  const auto [low, high] = std::minmax(a.place.value, b.place.value);
  const double accuracy = edge_accuracy * std::max(std::abs(low), std::abs(high));
  std::vector<const StabilityEdge*> between;
  for (const StabilityEdge& edge : edges)
    if (std::min(edge.from, edge.to) >= low && std::max(edge.from, edge.to) <= high)
      between.push_back(&edge);
  const auto place_of = [accuracy](const StabilityEdge& edge) -> std::optional<double> {
    if (std::abs(edge.to - edge.from) > accuracy) return std::nullopt;
    return 0.5 * (edge.from + edge.to);
  };
  for (const StabilityEdge* edge : between)
    if ((edge->growing_to > edge->growing_from) == begins &&
        std::ranges::count(edge->modes, static_cast<int>(mode)) > 0)
      return place_of(*edge);
  if (between.size() == 1 && between.front()->growing_from == count_growing(a) &&
      between.front()->growing_to == count_growing(b))
    return place_of(*between.front());
  return std::nullopt;
}

/// The most frequent name, and its most frequent number.
std::pair<std::string, int> most_frequent_name(const std::vector<CampbellPoint>& points,
                                               const std::vector<TrackedMode>& line) {
  std::map<std::string, std::map<int, int>> turning;  // how often each number of a name
  std::map<std::string, std::map<int, int>> at_rest;
  for (const TrackedMode& tracked : line) {
    const CampbellMode& mode = mode_of(points, tracked);
    ++(points[tracked.point].rotor_speed > 0.0 ? turning : at_rest)[mode.name][mode.number];
  }
  const auto& names = turning.empty() ? at_rest : turning;
  const auto& [name, numbers] = *std::ranges::max_element(names, {}, [](const auto& one) {
    int count = 0;
    for (const auto& [number, times] : one.second) count += times;
    return count;
  });
  return {name,
          std::ranges::max_element(numbers, {}, [](const auto& one) { return one.second; })->first};
}

}  // namespace

bool are_in_a_row(const SweepPlace& a, const SweepPlace& b) {
  return std::isnan(a.second) ? std::isnan(b.second) : a.second == b.second;
}

CampbellPoint find_campbell_point(const turbine::TurbineSystem& system, const analysis::Trim& trim,
                                  const analysis::FloquetOptions& options, MPI_Comm comm,
                                  analysis::Observer& observer) {
  const model::Turbine& turbine = system.turbine();
  const auto held = hold_wake(system);
  const turbine::TurbineSystem& small = held ? *held : system;
  const ModeSet set =
      turbine.speed > 0.0
          ? analysis::find_floquet_modes(small, trim.solution, options, comm, observer).set
          : analysis::find_constant_modes(small, trim.solution, options, comm, observer);
  CampbellPoint point;
  point.rotor_speed = turbine.speed;
  point.pitch = turbine.pitch;
  point.sectors = system.symmetry().sectors;
  const analysis::Ranks ranks(comm);
  ranks.attempt([&] {
    if (ranks.rank == 0) take_modes(system, set, point);
  });
  share_modes(ranks, point);
  return point;
}

bool is_growing(const CampbellMode& mode) {
  return mode.motion == Motion::growing && !mode.is_rough;
}

int count_growing(const CampbellPoint& point) {
  return static_cast<int>(std::ranges::count_if(point.modes, is_growing));
}

std::vector<std::pair<std::size_t, std::size_t>> find_neighbours(
    const std::vector<CampbellPoint>& points) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::optional<std::size_t> last;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!points[p].failure.empty()) continue;
    if (last && are_in_a_row(points[*last].place, points[p].place) &&
        points[*last].rotor_speed > 0.0 && points[p].rotor_speed > 0.0)
      pairs.emplace_back(*last, p);
    last = p;
  }
  return pairs;
}

std::vector<GrowthRange> find_growth(const std::vector<CampbellPoint>& points,
                                     const CampbellLine& line,
                                     const std::vector<StabilityEdge>& edges) {
  std::vector<GrowthRange> ranges;
  const auto grows = [&](std::size_t i) { return is_growing(mode_of(points, line.modes[i])); };
  const auto point_of = [&](std::size_t i) -> const CampbellPoint& {
    return points[line.modes[i].point];
  };
  // A line may end before the sweep: where two modes of one frequency become one.
  const std::vector<std::pair<std::size_t, std::size_t>> neighbours = find_neighbours(points);
  using Pair = std::pair<std::size_t, std::size_t>;
  const auto neighbour = [&](std::size_t i, std::size_t Pair::*own, std::size_t Pair::*other) {
    const auto pair = std::ranges::find(neighbours, line.modes[i].point, own);
    return pair == neighbours.end() ? nullptr : &points[(*pair).*other];
  };
  for (std::size_t i = 0; i < line.modes.size(); ++i) {
    if (!grows(i)) continue;
    const std::size_t first = i;
    while (i + 1 < line.modes.size() && grows(i + 1)) ++i;
    GrowthRange range{point_of(first).place.value, point_of(i).place.value};
    if (const CampbellPoint* other = neighbour(first, &Pair::second, &Pair::first))
      range.from = edge_between(*other, point_of(first), true, line.modes[first].mode, edges)
                       .value_or(range.from);
    if (const CampbellPoint* other = neighbour(i, &Pair::first, &Pair::second))
      range.to =
          edge_between(point_of(i), *other, false, line.modes[i].mode, edges).value_or(range.to);
    ranges.push_back(range);
  }
  return ranges;
}

std::vector<CampbellLine> name_lines(const std::vector<CampbellPoint>& points,
                                     const std::vector<std::vector<TrackedMode>>& lines) {
  std::vector<std::pair<double, CampbellLine>> sorted;
  for (const std::vector<TrackedMode>& line : lines) {
    const TrackedMode& middle = line[line.size() / 2];
    sorted.emplace_back(std::abs(tracked_exponent(mode_of(points, middle).exponent, middle,
                                                  points[middle.point].rotor_speed)
                                     .imag()),
                        CampbellLine{"", line});
  }
  std::ranges::stable_sort(sorted, {}, [](const auto& line) { return line.first; });
  std::vector<CampbellLine> result;
  for (auto& [frequency, line] : sorted) result.push_back(std::move(line));
  // Of lines with one name, the one with the most points has it as it is.
  std::vector<CampbellLine*> longest;
  for (CampbellLine& line : result) longest.push_back(&line);
  std::ranges::stable_sort(longest, std::ranges::greater(),
                           [](const CampbellLine* line) { return line->modes.size(); });
  std::map<std::string, int> times;
  for (CampbellLine* line : longest) {
    const auto [name, number] = most_frequent_name(points, line->modes);
    line->name = analysis::label_of(name, number, times);
  }
  return result;
}

}  // namespace samara::simulation
