// A torque that depends on a speed: a straight line or a table.
#pragma once

#include <cstddef>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include "samara/base/error.hpp"

namespace samara::elements {

struct TorqueLine {
  double torque = 0.0;  ///< torque at `speed` [N m]
  double slope = 0.0;   ///< derivative with respect to the speed [N m s/rad]
  double speed = 0.0;   ///< [rad/s]
  std::vector<std::pair<double, double>> table;  ///< speed (ascending), torque; empty: the line

  bool is_zero() const { return torque == 0.0 && slope == 0.0 && table.empty(); }

  /// @throws DomainError if a speed is outside the table
  void require(double at_speed) const {
    if (table.empty() || (at_speed >= table.front().first && at_speed <= table.back().first))
      return;
    std::ostringstream text;
    text << "a torque table reaches from " << table.front().first << " to " << table.back().first
         << " rad/s, but the speed is " << at_speed << " rad/s; hint: add entries";
    throw DomainError(text.str());
  }

  struct Value {
    double torque = 0.0;
    double slope = 0.0;
  };

  /// Torque and slope at a speed. At an inner entry of the table the slope is the mean of both
  /// sides. The table is extrapolated beyond its ends, for the iterates of a solver. For a NaN
  /// speed a line has its own slope and a table has a NaN slope.
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
