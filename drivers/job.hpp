// Input of a command, and delivery of its results.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "samara/io/case.hpp"
#include "samara/io/file_lock.hpp"
#include "samara/io/result_file.hpp"

namespace samara::drivers {

struct Job {
  io::Case input;
  std::string command_line;            ///< as typed
  std::string result_path;             ///< empty: no result is wanted
  std::string csv_path;                ///< empty: no table is wanted
  std::shared_ptr<io::FileLock> lock;  ///< on the result; only the first rank has it
  bool all_modes = false;              ///< also those that are not resolved are listed
  int first_modes = 0;                 ///< so many rows are listed; 0: all
  std::string restart_path;            ///< empty: the run starts at its beginning
  /// Results that the command reads, if any; `input` is the case of the first.
  std::vector<std::string> sources;
  std::vector<std::string> settings;  ///< its own --set arguments, which are no keys of the case
};

/// How the result came about, for its attributes.
io::RunRecord record_of(const Job& job);

/// Refuses to overwrite a file that the command reads. @throws InputError
void require_other_path(const std::string& path, const std::vector<std::string>& sources);

/// Writes the files and prints the tables; the tables also where a file cannot be written, for they
/// may have taken long. The first rank alone calls it.
void deliver(const Job& job, const std::string& tables,
             const std::function<void(io::ResultFile&)>& write_result,
             const std::function<void(const std::string&)>& write_csv);

}  // namespace samara::drivers
