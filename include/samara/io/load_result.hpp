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
  std::optional<double> from;         ///< first time of a time series [s]; none: its first row
  std::optional<double> until;        ///< last time [s]; none: its last row
  int azimuths = 720;                 ///< instants per revolution of a steady state
  std::vector<double> hours;          ///< hours per result in the lifetime; empty: no lifetime
  std::optional<double> equivalent_cycles;  ///< cycles of the lifetime; none: frequency times hours
  std::map<std::string, loads::GoodmanCorrection> goodman;  ///< by channel
  loads::LoadEvaluationOptions evaluation;  ///< except `goodman`, given by name above
};

/// Declares the keys of `samara loads --set`.
void declare(fields::Visitor& fields, LoadOptions& options);

/// Reads `key=value` pairs. @throws InputError with all errors, one per line
LoadOptions read_load_options(const std::vector<std::string>& settings);

/// Evaluation of one result.
struct LoadReport {
  std::string source;  ///< path of the result
  std::vector<turbine::Channel> channels;
  loads::LoadSeries series;
  loads::LoadEvaluation evaluation;
};

/// Equivalent loads of all results together.
struct LifetimeReport {
  std::vector<double> hours;
  std::vector<std::vector<double>> damage;  ///< [channel][exponent]; empty: no lifetime
};

/// Writes /loads; for several results /loads/1, /loads/2 ..., and /loads/lifetime if there is a
/// lifetime.
void write_loads(ResultFile& file, const std::vector<LoadReport>& reports,
                 const LifetimeReport& lifetime, const LoadOptions& options);

/// Start of the first line of the table.
inline constexpr std::string_view load_table_start = "result,channel,unit,mean,";

/// Writes one line per result and channel: statistics and equivalent loads, with all digits. Lines
/// with the result `lifetime` have the equivalent loads of the lifetime.
void write_load_table(const std::string& path, const std::vector<LoadReport>& reports,
                      const LifetimeReport& lifetime, const LoadOptions& options);

}  // namespace samara::io
