#include "samara/io/operation_table.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::io {
namespace {

using simulation::OperatingPoint;
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

}  // namespace

void write_operation(ResultFile& file, const std::vector<OperatingPoint>& points) {
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
