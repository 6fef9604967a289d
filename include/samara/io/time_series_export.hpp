// Time series in one file, of this program or in formats that others read.
#pragma once

#include <string>
#include <string_view>

#include "samara/io/time_series_file.hpp"

namespace samara::io {

/// By the ending of the file.
enum class TimeSeriesFormat {
  result,           ///< .h5: the whole result, without segments
  table,            ///< .csv: all digits, a header `time [s],name [unit],...`
  openfast_text,    ///< .out of OpenFAST, with all digits
  openfast_binary,  ///< .outb of OpenFAST, in double precision: its kind 3, without times
};

/// The first line of a .csv begins so.
inline constexpr std::string_view series_table_start = "time [s],";

/// @throws InputError for another ending
TimeSeriesFormat find_series_format(const std::string& path);

/// @throws InputError where nothing can be written at `path`, something is there that is not ours,
/// or it is the result `source` itself
void require_export_path(const std::string& path, const std::string& source);

/// Writes the time series of the result `source` to `path`, which is there as a whole or not at
/// all. Memory is for a slice of the rows; for a .h5 twice all of them.
/// @throws InputError where a segment is missing, or the format cannot hold the time series
void export_series(const std::string& source, const TimeSeriesReader& series,
                   const std::string& path);

}  // namespace samara::io
