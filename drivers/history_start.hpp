// Where a time history begins.
#pragma once

#include <vector>

#include "samara/analysis/transient.hpp"
#include "samara/model/turbine.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "job.hpp"
#include "progress.hpp"

namespace samara::drivers {

struct HistoryStart {
  analysis::TransientStart point;
  std::vector<double> fired;       ///< when the events came that have come already
  model::Turbine turbine;          ///< at the azimuth of the start, as earlier events left it
  bool is_generator_lost = false;  ///< by one of them
};

/// From the checkpoint of --restart, on the trim, undeformed, or from the end of another result, as
/// the case says. `system`: of the turbine with what the case prescribes in time.
/// @throws InputError where a result does not fit to the case
HistoryStart find_history_start(const Job& job, const turbine::TurbineSystem& system,
                                Progress& progress);

}  // namespace samara::drivers
