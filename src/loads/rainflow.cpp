#include "samara/loads/rainflow.hpp"

#include <algorithm>
#include <cmath>

#include "samara/base/error.hpp"

namespace samara::loads {
namespace {

void check_values(const Eigen::Ref<const Eigen::VectorXd>& values, double gate) {
  if (values.size() == 0) throw InputError("rainflow: there are no values to count");
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (!std::isfinite(values(i)))
      throw InputError("rainflow: row " + std::to_string(i + 1) + " is not a finite number");
  if (!(gate >= 0.0 && gate < 1.0))
    throw InputError("rainflow: the gate must be a share of the range, 0 <= gate < 1, not " +
                     std::to_string(gate));
}

Cycle cycle_between(double first, double second, double count) {
  return {std::abs(second - first), 0.5 * (first + second), count};
}

/// Range X of the last two points is no less than Y of the two before: Y has closed (5.4.4 rule 3).
bool closes(const std::vector<double>& points) {
  const std::size_t n = points.size();
  return n >= 3 &&
         std::abs(points[n - 1] - points[n - 2]) >= std::abs(points[n - 2] - points[n - 3]);
}

/// Counts Y as one cycle and discards its peak and valley (5.4.4 rule 4).
void count_closed(std::vector<double>& points, std::vector<Cycle>& cycles) {
  const auto y = points.end() - 3;
  cycles.push_back(cycle_between(y[0], y[1], 1.0));
  points.erase(y, y + 2);
}

/// The bin of `value` among `edges` that grow in equal steps.
Eigen::Index bin_of(double value, const Eigen::VectorXd& edges) {
  const auto first_above = std::upper_bound(edges.begin(), edges.end(), value);
  return std::clamp<Eigen::Index>(first_above - edges.begin() - 1, 0, edges.size() - 2);
}

}  // namespace

std::vector<double> find_turning_points(const Eigen::Ref<const Eigen::VectorXd>& values,
                                        double gate) {
  check_values(values, gate);
  const double least = gate * (values.maxCoeff() - values.minCoeff());
  std::vector<double> points;
  // Until a swing is large enough, either extreme may become the first point.
  double lowest = values(0);
  double highest = values(0);
  bool is_rising = false;
  double candidate = values(0);
  for (const double value : values) {
    if (points.empty()) {
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
      if (!(highest - lowest > least)) continue;
      is_rising = value == highest;
      points.push_back(is_rising ? lowest : highest);
      candidate = value;
    } else if (is_rising ? value >= candidate : value <= candidate) {
      candidate = value;
    } else if (std::abs(value - candidate) > least) {
      points.push_back(candidate);
      candidate = value;
      is_rising = !is_rising;
    }
  }
  points.push_back(candidate);
  return points;
}

std::vector<Cycle> count_cycles(const Eigen::Ref<const Eigen::VectorXd>& values, double gate) {
  std::vector<Cycle> cycles;
  std::vector<double> points;
  for (const double point : find_turning_points(values, gate)) {
    points.push_back(point);
    while (closes(points)) {
      if (points.size() > 3) {
        count_closed(points, cycles);
        continue;
      }
      // Y contains the starting point (rule 5).
      cycles.push_back(cycle_between(points[0], points[1], 0.5));
      points.erase(points.begin());
    }
  }
  for (std::size_t i = 1; i < points.size(); ++i)  // rule 6
    cycles.push_back(cycle_between(points[i - 1], points[i], 0.5));
  return cycles;
}

std::vector<Cycle> count_periodic_cycles(const Eigen::Ref<const Eigen::VectorXd>& values,
                                         double gate) {
  check_values(values, gate);
  Eigen::Index peak = 0;
  values.maxCoeff(&peak);
  Eigen::VectorXd from_peak(values.size() + 1);
  from_peak << values.tail(values.size() - peak), values.head(peak), values(peak);
  std::vector<Cycle> cycles;
  std::vector<double> points;
  for (const double point : find_turning_points(from_peak, gate)) {
    points.push_back(point);
    while (closes(points)) count_closed(points, cycles);
  }
  return cycles;
}

std::vector<Cycle> count_cycles(const LoadSeries& series, Eigen::Index channel, double gate) {
  check(series);
  if (channel < 0 || channel >= series.values.cols())
    throw InternalError("a time series has no channel " + std::to_string(channel));
  return series.is_periodic() ? count_periodic_cycles(series.values.col(channel), gate)
                              : count_cycles(series.values.col(channel), gate);
}

RainflowTable tabulate_cycles(const std::vector<Cycle>& cycles, int range_bins, int mean_bins) {
  if (range_bins < 1 || mean_bins < 1)
    throw InputError("rainflow: the numbers of bins must be >= 1, not " +
                     std::to_string(range_bins) + " and " + std::to_string(mean_bins));
  RainflowTable table;
  table.range_edges.setZero(range_bins + 1);
  table.mean_edges.setZero(mean_bins + 1);
  table.counts.setZero(range_bins, mean_bins);
  if (cycles.empty()) return table;
  double largest_range = 0.0;
  double lowest = cycles.front().mean;
  double highest = lowest;
  for (const Cycle& cycle : cycles) {
    largest_range = std::max(largest_range, cycle.range);
    lowest = std::min(lowest, cycle.mean);
    highest = std::max(highest, cycle.mean);
  }
  if (lowest == highest) {
    lowest -= 0.5 * largest_range;
    highest += 0.5 * largest_range;
  }
  table.range_edges.setLinSpaced(0.0, largest_range);
  table.mean_edges.setLinSpaced(lowest, highest);
  for (const Cycle& cycle : cycles)
    table.counts(bin_of(cycle.range, table.range_edges), bin_of(cycle.mean, table.mean_edges)) +=
        cycle.count;
  return table;
}

}  // namespace samara::loads
