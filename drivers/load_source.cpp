#include "load_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"
#include "samara/io/result_reader.hpp"
#include "samara/io/time_series_file.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/simulation/steady_state.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "table.hpp"

namespace samara::drivers {
namespace {

using turbine::Channel;

/// Names of the azimuth channel, for harmonics. It has statistics only if it is requested.
constexpr std::array<const char*, 3> azimuth_names{"Azimuth", "LSSTipPxa", "LSSTipPxs"};

/// Number of values read at once (8 MB).
constexpr std::size_t slice_values = std::size_t{1} << 20;

/// Largest distance of `from` and `until` from the time of a row, relative to the time.
constexpr double round_off = 1e-9;

bool is_azimuth(const std::string& name) {
  return std::ranges::find(azimuth_names, name) != azimuth_names.end();
}

/// The columns of all requested channels.
struct Columns {
  std::vector<std::size_t> wanted;
  std::size_t azimuth = 0;
  bool has_azimuth = false;
};

Columns choose_columns(const std::string& path, const std::vector<Channel>& all,
                       const io::LoadOptions& options) {
  Columns columns;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (is_azimuth(all[i].name)) {
      columns.azimuth = i;
      columns.has_azimuth = true;
    } else if (options.channels.empty()) {
      columns.wanted.push_back(i);
    }
  }
  std::vector<std::string> unknown;
  for (const std::string& name : options.channels) {
    const auto found = std::ranges::find(all, name, &Channel::name);
    if (found == all.end())
      unknown.push_back(name);
    else
      columns.wanted.push_back(static_cast<std::size_t>(found - all.begin()));
  }
  if (!unknown.empty()) {
    std::vector<std::string> names;
    for (const Channel& channel : all) names.push_back(channel.name);
    throw InputError(
        "--set channels: " + path + " has no " + (unknown.size() == 1 ? "channel " : "channels ") +
        list_unknown(unknown, names,
                     "; hint: transient.output.channels chooses those of a time series"));
  }
  if (columns.wanted.empty()) throw InputError(path + ": has no channel but the azimuth");
  return columns;
}

LoadSource make_source(const std::string& path, const std::vector<Channel>& all,
                       const Columns& columns) {
  LoadSource source;
  source.report.source = path;
  for (const std::size_t i : columns.wanted) {
    source.report.channels.push_back(all[i]);
    source.report.series.names.push_back(all[i].name);
  }
  return source;
}

/// Rows that are collected before their number is known.
class Rows {
 public:
  explicit Rows(const Columns& columns) : columns_(columns) {}

  void add(double time, const double* values) {
    times_.push_back(time);
    for (const std::size_t i : columns_.wanted) values_.push_back(values[i]);
    if (columns_.has_azimuth) azimuth_.push_back(values[columns_.azimuth]);
  }

  bool is_empty() const { return times_.empty(); }

  void take(LoadSource& source) const {
    const auto rows = static_cast<Eigen::Index>(times_.size());
    const auto width = static_cast<Eigen::Index>(columns_.wanted.size());
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    source.report.series.times = Eigen::Map<const Eigen::VectorXd>(times_.data(), rows);
    source.report.series.values = Eigen::Map<const RowMajor>(values_.data(), rows, width);
    if (columns_.has_azimuth)
      source.azimuth = Eigen::Map<const Eigen::VectorXd>(azimuth_.data(), rows);
  }

 private:
  const Columns& columns_;
  std::vector<double> times_;
  std::vector<double> values_;
  std::vector<double> azimuth_;
};

LoadSource read_series(const std::string& path, const io::LoadOptions& options) {
  const io::TimeSeriesReader series(path);
  if (series.content().status != "complete")
    std::cerr << "note: " << path << ": " << series.content().status << "\n";
  if (!series.damage().empty()) std::cerr << "note: " << series.damage() << "\n";
  const std::vector<Channel>& all = series.content().channels;
  const Columns columns = choose_columns(path, all, options);
  LoadSource source = make_source(path, all, columns);
  Rows rows(columns);
  const auto is_wanted = [&options](double t) {
    const double margin = round_off * std::max(1.0, std::abs(t));
    return (!options.from || t >= *options.from - margin) &&
           (!options.until || t <= *options.until + margin);
  };
  const std::size_t slice = std::max<std::size_t>(1, slice_values / all.size());
  for (std::size_t first = 0; first < series.rows(); first += slice) {
    const std::size_t count = std::min(slice, series.rows() - first);
    const std::vector<double> times = series.read_time(first, count);
    const std::vector<double> values = series.read_values(first, count);
    for (std::size_t i = 0; i < count; ++i)
      if (is_wanted(times[i])) rows.add(times[i], values.data() + i * all.size());
  }
  if (rows.is_empty() && series.rows() > 0)
    throw InputError(path + ": no row from `from` to `until`; its time series lasts from " +
                     general(series.read_time(0, 1).at(0), 6) + " to " +
                     general(series.read_time(series.rows() - 1, 1).at(0), 6) + " s");
  rows.take(source);
  return source;
}

/// The requested channels and the azimuth; empty: all.
std::vector<std::string> channel_names(const io::LoadOptions& options) {
  std::vector<std::string> names = options.channels;
  if (!names.empty() && std::ranges::none_of(names, is_azimuth)) names.emplace_back("Azimuth");
  return names;
}

turbine::TurbineChannels make_channels(const turbine::TurbineSystem& system,
                                       const simulation::TransientSetup& transient,
                                       const io::LoadOptions& options) {
  return at_place("--set channels", [&] {
    return turbine::TurbineChannels(system, transient.stations, channel_names(options));
  });
}

LoadSource sample_steady_state(const std::string& path, const io::LoadOptions& options,
                               analysis::Observer& observer) {
  if (options.from || options.until)
    throw InputError(path +
                     ": a steady state is one revolution; hint: leave `from` and `until` out");
  const io::Case input = io::read_result_case(path);
  const analysis::Trim trim = io::read_result_trim(path);
  const analysis::PeriodicSolution& solution = trim.solution;
  if (!(solution.period() > 0.0))
    throw InputError(path +
                     ": its rotor stands still and its loads are constant; hint: samara "
                     "transient gives them by channel");
  const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
  if (solution.coefficients().rows() != system.size())
    throw InputError(path + ": its steady state has " +
                     std::to_string(solution.coefficients().rows()) + " unknowns, the model has " +
                     std::to_string(system.size()) + "; hint: run samara trim again");
  simulation::note_doubts(system, trim, observer, path);
  const turbine::TurbineChannels channels = make_channels(system, input.transient, options);
  const std::vector<Channel>& all = channels.channels();
  const Columns columns = choose_columns(path, all, options);
  LoadSource source = make_source(path, all, columns);
  Rows rows(columns);
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  std::vector<double> values(all.size());
  for (int i = 0; i < options.azimuths; ++i) {
    const double t = solution.period() * i / options.azimuths;
    solution.evaluate(t, z.get(), z_dot.get());
    channels.evaluate(t, z.get(), z_dot.get(), values);
    rows.add(t, values.data());
  }
  rows.take(source);
  source.report.series.period = solution.period();
  return source;
}

}  // namespace

LoadSource read_load_source(const std::string& path, const io::LoadOptions& options,
                            analysis::Observer& observer) {
  switch (io::find_result_kind(path)) {
    case io::ResultKind::time_series:
      return read_series(path, options);
    case io::ResultKind::steady_state:
      return sample_steady_state(path, options, observer);
    case io::ResultKind::other:
      break;
  }
  throw InputError(path +
                   ": has no loads; hint: they come from results of transient, trim or floquet");
}

}  // namespace samara::drivers
