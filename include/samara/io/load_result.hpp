// Options of the evaluation of loads, and its results (docs/case_file.md, "Loads of a result").
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "samara/fields/visitor.hpp"
#include "samara/io/result_file.hpp"
#include "samara/loads/load_evaluation.hpp"
#include "samara/turbine/turbine_channels.hpp"

namespace samara::io {

/// The keys of `samara loads`.
struct LoadOptions {
  std::vector<std::string> channels;  ///< empty: all
  std::optional<double> from;         ///< [s] of a time series; none: its first row
  std::optional<double> until;        ///< [s]
  int azimuths = 720;                 ///< of a steady state, a revolution
  std::vector<double> hours;          ///< [h] of the lifetime, one a result; empty: no lifetime
  std::optional<double> equivalent_cycles;  ///< of the lifetime; none: by frequency and hours
  std::map<std::string, loads::GoodmanCorrection> goodman;  ///< by channel
  loads::LoadEvaluationOptions evaluation;  ///< without `goodman`, which is by name here
};

/// The keys of --set of `samara loads`.
void declare(fields::Visitor& fields, LoadOptions& options);

/// Reads `key=value` pairs. @throws InputError with every error found, one a line
LoadOptions read_load_options(const std::vector<std::string>& settings);

/// One result that was evaluated.
struct LoadReport {
  std::string source;  ///< path of the result
  std::vector<turbine::Channel> channels;
  loads::LoadSeries series;
  loads::LoadEvaluation evaluation;
};

/// Equivalent loads of all results together.
struct LifetimeReport {
  std::vector<double> hours;
  std::vector<std::vector<double>> damage;  ///< [channel][exponent]; empty: none was asked for
};

/// Writes /loads; of several results /loads/1, /loads/2 ..., and /loads/lifetime where there is
/// one.
void write_loads(ResultFile& file, const std::vector<LoadReport>& reports,
                 const LifetimeReport& lifetime, const LoadOptions& options);

/// The first line of the table begins so.
inline constexpr std::string_view load_table_start = "result,channel,unit,mean,";

/// One line a result and channel: statistics and equivalent loads, all digits; those of a lifetime
/// in lines whose result is `lifetime`.
void write_load_table(const std::string& path, const std::vector<LoadReport>& reports,
                      const LifetimeReport& lifetime, const LoadOptions& options);

}  // namespace samara::io
