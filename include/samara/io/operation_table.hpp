// Tables of operating points: in a result, as comma-separated values, and in the form of HAWC2's
// .opt files; and the points as files while a run finds them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "samara/io/point_files.hpp"
#include "samara/io/result_file.hpp"
#include "samara/simulation/operation.hpp"

namespace samara::io {

/// Beginning of the table of comma-separated values.
inline constexpr std::string_view operation_table_start = "wind_speed,region,";

/// /operation: one list per quantity. `status`: complete, interrupted, or failed and why.
void write_operation(ResultFile& file, const std::vector<simulation::OperatingPoint>& points,
                     const std::string& status);

/// Operating points as files, each with the memory of the search behind it.
class OperationPointFiles : public PointFiles {
 public:
  using PointFiles::PointFiles;

  /// The last point of the memory. @throws InternalError if the file cannot be written
  void write(std::size_t point, const simulation::OperationMemory& memory) const;
  /// None as in has(). @throws InputError as has(), and if the file is damaged
  std::optional<simulation::OperationMemory> read(std::size_t point) const;
};

/// One line per point, with the names and units of /operation.
void write_operation_table(const std::string& path,
                           const std::vector<simulation::OperatingPoint>& points);

/// A line with the number of rows and the names of the columns, then wind speed [m/s], pitch [deg],
/// rotor speed [rpm], power of the air [kW] and thrust [kN].
void write_opt_file(const std::string& path, const std::vector<simulation::OperatingPoint>& points);

/// Reads the first three columns of such a file, with rising wind speeds.
/// @throws InputError with path and line
std::vector<simulation::ScheduledPoint> read_opt_file(const std::string& path);

/// @throws InputError if no .opt file can be written there, or there is a file that is not one
void require_opt_path(const std::string& path);

}  // namespace samara::io
