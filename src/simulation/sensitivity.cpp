#include "samara/simulation/sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "samara/analysis/exponent_derivatives.hpp"
#include "samara/analysis/ranks.hpp"
#include "samara/base/error.hpp"
#include "samara/simulation/held_air.hpp"
#include "samara/simulation/steady_state.hpp"

namespace samara::simulation {
namespace {

using analysis::ExponentDerivatives;
using Residuals = ExponentDerivatives::Residuals;

/// Steps of a number, relative to it. Truncation is of the fourth order in the step, but of the
/// first where curves of airfoils have kinks in their second derivatives; round-off of the steady
/// state is divided by it.
constexpr double relative_step = 1e-4;
/// Steps of a number that is 0, in its unit: that of the smallest estimated error counts.
constexpr std::array zero_steps{1e-4, 1e-2, 1.0, 100.0};
/// Relative residual of the steady states.
constexpr double trim_tolerance = 1e-12;

/// Parameters whose residuals are in memory together.
constexpr std::size_t parameters_at_once = 8;

/// A difference quotient: the derivative is the sum of weight times value over the step. `better`
/// and `simple` differ in order; their difference, times `caution`, estimates the error. If only
/// the number itself has another form of the equations, as a part without inertia has, one-sided
/// quotients are wrong by (25/12) / (1/4) of their difference.
struct Stencil {
  std::array<double, 5> offsets;  ///< in steps; those beyond `count` are unused
  std::array<double, 5> better;
  std::array<double, 5> simple;
  std::size_t count;
  double caution;
};
constexpr Stencil central{{-2.0, -1.0, 1.0, 2.0, 0.0},
                          {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0, 0.0},
                          {0.0, -0.5, 0.5, 0.0, 0.0},
                          4,
                          1.0};
constexpr Stencil one_sided{{0.0, 1.0, 2.0, 3.0, 4.0},
                            {-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -1.0 / 4.0},
                            {-11.0 / 6.0, 3.0, -1.5, 1.0 / 3.0, 0.0},
                            5,
                            25.0 / 3.0};

double first_step(const Parameter& parameter) {
  return parameter.value == 0.0 ? zero_steps.front() : relative_step * std::abs(parameter.value);
}

/// Whether a value is in the range of its key.
bool allows(const ScenarioAt& scenario_at, const Parameter& parameter, double value) {
  try {
    scenario_at(parameter, value);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

class Differences {
 public:
  Differences(const Scenario& scenario, const turbine::TurbineSystem& system,
              const analysis::Trim& trim, const ScenarioAt& scenario_at,
              ExponentDerivatives& derivatives)
      : options_(trim_options(scenario)),
        system_(system),
        trim_(trim),
        scenario_at_(scenario_at),
        derivatives_(derivatives) {
    options_.automatic = false;
    options_.harmonics = trim.solution.harmonics();
    options_.tolerance = std::min(options_.tolerance, trim_tolerance);
  }

  /// Of several parameters: each group of modes has its factors once.
  std::vector<Sensitivity> find(const std::vector<Parameter>& parameters) {
    std::vector<Quotients> all;
    for (const Parameter& parameter : parameters)
      if (parameter.value != 0.0) all.push_back(find_quotients(parameter, first_step(parameter)));
    std::vector<Sensitivity> found = differentiate(all);
    auto next = found.begin();
    std::vector<Sensitivity> result;
    for (const Parameter& parameter : parameters)
      result.push_back(parameter.value != 0.0 ? *next++ : find_at_zero(parameter));
    return result;
  }

 private:
  /// Difference quotients of the residuals: the better one, and another for the error.
  struct Quotients {
    std::optional<Residuals> better;
    std::optional<Residuals> simple;
    double caution = 1.0;  ///< of Stencil
  };

  /// With the step that has the smallest error.
  Sensitivity find_at_zero(const Parameter& parameter) {
    std::optional<Sensitivity> best;
    double least = std::numeric_limits<double>::infinity();
    for (const double step : zero_steps) {
      Sensitivity found;
      try {
        found = differentiate({find_quotients(parameter, step)}).front();
      } catch (const InputError&) {
        if (!best) throw;
        break;  // beyond the range of the key
      } catch (const ConvergenceError&) {
        if (!best) throw;
        break;
      }
      double error = 0.0;
      for (const double own : found.errors)
        if (std::isfinite(own)) error = std::max(error, own);
      if (best && error >= least) break;
      least = error;
      best = std::move(found);
    }
    return *best;
  }

  Quotients find_quotients(const Parameter& parameter, double step) {
    const bool has_smaller = allows(scenario_at_, parameter, parameter.value - 2.0 * step);
    if (has_smaller && allows(scenario_at_, parameter, parameter.value + 2.0 * step))
      return find_quotients(parameter, step, central);
    return find_quotients(parameter, has_smaller ? -step : step, one_sided);
  }

  Quotients find_quotients(const Parameter& parameter, double step, const Stencil& stencil) {
    std::vector<std::unique_ptr<turbine::TurbineSystem>> systems;
    std::vector<analysis::Trim> trims;
    bool by_sector = true;
    for (std::size_t i = 0; i < stencil.count; ++i) {
      const double value = parameter.value + stencil.offsets.at(i) * step;
      const Scenario scenario = scenario_at_(parameter, value);
      auto own = std::make_unique<turbine::TurbineSystem>(model::build_turbine(scenario.turbine),
                                                          PETSC_COMM_SELF);
      if (own->size() != system_.size())
        throw InputError("--sensitivity " + parameter.key +
                         ": another value has other unknowns; hint: a key that keeps the parts and "
                         "the elements");
      trims.push_back(solve_trim(scenario, *own, options_, silent_, PETSC_COMM_SELF, &trim_));
      if (auto held = hold_wake(*own)) own = std::move(held);
      by_sector = by_sector && own->symmetry().sectors == system_.symmetry().sectors;
      systems.push_back(std::move(own));
    }
    Quotients quotients;
    quotients.caution = stencil.caution;
    const auto add = [](std::optional<Residuals>& sum, double factor, const Residuals& residuals) {
      sum =
          sum ? combine(1.0, *sum, factor, residuals) : combine(factor, residuals, 0.0, residuals);
    };
    for (std::size_t i = 0; i < stencil.count; ++i) {
      Residuals residuals = derivatives_.residuals(*systems[i], trims[i].solution, by_sector);
      add(quotients.better, stencil.better.at(i) / step, residuals);
      Residuals plain = std::move(residuals);
      plain.of_half.clear();
      plain.before.clear();
      add(quotients.simple, stencil.simple.at(i) / step, plain);
    }
    return quotients;
  }

  std::vector<Sensitivity> differentiate(const std::vector<Quotients>& quotients) {
    std::vector<Residuals> rates;
    for (const Quotients& one : quotients) {
      rates.push_back(*one.better);
      rates.push_back(*one.simple);
    }
    const std::vector<ExponentDerivatives::Derivatives> found = derivatives_.derivatives(rates);
    std::vector<Sensitivity> result(quotients.size());
    for (std::size_t p = 0; p < result.size(); ++p) {
      const ExponentDerivatives::Derivatives& better = found[2 * p];
      const ExponentDerivatives::Derivatives& simple = found[2 * p + 1];
      for (Eigen::Index m = 0; m < better.values.size(); ++m) {
        result[p].rates.push_back(better.values(m));
        result[p].errors.push_back(quotients[p].caution *
                                       std::abs(better.values(m) - simple.values(m)) +
                                   better.errors(m));
      }
    }
    return result;
  }

  analysis::TrimOptions options_;
  const turbine::TurbineSystem& system_;
  const analysis::Trim& trim_;
  const ScenarioAt& scenario_at_;
  ExponentDerivatives& derivatives_;
  analysis::Observer silent_;
};

/// The exponents, harmonics and shapes of some modes of the first rank's set, on all ranks.
analysis::ModeSet share_modes(const analysis::ModeSet& set, const std::vector<std::size_t>& modes,
                              const analysis::Ranks& ranks) {
  analysis::ModeSet some;
  some.rotor_speed = set.rotor_speed;
  some.shape_times = set.shape_times;
  std::size_t count = modes.size();
  ranks.share(0, some.rotor_speed);
  ranks.share(0, some.shape_times);
  ranks.share(0, count);
  for (std::size_t i = 0; i < count; ++i) {
    analysis::Mode mode;
    Eigen::MatrixXcd shape;
    if (ranks.rank == 0) {
      mode.exponent = set.modes[modes[i]].exponent;
      mode.harmonic = set.modes[modes[i]].harmonic;
      shape = set.shapes[modes[i]];
    }
    ranks.share(0, mode.exponent);
    ranks.share(0, mode.harmonic);
    ranks.share(0, shape);
    some.modes.push_back(std::move(mode));
    some.shapes.push_back(std::move(shape));
  }
  return some;
}

}  // namespace

void require_range(const std::vector<Parameter>& parameters, const ScenarioAt& scenario_at) {
  for (const Parameter& parameter : parameters) {
    const double step = first_step(parameter);
    if (!allows(scenario_at, parameter, parameter.value - step))
      scenario_at(parameter, parameter.value + step);
  }
}

std::vector<Sensitivity> find_sensitivities(
    const Scenario& scenario, const turbine::TurbineSystem& system, const analysis::Trim& trim,
    const analysis::ModeSet& set, const std::vector<std::size_t>& modes,
    const std::vector<Parameter>& parameters, const ScenarioAt& scenario_at,
    analysis::Observer& observer, MPI_Comm comm) {
  const analysis::Ranks ranks(comm);
  const auto held = hold_wake(system);
  const turbine::TurbineSystem& linear = held ? *held : system;
  const analysis::ModeSet some = share_modes(set, modes, ranks);
  ExponentDerivatives derivatives(linear, trim.solution, some);
  Differences differences(scenario, linear, trim, scenario_at, derivatives);
  std::vector<Sensitivity> found(parameters.size());
  // Neighbours stay on one rank, which takes some of them at a time: their residuals need memory.
  const auto owner = [&](std::size_t i) {
    return static_cast<int>(i * static_cast<std::size_t>(ranks.size) / parameters.size());
  };
  ranks.attempt([&] {
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (owner(i) == ranks.rank) own.push_back(i);
    for (std::size_t from = 0; from < own.size(); from += parameters_at_once) {
      observer.progress("sensitivities", static_cast<long>(from), static_cast<long>(own.size()));
      std::vector<Parameter> next;
      for (std::size_t i = from; i < std::min(from + parameters_at_once, own.size()); ++i)
        next.push_back(parameters[own[i]]);
      std::vector<Sensitivity> results = differences.find(next);
      for (std::size_t i = 0; i < results.size(); ++i) found[own[from + i]] = std::move(results[i]);
    }
  });
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    ranks.share(owner(i), found[i].rates);
    ranks.share(owner(i), found[i].errors);
  }
  return found;
}

}  // namespace samara::simulation
