// Takes a time history while it runs: rows to the file, events, what each channel did.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "samara/analysis/transient.hpp"
#include "samara/io/case.hpp"
#include "samara/io/history_file.hpp"
#include "samara/turbine/turbine_channels.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "progress.hpp"

namespace samara::drivers {

/// What a channel did, over the rows of the history.
struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();
  double sum = 0.0;
  double last = 0.0;
  long rows = 0;

  void add(double value);
};

/// A state event that a step has passed.
struct Crossing {
  std::size_t event = 0;
  double time = 0.0;  ///< by the secant of its channel over the step
};

/// The channels of the history; those of events must exist, too. @throws InputError
turbine::TurbineChannels find_channels(const io::Case& input, const turbine::TurbineSystem& system);

/// Writes the history while it grows, and watches for events.
class HistoryRecorder final : public analysis::TransientObserver {
 public:
  /// All arguments must live on.
  HistoryRecorder(const io::TransientCase& transient, io::HistoryFile& file, Progress& progress);

  /// What follows is of this system, with these events still to come. The system must live on.
  void begin_leg(const turbine::TurbineSystem& system, const std::vector<std::size_t>& watched);

  bool sample(const analysis::TransientSample& sample) override;
  void checkpoint(const analysis::TransientStart& point) override { file_.write_checkpoint(point); }
  void note(const std::string& text) override { progress_.note(text); }

  /// One for each channel.
  const std::vector<Extent>& extents() const { return extents_; }
  bool has_rows() const { return has_rows_; }
  /// The event that ended the leg.
  const std::optional<Crossing>& crossing() const { return crossing_; }

 private:
  bool find_crossing(const analysis::TransientSample& sample);

  const io::TransientCase& transient_;
  io::HistoryFile& file_;
  Progress& progress_;
  std::optional<turbine::TurbineChannels> channels_;
  std::optional<turbine::TurbineChannels> watch_;
  std::vector<std::size_t> watched_;
  std::vector<double> levels_;  ///< of the watched channels at the last sample
  bool has_level_ = false;
  double time_ = 0.0;  ///< of the last sample
  std::optional<Crossing> crossing_;
  std::vector<double> values_;
  std::vector<Extent> extents_;
  long steps_;
  bool has_rows_ = false;
  double last_row_ = 0.0;  ///< [s]
};

}  // namespace samara::drivers
