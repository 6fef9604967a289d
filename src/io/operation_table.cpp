#include "samara/io/operation_table.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"

#include "hdf5_file.hpp"
#include "hdf5_reader.hpp"

namespace samara::io {
namespace {

using simulation::OperatingPoint;
using simulation::OperationMemory;
using simulation::ScheduledPoint;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double rpm = std::numbers::pi / 30.0;
constexpr double kilo = 1e3;
constexpr std::size_t most_megabytes = 16;

struct Quantity {
  const char* name;
  const char* unit;
  const char* description;
  double OperatingPoint::*value;
};

constexpr std::array<Quantity, 15> quantities{
    {{"rotor_speed", "rad/s", "mean speed of the rotor", &OperatingPoint::speed},
     {"pitch", "rad", "pitch of the blades, toward feather", &OperatingPoint::pitch},
     {"generator_torque", "N m", "torque of the generator against its turning, behind the gear",
      &OperatingPoint::torque},
     {"power", "W", "power of the air on the rotor", &OperatingPoint::power},
     {"thrust", "N", "force of the air on the rotor along the shaft", &OperatingPoint::thrust},
     {"power_coefficient", "1", "with the wind speed and the area of the undeformed rotor",
      &OperatingPoint::power_coefficient},
     {"thrust_coefficient", "1", "with the wind speed and the area of the undeformed rotor",
      &OperatingPoint::thrust_coefficient},
     {"tip_speed_ratio", "1", "with the wind speed and the radius of the undeformed rotor",
      &OperatingPoint::tip_speed_ratio},
     {"tip_out_of_plane", "m", "deflection of the tip of blade 1 out of plane",
      &OperatingPoint::tip_out_of_plane},
     {"tip_in_plane", "m", "deflection of the tip of blade 1 in plane",
      &OperatingPoint::tip_in_plane},
     {"tip_twist", "rad", "rotation of the tip of blade 1 toward feather",
      &OperatingPoint::tip_twist},
     {"root_flap_moment", "N m", "moment at the root of blade 1, out of plane",
      &OperatingPoint::root_flap_moment},
     {"tower_moment", "N m", "fore-aft moment at the base of the tower",
      &OperatingPoint::tower_moment},
     {"inflow_time_constant", "s", "first time constant of the dynamic inflow",
      &OperatingPoint::time_constant},
     {"imbalance", "1", "residual of the steady state relative to the largest load",
      &OperatingPoint::imbalance}}};

[[noreturn]] void fail(const std::string& path, int line, const std::string& text) {
  throw InputError(path + ":" + std::to_string(line) + ": " + text);
}

/// The numbers of a line, up to the first word that is none.
std::vector<double> numbers_of(const std::string& line) {
  std::istringstream words(line);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (*end != '\0' || !std::isfinite(number)) break;
    numbers.push_back(number);
  }
  return numbers;
}

/// Datasets of a point; their format is internal.
constexpr char point_name[] = "/point/values";
constexpr char search_name[] = "/point/search";
constexpr char pitched_name[] = "/point/pitched";

/// Wind and region stand before the quantities.
constexpr std::size_t values_before = 2;
constexpr std::size_t search_values = 3;
constexpr std::size_t pitched_values = 3;
constexpr std::size_t solved_values = 3;

struct NamedState {
  const char* name;
  std::optional<simulation::Solved> simulation::StartPredictor::*state;
};
constexpr std::array<NamedState, 3> states{{{"last", &simulation::StartPredictor::last},
                                            {"point", &simulation::StartPredictor::point},
                                            {"before", &simulation::StartPredictor::before}}};

struct NamedSlope {
  const char* name;
  simulation::StartSlope simulation::StartPredictor::*slope;
};
constexpr std::array<NamedSlope, 2> slopes{
    {{"speed_slope", &simulation::StartPredictor::speed_slope},
     {"pitch_slope", &simulation::StartPredictor::pitch_slope}}};

Meaning internal(const std::vector<std::string>& axes) { return {"1", "none", "internal", axes}; }

/// Numbers, and a matrix where it has entries.
void write_part(Hdf5File& file, const std::string& name, const std::vector<double>& numbers,
                const Eigen::MatrixXd& matrix) {
  const std::string group = "/point/" + name;
  file.write(group + "/numbers", numbers, {numbers.size()}, internal({name + "_number"}));
  if (matrix.size() == 0) return;
  const auto size = static_cast<std::size_t>(matrix.size());
  file.write(group + "/matrix", {matrix.data(), size},
             {static_cast<hsize_t>(matrix.cols()), static_cast<hsize_t>(matrix.rows())},
             internal({name + "_column", name + "_row"}));
}

Eigen::MatrixXd read_matrix(const Hdf5Reader& file, const std::string& name) {
  const std::string whole = "/point/" + name + "/matrix";
  if (!file.has(whole)) return {};
  hsize_t columns = 0;
  hsize_t rows = 0;
  const std::vector<double> values = file.table(whole, columns, rows);
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), static_cast<Eigen::Index>(rows),
                                           static_cast<Eigen::Index>(columns));
}

}  // namespace

void OperationPointFiles::write(std::size_t point, const OperationMemory& memory) const {
  Hdf5File file;
  std::vector<double> values{memory.point->wind, static_cast<double>(memory.point->region)};
  for (const Quantity& quantity : quantities) values.push_back(*memory.point.*quantity.value);
  file.write(point_name, values, {values.size()}, internal({"value"}));
  const std::array<double, search_values> search{memory.speed_slope, memory.tip_radius,
                                                 memory.density};
  file.write(search_name, search, {search.size()}, internal({"search_value"}));
  std::vector<double> pitched;
  for (const simulation::PitchedPoint& one : memory.pitched)
    pitched.insert(pitched.end(), {one.wind, one.pitch, one.slope});
  if (!pitched.empty())
    file.write(pitched_name, pitched, {memory.pitched.size(), pitched_values},
               internal({"pitched_point", "pitched_value"}));
  for (const auto& [name, state] : states)
    if (const auto& solved = memory.starts.*state)
      write_part(file, name, {solved->wind, solved->speed, solved->pitch}, solved->coefficients);
  for (const auto& [name, slope] : slopes)
    write_part(file, name, {(memory.starts.*slope).length}, (memory.starts.*slope).value);
  save(point, file);
}

std::optional<OperationMemory> OperationPointFiles::read(std::size_t point) const {
  const std::unique_ptr<Hdf5Reader> file = open(point);
  if (!file) return std::nullopt;
  const auto numbers = [&](const std::string& name, std::size_t size) {
    std::vector<double> values = file->numbers(name);
    if (values.size() != size) refuse(point);
    return values;
  };
  OperationMemory memory;
  const std::vector<double> values = numbers(point_name, values_before + quantities.size());
  OperatingPoint& found = memory.point.emplace();
  found.wind = values[0];
  found.region = static_cast<simulation::OperatingRegion>(static_cast<int>(values[1]));
  for (std::size_t i = 0; i < quantities.size(); ++i)
    found.*quantities.at(i).value = values[values_before + i];
  const std::vector<double> search = numbers(search_name, search_values);
  memory.speed_slope = search[0];
  memory.tip_radius = search[1];
  memory.density = search[2];
  if (file->has(pitched_name)) {
    hsize_t count = 0;
    hsize_t width = 0;
    const std::vector<double> rows = file->table(pitched_name, count, width);
    if (width != pitched_values) refuse(point);
    for (std::size_t i = 0; i < rows.size(); i += pitched_values)
      memory.pitched.push_back({rows[i], rows[i + 1], rows[i + 2]});
  }
  for (const auto& [name, state] : states) {
    const std::string place = std::string("/point/") + name + "/numbers";
    if (!file->has(place)) continue;
    const std::vector<double> own = numbers(place, solved_values);
    memory.starts.*state = {own[0], own[1], own[2], read_matrix(*file, name)};
  }
  for (const auto& [name, slope] : slopes)
    memory.starts.*slope = {read_matrix(*file, name),
                            numbers(std::string("/point/") + name + "/numbers", 1).front()};
  return memory;
}

void write_operation(ResultFile& file, const std::vector<OperatingPoint>& points,
                     const std::string& status) {
  const auto values_of = [&points](double OperatingPoint::*value) {
    std::vector<double> values;
    for (const OperatingPoint& point : points) values.push_back(point.*value);
    return values;
  };
  file.write_values("operation/wind_speed", values_of(&OperatingPoint::wind),
                    {"m/s", "", "speed of the wind at its reference height", {"wind_speed"}});
  std::vector<std::string> regions;
  for (const OperatingPoint& point : points)
    regions.push_back(simulation::region_name(point.region));
  file.write_texts("operation/region", regions,
                   {"1", "", "rule that the point follows", {"wind_speed"}});
  for (const Quantity& quantity : quantities)
    file.write_values(std::string("operation/") + quantity.name, values_of(quantity.value),
                      {quantity.unit, "", quantity.description, {"wind_speed"}});
  file.set_attribute("/operation", "status", status);
}

void write_operation_table(const std::string& path, const std::vector<OperatingPoint>& points) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(std::numeric_limits<double>::max_digits10) << operation_table_start;
  for (std::size_t i = 0; i < quantities.size(); ++i)
    text << (i > 0 ? "," : "") << quantities[i].name;
  text << '\n';
  for (const OperatingPoint& point : points) {
    text << point.wind << ',' << simulation::region_name(point.region);
    for (const Quantity& quantity : quantities) text << ',' << point.*quantity.value;
    text << '\n';
  }
  write_whole_file(path, text.str());
}

void write_opt_file(const std::string& path, const std::vector<OperatingPoint>& points) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setw(4) << points.size()
       << "  wind speed [m/s]  pitch [deg]  rot. speed [rpm]  aero power [kW]  aero thrust [kN]\n"
       << std::fixed;
  for (const OperatingPoint& point : points)
    text << std::setprecision(6) << std::setw(14) << point.wind << std::setw(14)
         << point.pitch / degree << std::setw(14) << point.speed / rpm << std::setprecision(3)
         << std::setw(16) << point.power / kilo << std::setw(14) << point.thrust / kilo << '\n';
  write_whole_file(path, text.str());
}

std::vector<ScheduledPoint> read_opt_file(const std::string& path) {
  std::istringstream text(read_whole_file(path, most_megabytes, "table of operating points"));
  std::string line;
  std::getline(text, line);
  const std::vector<double> head = numbers_of(line);
  constexpr double most_rows = 1e6;
  if (head.empty() || head.front() != std::floor(head.front()) || !(head.front() >= 1.0) ||
      head.front() > most_rows)
    fail(path, 1, "expected the number of rows, got \"" + line.substr(0, 40) + "\"");
  const auto count = static_cast<int>(head.front());
  std::vector<ScheduledPoint> rows;
  for (int i = 0; i < count; ++i) {
    if (!std::getline(text, line))
      fail(path, i + 2,
           "the file ends after " + std::to_string(i) + " of " + std::to_string(count) + " rows");
    const std::vector<double> values = numbers_of(line);
    if (values.size() < 3)
      fail(path, i + 2, "expected wind speed [m/s], pitch [deg] and rotor speed [rpm]");
    const ScheduledPoint row{values[0], values[2] * rpm, values[1] * degree};
    if (!(row.wind > 0.0)) fail(path, i + 2, "the wind speed must be > 0");
    if (!rows.empty() && !(row.wind > rows.back().wind))
      fail(path, i + 2, "the wind speed must be higher than that of the row before");
    if (!(row.speed > 0.0)) fail(path, i + 2, "the rotor speed must be > 0");
    if (!(std::abs(values[1]) <= 180.0)) fail(path, i + 2, "the pitch must be an angle in degrees");
    rows.push_back(row);
  }
  return rows;
}

void require_opt_path(const std::string& path) {
  if (!require_writable(path)) return;
  try {
    read_opt_file(path);
  } catch (const InputError&) {
    throw InputError(path + ": exists and is no table of operating points; hint: another name");
  }
}

}  // namespace samara::io
