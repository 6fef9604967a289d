// Kinetic energy of a turbine by the motion that it belongs to (docs/theory.md, section 5.6).
#pragma once

#include <memory>
#include <vector>

#include "samara/model/layout.hpp"
#include "samara/model/turbine.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::system {

/// Deformations of blades and tower by direction, hinges of blades, foundation, joints.
std::vector<Motion> motions_of(const model::Turbine& turbine, const model::Layout& layout);

/// About the state `steady` at t.
std::unique_ptr<MotionEnergies> find_motion_energies(const model::Turbine& turbine,
                                                     const model::Layout& layout, double t,
                                                     const Eigen::VectorXd& steady);

}  // namespace samara::system
