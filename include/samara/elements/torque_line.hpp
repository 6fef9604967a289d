// A torque that depends on a speed: a straight line, or a table of them.
#pragma once

#include <cstddef>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include "samara/base/error.hpp"

namespace samara::elements {

struct TorqueLine {
  double torque = 0.0;                           ///< at `speed` [N m]
  double slope = 0.0;                            ///< by the speed [N m s/rad]
  double speed = 0.0;                            ///< [rad/s]
  std::vector<std::pair<double, double>> table;  ///< rising speed, torque; empty: the line

  bool is_zero() const { return torque == 0.0 && slope == 0.0 && table.empty(); }

  /// @throws DomainError where the table does not reach to a speed
  void require(double at_speed) const {
    if (table.empty() || (at_speed >= table.front().first && at_speed <= table.back().first))
      return;
    std::ostringstream text;
    text << "a torque table reaches from " << table.front().first << " to " << table.back().first
         << " rad/s, the speed is " << at_speed << " rad/s; hint: more entries";
    throw DomainError(text.str());
  }

  struct Value {
    double torque = 0.0;
    double slope = 0.0;
  };

  /// Torque and slope at a speed; where that is an entry of the table, the mean of both slopes. A
  /// table goes on beyond its ends, for the iterates of a solver on their way. At no number the
  /// slope of a line is its own, of a table no number.
  Value at(double at_speed) const {
    if (table.empty()) return {(at_speed - speed) * slope + torque, slope};
    if (at_speed != at_speed)
      return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    const auto slope_before = [this](std::size_t i) {
      return (table[i].second - table[i - 1].second) / (table[i].first - table[i - 1].first);
    };
    std::size_t i = 1;
    while (i + 1 < table.size() && table[i].first < at_speed) ++i;
    double local = slope_before(i);
    if (i + 1 < table.size() && table[i].first == at_speed)
      local = 0.5 * (slope_before(i) + slope_before(i + 1));
    return {(at_speed - table[i].first) * local + table[i].second, local};
  }
};

}  // namespace samara::elements
