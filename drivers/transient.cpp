// samara transient: the motion in time.
#include "samara/analysis/transient.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>

#include "samara/base/error.hpp"
#include "samara/io/history_file.hpp"
#include "samara/petsc/session.hpp"
#include "samara/system/turbine_channels.hpp"
#include "samara/system/turbine_system.hpp"

#include "commands.hpp"
#include "masses.hpp"
#include "progress.hpp"
#include "table.hpp"

namespace samara::drivers {
namespace {

using analysis::TransientStart;
using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t interrupted = 0;

/// The first SIGINT or SIGTERM ends the run in good order, the second one at once.
class Interruption {
 public:
  Interruption() {
    interrupted = 0;
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
  }
  ~Interruption() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
  }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

 private:
  static void note(int number) {
    interrupted = 1;
    std::signal(number, SIG_DFL);
  }
};

/// What a channel did, over the rows of the history.
struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();
  double sum = 0.0;
  double last = 0.0;
  long rows = 0;

  void add(double value) {
    least = std::min(least, value);
    largest = std::max(largest, value);
    sum += value;
    last = value;
    ++rows;
  }
};

/// A state event that a step has passed.
struct Crossing {
  std::size_t event = 0;
  double time = 0.0;  ///< by the secant of its channel over the step
};

/// Writes the history while it grows, and watches for events.
class Recorder final : public analysis::TransientObserver {
 public:
  Recorder(const io::TransientCase& transient, io::HistoryFile& file, Progress& progress)
      : transient_(transient),
        file_(file),
        progress_(progress),
        steps_(std::lround(transient.options.duration / transient.options.step)) {}

  /// What follows is of this system, with these events still to come.
  void begin_leg(const system::TurbineSystem& system, const std::vector<std::size_t>& watched) {
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

  bool sample(const analysis::TransientSample& sample) override {
    if (find_crossing(sample)) return false;
    if (sample.on_grid && sample.step % transient_.output_steps == 0) {
      channels_->evaluate(sample.t, sample.z, sample.z_dot, values_);
      file_.append(sample.t, values_);
      has_rows_ = true;
      for (std::size_t i = 0; i < values_.size(); ++i) extents_[i].add(values_[i]);
    }
    progress_.progress("transient", sample.step, steps_);
    return interrupted == 0;
  }

  void checkpoint(const TransientStart& point) override { file_.write_checkpoint(point); }

  void note(const std::string& text) override { progress_.note(text); }

  const std::vector<Extent>& extents() const { return extents_; }
  const std::vector<system::Channel>& channels() const { return channels_->channels(); }
  bool has_rows() const { return has_rows_; }
  const std::optional<Crossing>& crossing() const { return crossing_; }
  /// The last value of the channel of a watched event.
  double level_of(std::size_t event) const {
    for (std::size_t i = 0; i < watched_.size(); ++i)
      if (watched_[i] == event) return levels_[i];
    return 0.0;
  }

 private:
  /// The first of the watched events whose condition holds now.
  bool find_crossing(const analysis::TransientSample& sample) {
    if (!watch_) return false;
    std::vector<double> now(levels_.size());
    watch_->evaluate(sample.t, sample.z, sample.z_dot, now);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const system::EventTrigger& trigger = transient_.events[watched_[i]].trigger;
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

  const io::TransientCase& transient_;
  io::HistoryFile& file_;
  Progress& progress_;
  std::optional<system::TurbineChannels> channels_;
  std::optional<system::TurbineChannels> watch_;
  std::vector<std::size_t> watched_;
  std::vector<double> levels_;  ///< of the watched channels at the last sample
  bool has_level_ = false;
  double time_ = 0.0;
  std::optional<Crossing> crossing_;
  std::vector<double> values_;
  std::vector<Extent> extents_;
  long steps_;
  bool has_rows_ = false;
};

/// The turbine with what is prescribed in time.
model::Turbine operated(const io::Case& input) {
  model::Turbine turbine = model::build_turbine(input.turbine);
  const io::TransientCase& transient = input.transient;
  const double duration = transient.options.duration;
  if (transient.speed) turbine.operation.turning.emplace(*transient.speed, duration);
  if (transient.pitch) turbine.operation.pitch.assign(turbine.blades.size(), transient.pitch);
  turbine.operation.yaw = transient.yaw;
  turbine.operation.teeter = transient.teeter;
  return turbine;
}

/// The run in legs: from event to event the turbine is the same.
class Legs {
 public:
  Legs(const io::TransientCase& transient, model::Turbine turbine, TransientStart start,
       std::vector<double> fired, Recorder& recorder, io::HistoryFile& file)
      : transient_(transient),
        turbine_(std::move(turbine)),
        start_(std::move(start)),
        fired_(std::move(fired)),
        recorder_(recorder),
        file_(file) {
    fired_.resize(transient_.events.size(), never);
    for (std::size_t i = 0; i < fired_.size(); ++i)
      if (std::isfinite(fired_[i])) apply(i, fired_[i]);
  }

  analysis::TransientRun run() {
    while (true) {
      file_.note_events(fired_);
      const analysis::TransientRun leg = run_leg(next_time(), to_watch());
      if (recorder_.crossing()) {
        pass(*recorder_.crossing(), leg);
        continue;
      }
      start_ = leg.end;
      if (leg.reason != analysis::TransientEnd::stopped) {
        total_.end = leg.end;
        total_.reason = leg.reason;
        return total_;
      }
      for (std::size_t i = 0; i < fired_.size(); ++i)
        if (!std::isfinite(fired_[i]) && transient_.events[i].trigger.time == next_time_) fire(i);
    }
  }

  const std::vector<double>& fired() const { return fired_; }

 private:
  static constexpr double never = std::numeric_limits<double>::quiet_NaN();

  analysis::TransientRun run_leg(std::optional<double> stop,
                                 const std::vector<std::size_t>& watch) {
    const system::TurbineSystem system(turbine_, PETSC_COMM_SELF);
    recorder_.begin_leg(system, watch);
    analysis::TransientOptions options = transient_.options;
    options.stop_at = stop;
    const analysis::TransientRun leg = analysis::run_transient(system, start_, options, recorder_);
    total_.method = leg.method;
    total_.steps += leg.steps;
    total_.newton_steps += leg.newton_steps;
    total_.factorizations += leg.factorizations;
    total_.cuts += leg.cuts;
    return leg;
  }

  /// Goes to where a state event came, from the step before it.
  void pass(const Crossing& crossing, const analysis::TransientRun& leg) {
    const double close = 1e-6 * transient_.options.step;
    if (leg.steps > 0) start_ = leg.before;
    if (leg.steps > 0 && crossing.time > start_.time + close)
      start_ = run_leg(std::min(crossing.time, leg.end.time), {}).end;
    fire(crossing.event);
  }

  void fire(std::size_t i) {
    fired_[i] = start_.time;
    apply(i, start_.time);
  }

  void apply(std::size_t i, double t) {
    const system::TurbineEvent& event = transient_.events[i];
    turbine_ = system::apply_event(turbine_, event, t);
    if (!event.generator_off) return;
    for (analysis::HeldCoordinate& held : start_.held)
      if (held.name == "generator") held.load = 0.0;
  }

  std::optional<double> next_time() {
    next_time_.reset();
    for (std::size_t i = 0; i < fired_.size(); ++i) {
      const std::optional<double>& time = transient_.events[i].trigger.time;
      if (!std::isfinite(fired_[i]) && time && (!next_time_ || *time < *next_time_))
        next_time_ = time;
    }
    return next_time_;
  }

  std::vector<std::size_t> to_watch() const {
    std::vector<std::size_t> watched;
    for (std::size_t i = 0; i < fired_.size(); ++i)
      if (!std::isfinite(fired_[i]) && !transient_.events[i].trigger.time) watched.push_back(i);
    return watched;
  }

  const io::TransientCase& transient_;
  model::Turbine turbine_;
  TransientStart start_;
  std::vector<double> fired_;  ///< time of each event; not-a-number: not yet
  Recorder& recorder_;
  io::HistoryFile& file_;
  std::optional<double> next_time_;
  analysis::TransientRun total_;
};

std::string channel_table(const std::vector<system::Channel>& channels,
                          const std::vector<Extent>& extents) {
  Table table;
  table.add_column("channel", "", Align::left);
  table.add_column("unit", "", Align::left);
  for (const char* name : {"least", "mean", "largest", "last"}) table.add_column(name, "");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Extent& extent = extents[i];
    if (extent.rows == 0) continue;
    table.add_row({channels[i].name, channels[i].unit, general(extent.least, 4),
                   general(extent.sum / static_cast<double>(extent.rows), 4),
                   general(extent.largest, 4), general(extent.last, 4)});
  }
  return table.text();
}

/// Where the two first differ: `key: value there, value here`.
std::string find_difference(const std::string& there, const std::string& here) {
  std::istringstream first(there);
  std::istringstream second(here);
  std::string a;
  std::string b;
  while (true) {
    const bool has_a = static_cast<bool>(std::getline(first, a));
    const bool has_b = static_cast<bool>(std::getline(second, b));
    if (!has_a && !has_b) return "";
    if (!has_a || !has_b || a != b)
      return (has_a ? a : std::string("nothing")) + " there, " +
             (has_b ? b : std::string("nothing")) + " here";
  }
}

TransientStart read_start(const Job& job, const system::TurbineSystem& system,
                          std::vector<double>& fired) {
  const io::HistoryReader history(job.restart_path);
  const io::HistoryContent& content = history.content();
  const std::string difference = find_difference(content.model, job.input.model_text);
  if (!difference.empty())
    throw InputError(job.restart_path + ": is of another model (" + difference + ")");
  if (!content.checkpoint)
    throw InputError(job.restart_path +
                     ": has no checkpoint; hint: transient.checkpoint sets their distance");
  const TransientStart& point = *content.checkpoint;
  if (point.z.size() != system.size())
    throw InputError(job.restart_path + ": its state has " + std::to_string(point.z.size()) +
                     " unknowns, the model " + std::to_string(system.size()));
  const analysis::TransientOptions& options = job.input.transient.options;
  const double grid = point.origin + static_cast<double>(point.step) * options.step;
  if (std::abs(grid - point.time) > 1e-9 * options.step)
    throw InputError(job.restart_path + ": was run with another transient.step");
  if (point.time >= point.origin + options.duration * (1.0 - 1e-12))
    throw InputError(job.restart_path + ": reaches to t = " + general(point.time, 6) +
                     " s already; hint: a longer transient.duration");
  fired = content.checkpoint_events;
  if (fired.size() != job.input.transient.events.size())
    throw InputError(job.restart_path + ": was run with other transient.events");
  return point;
}

TransientStart make_start(const Job& job, const system::TurbineSystem& system,
                          std::vector<double>& fired, Progress& progress) {
  if (!job.restart_path.empty()) return read_start(job, system, fired);
  if (job.input.transient.start == io::TransientOrigin::undeformed)
    return analysis::start_undeformed(system, 0.0);
  require_motion(job.input);
  return analysis::start_on(system, analysis::find_trim(system, job.input.trim, progress), 0.0);
}

std::string summary(const io::Case& input, const analysis::TransientRun& run,
                    const std::vector<double>& fired, double began, double seconds) {
  const double simulated = run.end.time - began;
  std::string text = (input.turbine.title.empty() ? input.path : input.turbine.title) + "\n";
  text += "time         " + general(began, 6) + " to " + general(run.end.time, 6) + " s" +
          (run.reason == analysis::TransientEnd::complete ? "" : ": interrupted") + "\n";
  text += "method       " + run.method + ", " + std::to_string(run.steps) + " steps, " +
          general(static_cast<double>(run.newton_steps) / static_cast<double>(run.steps), 3) +
          " Newton steps each, " + std::to_string(run.factorizations) + " factorizations";
  if (run.cuts > 0) text += ", " + std::to_string(run.cuts) + " cuts of the step";
  for (std::size_t i = 0; i < fired.size(); ++i)
    if (std::isfinite(fired[i]))
      text += "\nevent        transient.events[" + std::to_string(i) +
              "] at t = " + general(fired[i], 6) + " s";
  text += "\nspeed        " + general(seconds, 3) + " s, " + general(simulated / seconds, 3) +
          " times real time\n\n";
  return text;
}

/// An event that never came is one that the user has wrong.
void require_fired(const io::TransientCase& transient, const std::vector<double>& fired) {
  for (std::size_t i = 0; i < fired.size(); ++i) {
    if (std::isfinite(fired[i])) continue;
    const system::EventTrigger& trigger = transient.events[i].trigger;
    throw InputError("transient.events[" + std::to_string(i) + "] never came: " + trigger.channel +
                     " was never " + (trigger.above ? "above " : "below ") +
                     general(trigger.level, 6) + "; the result is complete without it");
  }
}

}  // namespace

void require_transient(const io::Case& input) {
  if (!input.transient.is_given)
    throw InputError(input.path +
                     ": missing key \"transient\"; hint: --set \"transient={duration: 60, step: "
                     "0.01}\"");
  if (input.transient.start == io::TransientOrigin::trim) require_motion(input);
  const auto refuse = [&input](const std::string& key, const std::string& why) {
    throw InputError(input.path + ": transient." + key + ": " + why);
  };
  const model::TurbineDefinition& turbine = input.turbine;
  const bool is_free = turbine.shaft.generator.kind == model::JointKind::free;
  if (input.transient.speed && is_free)
    refuse("speed",
           "the generator is free, its torque makes the speed; hint: "
           "shaft.generator.joint: locked");
  if (input.transient.yaw && turbine.nacelle.yaw.kind != model::JointKind::prescribed)
    refuse("yaw_deg", "only a joint: prescribed has a motion");
  if (input.transient.teeter && turbine.hub.teeter.kind != model::JointKind::prescribed)
    refuse("teeter_deg", "only a joint: prescribed has a motion");
  for (std::size_t i = 0; i < input.transient.events.size(); ++i) {
    const system::TurbineEvent& event = input.transient.events[i];
    const std::string place = "events[" + std::to_string(i) + "]";
    if (!is_free && (event.brake > 0.0 || event.generator_off))
      refuse(place,
             "the generator is locked and takes any torque; hint: "
             "shaft.generator.joint: free");
    if (event.pitch && event.pitch->blade > turbine.blades.count)
      refuse(place + ".pitch.blade", "there is no such blade");
  }
  for (std::size_t i = 0; i < turbine.loads.size(); ++i) {
    const auto& table = turbine.loads[i].history.table;
    if (!table.empty() &&
        (table.front().first > 0.0 || table.back().first < input.transient.options.duration))
      throw InputError(input.path + ": loads[" + std::to_string(i) +
                       "].table: does not reach over the run, from 0 to " +
                       general(input.transient.options.duration, 6) + " s");
  }
}

void run_transient(const Job& job) {
  if (petsc::Session::rank() != 0) return;  // one system, one integrator
  const io::TransientCase& transient = job.input.transient;
  const model::Turbine turbine = operated(job.input);
  const system::TurbineSystem system(turbine, PETSC_COMM_SELF);
  const system::TurbineChannels channels =
      at_place(job.input.path + ": transient.output.channels", [&] {
        return system::TurbineChannels(system, transient.stations, transient.channels);
      });
  for (std::size_t i = 0; i < transient.events.size(); ++i)
    if (const system::EventTrigger& trigger = transient.events[i].trigger; !trigger.time)
      at_place(job.input.path + ": transient.events[" + std::to_string(i) + "].when.channel", [&] {
        return system::TurbineChannels(system, transient.stations, {trigger.channel});
      });
  Progress progress(true);
  std::vector<double> fired;
  const TransientStart start = make_start(job, system, fired, progress);
  io::HistoryFile file(job.result_path, job.input, record_of(job), channels.channels(),
                       [&](io::ResultFile& result) {
                         result.write_model(system);
                         write_masses(result, model::compute_masses(job.input.turbine, turbine));
                       });
  if (job.restart_path == job.result_path) file.resume();
  Recorder recorder(transient, file, progress);
  const Interruption interruption;
  const Clock::time_point began = Clock::now();
  try {
    Legs legs(transient, turbine, start, fired, recorder, file);
    const analysis::TransientRun run = legs.run();
    const bool is_complete = run.reason == analysis::TransientEnd::complete;
    const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
    file.finish(is_complete ? "complete" : "interrupted", is_complete ? &run.end : nullptr);
    progress.finish();
    std::cout << summary(job.input, run, legs.fired(), start.time, seconds)
              << channel_table(channels.channels(), recorder.extents())
              << "result: " << job.result_path << "\n"
              << std::flush;
    if (!is_complete)
      throw Interrupted("interrupted at t = " + general(run.end.time, 6) + " s; hint: --restart " +
                        job.result_path + " goes on from its last checkpoint");
    require_fired(transient, legs.fired());
  } catch (const Interrupted&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    progress.finish();
    if (recorder.has_rows()) {
      file.finish(std::string("failed: ") + error.what(), nullptr);
      std::cerr << "samara: what was computed is in " << job.result_path << "\n";
    }
    throw;
  }
}

}  // namespace samara::drivers
