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

/// Starts of steady states from those before: the change with the wind speed continues that of the
/// last two operating points, the change with speed or pitch is that of the last two steady states
/// at one wind speed.
class StartPredictor {
 public:
  /// Takes a steady state of the present search.
  void add(Solved solved);
  /// The last steady state is that of an operating point.
  void finish_point();
  /// Coefficients of a start; empty before the first steady state.
  std::optional<Eigen::MatrixXd> predict(double wind, double speed, double pitch) const;

 private:
  /// Change of the coefficients with speed or pitch, by a secant.
  struct Slope {
    Eigen::MatrixXd value;  ///< empty: not known
    double length = 0.0;    ///< of the secant

    void add_change(double change, Eigen::MatrixXd& to) const;
    void take(const Solved& a, const Solved& b, double change);
  };

  std::optional<Solved> last_;
  std::optional<Solved> point_;   ///< last operating point
  std::optional<Solved> before_;  ///< the one before
  Slope speed_slope_;
  Slope pitch_slope_;
};

}  // namespace samara::simulation
