// Damage-equivalent loads: the range of N_eq equal cycles that cause the damage of the counted
// ones, by Palmgren and Miner's sum with a straight S-N curve (docs/theory.md, section 8.4; G. J.
// Hayman, "MLife Theory Manual for Version 1.00", NREL, 2012).
#pragma once

#include <optional>
#include <vector>

#include "samara/loads/rainflow.hpp"

namespace samara::loads {

/// Straight Goodman lines from the ultimate load: brings cycles of all means to one mean.
struct GoodmanCorrection {
  double ultimate_load = 0.0;  ///< L_ult > 0, in the unit of the channel, equal in both directions
  double fixed_mean = 0.0;     ///< L_MF; only its absolute value counts
};

/// The same cycles with the ranges R (L_ult - |L_MF|)/(L_ult - |mean|) and the mean L_MF.
/// @throws InputError where a mean reaches the ultimate load.
std::vector<Cycle> correct_means(const std::vector<Cycle>& cycles,
                                 const GoodmanCorrection& correction);

struct DamageOptions {
  std::vector<double> exponents = {4.0, 10.0};  ///< m of Woehler's curve: steel, glass fibre
  double frequency = 1.0;                       ///< f_eq [Hz]: N_eq = f_eq T
  std::optional<GoodmanCorrection> goodman;     ///< none: means have no effect
};

/// (sum n R^m / (f_eq T))^(1/m) for each exponent, in the unit of the channel, of cycles counted in
/// `duration` = T [s]; 0 where there are no cycles.
/// @throws InputError where an option or the duration is out of range; as `correct_means`.
std::vector<double> compute_damage_equivalent_loads(const std::vector<Cycle>& cycles,
                                                    double duration, const DamageOptions& options);

/// A time series that stands for `hours` of the lifetime.
struct LoadCase {
  std::vector<Cycle> cycles;
  double duration = 0.0;  ///< [s] of the counted time series
  double hours = 0.0;     ///< [h] of the lifetime, >= 0
};

/// The same over all load cases, each repeated 3600 hours / duration times. N_eq is f_eq times the
/// time of all cases, or `equivalent_cycles` of the lifetime, e.g. 1e7.
/// @throws InputError where there is no case or no time; otherwise as for one time series.
std::vector<double> compute_lifetime_loads(const std::vector<LoadCase>& cases,
                                           const DamageOptions& options,
                                           std::optional<double> equivalent_cycles = {});

}  // namespace samara::loads
