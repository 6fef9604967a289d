// samara export: writes a time series as one file, also in formats of other programs.
#include <iostream>

#include "samara/base/error.hpp"
#include "samara/io/file_lock.hpp"
#include "samara/io/result_reader.hpp"
#include "samara/io/time_series_export.hpp"

#include "commands.hpp"
#include "table.hpp"

namespace samara::drivers {

void run_export(const CommandLine& line) {
  const std::string& source = line.case_path;
  const std::string& path = line.result_path;
  io::find_series_format(path);
  if (io::find_result_kind(source) != io::ResultKind::time_series)
    throw InputError(source + ": has no time series; hint: samara transient makes one");
  const io::TimeSeriesReader series(source);
  if (!series.damage().empty()) std::cerr << "note: " << series.damage() << "\n";
  io::require_export_path(path, source);
  const io::FileLock lock(path);
  io::export_series(source, series, path);
  std::cout << "time series " << series.rows() << " rows of "
            << count(static_cast<int>(series.content().channels.size()), "channel");
  if (series.rows() > 0)
    std::cout << ", t = " << general(series.read_time(0, 1).at(0), 6) << " to "
              << general(series.read_time(series.rows() - 1, 1).at(0), 6) << " s";
  std::cout << "\nstatus  " << series.content().status << "\nexport: " << path << "\n";
}

}  // namespace samara::drivers
