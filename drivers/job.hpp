// Input of a command, and delivery of its results.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "samara/io/case.hpp"
#include "samara/io/file_lock.hpp"
#include "samara/io/result_file.hpp"

#include "sweep.hpp"

namespace samara::drivers {

struct Job {
  io::Case input;
  std::string command_line;            ///< as typed
  std::string result_path;             ///< empty: no result
  std::string csv_path;                ///< empty: no table
  std::shared_ptr<io::FileLock> lock;  ///< lock of the result; only on the first rank
  bool all_modes = false;              ///< also list modes that are not resolved
  bool air_part = false;               ///< also find the part of the air in the damping
  int first_modes = 0;                 ///< number of listed rows; 0: all
  std::string sensitivity;             ///< patterns of keys; empty: none
  std::string restart_path;            ///< empty: the run starts at its beginning
  Sweep sweep;                         ///< not given: the operating points of the case
  std::optional<int> bands;            ///< crossings that a sweep searches; none: not given
  /// Results that the command reads, if any; `input` is the case of the first.
  std::vector<std::string> sources;
  std::vector<std::string> settings;  ///< its own --set arguments, not keys of the case
};

/// The title of a case, or its path where it has none.
inline const std::string& title_of(const io::Case& input) {
  return input.turbine.title.empty() ? input.path : input.turbine.title;
}

/// Record of the run, for the attributes of the result.
io::RunRecord record_of(const Job& job);

/// Refuses to overwrite a file that the command reads. @throws InputError
void require_other_path(const std::string& path, const std::vector<std::string>& sources);

/// Writes the files and prints the tables. The tables are also printed if a file cannot be written,
/// because they may have taken long. Called only on the first rank.
void deliver(const Job& job, const std::string& tables,
             const std::function<void(io::ResultFile&)>& write_result,
             const std::function<void(const std::string&)>& write_csv);

}  // namespace samara::drivers
