// Some of all modes: those that `floquet.modes` or `floquet.least_damped` ask for.
#pragma once

#include <optional>

#include "samara/analysis/mode.hpp"
#include "samara/analysis/options.hpp"

namespace samara::analysis {

/// Modulus of an exponent [rad/s] up to which all modes are to be resolved, so that those asked for
/// are among them; none where they are, or where no mode is resolved that could show it.
/// The slowest decays are known where they belong to the lower part of the resolved frequencies, or
/// where many more modes are resolved than are asked for: in general faster modes decay faster.
std::optional<double> lacking_reach(const ModeSet& set, const FloquetOptions& options);

/// Leaves the modes asked for: the slowest ones, those nearest to a frequency, or of those below
/// ModeSet::reach the ones of slowest decay, with all that equal the last one, and every other mode
/// that grows. Modes of a medium that decay are left out. Describes the part of the spectrum in
/// which they are complete. `set`: all modes, arranged. Where no mode is resolved, it stays as it
/// is.
/// @throws ConvergenceError if `options.near_hz` is beyond ModeSet::reach
void leave_wanted(ModeSet& set, const FloquetOptions& options);

}  // namespace samara::analysis
