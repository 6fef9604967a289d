// A turbine of the inputs with its steady state, for Floquet analyses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases.hpp"

namespace samara::test {

struct Turning {
  /// `name`: of a file in inputs, without its ending; `settings`: keys that are replaced.
  Turning(const std::string& name, const std::vector<std::string>& settings)
      : input(structure(name, settings)),
        system(model::build_turbine(input.turbine), PETSC_COMM_SELF),
        trim(analysis::find_trim(system, input.trim, observer)) {}

  analysis::Floquet modes(const analysis::FloquetOptions& options) {
    return analysis::find_floquet_modes(system, trim.solution, options, PETSC_COMM_SELF, observer);
  }

  analysis::ModeSet by_steps(int steps, int order = 6,
                             analysis::FloquetPeriod period = analysis::FloquetPeriod::automatic) {
    return modes({steps, period, order}).set;
  }
  analysis::Floquet by_hill(int count, std::optional<double> near_hz = {}) {
    analysis::FloquetOptions options;
    options.modes = count;
    options.search = analysis::ModeSearch::hill;
    options.near_hz = near_hz;
    return modes(options);
  }

  analysis::Floquet by_least_damped(int count) {
    analysis::FloquetOptions options;
    options.least_damped = count;
    options.search = analysis::ModeSearch::hill;
    return modes(options);
  }

  analysis::Observer observer;
  io::Case input;
  turbine::TurbineSystem system;
  analysis::Trim trim;
};

}  // namespace samara::test
