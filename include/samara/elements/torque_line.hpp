// A torque that depends on a speed: a straight line, or a table of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <utility>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/math/scalar.hpp"

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

  /// The torque at a speed; where that is an entry of the table, with the mean of both slopes. A
  /// table goes on beyond its ends, for the iterates of a solver on their way.
  template <class T>
  T at(const T& at_speed) const {
    if (table.empty()) return (at_speed - T(speed)) * slope + T(torque);
    const double value = math::plain_value(at_speed);
    const auto slope_before = [this](std::size_t i) {
      return (table[i].second - table[i - 1].second) / (table[i].first - table[i - 1].first);
    };
    std::size_t i = 1;
    while (i + 1 < table.size() && table[i].first < value) ++i;
    double local = slope_before(i);
    if (i + 1 < table.size() && table[i].first == value)
      local = 0.5 * (slope_before(i) + slope_before(i + 1));
    return (at_speed - T(table[i].first)) * local + T(table[i].second);
  }
};

}  // namespace samara::elements
