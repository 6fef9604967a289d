// samara operate: operating points over the wind speed.
#include <exception>
#include <numbers>
#include <optional>

#include "samara/analysis/ranks.hpp"
#include "samara/base/error.hpp"
#include "samara/base/words.hpp"
#include "samara/io/operation_table.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/petsc/session.hpp"
#include "samara/simulation/operation.hpp"

#include "commands.hpp"
#include "interruption.hpp"
#include "point_origin.hpp"
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

/// Each point depends on those before it.
std::vector<std::string> origins_of(const Job& job,
                                    const std::vector<simulation::ScheduledPoint>& table,
                                    const std::vector<double>& winds) {
  std::vector<std::string> origins;
  std::string value = "operation " + row_words(table);
  for (const double wind : winds)
    origins.push_back(point_origin(job.input.text, value += exact_words({wind})));
  return origins;
}

/// The points so far: those that an earlier run has left in files, and those that this one finds.
class Points {
 public:
  Points(const Job& job, const std::vector<simulation::ScheduledPoint>& table,
         const std::vector<double>& winds)
      : winds_(winds),
        files_(job.result_path, origins_of(job, table, winds)),
        finder_(job.input, table) {}

  void recall() {
    std::optional<simulation::OperationMemory> last;
    while (found.size() < winds_.size()) {
      std::optional<simulation::OperationMemory> memory = files_.read(found.size());
      if (!memory) break;
      found.push_back(*memory->point);
      last = std::move(memory);
    }
    if (last) finder_.recall(*last);
  }

  void find_next(analysis::Observer& observer) {
    observer.progress("operation", static_cast<long>(found.size()),
                      static_cast<long>(winds_.size()));
    const OperatingPoint point = finder_.find_at(winds_[found.size()], observer);
    files_.write(found.size(), finder_.memory());
    found.push_back(point);
  }

  void remove_files() const { files_.remove(); }

  std::vector<OperatingPoint> found;

 private:
  const std::vector<double>& winds_;
  io::OperationPointFiles files_;
  simulation::OperatingPointFinder finder_;
};

void deliver_points(const Job& job, const std::vector<OperatingPoint>& points,
                    const std::string& status) {
  std::string text = title_of(job.input) + "\n\n" + point_table(points);
  if (const std::string& path = job.input.operation.opt_path; !path.empty()) {
    io::write_opt_file(path, points);
    text += "table for HAWC2: " + path + "\n";
  }
  deliver(
      job, text, [&](io::ResultFile& file) { io::write_operation(file, points, status); },
      [&](const std::string& path) { io::write_operation_table(path, points); });
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
  const std::vector<double> winds = simulation::operating_winds(job.input, table);
  const bool is_first = petsc::Session::rank() == 0;
  Progress progress(is_first);
  const Interruption interruption("samara: ends after the present point; again to end at once\n");
  const analysis::Ranks ranks(PETSC_COMM_WORLD);
  // The first rank works. A signal may come to any of them.
  std::optional<Points> points;
  std::size_t count = 0;
  std::string status;
  std::exception_ptr failure;
  try {
    ranks.attempt([&] {
      if (!is_first) return;
      points.emplace(job, table, winds);
      points->recall();
      count = points->found.size();
    });
    ranks.share(0, count);
    while (count < winds.size() && ranks.all(!Interruption::is_asked())) {
      ranks.attempt([&] {
        if (is_first) points->find_next(progress);
      });
      ++count;
    }
    status = count == winds.size() ? "complete" : "interrupted";
  } catch (const std::exception& error) {
    failure = std::current_exception();
    status = std::string("failed: ") + error.what();
  }
  progress.finish();
  if (is_first && count > 0) deliver_points(job, points->found, status);
  if (failure) std::rethrow_exception(failure);
  if (count < winds.size())
    throw Interrupted("interrupted after " + std::to_string(count) + " of " +
                      samara::count(static_cast<int>(winds.size()), "point") +
                      "; hint: the same command goes on from here");
  if (is_first) points->remove_files();
}

}  // namespace samara::drivers
