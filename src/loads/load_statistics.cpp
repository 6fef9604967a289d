#include "samara/loads/load_statistics.hpp"

#include <cmath>

namespace samara::loads {

std::vector<ChannelStatistics> compute_statistics(const LoadSeries& series) {
  check(series);
  const Eigen::VectorXd weights =
      trapezoidal_weights(series.times, series.period) / duration(series);
  std::vector<ChannelStatistics> all;
  for (Eigen::Index c = 0; c < series.values.cols(); ++c) {
    const Eigen::VectorXd values = series.values.col(c);
    ChannelStatistics one;
    one.minimum = values.minCoeff(&one.row_of_minimum);
    one.maximum = values.maxCoeff(&one.row_of_maximum);
    one.range = one.maximum - one.minimum;
    one.time_of_minimum = series.times(one.row_of_minimum);
    one.time_of_maximum = series.times(one.row_of_maximum);
    // Relative to the first value, so that a large mean does not cost digits of small variations.
    const Eigen::ArrayXd swings = values.array() - values(0);
    const double mean_swing = weights.dot(swings.matrix());
    one.mean = values(0) + mean_swing;
    one.standard_deviation = std::sqrt(weights.dot((swings - mean_swing).square().matrix()));
    all.push_back(one);
  }
  return all;
}

std::vector<ExtremeEvent> find_extreme_events(const LoadSeries& series) {
  std::vector<ExtremeEvent> events;
  Eigen::Index channel = 0;
  for (const ChannelStatistics& one : compute_statistics(series)) {
    events.push_back({channel, false, one.row_of_minimum, one.time_of_minimum});
    events.push_back({channel, true, one.row_of_maximum, one.time_of_maximum});
    ++channel;
  }
  return events;
}

}  // namespace samara::loads
