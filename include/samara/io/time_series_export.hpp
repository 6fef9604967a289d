// Writes a time series as one file, also in formats of other programs.
#pragma once

#include <string>
#include <string_view>

#include "samara/io/time_series_file.hpp"

namespace samara::io {

/// Format of the file, chosen by its ending.
enum class TimeSeriesFormat {
  result,           ///< .h5: the whole result, without segments
  table,            ///< .csv: all digits, a header `time [s],name [unit],...`
  openfast_text,    ///< .out of OpenFAST, with all digits
  openfast_binary,  ///< .outb of OpenFAST: its kind 4, 16 bits per value, without times
};

/// Start of the first line of a .csv.
inline constexpr std::string_view series_table_start = "time [s],";

/// @throws InputError for another ending
TimeSeriesFormat find_series_format(const std::string& path);

/// @throws InputError if `path` cannot be written, has a file that samara did not write, or is the
/// result `source` itself
void require_export_path(const std::string& path, const std::string& source);

/// Writes the time series of the result `source` to `path`, completely or not at all. The memory
/// holds a slice of the rows; for a .h5 it holds all rows twice.
/// @throws InputError if the format cannot hold the time series, or `path` cannot be written
void export_series(const std::string& source, const TimeSeriesReader& series,
                   const std::string& path);

}  // namespace samara::io
