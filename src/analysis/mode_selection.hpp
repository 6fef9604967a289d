// Some of all modes: those that `floquet.modes` or `floquet.least_damped` ask for.
#pragma once

#include <algorithm>
#include <optional>

#include "samara/analysis/mode.hpp"
#include "samara/analysis/options.hpp"

namespace samara::analysis {

/// Number of modes that are asked for; 0: all.
inline int wanted_modes(const FloquetOptions& options) {
  return std::max(options.modes, options.least_damped);
}

/// The slowest decays are known where they have frequencies in this part of the known ones, or
/// where this many times as many modes are known: in general faster modes decay faster.
inline constexpr double part_of_slowest = 0.6;
inline constexpr double most_of_slowest = 3.0;

/// Whether the `wanted` ones of slowest decay, with moduli up to `highest`, are known among `found`
/// modes of moduli up to `reach`.
inline bool knows_slowest_decays(double found, int wanted, double highest, double reach) {
  return found >= most_of_slowest * wanted || highest < part_of_slowest * reach;
}

/// Modulus of an exponent [rad/s] up to which all modes are to be resolved, so that those asked for
/// are among them; none where they are, or where no mode is resolved that could show it.
std::optional<double> lacking_reach(const ModeSet& set, const FloquetOptions& options);

/// Leaves the modes asked for: the slowest ones, those nearest to a frequency, or of those below
/// ModeSet::reach the ones of slowest decay, with all that equal the last one, and every other mode
/// that grows. Modes of a medium that decay are left out. Describes the part of the spectrum in
/// which they are complete. `set`: all modes, arranged. Where no mode is resolved, it stays as it
/// is.
/// @throws ConvergenceError if `options.near_hz` is beyond ModeSet::reach
void leave_wanted(ModeSet& set, const FloquetOptions& options);

}  // namespace samara::analysis
