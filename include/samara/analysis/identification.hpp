// What a mode is called, from the shape and the strain energy of its parts (docs/theory.md,
// section 5).
#pragma once

#include "samara/analysis/mode.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// True where almost nothing strains: a rigid-body motion of the free joints. A strain's damping
/// counts with it: an overdamped motion of a beam is none of its joints.
bool is_rigid_body(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                   const Mode& mode);

/// What modes are sorted by: |lambda| [rad/s], and 0 for real exponents slower than the rotor (or
/// 1 rad/s), which come in pairs that rounding must not sort.
double sorting_frequency(std::complex<double> exponent, double rotor_speed);

/// Scales every shape so that its largest position is 1, and its kinetic energy with it.
void scale_shapes(const system::PeriodicSystem& system, ModeSet& set);

/// Names modes by where their strain energy is, or by the joint that moves where nothing strains,
/// with symmetric or antisymmetric for two blades, numbered by frequency. Needs the shapes: where
/// there are none, labels stay empty.
void label_modes(const system::PeriodicSystem& system, ModeSet& set);

}  // namespace samara::analysis
