#include "samara/io/load_result.hpp"

#include <numeric>
#include <sstream>

#include "samara/io/whole_file.hpp"

#include "axes.hpp"

namespace samara::io {
namespace {

using loads::ChannelStatistics;

constexpr char no_frame[] = "none";
constexpr char unit_of_channel[] = "see channel_unit";
constexpr char frame_of_channel[] = "see channel_frame";
constexpr char event_axis[] = "event";

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The entries row by row.
std::vector<double> flat(const RowMajor& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

std::vector<double> flat(const std::vector<std::vector<double>>& rows) {
  std::vector<double> values;
  for (const std::vector<double>& row : rows) values.insert(values.end(), row.begin(), row.end());
  return values;
}

template <class Member>
std::vector<double> collect(const LoadReport& report, const Member& member) {
  std::vector<double> values;
  for (const ChannelStatistics& one : report.evaluation.statistics) values.push_back(one.*member);
  return values;
}

void write_statistics(ResultFile& file, const std::string& group, const LoadReport& report) {
  const auto write = [&](const std::string& name, const auto& member,
                         const std::string& description) {
    file.write_values(group + "/" + name, collect(report, member),
                      {unit_of_channel, frame_of_channel, description, {channel_axis}});
  };
  write("mean", &ChannelStatistics::mean, "mean over time");
  write("standard_deviation", &ChannelStatistics::standard_deviation,
        "standard deviation over time, of the time series");
  write("minimum", &ChannelStatistics::minimum, "smallest value");
  write("maximum", &ChannelStatistics::maximum, "largest value");
  write("range", &ChannelStatistics::range, "maximum - minimum");
  file.write_values(group + "/time_of_minimum",
                    collect(report, &ChannelStatistics::time_of_minimum),
                    {"s", no_frame, "time of the first row with the minimum", {channel_axis}});
  file.write_values(group + "/time_of_maximum",
                    collect(report, &ChannelStatistics::time_of_maximum),
                    {"s", no_frame, "time of the first row with the maximum", {channel_axis}});
}

void write_events(ResultFile& file, const std::string& group, const LoadReport& report) {
  std::vector<std::string> names;
  std::vector<std::string> kinds;
  std::vector<double> times;
  RowMajor values(static_cast<Eigen::Index>(report.evaluation.events.size()),
                  report.series.values.cols());
  for (const loads::ExtremeEvent& event : report.evaluation.events) {
    values.row(static_cast<Eigen::Index>(names.size())) = report.series.values.row(event.row);
    names.push_back(report.series.names[static_cast<std::size_t>(event.channel)]);
    kinds.emplace_back(event.is_maximum ? "maximum" : "minimum");
    times.push_back(event.time);
  }
  file.write_texts(group + "/event/channel", names,
                   {"", no_frame, "channel of the extreme value", {event_axis}});
  file.write_texts(group + "/event/kind", kinds,
                   {"", no_frame, "minimum or maximum", {event_axis}});
  file.write_values(group + "/event/time", times,
                    {"s", no_frame, "time of each event", {event_axis}});
  file.write_array(group + "/event/values", flat(values), {names.size(), report.channels.size()},
                   {unit_of_channel,
                    frame_of_channel,
                    "values of all channels at the time of the event",
                    {event_axis, channel_axis}});
}

void write_harmonics(ResultFile& file, const std::string& group, const LoadReport& report) {
  if (!report.evaluation.harmonics) return;
  const loads::LoadHarmonics& harmonics = *report.evaluation.harmonics;
  const std::vector<std::size_t> shape{static_cast<std::size_t>(harmonics.amplitudes.rows()),
                                       report.channels.size()};
  std::vector<double> orders(shape.front());
  std::iota(orders.begin(), orders.end(), 0.0);
  file.write_values(group + "/harmonics/harmonic", orders,
                    {"1", no_frame, "harmonic k of the rotor speed", {"harmonic"}});
  file.write_array(group + "/harmonics/amplitude", flat(harmonics.amplitudes), shape,
                   {unit_of_channel,
                    frame_of_channel,
                    "y = sum of amplitude k * cos(k azimuth + phase k), the mean at k = 0",
                    {"harmonic", channel_axis}});
  file.write_array(group + "/harmonics/phase", flat(harmonics.phases), shape,
                   {"rad",
                    no_frame,
                    "phase from -pi to pi, relative to the azimuth",
                    {"harmonic", channel_axis}});
  file.set_attribute(group + "/harmonics", "revolutions",
                     static_cast<double>(harmonics.revolutions));
}

void write_rainflow(ResultFile& file, const std::string& group, const LoadReport& report) {
  std::vector<double> ranges;
  std::vector<double> means;
  std::vector<double> counts;
  for (const loads::RainflowTable& table : report.evaluation.tables) {
    ranges.insert(ranges.end(), table.range_edges.begin(), table.range_edges.end());
    means.insert(means.end(), table.mean_edges.begin(), table.mean_edges.end());
    const std::vector<double> all = flat(table.counts);
    counts.insert(counts.end(), all.begin(), all.end());
  }
  const std::size_t channels = report.channels.size();
  const std::size_t range_bins = ranges.size() / channels - 1;
  const std::size_t mean_bins = means.size() / channels - 1;
  file.write_array(group + "/rainflow/range_edges", ranges, {channels, range_bins + 1},
                   {unit_of_channel,
                    frame_of_channel,
                    "edges of the bins of ranges",
                    {channel_axis, "range_edge"}});
  file.write_array(group + "/rainflow/mean_edges", means, {channels, mean_bins + 1},
                   {unit_of_channel,
                    frame_of_channel,
                    "edges of the bins of means",
                    {channel_axis, "mean_edge"}});
  file.write_array(group + "/rainflow/counts", counts, {channels, range_bins, mean_bins},
                   {"1",
                    no_frame,
                    "number of cycles, a half cycle as 0.5, without Goodman's correction",
                    {channel_axis, "range_bin", "mean_bin"}});
}

void write_damage(ResultFile& file, const std::string& group,
                  const std::vector<std::vector<double>>& damage, std::size_t channels,
                  const LoadOptions& options, const std::string& description) {
  const std::vector<double>& exponents = options.evaluation.exponents;
  file.write_values(group + "/exponent", exponents,
                    {"1", no_frame, "m of the S-N curve", {"exponent"}});
  file.write_array(group + "/equivalent_load", flat(damage), {channels, exponents.size()},
                   {unit_of_channel, frame_of_channel, description, {channel_axis, "exponent"}});
  file.set_attribute(group, "equivalent_frequency", options.evaluation.frequency);
}

void write_report(ResultFile& file, const std::string& group, const LoadReport& report,
                  const LoadOptions& options) {
  file.write_channels(group, report.channels);
  write_statistics(file, group, report);
  write_events(file, group, report);
  write_harmonics(file, group, report);
  write_rainflow(file, group, report);
  write_damage(file, group + "/damage", report.evaluation.damage, report.channels.size(), options,
               "range of equal cycles that cause the same damage; their number is "
               "equivalent_frequency [Hz] times the duration");
  const loads::LoadSeries& series = report.series;
  file.set_attribute(group, "source", report.source);
  file.set_attribute(group, "rows", static_cast<double>(series.times.size()));
  file.set_attribute(group, "from", series.times(0));
  file.set_attribute(group, "duration", loads::duration(series));
  file.set_attribute(group, "period", series.period);
}

std::string csv_word(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string word = "\"";
  for (const char c : text) word += c == '"' ? std::string("\"\"") : std::string(1, c);
  return word + "\"";
}

}  // namespace

void write_loads(ResultFile& file, const std::vector<LoadReport>& reports,
                 const LifetimeReport& lifetime, const LoadOptions& options) {
  const std::string top = "/loads";
  for (std::size_t i = 0; i < reports.size(); ++i)
    write_report(file, reports.size() == 1 ? top : top + "/" + std::to_string(i + 1), reports[i],
                 options);
  if (lifetime.damage.empty()) return;
  const std::string group = top + "/lifetime";
  const std::vector<turbine::Channel>& channels = reports.front().channels;
  file.write_channels(group, channels);
  file.write_values(
      group + "/hours", lifetime.hours,
      {"h", no_frame, "hours of the lifetime that each result represents", {"result"}});
  write_damage(file, group, lifetime.damage, channels.size(), options,
               "range of equal cycles that cause the damage of the lifetime");
  if (options.equivalent_cycles)
    file.set_attribute(group, "equivalent_cycles", *options.equivalent_cycles);
}

void write_load_table(const std::string& path, const std::vector<LoadReport>& reports,
                      const LifetimeReport& lifetime, const LoadOptions& options) {
  std::ostringstream text;
  text.precision(17);
  text << load_table_start
       << "standard_deviation,minimum,time_of_minimum,maximum,time_of_maximum,range";
  for (const double exponent : options.evaluation.exponents)
    text << ",equivalent_load_" << std::defaultfloat << exponent;
  text << '\n';
  for (const LoadReport& report : reports)
    for (std::size_t c = 0; c < report.channels.size(); ++c) {
      const ChannelStatistics& one = report.evaluation.statistics[c];
      text << csv_word(report.source) << ',' << report.channels[c].name << ','
           << report.channels[c].unit << ',' << one.mean << ',' << one.standard_deviation << ','
           << one.minimum << ',' << one.time_of_minimum << ',' << one.maximum << ','
           << one.time_of_maximum << ',' << one.range;
      for (const double load : report.evaluation.damage[c]) text << ',' << load;
      text << '\n';
    }
  for (std::size_t c = 0; c < lifetime.damage.size(); ++c) {
    const turbine::Channel& channel = reports.front().channels[c];
    text << "lifetime," << channel.name << ',' << channel.unit << ",,,,,,,";
    for (const double load : lifetime.damage[c]) text << ',' << load;
    text << '\n';
  }
  write_whole_file(path, text.str());
}

}  // namespace samara::io
