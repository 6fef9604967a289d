// Time series of loads out of results: rows of a transient, or one revolution of a steady state.
#pragma once

#include <string>

#include "samara/analysis/observer.hpp"
#include "samara/io/load_result.hpp"

namespace samara::drivers {

struct LoadSource {
  io::LoadReport report;    ///< without its evaluation
  Eigen::VectorXd azimuth;  ///< [deg] of each row; empty: the time series has none
};

/// A steady state needs a PETSc session; a rough one is noted.
/// @throws InputError where the result has neither, or not what the options ask for
LoadSource read_load_source(const std::string& path, const io::LoadOptions& options,
                            analysis::Observer& observer);

}  // namespace samara::drivers
