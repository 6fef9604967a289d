// Name of a mode, from the kinetic energy of its motions, and its place in the list of modes
// (docs/theory.md, section 5.6).
#pragma once

#include <map>
#include <string>

#include "samara/analysis/leading_motion.hpp"
#include "samara/analysis/mode.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Mean strain energy of a shape as it is scaled.
double strain_energy_of(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape);

/// True where almost no part is strained: a rigid-body motion of the free joints. The damping of a
/// strain counts with the strain, so that an overdamped motion of a beam is not taken for a motion
/// of its joints.
bool is_rigid_body(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                   const Mode& mode);

/// Whether the phase between the blades distinguishes constant modes of equal exponents: true for
/// three or more identical blades of a turning rotor.
bool has_canonical_shapes(const system::PeriodicSystem& system);

/// Where has_canonical_shapes, replaces constant modes of equal exponents by their combinations in
/// which each blade is ahead of the blade behind it by the same phase angle. The exponents change
/// by round-off.
void choose_shapes(const system::PeriodicSystem& system,
                   std::vector<std::complex<double>>& exponents,
                   std::vector<Eigen::MatrixXcd>& shapes);

/// The leading motions of all modes (find_leading_motions). Before, modes at rest, whose exponents
/// are all zero, are replaced by combinations each of which moves one unconstrained coordinate: the
/// rotor's azimuth, or the yaw angle. They stay where they do not move the coordinates one by one.
std::vector<LeadingMotion> separate_motions(const system::PeriodicSystem& system,
                                            const PeriodicSolution& solution, ModeSet& set,
                                            int sectors = 1);

/// Replaces mode m by its conjugate, which represents the pair from then on.
void conjugate_mode(ModeSet& set, std::size_t m);

/// Mirrors row m of shares by harmonic k = -floor(n/2) ...: those of the conjugate.
void mirror_harmonics(Eigen::Index m, Eigen::MatrixXd& shares);

/// Scales every shape so that its largest position is 1, and its kinetic energy accordingly.
void scale_shapes(const system::PeriodicSystem& system, ModeSet& set);

/// Names modes, without numbers, after their leading motion or, if `leading` is empty, after the
/// motion with most strain energy. Adds a word for the phase between the blades, and sets the
/// frequency in the fixed frame. Each mode must already be at the harmonic of its leading motion.
/// Without shapes no mode is named.
void name_modes(const system::PeriodicSystem& system, const std::vector<LeadingMotion>& leading,
                ModeSet& set, int sectors = 1);

/// "2nd blade flap"; without a number (0) the name. `times`: how often each label was given,
/// counted here; the second one has " (2)" behind it.
std::string label_of(const std::string& name, int number, std::map<std::string, int>& times);

/// Leaves the modes of these numbers, in their order, with their shapes and participation.
void pick_modes(ModeSet& set, const std::vector<std::size_t>& numbers);

/// Sorts modes: resolved ones first, then by |lambda|, growth, name and harmonic. Numbers the modes
/// of the same name. Order and numbers do not depend on the order in which an eigensolver found the
/// modes.
void arrange_modes(ModeSet& set);

}  // namespace samara::analysis
