// Name of a mode, from the kinetic energy of its motions, and its place in the list of modes
// (docs/theory.md, section 5.6).
#pragma once

#include "samara/analysis/leading_motion.hpp"
#include "samara/analysis/mode.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Mean strain energy of a shape, in its scale.
double strain_energy_of(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape);

/// True where almost nothing strains: a rigid-body motion of the free joints. A strain's damping
/// counts with it: an overdamped motion of a beam is none of its joints.
bool is_rigid_body(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                   const Mode& mode);

/// Whether constant modes of equal exponents are told apart by how the blades move together: where
/// three or more turn, and look alike.
bool has_canonical_shapes(const system::PeriodicSystem& system);

/// Among the combinations of constant modes of equal exponents those in which each blade is ahead
/// of the one behind it by the same angle, where has_canonical_shapes; exponents by round-off.
void choose_shapes(const system::PeriodicSystem& system,
                   std::vector<std::complex<double>>& exponents,
                   std::vector<Eigen::MatrixXcd>& shapes);

/// Scales every shape so that its largest position is 1, and its kinetic energy with it.
void scale_shapes(const system::PeriodicSystem& system, ModeSet& set);

/// Names modes, without numbers, by their leading motion, or by where their strain energy is where
/// there is no `leading`; with words for how the blades move together, and the frequency in the
/// fixed frame. A mode is at the harmonic of its leading motion by now. Where there are no shapes,
/// nothing is named.
void name_modes(const system::PeriodicSystem& system, const std::vector<LeadingMotion>& leading,
                ModeSet& set, int sectors = 1);

/// Sorts modes and numbers those of one name: resolved ones first, then by |lambda|; where that is
/// the same, by growth, name and harmonic. Neither depends on the order in which an eigensolver
/// found them.
void arrange_modes(ModeSet& set);

}  // namespace samara::analysis
