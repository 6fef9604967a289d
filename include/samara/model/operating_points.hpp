// The operating points of a turbine over the wind speed, as defined by the user.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace samara::model {

/// Operating points over the wind speed. Speeds are those of the rotor.
struct OperatingPointsDefinition {
  std::vector<double> wind_speeds;  ///< [m/s], ascending; empty: those of `table`, or wind.speed
  double least_speed = 0.0;         ///< [rad/s]
  double rated_speed = 0.0;         ///< [rad/s]; 0: not given
  double rated_power = 0.0;         ///< torque of the generator times its speed [W]; 0: not given
  /// Torque of the generator between both speeds: gain times the square of its speed
  /// [N m s^2/rad^2], or a table over its speed [rad/s], [N m].
  double torque_gain = 0.0;
  std::vector<std::pair<double, double>> torque_table;
  std::string table_path;  ///< table of wind speed, pitch and speed, HAWC2's .opt; empty: none
  std::string opt_path;    ///< file to write in that form; empty: none
};

}  // namespace samara::model
