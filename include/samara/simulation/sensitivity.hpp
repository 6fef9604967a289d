// Derivatives of the exponents of modes with respect to numbers of a case (docs/theory.md, section
// 5.13).
#pragma once

#include <complex>
#include <functional>
#include <string>
#include <vector>

#include "samara/analysis/floquet.hpp"
#include "samara/analysis/observer.hpp"
#include "samara/analysis/trim.hpp"
#include "samara/simulation/scenario.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::simulation {

/// A number of a case.
struct Parameter {
  std::string key;
  double value = 0.0;
  std::string unit;
};

/// Derivatives with respect to one number, in the order of the modes; not-a-number where there is
/// none (ExponentDerivatives).
struct Sensitivity {
  std::vector<std::complex<double>> rates;  ///< of the exponents [1/s per unit of the key]
  std::vector<double> errors;               ///< estimated, of the modulus of a rate
};

/// The scenario with another value of a number. @throws InputError
using ScenarioAt = std::function<Scenario(const Parameter& parameter, double value)>;

/// @throws InputError for a parameter that allows no value beside its own
void require_range(const std::vector<Parameter>& parameters, const ScenarioAt& scenario_at);

/// The derivatives for all parameters. The steady state is found again at four values of a
/// parameter, two on each side, or four on one side where the other one is not allowed; the
/// residuals of the eigenproblem are differentiated by these. Ranks share the parameters; all of
/// them get the same result. `system`, `trim`: of `scenario`; `modes`: numbers in `set`, those
/// of the first rank.
/// @throws InputError, ConvergenceError
std::vector<Sensitivity> find_sensitivities(
    const Scenario& scenario, const turbine::TurbineSystem& system, const analysis::Trim& trim,
    const analysis::ModeSet& set, const std::vector<std::size_t>& modes,
    const std::vector<Parameter>& parameters, const ScenarioAt& scenario_at,
    analysis::Observer& observer, MPI_Comm comm);

}  // namespace samara::simulation
