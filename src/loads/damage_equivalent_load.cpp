#include "samara/loads/damage_equivalent_load.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "samara/base/error.hpp"

namespace samara::loads {
namespace {

constexpr double seconds_per_hour = 3600.0;

void require_positive(double value, const char* name) {
  if (std::isfinite(value) && value > 0.0) return;
  std::ostringstream text;
  text << name << " must be > 0, not " << value;
  throw InputError(text.str());
}

void check_options(const DamageOptions& options) {
  require_positive(options.frequency, "the frequency of the equivalent cycles");
  if (options.exponents.empty()) throw InputError("there is no Woehler exponent");
  for (const double exponent : options.exponents)
    if (!(std::isfinite(exponent) && exponent >= 1.0)) {
      std::ostringstream text;
      text << "a Woehler exponent must be >= 1, not " << exponent;
      throw InputError(text.str());
    }
}

/// Cycles whose counts are multiplied by `times`.
struct WeightedCycles {
  std::vector<Cycle> cycles;
  double times = 1.0;
};

/// (sum n R^m / N_eq)^(1/m); ranges are divided by the largest one, whose power may be too large
/// for a number.
double equivalent_load(const std::vector<WeightedCycles>& all, double exponent,
                       double equivalent_cycles) {
  double largest = 0.0;
  for (const WeightedCycles& part : all)
    for (const Cycle& cycle : part.cycles) largest = std::max(largest, cycle.range);
  if (!(largest > 0.0)) return 0.0;
  double sum = 0.0;
  for (const WeightedCycles& part : all)
    for (const Cycle& cycle : part.cycles)
      sum += part.times * cycle.count * std::pow(cycle.range / largest, exponent);
  return largest * std::pow(sum / equivalent_cycles, 1.0 / exponent);
}

std::vector<double> equivalent_loads(const std::vector<WeightedCycles>& all,
                                     const DamageOptions& options, double equivalent_cycles) {
  std::vector<double> loads;
  for (const double exponent : options.exponents)
    loads.push_back(equivalent_load(all, exponent, equivalent_cycles));
  return loads;
}

std::vector<Cycle> corrected(const std::vector<Cycle>& cycles, const DamageOptions& options) {
  return options.goodman ? correct_means(cycles, *options.goodman) : cycles;
}

}  // namespace

std::vector<Cycle> correct_means(const std::vector<Cycle>& cycles,
                                 const GoodmanCorrection& correction) {
  const double ultimate = correction.ultimate_load;
  require_positive(ultimate, "the ultimate load");
  const auto margin_at = [&](double mean) {
    const double margin = ultimate - std::abs(mean);
    if (margin > 0.0) return margin;
    std::ostringstream text;
    text << "a mean of " << mean << " reaches the ultimate load of " << ultimate
         << ", Goodman's correction has no meaning there";
    throw InputError(text.str());
  };
  const double fixed_margin = margin_at(correction.fixed_mean);
  std::vector<Cycle> result = cycles;
  for (Cycle& cycle : result) {
    cycle.range *= fixed_margin / margin_at(cycle.mean);
    cycle.mean = correction.fixed_mean;
  }
  return result;
}

std::vector<double> compute_damage_equivalent_loads(const std::vector<Cycle>& cycles,
                                                    double duration, const DamageOptions& options) {
  check_options(options);
  require_positive(duration, "the duration of a time series");
  return equivalent_loads({{corrected(cycles, options), 1.0}}, options,
                          options.frequency * duration);
}

std::vector<double> compute_lifetime_loads(const std::vector<LoadCase>& cases,
                                           const DamageOptions& options,
                                           std::optional<double> equivalent_cycles) {
  check_options(options);
  std::vector<WeightedCycles> all;
  double lifetime = 0.0;
  for (const LoadCase& one : cases) {
    require_positive(one.duration, "the duration of a time series");
    if (!(std::isfinite(one.hours) && one.hours >= 0.0))
      throw InputError("the hours of a time series must be >= 0, not " + std::to_string(one.hours));
    const double seconds = seconds_per_hour * one.hours;
    if (seconds == 0.0) continue;
    lifetime += seconds;
    all.push_back({corrected(one.cycles, options), seconds / one.duration});
  }
  require_positive(lifetime, "the time of all time series");
  const double number = equivalent_cycles.value_or(options.frequency * lifetime);
  require_positive(number, "the number of equivalent cycles");
  return equivalent_loads(all, options, number);
}

}  // namespace samara::loads
