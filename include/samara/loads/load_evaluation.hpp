// All results of one time series of loads: statistics, extreme events, harmonics, rainflow counts
// and damage-equivalent loads (docs/theory.md, section 8).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "samara/loads/damage_equivalent_load.hpp"
#include "samara/loads/load_harmonics.hpp"
#include "samara/loads/load_series.hpp"
#include "samara/loads/load_statistics.hpp"
#include "samara/loads/rainflow.hpp"

namespace samara::loads {

struct LoadEvaluationOptions {
  std::vector<double> exponents = {4.0, 10.0};  ///< as DamageOptions
  double frequency = 1.0;                       ///< [Hz], as DamageOptions
  int harmonics = 4;
  bool harmonics_are_asked_for = false;  ///< otherwise they may be left out
  int range_bins = 10;
  int mean_bins = 10;
  /// By channel; empty: no correction of any channel.
  std::vector<std::optional<GoodmanCorrection>> goodman;

  DamageOptions damage_of(Eigen::Index channel) const;
};

/// Results by channel, unless stated otherwise.
struct LoadEvaluation {
  std::vector<ChannelStatistics> statistics;
  std::vector<ExtremeEvent> events;
  std::optional<LoadHarmonics> harmonics;
  std::string why_no_harmonics;             ///< empty where there are harmonics
  std::vector<std::vector<Cycle>> cycles;   ///< as counted, without Goodman's correction
  std::vector<RainflowTable> tables;        ///< of these cycles
  std::vector<std::vector<double>> damage;  ///< equivalent load [channel][exponent]
};

/// `azimuth_deg` [deg], one for each row, for the harmonics; empty: it is not known.
/// @throws InputError as the single evaluations, with the channel's name. A missing azimuth or
/// whole revolution is an error only where harmonics are requested.
LoadEvaluation evaluate_loads(const LoadSeries& series, const Eigen::VectorXd& azimuth_deg,
                              const LoadEvaluationOptions& options);

/// Equivalent loads [channel][exponent] of a lifetime of several time series with the same
/// channels, each for some `hours` [h]. As `compute_lifetime_loads`.
std::vector<std::vector<double>> evaluate_lifetime(const std::vector<LoadEvaluation>& evaluations,
                                                   const std::vector<double>& durations,
                                                   const std::vector<double>& hours,
                                                   const std::vector<std::string>& names,
                                                   const LoadEvaluationOptions& options,
                                                   std::optional<double> equivalent_cycles);

}  // namespace samara::loads
