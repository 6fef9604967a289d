// Writes a time series to the disk while it grows, and reads it.
//
// Rows are collected in memory. Every few seconds they are written as a segment: a complete HDF5
// file of its own in the folder RESULT.h5.parts beside RESULT.h5. The result is then written anew:
// it names the segments and shows them as one (virtual) dataset. So it is a complete file at any
// moment, whatever happens to the run; only the rows of the last seconds are missing. A run that
// ends before the first segment is due leaves one file.
//
// Segments and results are on the disk (fsync) before anything refers to them. Segments are removed
// from the folder only if they belong to runs that the result named before.
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

/// Number of checkpoints in a result: one that has lost its last rows can restart from the other.
inline constexpr std::size_t kept_checkpoints = 2;

/// Point from which a time series can be restarted.
struct TimeSeriesCheckpoint {
  analysis::TransientStart point;
  std::size_t rows = 0;        ///< number of rows up to this point
  std::vector<double> events;  ///< time of each event [s]; not-a-number: not yet
};

/// Description of a time series in a result.
struct TimeSeriesContent {
  std::vector<turbine::Channel> channels;
  std::vector<TimeSeriesSegment> segments;
  std::vector<double> time;        ///< times of rows in no segment; empty if there are segments
  std::vector<double> values;      ///< values of these rows, row by row
  std::string model;               ///< Case::model_text
  std::optional<double> azimuth;   ///< azimuth of blade 1 at t = 0 [rad]; none: as in the case
  double brake_torque = 0.0;       ///< brake torque at the start [N m]
  bool is_generator_lost = false;  ///< generator lost at the start
  std::vector<TimeSeriesCheckpoint> checkpoints;  ///< the last ones, at most `kept_checkpoints`
  std::string status;  ///< "running", "complete", "interrupted", "failed: ..."
};

class TimeSeriesFile {
 public:
  /// `content`: channels, and the state of the drive train at the start. `write_rest` adds the
  /// other groups to each version of the result.
  TimeSeriesFile(const std::string& path, const Case& input, RunRecord record,
                 TimeSeriesContent content, std::function<void(ResultFile&)> write_rest);
  ~TimeSeriesFile();
  TimeSeriesFile(const TimeSeriesFile&) = delete;
  TimeSeriesFile& operator=(const TimeSeriesFile&) = delete;

  /// Continues the time series of the existing result; keeps its rows up to the last checkpoint.
  void resume();

  void append(double t, std::span<const double> values);

  /// When it returns, all rows so far and the checkpoint are on the disk.
  void write_checkpoint(const analysis::TransientStart& point);

  /// Sets the times of the events, for all later checkpoints.
  void note_events(const std::vector<double>& times) { events_ = times; }

  /// Writes the remaining rows. `end`: point from which the time series can be restarted, or null.
  void finish(const std::string& status, const analysis::TransientStart* end);

  /// The same after a failure, such as a full disk. The status is written first, in disk space that
  /// was reserved for it, then the rows. Returns true if everything is written.
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
  std::string run_;                 ///< first part of the names of this run's segments
  std::set<std::string> replaced_;  ///< the same for runs whose result this one replaces
  int next_segment_ = 1;
  std::chrono::steady_clock::time_point due_;
  std::int64_t room_ = 0;  ///< bytes reserved on the disk for the last version of the result
};

/// Reads the time series of a result. If a segment is missing or damaged, only the rows before it
/// are read, and the checkpoints within these rows.
class TimeSeriesReader {
 public:
  /// @throws InputError if the result has no time series
  explicit TimeSeriesReader(const std::string& path);
  ~TimeSeriesReader();
  TimeSeriesReader(const TimeSeriesReader&) = delete;
  TimeSeriesReader& operator=(const TimeSeriesReader&) = delete;

  const TimeSeriesContent& content() const { return content_; }
  std::size_t rows() const { return rows_; }
  /// Description of the missing parts, for a note; empty if the time series is complete.
  const std::string& damage() const { return damage_; }
  /// Times of `count` rows from row `first` on, and their values row by row.
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
