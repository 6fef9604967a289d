// Deflections and internal loads along the beams of a turbine in a state.
#pragma once

#include <vector>

#include "samara/turbine/turbine_system.hpp"

namespace samara::turbine {

/// A place of a beam; components in the axes a of its root, which turn with pitch and hinges.
struct BeamStation {
  Vector3 displacement = Vector3::Zero();  ///< from the undeformed beam [m]
  Vector3 rotation = Vector3::Zero();      ///< rotation vector from the undeformed beam [rad]
  Vector3 force = Vector3::Zero();         ///< of the outer part on the inner one [N]
  Vector3 moment = Vector3::Zero();        ///< the same about the place of the station [N m]
};

/// Fractions of the length of a beam at which its stations are: root, Gauss points, end.
std::vector<double> station_fractions(const model::Beam& beam);

/// The stations of each beam, blades, then tower, at a state where the equations hold. The loads
/// include structural damping; at the root they are those on the part that carries the beam.
std::vector<std::vector<BeamStation>> find_beam_stations(const TurbineSystem& system, double t,
                                                         const std::vector<double>& z,
                                                         const std::vector<double>& z_dot);

}  // namespace samara::turbine
