// A controller outside of the equations, which is called at fixed instants of a transient: a
// library (io/controller_library.hpp), or one of the calling program.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace samara::simulation {

/// Keys of `transient.controller`.
struct ControllerSetup {
  std::string library;               ///< path of the library; relative: from the case's folder
  std::string input;                 ///< path of its input file; empty: none
  std::string procedure = "DISCON";  ///< name in the library
  double step = 0.0;                 ///< between calls [s]; 0: each step of the transient
  double timeout = 10.0;             ///< longest time of a call [s], by the clock
  bool is_individual = false;        ///< each blade has its own demand of the pitch
  double pitch_rate = 0.17453292519943295;  ///< largest rate of the pitch without actuators [rad/s]
  double efficiency = 1.0;                  ///< of the generator
};

/// Measured values at a call. Vectors have one entry per blade. The blade frames are coned and not
/// pitched, the loads are those of the outer part on the inner one (docs/channels.md).
struct ControlMeasurement {
  enum class Call { first, next, last };

  Call call = Call::first;
  double time = 0.0;                        ///< [s]
  double interval = 0.0;                    ///< between calls [s]
  std::vector<double> pitch;                ///< toward feather, without `each.pitch_deg` [rad]
  std::vector<double> out_of_plane;         ///< moments at the roots [N m]
  std::vector<double> in_plane;             ///< moments at the roots [N m]
  double rotor_speed = 0.0;                 ///< relative to the nacelle [rad/s]
  double generator_speed = 0.0;             ///< behind the gear [rad/s]
  double generator_torque = 0.0;            ///< behind the gear, against the turning [N m]
  double shaft_power = 0.0;                 ///< [W]
  double electrical_power = 0.0;            ///< [W]
  double azimuth = 0.0;                     ///< 0: blade 1 is up [rad]
  double yaw = 0.0;                         ///< of the nacelle, counter-clockwise from above [rad]
  double yaw_error = 0.0;                   ///< direction of the wind less the yaw [rad]
  double wind_speed = 0.0;                  ///< horizontal, undisturbed, at the hub [m/s]
  double fore_aft_acceleration = 0.0;       ///< of the tower top [m/s^2]
  double side_side_acceleration = 0.0;      ///< of the tower top [m/s^2]
  std::array<double, 3> nacelle_turning{};  ///< angular acceleration: roll, nod, yaw; axes of the
                                            ///< shaft, not turning with it [rad/s^2]
  double shaft_torque = 0.0;                ///< [N m]
  double thrust = 0.0;                      ///< [N]
  std::array<double, 2> shaft_force{};      ///< y and z, not turning [N]
  std::array<double, 2> turning_hub_moment{};  ///< y and z, turning with the rotor [N m]
  std::array<double, 2> hub_moment{};          ///< y and z, not turning [N m]
  std::array<double, 2> yaw_bearing_moment{};  ///< nod and yaw, axes of the nacelle [N m]
};

/// Demanded values, until the next call.
struct ControlDemand {
  std::vector<double> pitch;       ///< of each blade, toward feather [rad]
  double torque = 0.0;             ///< of the generator, behind the gear, against its turning [N m]
  std::vector<std::string> notes;  ///< for the user
};

class SteppedController {
 public:
  SteppedController() = default;
  SteppedController(const SteppedController&) = delete;
  SteppedController& operator=(const SteppedController&) = delete;
  virtual ~SteppedController() = default;

  /// The demand of the last call of a run has no effect.
  /// @throws ConvergenceError if it fails
  virtual ControlDemand call(const ControlMeasurement& measured) = 0;
};

}  // namespace samara::simulation
