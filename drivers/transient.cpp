// samara transient: the motion in time.
#include "samara/analysis/transient.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <iostream>
#include <limits>

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

/// Writes the history while it grows.
class Recorder final : public analysis::TransientObserver {
 public:
  Recorder(const io::TransientCase& transient, const system::TurbineChannels& channels,
           io::HistoryFile& file, Progress& progress)
      : transient_(transient),
        channels_(channels),
        file_(file),
        progress_(progress),
        values_(channels.channels().size()),
        extents_(values_.size()),
        steps_(std::lround(transient.options.duration / transient.options.step)) {}

  bool sample(const analysis::TransientSample& sample) override {
    time_ = sample.t;
    if (sample.on_grid && sample.step % transient_.output_steps == 0) {
      channels_.evaluate(sample.t, sample.z, sample.z_dot, values_);
      file_.append(sample.t, values_);
      for (std::size_t i = 0; i < values_.size(); ++i) extents_[i].add(values_[i]);
    }
    progress_.progress("transient", sample.step, steps_);
    return interrupted == 0;
  }

  void checkpoint(const TransientStart& point) override { file_.write_checkpoint(point); }

  void note(const std::string& text) override { progress_.note(text); }

  const std::vector<Extent>& extents() const { return extents_; }
  double time() const { return time_; }

 private:
  const io::TransientCase& transient_;
  const system::TurbineChannels& channels_;
  io::HistoryFile& file_;
  Progress& progress_;
  std::vector<double> values_;
  std::vector<Extent> extents_;
  long steps_;
  double time_ = 0.0;
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

TransientStart read_start(const Job& job, const system::TurbineSystem& system) {
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
  return point;
}

TransientStart make_start(const Job& job, const system::TurbineSystem& system, Progress& progress) {
  if (!job.restart_path.empty()) return read_start(job, system);
  if (job.input.transient.start == io::TransientOrigin::undeformed)
    return analysis::start_undeformed(system, 0.0);
  require_motion(job.input);
  return analysis::start_on(system, analysis::find_trim(system, job.input.trim, progress), 0.0);
}

std::string summary(const io::Case& input, const analysis::TransientRun& run, double began,
                    double seconds) {
  const double simulated = run.end.time - began;
  std::string text = (input.turbine.title.empty() ? input.path : input.turbine.title) + "\n";
  text += "time         " + general(began, 6) + " to " + general(run.end.time, 6) + " s" +
          (run.complete ? "" : ": interrupted") + "\n";
  text += "method       " + run.method + ", " + std::to_string(run.steps) + " steps, " +
          general(static_cast<double>(run.newton_steps) / static_cast<double>(run.steps), 3) +
          " Newton steps each, " + std::to_string(run.factorizations) + " factorizations";
  if (run.cuts > 0) text += ", " + std::to_string(run.cuts) + " cuts of the step";
  text += "\nspeed        " + general(seconds, 3) + " s, " + general(simulated / seconds, 3) +
          " times real time\n\n";
  return text;
}

}  // namespace

void require_transient(const io::Case& input) {
  if (!input.transient.is_given)
    throw InputError(input.path +
                     ": missing key \"transient\"; hint: --set \"transient={duration: 60, step: "
                     "0.01}\"");
  if (input.transient.start == io::TransientOrigin::trim) require_motion(input);
}

void run_transient(const Job& job) {
  if (petsc::Session::rank() != 0) return;  // one system, one integrator
  const io::TransientCase& transient = job.input.transient;
  const model::Turbine turbine = model::build_turbine(job.input.turbine);
  const system::TurbineSystem system(turbine, PETSC_COMM_SELF);
  const system::TurbineChannels channels(system, transient.stations, transient.channels);
  Progress progress(true);
  const TransientStart start = make_start(job, system, progress);
  io::HistoryFile file(job.result_path, job.input, record_of(job), channels.channels(),
                       [&](io::ResultFile& result) {
                         result.write_model(system);
                         write_masses(result, model::compute_masses(job.input.turbine, turbine));
                       });
  if (job.restart_path == job.result_path) file.resume();
  Recorder recorder(transient, channels, file, progress);
  const Interruption interruption;
  const Clock::time_point began = Clock::now();
  try {
    const analysis::TransientRun run =
        analysis::run_transient(system, start, transient.options, recorder);
    const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
    file.finish(run.complete ? "complete" : "interrupted", run.complete ? &run.end : nullptr);
    progress.finish();
    std::cout << summary(job.input, run, start.time, seconds)
              << channel_table(channels.channels(), recorder.extents())
              << "result: " << job.result_path << "\n"
              << std::flush;
    if (!run.complete)
      throw Interrupted("interrupted at t = " + general(run.end.time, 6) + " s; hint: --restart " +
                        job.result_path + " goes on from its last checkpoint");
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    progress.finish();
    file.finish(std::string("failed: ") + error.what(), nullptr);
    std::cerr << "samara: what was computed is in " << job.result_path << "\n";
    throw;
  }
}

}  // namespace samara::drivers
