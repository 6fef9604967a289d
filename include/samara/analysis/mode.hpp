// A mode of a linearized system, identified (docs/theory.md, section 5).
#pragma once

#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Share of a mode's mean kinetic energy in a part.
struct PartShare {
  std::string part;
  double share = 0.0;
};

struct Mode {
  std::complex<double> multiplier;  ///< over the full period; 0 where the analysis has no period
  std::complex<double> exponent;    ///< lambda + i k Omega with the dominant k [rad/s], Im >= 0
  /// Exponent of the sequence of steps, which (2/dt) tanh(. dt/2) maps to `exponent`; without an
  /// integration, the exponent itself.
  std::complex<double> step_exponent;
  int harmonic = 0;            ///< k, relative to the principal exponent
  double damping_ratio = 0.0;  ///< -Re / |lambda|; 0 where |lambda| counts as zero
  std::string name;            ///< of its motion: equal for modes of the same motion
  std::string motion;          ///< name without the word for how the blades move together
  /// Number of the mode among those of its motion: the load that the motion restores
  /// changes its sign `shape_number` - 1 times along the part. 0: not known.
  int shape_number = 0;
  bool is_mixture = false;  ///< bends in two directions, as others of the same exponent
  /// That of the shape, or else one more than the largest one of the name; 0: the name has none.
  int number = 0;
  std::string label;  ///< number, as "1st", and name; another mode with both has "(2)" behind it
  /// Im of the exponent in the fixed frame [rad/s]; not-a-number where the motion has no single
  /// frequency there (docs/theory.md, section 5.6).
  double fixed_frame_frequency = std::numeric_limits<double>::quiet_NaN();
  bool resolved = true;  ///< |lambda| dt / 2 and the residual are small enough
  /// Estimated errors of the exponent, relative to its modulus (docs/theory.md, section 5.9).
  double step_error = 0.0;
  double mesh_error = 0.0;
  double round_off_error = 0.0;
  double growth_error = 0.0;  ///< of the real part [rad/s]; a smaller growth is not significant
  double mesh_growth_error = 0.0;  ///< part of growth_error from the elements
  /// Floquet: |P z(T/Q) - mu z(0)| / |z(0)| of velocities and Omega times positions; Hill's method:
  /// largest scaled residual over a period, relative to the inertia loads, or in a medium the
  /// relative change of the exponent since fewer harmonics; constant tangents:
  /// relative difference of the exponent found with two shifts.
  double residual = 0.0;
  std::vector<PartShare> parts;  ///< descending
  /// Part whose first-order states dominate the mode; empty for a mode of a motion.
  std::optional<system::Owner> state;
  double kinetic_energy = 0.0;  ///< mean, of the shape as it is scaled [J]
};

/// True for a mode of the states of a medium: exponents of the air around a part.
inline bool is_of_medium(const Mode& mode) {
  return mode.state && mode.state->kind == system::PartKind::medium;
}

/// Error of an exponent, relative to its modulus.
inline double total_error(const Mode& mode) {
  return mode.step_error + mode.mesh_error + mode.round_off_error;
}

/// Logarithm of the ratio of two maxima one cycle apart; not a number for a real exponent.
inline double logarithmic_decrement(const Mode& mode) {
  return mode.exponent.imag() == 0.0
             ? std::numeric_limits<double>::quiet_NaN()
             : -2.0 * std::numbers::pi * mode.exponent.real() / mode.exponent.imag();
}

/// A part of the spectrum in which modes were searched: exponents with -`decay` <= Re <= `growth`
/// [1/s] and `low` <= |Im| <= `high` [rad/s].
struct SearchedRegion {
  double low = 0.0;
  double high = 0.0;
  double decay = 0.0;
  double growth = 0.0;
  /// Whether the number of modes in it is known, and is that of the modes.
  bool is_counted = false;
  int wanted = 0;                  ///< number of modes that were asked for
  bool is_of_slow_decays = false;  ///< those of slowest decay, not those next to a frequency
  double largest_damping = 1.0;    ///< ratio up to which the modes are counted
  bool is_of_all = false;          ///< taken from all modes; others are known, too
};

struct ModeSet {
  std::vector<Mode> modes;     ///< in the order of arrange_modes (identification.hpp)
  int degrees_of_freedom = 0;  ///< 0: not counted
  int instances = 0;           ///< number of identical parts (the blades); 0: none
  double rotor_speed = 0.0;    ///< Omega [rad/s]
  double step = 0.0;           ///< time step of the integration [s]; 0: no integration
  bool conservative = false;   ///< multipliers should come in pairs mu, 1/mu*
  int states = 0;              ///< number of exponents; both of a pair count; 0: not counted
  int found = 0;               ///< number of these that belong to `modes`
  int medium_states = 0;       ///< number of exponents that first-order states of a medium add
  /// Number of exponents that decay below round-off within the integration: their values are not
  /// known, and `modes` does not contain them. All of them decay at `deflated_rate` [1/s] or
  /// faster.
  int deflated = 0;
  double deflated_rate = std::numeric_limits<double>::infinity();
  /// Smallest modulus of an exponent that is not resolved and does not belong to a medium [rad/s],
  /// but not more than the largest modulus that the time step resolves. All modes below it are
  /// known, except deflated ones.
  double reach = std::numeric_limits<double>::infinity();
  /// Set where not all modes were searched.
  std::optional<SearchedRegion> searched;
  /// Share of the mean kinetic energy, mode x harmonic, harmonics from `first_harmonic`.
  Eigen::MatrixXd participation;
  int first_harmonic = 0;
  /// Periodic mode shapes Z(t) exp(-lambda t): per mode, size x samples, at `shape_times` [s]; the
  /// largest position is 1 m or 1 rad; in a mode of states the largest state equals its scale.
  /// Empty for a mode that is not resolved.
  std::vector<Eigen::MatrixXcd> shapes;
  std::vector<double> shape_times;
};

/// Below this, relative to the rotor speed or 1 rad/s, an exponent counts as zero.
inline constexpr double zero_exponent = 1e-6;

}  // namespace samara::analysis
