// Operating points of a turbine in wind: speed, pitch and torque, and the steady state there.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <mpi.h>

#include "samara/analysis/observer.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/simulation/scenario.hpp"
#include "samara/simulation/start_predictor.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// Rule that an operating point follows.
enum class OperatingRegion {
  given,        ///< speed and pitch of a table
  least_speed,  ///< the least speed is held by the torque, which is below the law
  torque_law,   ///< the torque follows its law over the speed
  rated_speed,  ///< the rated speed is held by the torque, which is between the law and the rated
                ///< one
  rated_power,  ///< rated speed and torque are held by the pitch
};

/// "torque law"
std::string region_name(OperatingRegion region);

/// A row of a table of operating points.
struct ScheduledPoint {
  double wind = 0.0;   ///< [m/s]
  double speed = 0.0;  ///< of the rotor [rad/s]
  double pitch = 0.0;  ///< [rad]
};

/// Values are means over a revolution.
struct OperatingPoint {
  double wind = 0.0;   ///< [m/s]
  double speed = 0.0;  ///< of the rotor [rad/s]
  double pitch = 0.0;  ///< of the case, without the differences of blades [rad]
  OperatingRegion region = OperatingRegion::given;
  double torque = 0.0;              ///< of the generator against its turning, behind the gear [N m]
  double power = 0.0;               ///< of the air on the rotor [W]
  double thrust = 0.0;              ///< of the air on the rotor along the shaft [N]
  double power_coefficient = 0.0;   ///< with `wind` and the area of the undeformed rotor
  double thrust_coefficient = 0.0;  ///< the same
  double tip_speed_ratio = 0.0;     ///< with `wind`
  double tip_out_of_plane = 0.0;    ///< deflection of blade 1 [m]
  double tip_in_plane = 0.0;        ///< [m]
  double tip_twist = 0.0;           ///< rotation of the tip of blade 1 toward feather [rad]
  double root_flap_moment = 0.0;    ///< of blade 1, out of plane [N m]
  double tower_moment = 0.0;        ///< fore-aft moment at the tower base [N m]; 0 without a tower
  double time_constant = 0.0;       ///< first one of the dynamic inflow [s]
  double imbalance = 0.0;           ///< analysis::Trim::imbalance
};

/// A point at the rated power.
struct PitchedPoint {
  double wind = 0.0;   ///< [m/s]
  double pitch = 0.0;  ///< [rad]
  double slope = 0.0;  ///< of the torque over the pitch, by the rated torque [1/rad]
};

/// What a search takes from the points before it.
struct OperationMemory {
  std::optional<OperatingPoint> point;  ///< the one before
  StartPredictor starts;
  std::vector<PitchedPoint> pitched;  ///< in the order in which they were found
  double speed_slope = 0.0;           ///< of the torque less its law, by the rated torque [s/rad]
  double tip_radius = 0.0;            ///< of the rotor [m]; 0: not known
  double density = 0.0;               ///< of the air [kg/m^3]
};

/// Finds operating points of `scenario.operation`. `table`: rows of its table; the speed and pitch
/// of a wind speed between two rows are linear between them. Without a table the pitch of the case
/// is the least pitch. Laws of the generator and the controller do not act. Each steady state
/// starts from an extrapolation of those before. `scenario` and `table` must outlive the object.
class OperatingPointFinder {
 public:
  OperatingPointFinder(const Scenario& scenario, const std::vector<ScheduledPoint>& table);
  ~OperatingPointFinder();

  /// @throws InputError where no operating point exists: wind speed, and reason
  /// @throws ConvergenceError, DomainError as analysis::find_trim, with the wind speed
  /// `comm`: ranks that share a large mesh; each of them calls it.
  OperatingPoint find_at(double wind, analysis::Observer& observer, MPI_Comm comm = MPI_COMM_SELF);

  /// With the memory of another object behind a point, the next points are the same as of that
  /// one.
  const OperationMemory& memory() const;
  void recall(const OperationMemory& memory);

  /// The turbine and its steady state at the last operating point that it has found itself.
  const turbine::TurbineSystem& system() const;
  const analysis::Trim& trim() const;

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

/// The wind speeds of `scenario.operation` [m/s]: listed, those of the table, or that of the case.
std::vector<double> operating_winds(const Scenario& scenario,
                                    const std::vector<ScheduledPoint>& table);

/// The operating points at these wind speeds. @throws as OperatingPointFinder::find_at
std::vector<OperatingPoint> find_operation(const Scenario& scenario,
                                           const std::vector<ScheduledPoint>& table,
                                           analysis::Observer& observer);

}  // namespace samara::simulation
