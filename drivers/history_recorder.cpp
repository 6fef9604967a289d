#include "history_recorder.hpp"

#include <algorithm>
#include <cmath>

#include "samara/base/error.hpp"

#include "interruption.hpp"

namespace samara::drivers {

void Extent::add(double value) {
  least = std::min(least, value);
  largest = std::max(largest, value);
  sum += value;
  last = value;
  ++rows;
}

turbine::TurbineChannels find_channels(const io::Case& input,
                                       const turbine::TurbineSystem& system) {
  const io::TransientCase& transient = input.transient;
  for (std::size_t i = 0; i < transient.events.size(); ++i)
    if (const turbine::EventTrigger& trigger = transient.events[i].trigger; !trigger.time)
      at_place(input.path + ": transient.events[" + std::to_string(i) + "].when.channel", [&] {
        return turbine::TurbineChannels(system, transient.stations, {trigger.channel});
      });
  return at_place(input.path + ": transient.output.channels", [&] {
    return turbine::TurbineChannels(system, transient.stations, transient.channels);
  });
}

HistoryRecorder::HistoryRecorder(const io::TransientCase& transient, io::HistoryFile& file,
                                 Progress& progress)
    : transient_(transient),
      file_(file),
      progress_(progress),
      steps_(std::lround(transient.options.duration / transient.options.step)) {}

void HistoryRecorder::begin_leg(const turbine::TurbineSystem& system,
                                const std::vector<std::size_t>& watched) {
  channels_.emplace(system, transient_.stations, transient_.channels);
  values_.resize(channels_->channels().size());
  extents_.resize(values_.size());
  watched_ = watched;
  watch_.reset();
  crossing_.reset();
  has_level_ = false;
  std::vector<std::string> names;
  for (const std::size_t i : watched) names.push_back(transient_.events[i].trigger.channel);
  levels_.resize(names.size());
  if (!names.empty()) watch_.emplace(system, transient_.stations, names);
}

bool HistoryRecorder::sample(const analysis::TransientSample& sample) {
  if (find_crossing(sample)) return false;
  const bool is_new = !has_rows_ || sample.t > last_row_;  // an event may start the run anew
  if (is_new && sample.on_grid && sample.step % transient_.output_steps == 0) {
    last_row_ = sample.t;
    channels_->evaluate(sample.t, sample.z, sample.z_dot, values_);
    file_.append(sample.t, values_);
    has_rows_ = true;
    for (std::size_t i = 0; i < values_.size(); ++i) extents_[i].add(values_[i]);
  }
  progress_.progress("transient", sample.step, steps_);
  return !Interruption::is_asked();
}

/// The first of the watched events whose condition holds now.
bool HistoryRecorder::find_crossing(const analysis::TransientSample& sample) {
  if (!watch_) return false;
  std::vector<double> now(levels_.size());
  watch_->evaluate(sample.t, sample.z, sample.z_dot, now);
  for (std::size_t i = 0; i < now.size(); ++i) {
    const turbine::EventTrigger& trigger = transient_.events[watched_[i]].trigger;
    if (!trigger.holds(now[i])) continue;
    double time = sample.t;
    if (has_level_ && now[i] != levels_[i])
      time = time_ + (sample.t - time_) * (trigger.level - levels_[i]) / (now[i] - levels_[i]);
    if (!crossing_ || time < crossing_->time) crossing_ = {watched_[i], time};
  }
  if (crossing_) return true;
  levels_ = now;
  time_ = sample.t;
  has_level_ = true;
  return false;
}

}  // namespace samara::drivers
