// Kinetic energy of a turbine by motion (docs/theory.md, section 5.6).
#pragma once

#include <memory>
#include <vector>

#include "samara/model/turbine.hpp"
#include "samara/system/periodic_system.hpp"
#include "samara/turbine/turbine_equations.hpp"

namespace samara::turbine {

/// Motions: deformations of blades and tower by direction, hinges of blades, foundation, joints.
std::vector<system::Motion> motions_of(const model::Turbine& turbine, const TurbineLayout& layout);

/// Energies about the state `steady` at t: motions of motions_of, then those that components
/// declare.
std::unique_ptr<system::MotionEnergies> find_motion_energies(const TurbineEquations& equations,
                                                             double t,
                                                             const Eigen::VectorXd& steady);

}  // namespace samara::turbine
