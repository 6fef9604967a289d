// Time series of loads from results: rows of a transient, or one revolution of a steady state.
#pragma once

#include <string>

#include "samara/analysis/observer.hpp"
#include "samara/io/load_result.hpp"

namespace samara::drivers {

struct LoadSource {
  io::LoadReport report;    ///< without its evaluation
  Eigen::VectorXd azimuth;  ///< azimuth of each row [deg]; empty: the time series has none
};

/// A steady state needs a PETSc session. A rough steady state gives a note.
/// @throws InputError if the result has neither, or lacks data that the options request
LoadSource read_load_source(const std::string& path, const io::LoadOptions& options,
                            analysis::Observer& observer);

}  // namespace samara::drivers
