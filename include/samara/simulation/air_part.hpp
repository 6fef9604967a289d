// The part of the air in the damping of modes, and its work on them.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "samara/analysis/mode.hpp"
#include "samara/analysis/options.hpp"
#include "samara/analysis/periodic_solution.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// The air in the modes of a set.
struct AirPart {
  /// Damping ratio of the same mode under held air loads, in the same steady state: of the mode
  /// whose shape is most alike. Not a number: none is alike, or the mode does not oscillate. The
  /// part of the air is the difference to the mode's damping ratio.
  std::vector<double> held_damping;
  /// Modal assurance criterion of both shapes, 0 to 1; 0: none.
  std::vector<double> likeness;
  /// Work of the air per cycle and length of the blade [J/m], mode x station, blade by blade, at an
  /// amplitude as in ModeSet::shapes: positive where the air feeds the motion.
  Eigen::MatrixXd work;
  std::vector<double> lengths;  ///< that each station stands for [m]; the sum of work times length
                                ///< is the work per cycle

  double whole_work(std::size_t mode) const;
};

/// Options for the modes of hold_air(system) with which those of `modes` are compared: where these
/// are taken from all modes, all of them.
analysis::FloquetOptions options_of_held_air(const analysis::ModeSet& modes,
                                             const analysis::FloquetOptions& options);

/// `held`: modes of hold_air(system), of held_air.hpp, at the same steady state. The work is the
/// mean over a revolution of the change of the loads times the rate of the change of the place, in
/// axes that turn with the steady rotor, over one cycle of the mode's frequency. Where the mode
/// does not oscillate the work is zero.
AirPart find_air_part(const turbine::TurbineSystem& system,
                      const analysis::PeriodicSolution& steady, const analysis::ModeSet& modes,
                      const analysis::ModeSet& held);

}  // namespace samara::simulation
