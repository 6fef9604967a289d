// Starts of the steady states of a search for operating points.
#pragma once

#include <optional>

#include <Eigen/Core>

namespace samara::simulation {

/// A steady state, and what it belongs to.
struct Solved {
  double wind = 0.0;             ///< [m/s]
  double speed = 0.0;            ///< of the rotor [rad/s]
  double pitch = 0.0;            ///< [rad]
  Eigen::MatrixXd coefficients;  ///< of analysis::PeriodicSolution
};

/// Change of the coefficients with speed or pitch, by a secant.
struct StartSlope {
  Eigen::MatrixXd value;  ///< empty: not known
  double length = 0.0;    ///< of the secant
};

/// Starts of steady states from those before: the change with the wind speed continues that of the
/// last two operating points, the change with speed or pitch is that of the last two steady states
/// at one wind speed.
struct StartPredictor {
  /// Takes a steady state of the present search.
  void add(Solved solved);
  /// The last steady state is that of an operating point.
  void finish_point();
  /// Coefficients of a start; empty before the first steady state.
  std::optional<Eigen::MatrixXd> predict(double wind, double speed, double pitch) const;

  std::optional<Solved> last;
  std::optional<Solved> point;   ///< last operating point
  std::optional<Solved> before;  ///< the one before
  StartSlope speed_slope;
  StartSlope pitch_slope;
};

}  // namespace samara::simulation
