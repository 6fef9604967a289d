// Modes as a table, and the verdict on stability in words.
#pragma once

#include <string>
#include <vector>

#include "samara/analysis/mode.hpp"
#include "samara/io/result_file.hpp"
#include "samara/simulation/air_part.hpp"
#include "samara/simulation/stability.hpp"

namespace samara::drivers {

/// Selection of the listed modes.
struct ModeListing {
  bool all = false;                          ///< also modes that are not resolved
  int first = 0;                             ///< number of rows; 0: all
  const simulation::AirPart* air = nullptr;  ///< its part in the damping; null: not known
};

/// Writes `group`/held_air_damping, held_air_likeness, air_work and the lengths of the stations.
void write_air_part(io::ResultFile& file, const std::string& group, const simulation::AirPart& part,
                    std::size_t blades);

/// Numbers of the modes that a listing has, in its order.
std::vector<std::size_t> listed_modes(const analysis::ModeSet& set,
                                      const simulation::StabilityAssessment& assessment,
                                      const ModeListing& listing);

/// One line per mode, with its number in the result. Modes that are not resolved are below the
/// others. Harmonics are listed if the set has participations.
std::string mode_table(const analysis::ModeSet& set,
                       const simulation::StabilityAssessment& assessment,
                       const ModeListing& listing);

/// "stable: ...", "neutral: ..." or "unstable: ...", the frequency up to which the verdict is valid
/// and the modes that were left out; or "no verdict: ..." and a hint on the remedy. `all`:
/// unresolved modes are listed.
std::string verdict_text(const analysis::ModeSet& set,
                         const simulation::StabilityAssessment& assessment, bool all);

/// @throws ConvergenceError if there is no verdict, for the exit code
void require_verdict(const analysis::ModeSet& set,
                     const simulation::StabilityAssessment& assessment);

}  // namespace samara::drivers
