// samara operate: operating points over the wind speed.
#include <numbers>

#include "samara/base/error.hpp"
#include "samara/io/operation_table.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/operation.hpp"

#include "commands.hpp"
#include "progress.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

using simulation::OperatingPoint;

constexpr double to_degrees = 180.0 / std::numbers::pi;
constexpr double to_rpm = 30.0 / std::numbers::pi;
constexpr double to_kilo = 1e-3;

std::string point_table(const std::vector<OperatingPoint>& points) {
  Table table;
  table.add_column("wind", "m/s");
  table.add_column("region", "", Align::left);
  table.add_column("speed", "rpm");
  table.add_column("pitch", "deg");
  table.add_column("torque", "kN m");
  table.add_column("power", "kW");
  table.add_column("thrust", "kN");
  table.add_column("C_P", "");
  table.add_column("C_T", "");
  table.add_column("tip out", "m");
  table.add_column("tip in", "m");
  table.add_column("tip twist", "deg");
  table.add_column("tau_1", "s");
  for (const OperatingPoint& point : points)
    table.add_row({general(point.wind, 5), simulation::region_name(point.region),
                   fixed(point.speed * to_rpm, 3), fixed(point.pitch * to_degrees, 3),
                   general(point.torque * to_kilo, 5), general(point.power * to_kilo, 5),
                   general(point.thrust * to_kilo, 5), fixed(point.power_coefficient, 4),
                   fixed(point.thrust_coefficient, 4), fixed(point.tip_out_of_plane, 3),
                   fixed(point.tip_in_plane, 3), fixed(point.tip_twist * to_degrees, 3),
                   fixed(point.time_constant, 2)});
  return table.text() +
         "Means over a revolution. Torque: of the generator, behind the gear. Power and thrust: of "
         "the air on\nthe rotor. Tip: of blade 1, out of plane, in plane, and toward feather\n";
}

}  // namespace

void run_operate(const Job& job) {
  const model::OperatingPointsDefinition& setup = job.input.operation;
  if (!setup.opt_path.empty()) {
    io::require_opt_path(setup.opt_path);
    for (const std::string& path : {job.result_path, job.csv_path, setup.table_path})
      if (!path.empty() && io::is_same_file(setup.opt_path, path))
        throw InputError(job.input.path + ": operation.opt and " + path +
                         " are the same file; hint: give each its own");
  }
  const std::vector<simulation::ScheduledPoint> table =
      setup.table_path.empty() ? std::vector<simulation::ScheduledPoint>()
                               : io::read_opt_file(setup.table_path);
  const bool is_first = petsc::Session::rank() == 0;
  Progress progress(is_first);
  const std::vector<OperatingPoint> points = simulation::find_operation(job.input, table, progress);
  progress.finish();
  if (!is_first) return;
  std::string text = title_of(job.input) + "\n\n" + point_table(points);
  if (!setup.opt_path.empty()) {
    io::write_opt_file(setup.opt_path, points);
    text += "table for HAWC2: " + setup.opt_path + "\n";
  }
  deliver(
      job, text, [&](io::ResultFile& file) { io::write_operation(file, points); },
      [&](const std::string& path) { io::write_operation_table(path, points); });
}

}  // namespace samara::drivers
