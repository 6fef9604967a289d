// Writes the time series of a transient to the result, until a signal ends it.
#pragma once

#include "samara/io/time_series_file.hpp"
#include "samara/simulation/transient_simulation.hpp"

#include "interruption.hpp"
#include "progress.hpp"

namespace samara::drivers {

class TimeSeriesOutput final : public simulation::TransientOutput {
 public:
  /// Both arguments must outlive the object. `file`: null on the ranks but the first one.
  TimeSeriesOutput(io::TimeSeriesFile* file, Progress& progress)
      : file_(file), progress_(progress) {}

  void row(double t, std::span<const double> values) override {
    if (file_ == nullptr) return;
    file_->append(t, values);
    has_rows_ = true;
  }
  void checkpoint(const simulation::TransientState& state) override {
    if (file_ == nullptr) return;
    file_->note_events(state.events);
    file_->write_checkpoint(state.point);
  }
  bool goes_on() override { return file_ == nullptr || !Interruption::is_asked(); }
  void note(const std::string& text) override { progress_.note(text); }
  void progress(const std::string& stage, long done, long all) override {
    progress_.progress(stage, done, all);
  }

  bool has_rows() const { return has_rows_; }

 private:
  io::TimeSeriesFile* file_;
  Progress& progress_;
  bool has_rows_ = false;
};

}  // namespace samara::drivers
