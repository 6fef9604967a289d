// Rainflow counting after ASTM E1049-85, sections 5.4.4 and 5.4.5 (docs/theory.md, section 8.3).
#pragma once

#include <vector>

#include "samara/loads/load_series.hpp"

namespace samara::loads {

/// A cycle, or half of one, in the unit of the channel.
struct Cycle {
  double range = 0.0;  ///< > 0
  double mean = 0.0;   ///< of its peak and its valley
  double count = 1.0;  ///< 1, or 0.5 for a half cycle
};

/// Peaks and valleys in turn, from the first to the last value. Swings of no more than `gate` times
/// the range of all values are left out, 0 <= gate < 1; the largest and the smallest value stay. A
/// constant has one turning point.
/// @throws InputError where there is no value, one is not finite, or the gate is out of range.
std::vector<double> find_turning_points(const Eigen::Ref<const Eigen::VectorXd>& values,
                                        double gate = 0.0);

/// Full and half cycles of values that do not repeat (5.4.4), in the order in which they close;
/// none for a constant.
/// @throws as `find_turning_points`
std::vector<Cycle> count_cycles(const Eigen::Ref<const Eigen::VectorXd>& values, double gate = 0.0);

/// Cycles of one period of values that repeat without end (5.4.5: from the largest peak on): the
/// first value follows the last one. All cycles are full.
/// @throws as `find_turning_points`
std::vector<Cycle> count_periodic_cycles(const Eigen::Ref<const Eigen::VectorXd>& values,
                                         double gate = 0.0);

/// Cycles of one channel, periodic or not.
/// @throws as `check` of the time series and `find_turning_points`
std::vector<Cycle> count_cycles(const LoadSeries& series, Eigen::Index channel, double gate = 0.0);

/// Counts by range and mean. A bin includes its lower edge, the last one both edges.
struct RainflowTable {
  Eigen::VectorXd range_edges;  ///< from 0 to the largest range, in equal steps
  Eigen::VectorXd mean_edges;   ///< over all means, or over the largest range where they are equal
  Eigen::MatrixXd counts;       ///< range bin x mean bin
};

/// @throws InputError where a number of bins is less than one.
RainflowTable tabulate_cycles(const std::vector<Cycle>& cycles, int range_bins, int mean_bins);

}  // namespace samara::loads
