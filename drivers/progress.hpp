// Reports the progress of a long analysis on stderr: a bar on a terminal, otherwise lines at
// intervals.
#pragma once

#include <chrono>
#include <string>

#include "samara/analysis/observer.hpp"

namespace samara::drivers {

class Progress final : public analysis::Observer {
 public:
  /// `speaks`: true only on the first rank.
  explicit Progress(bool speaks);
  ~Progress() override;

  void note(const std::string& text) override;
  /// Shows the part that is done, and the time that the rest of the stage would take at the same
  /// rate. The cost is one reading of the clock.
  void progress(const std::string& stage, long done, long all) override;

  /// Removes the bar before output to stdout.
  void finish() { clear_bar(); }

 private:
  using Clock = std::chrono::steady_clock;

  void clear_bar();
  void draw_bar(const std::string& stage, double part, const std::string& words);

  bool speaks_;
  bool on_terminal_;
  bool has_bar_ = false;
  Clock::duration interval_;
  Clock::time_point next_;
  std::string stage_;  ///< the present one
  Clock::time_point begun_;
  double begun_part_ = 0.0;  ///< part that was done when it began here
};

}  // namespace samara::drivers
