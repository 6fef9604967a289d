// Time histories on disk while they grow.
//
// Rows are gathered and every few seconds closed away as a segment, a complete HDF5 file of its own
// in the folder RESULT.parts beside RESULT.h5. The result is then written anew: it names the
// segments and shows them as one (virtual) dataset, so that at any moment, whatever happens to the
// run, it is a complete file of all rows but the last seconds'. A run that is over before the first
// segment is due leaves one file.
//
// Serial: one rank writes.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "samara/analysis/transient.hpp"
#include "samara/io/result_file.hpp"
#include "samara/system/turbine_channels.hpp"

namespace samara::io {

/// Rows that are in a file of their own.
struct HistorySegment {
  std::string file;  ///< relative to the folder of the result
  std::size_t rows = 0;
};

/// What the result says of a history.
struct HistoryContent {
  std::vector<system::Channel> channels;
  std::vector<HistorySegment> segments;
  std::vector<double> time;    ///< of rows that are in no segment; empty where there are segments
  std::vector<double> values;  ///< row by row
  std::string model;           ///< Case::model_text
  std::optional<double> azimuth;   ///< of blade 1 at t = 0 [rad]; none: that of the case
  double brake_torque = 0.0;       ///< that acts from the start [N m]
  bool is_generator_lost = false;  ///< from the start
  std::optional<analysis::TransientStart> checkpoint;
  std::size_t checkpoint_rows = 0;        ///< rows up to the checkpoint
  std::vector<double> checkpoint_events;  ///< when each event came [s]; not-a-number: not yet
  std::string status;                     ///< "running", "complete", "interrupted", "failed: ..."
};

class HistoryFile {
 public:
  /// `content`: channels, and how the drive train is at the start; `write_rest` adds to each
  /// version of the result what else belongs in it.
  HistoryFile(std::string path, const Case& input, RunRecord record, HistoryContent content,
              std::function<void(ResultFile&)> write_rest);

  /// Goes on with the history that is in the result already, up to its checkpoint.
  void resume();

  void append(double t, std::span<const double> values);

  /// All rows so far and the point to go on from are safe when it returns.
  void write_checkpoint(const analysis::TransientStart& point);

  /// When the events came, for the checkpoints from now on.
  void note_events(const std::vector<double>& times) { events_ = times; }

  /// Writes what is left. `end`: from which the history can go on, where there is such a point.
  void finish(const std::string& status, const analysis::TransientStart* end);

 private:
  void close_segment();
  void publish();
  void remove_strangers() const;
  std::string folder_name() const;

  std::string path_;
  const Case& input_;
  RunRecord record_;
  std::function<void(ResultFile&)> write_rest_;
  HistoryContent content_;
  std::size_t rows_ = 0;
  std::vector<double> events_;
  std::string run_;  ///< starts the names of the segments of this run
  int next_segment_ = 1;
  std::chrono::steady_clock::time_point due_;
};

/// Reads the history of a result.
class HistoryReader {
 public:
  /// @throws InputError where there is none, or a segment is missing, damaged or from another run
  explicit HistoryReader(const std::string& path);
  ~HistoryReader();
  HistoryReader(const HistoryReader&) = delete;
  HistoryReader& operator=(const HistoryReader&) = delete;

  const HistoryContent& content() const { return content_; }
  std::size_t rows() const { return rows_; }
  /// Rows first to first + count of the times, and of the values row by row.
  std::vector<double> read_time(std::size_t first, std::size_t count) const;
  std::vector<double> read_values(std::size_t first, std::size_t count) const;

 private:
  class Storage;
  std::unique_ptr<Storage> storage_;
  HistoryContent content_;
  std::size_t rows_ = 0;
};

}  // namespace samara::io
