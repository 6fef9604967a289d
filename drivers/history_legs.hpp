// A time history in legs: from event to event the turbine is the same.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "samara/analysis/transient.hpp"
#include "samara/io/case.hpp"
#include "samara/model/turbine.hpp"

#include "history_recorder.hpp"

namespace samara::drivers {

/// Time of an event that did not come yet.
inline constexpr double never = std::numeric_limits<double>::quiet_NaN();

/// The turbine with what the case prescribes in time.
model::Turbine operated_turbine(const io::Case& input);

/// The turbine after the events that came at the times `fired`, one for each event of the case.
model::Turbine turbine_after(const io::TransientCase& transient, model::Turbine turbine,
                             const std::vector<double>& fired);

class HistoryLegs {
 public:
  /// `fired`: time of each event; may be shorter than their number. `generator`: unknown of its
  /// angle. The case, the recorder and the file must live on.
  HistoryLegs(const io::TransientCase& transient, const model::Turbine& turbine,
              analysis::TransientStart start, std::vector<double> fired, int generator,
              HistoryRecorder& recorder, io::HistoryFile& file);

  /// @throws ConvergenceError as `analysis::run_transient`
  analysis::TransientRun run();

  const std::vector<double>& fired() const { return fired_; }

 private:
  analysis::TransientRun run_leg(std::optional<double> stop, const std::vector<std::size_t>& watch);
  void pass(Crossing crossing, const analysis::TransientRun& leg);
  void fire(std::size_t i);
  void fire_at(double time);
  double on_grid(double time) const;
  std::optional<double> next_time() const;
  std::vector<std::size_t> to_watch() const;

  const io::TransientCase& transient_;
  model::Turbine turbine_;
  analysis::TransientStart start_;
  std::vector<double> fired_;
  int generator_;
  HistoryRecorder& recorder_;
  io::HistoryFile& file_;
  analysis::TransientRun total_;
};

}  // namespace samara::drivers
