// samara export: a time history in one file, also in formats that others read.
#include <iostream>

#include "samara/base/error.hpp"
#include "samara/io/file_lock.hpp"
#include "samara/io/history_export.hpp"
#include "samara/io/result_reader.hpp"

#include "commands.hpp"
#include "table.hpp"

namespace samara::drivers {

void run_export(const CommandLine& line) {
  const std::string& source = line.case_path;
  const std::string& path = line.result_path;
  io::find_history_format(path);
  if (io::find_result_kind(source) != io::ResultKind::history)
    throw InputError(source + ": has no time history; hint: samara transient makes one");
  const io::HistoryReader history(source);
  if (!history.damage().empty()) std::cerr << "note: " << history.damage() << "\n";
  io::require_export_path(path, source);
  const io::FileLock lock(path);
  io::export_history(source, history, path);
  std::cout << "history " << history.rows() << " rows of "
            << count(static_cast<int>(history.content().channels.size()), "channel");
  if (history.rows() > 0)
    std::cout << ", t = " << general(history.read_time(0, 1).at(0), 6) << " to "
              << general(history.read_time(history.rows() - 1, 1).at(0), 6) << " s";
  std::cout << "\nstatus  " << history.content().status << "\nexport: " << path << "\n";
}

}  // namespace samara::drivers
