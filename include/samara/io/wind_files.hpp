// Files of winds that change with time: boxes of turbulence of TurbSim (.bts) and of HAWC2, and
// tables of a uniform wind of InflowWind.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "samara/model/air_definition.hpp"
#include "samara/model/changing_wind.hpp"

namespace samara::io {

/// Reads a file of TurbSim: whole velocities.
/// @throws InputError with the path
model::WindBox read_turbsim_box(const std::string& path);

/// Reads three files of raw 32-bit numbers, u, v, w, in the order of HAWC2: along the wind slowest
/// and against it, then across from left to right, up fastest. Fluctuations. `shape`: times, rows,
/// columns and all lengths of the box; `scale`: factors of u, v, w.
/// @throws InputError with the path
model::WindBox read_hawc_box(const std::array<std::string, 3>& paths, const model::WindBox& shape,
                             const std::array<double, 3>& scale);

/// A row of a table of InflowWind.
struct UniformWindRow {
  double time = 0.0;        ///< [s]
  double speed = 0.0;       ///< [m/s]
  double direction = 0.0;   ///< clockwise seen from above [deg]
  double vertical = 0.0;    ///< vertical speed [m/s]
  double shear_left = 0.0;  ///< parts of the speed across the reference length
  double exponent = 0.0;    ///< of the power law
  double shear_up = 0.0;    ///< as shear_left
  double gust = 0.0;        ///< added to the speed [m/s]
  double upflow = 0.0;      ///< [deg]

  bool operator==(const UniformWindRow&) const = default;
};

/// Lines of the time and seven or eight numbers, rising in time; text starts with an exclamation
/// mark.
/// @throws InputError with path and line
std::vector<UniformWindRow> read_uniform_wind(const std::string& path);

/// Reads the files that a change of the wind names: the table sets curves that are not given (of
/// shears, where they or those of the mean wind are not zero), the box is filled. Paths count from
/// `folder`.
/// @throws InputError with the path
void read_wind_files(model::WindChange& change, const std::filesystem::path& folder,
                     const model::WindDefinition& mean);

}  // namespace samara::io
