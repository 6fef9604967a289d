// A time series of loads, or of anything else that is evaluated like loads: rows are instants,
// columns channels (docs/theory.md, section 8).
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace samara::loads {

struct LoadSeries {
  std::vector<std::string> names;  ///< of the channels, as error messages name them
  Eigen::VectorXd times;           ///< [s], growing, in steps that may vary
  Eigen::MatrixXd values;          ///< row an instant, column a channel, each in its own unit
  /// [s] of a periodic steady state, whose rows are one period and do not repeat the first; 0 for
  /// a time series that begins and ends.
  double period = 0.0;

  bool is_periodic() const { return period > 0.0; }
};

/// Refuses a time series that has no statistics.
/// @throws InputError, one error a line, where there is no channel, fewer than two rows (one if
/// periodic), a time that does not grow or a number that is not finite.
/// @throws InternalError where names, times and values differ in size.
void check(const LoadSeries& series);

/// T [s]: from the first to the last time, or the period. For a time series that `check` accepts.
double duration(const LoadSeries& series);

/// Weights of the trapezoidal rule over `points`, which grow: the integral of a function that is
/// linear in between is the sum of weights and values. With a period > 0 the last point's neighbour
/// is the first of the next period.
Eigen::VectorXd trapezoidal_weights(const Eigen::VectorXd& points, double period = 0.0);

}  // namespace samara::loads
