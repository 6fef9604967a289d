// Statistics and extreme events of the channels of a time series (docs/theory.md, section 8.1).
#pragma once

#include <vector>

#include "samara/loads/load_series.hpp"

namespace samara::loads {

/// Statistics of one channel, in its unit; mean and deviation are weighted by time (trapezoidal
/// rule), so that they do not depend on where the steps are short.
struct ChannelStatistics {
  double mean = 0.0;
  double standard_deviation = 0.0;  ///< of the whole time series, not an estimate from a sample
  double minimum = 0.0;
  double maximum = 0.0;
  double range = 0.0;            ///< maximum - minimum
  double time_of_minimum = 0.0;  ///< [s], the first if there are several
  double time_of_maximum = 0.0;  ///< [s]
  Eigen::Index row_of_minimum = 0;
  Eigen::Index row_of_maximum = 0;
};

/// One entry for each channel.
/// @throws as `check` of the time series.
std::vector<ChannelStatistics> compute_statistics(const LoadSeries& series);

/// A channel is at its largest or smallest value; `series.values.row(row)` holds the values of the
/// others at the same time.
struct ExtremeEvent {
  Eigen::Index channel = 0;
  bool is_maximum = false;
  Eigen::Index row = 0;
  double time = 0.0;  ///< [s]
};

/// Minimum and maximum of every channel, in the order of the channels.
/// @throws as `check` of the time series.
std::vector<ExtremeEvent> find_extreme_events(const LoadSeries& series);

}  // namespace samara::loads
