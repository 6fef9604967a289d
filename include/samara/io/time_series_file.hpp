// Time series on disk while they grow.
//
// Rows are gathered and every few seconds closed away as a segment, a complete HDF5 file of its own
// in the folder RESULT.h5.parts beside RESULT.h5. The result is then written anew: it names the
// segments and shows them as one (virtual) dataset, so that at any moment, whatever happens to the
// run, it is a complete file of all rows but the last seconds'. A run that is over before the first
// segment is due leaves one file.
//
// Segments and results are on the disk (fsync) before anything names them. Only
// segments of runs that the result named before are removed from the folder.
//
// Serial: one rank writes, and holds a FileLock on the result.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "samara/analysis/transient.hpp"
#include "samara/io/result_file.hpp"
#include "samara/turbine/turbine_channels.hpp"

namespace samara::io {

/// Rows that are in a file of their own.
struct TimeSeriesSegment {
  std::string file;  ///< relative to the folder of the result
  std::size_t rows = 0;
};

/// A result that has lost its last rows can still go on from the one before.
inline constexpr std::size_t kept_checkpoints = 2;

/// From where a time series can go on.
struct TimeSeriesCheckpoint {
  analysis::TransientStart point;
  std::size_t rows = 0;        ///< of the time series up to it
  std::vector<double> events;  ///< when each event came [s]; not-a-number: not yet
};

/// Description of a time series in a result.
struct TimeSeriesContent {
  std::vector<turbine::Channel> channels;
  std::vector<TimeSeriesSegment> segments;
  std::vector<double> time;    ///< of rows that are in no segment; empty where there are segments
  std::vector<double> values;  ///< row by row
  std::string model;           ///< Case::model_text
  std::optional<double> azimuth;   ///< of blade 1 at t = 0 [rad]; none: that of the case
  double brake_torque = 0.0;       ///< that acts from the start [N m]
  bool is_generator_lost = false;  ///< from the start
  std::vector<TimeSeriesCheckpoint> checkpoints;  ///< the last ones, `kept_checkpoints` at the most
  std::string status;  ///< "running", "complete", "interrupted", "failed: ..."
};

class TimeSeriesFile {
 public:
  /// `content`: channels, and how the drive train is at the start; `write_rest` adds to each
  /// version of the result what else belongs in it.
  TimeSeriesFile(const std::string& path, const Case& input, RunRecord record,
                 TimeSeriesContent content, std::function<void(ResultFile&)> write_rest);
  ~TimeSeriesFile();
  TimeSeriesFile(const TimeSeriesFile&) = delete;
  TimeSeriesFile& operator=(const TimeSeriesFile&) = delete;

  /// Goes on with the time series that is in the result already, up to its checkpoint.
  void resume();

  void append(double t, std::span<const double> values);

  /// All rows so far and the point to go on from are on the disk when it returns.
  void write_checkpoint(const analysis::TransientStart& point);

  /// When the events came, for the checkpoints from now on.
  void note_events(const std::vector<double>& times) { events_ = times; }

  /// Writes what is left. `end`: from which the time series can go on, where there is such a point.
  void finish(const std::string& status, const analysis::TransientStart* end);

  /// The same after a failure, which may be that nothing can be written any more: first the status,
  /// in room that was kept for it, then the rows. Returns whether all is written.
  bool finish_failed(const std::string& status) noexcept;

 private:
  void add_checkpoint(const analysis::TransientStart& point);
  void note_replaced();
  void keep_room();
  void give_room() noexcept;
  void close_segment();
  void publish();
  void remove_replaced();
  std::string folder_name() const;
  std::filesystem::path folder() const;

  std::string path_;
  const Case& input_;
  RunRecord record_;
  std::function<void(ResultFile&)> write_rest_;
  TimeSeriesContent content_;
  std::size_t rows_ = 0;
  std::vector<double> events_;
  std::string run_;  ///< starts the names of the segments of this run
  std::set<std::string>
      replaced_;  ///< the same of runs whose result this one has taken the place of
  int next_segment_ = 1;
  std::chrono::steady_clock::time_point due_;
  std::int64_t room_ = 0;  ///< bytes that are kept on the disk for the end
};

/// Reads the time series of a result: where a segment is missing or damaged, up to that one, and
/// with the checkpoints that its rows reach.
class TimeSeriesReader {
 public:
  /// @throws InputError where there is none
  explicit TimeSeriesReader(const std::string& path);
  ~TimeSeriesReader();
  TimeSeriesReader(const TimeSeriesReader&) = delete;
  TimeSeriesReader& operator=(const TimeSeriesReader&) = delete;

  const TimeSeriesContent& content() const { return content_; }
  std::size_t rows() const { return rows_; }
  /// Missing parts, in words for a note; empty where the time series is complete.
  const std::string& damage() const { return damage_; }
  /// Rows first to first + count of the times, and of the values row by row.
  std::vector<double> read_time(std::size_t first, std::size_t count) const;
  std::vector<double> read_values(std::size_t first, std::size_t count) const;

 private:
  class Storage;

  void read_segments();
  void read_checkpoints();

  std::string path_;
  std::unique_ptr<Storage> storage_;
  TimeSeriesContent content_;
  std::size_t rows_ = 0;
  std::string damage_;
};

}  // namespace samara::io
