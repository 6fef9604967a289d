#include "load_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "table.hpp"

namespace samara::drivers {
namespace {

/// Tables with more columns than these are only in the result.
constexpr std::size_t most_event_columns = 8;
constexpr Eigen::Index most_range_columns = 20;

constexpr int digits = 5;

/// Relative to a channel's largest value. Smaller values are round-off.
constexpr double round_off = 1e-12;

/// Text of `value`, of a channel with these extremes.
std::string word_of(double value, const loads::ChannelStatistics& extremes) {
  const double largest = std::max(std::abs(extremes.minimum), std::abs(extremes.maximum));
  return general(std::abs(value) < round_off * largest ? 0.0 : value, digits);
}

Table channel_table() {
  Table table;
  table.add_column("channel", "", Align::left);
  table.add_column("unit", "", Align::left);
  return table;
}

void add_exponents(Table& table, const io::LoadOptions& options) {
  for (const double exponent : options.evaluation.exponents)
    table.add_column("DEL m=" + general(exponent, 4), "of unit");
}

std::string headline(const io::LoadReport& report) {
  const loads::LoadSeries& series = report.series;
  const auto rows = static_cast<int>(series.times.size());
  std::string text = "source       " + report.source + ": ";
  if (series.is_periodic())
    return text + "one revolution of the steady state, " + general(series.period, 6) + " s at " +
           std::to_string(rows) + " azimuths\n";
  return text + "time series, " + count(rows, "row") + " from t = " + general(series.times(0), 6) +
         " to " + general(series.times(rows - 1), 6) + " s\n";
}

std::string statistics_table(const io::LoadReport& report, const io::LoadOptions& options) {
  Table table = channel_table();
  table.add_column("mean", "of unit");
  table.add_column("deviation", "of unit");
  table.add_column("minimum", "of unit");
  table.add_column("at", "s");
  table.add_column("maximum", "of unit");
  table.add_column("at", "s");
  add_exponents(table, options);
  for (std::size_t c = 0; c < report.channels.size(); ++c) {
    const loads::ChannelStatistics& one = report.evaluation.statistics[c];
    std::vector<std::string> row{report.channels[c].name,   report.channels[c].unit,
                                 word_of(one.mean, one),    word_of(one.standard_deviation, one),
                                 word_of(one.minimum, one), general(one.time_of_minimum, digits),
                                 word_of(one.maximum, one), general(one.time_of_maximum, digits)};
    for (const double load : report.evaluation.damage[c]) row.push_back(general(load, digits));
    table.add_row(row);
  }
  return "statistics, and damage-equivalent loads (DEL): ranges of cycles at " +
         general(options.evaluation.frequency, 4) + " Hz that cause the same damage\n\n" +
         table.text();
}

std::string event_table(const io::LoadReport& report) {
  const std::string title = "extreme events: all channels at the time of each extreme value";
  if (report.channels.size() > most_event_columns)
    return title + "\nare in the result (-o) where there are more than " +
           std::to_string(most_event_columns) + " channels; hint: --set channels=[...]\n";
  Table table;
  table.add_column("extreme", "", Align::left);
  table.add_column("of", "", Align::left);
  table.add_column("t", "s");
  for (const turbine::Channel& channel : report.channels)
    table.add_column(channel.name, channel.unit);
  for (const loads::ExtremeEvent& event : report.evaluation.events) {
    std::vector<std::string> row{event.is_maximum ? "maximum" : "minimum",
                                 report.series.names[static_cast<std::size_t>(event.channel)],
                                 general(event.time, digits)};
    for (Eigen::Index c = 0; c < report.series.values.cols(); ++c)
      row.push_back(word_of(report.series.values(event.row, c),
                            report.evaluation.statistics[static_cast<std::size_t>(c)]));
    table.add_row(row);
  }
  return title + "\n\n" + table.text();
}

std::string harmonic_table(const io::LoadReport& report) {
  if (!report.evaluation.harmonics)
    return "no harmonics: " + report.evaluation.why_no_harmonics + "\n";
  const loads::LoadHarmonics& harmonics = *report.evaluation.harmonics;
  Table table = channel_table();
  table.add_column("mean", "of unit");
  for (Eigen::Index k = 1; k < harmonics.amplitudes.rows(); ++k) {
    table.add_column(std::to_string(k) + "P", "of unit");
    table.add_column("phase", "deg");
  }
  for (std::size_t c = 0; c < report.channels.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    const loads::ChannelStatistics& extremes = report.evaluation.statistics[c];
    std::vector<std::string> row{report.channels[c].name, report.channels[c].unit,
                                 word_of(harmonics.amplitudes(0, column), extremes)};
    for (Eigen::Index k = 1; k < harmonics.amplitudes.rows(); ++k) {
      row.push_back(word_of(harmonics.amplitudes(k, column), extremes));
      const double degrees = harmonics.phases(k, column) * 180.0 / std::numbers::pi;
      row.push_back(row.back() == "0" ? "" : fixed(degrees, 1));
    }
    table.add_row(row);
  }
  return "harmonics of the rotor speed, amplitude cos(k azimuth + phase), over " +
         count(harmonics.revolutions, "revolution") + "\n\n" + table.text();
}

std::string rainflow_table(const io::LoadReport& report) {
  const std::string title = "rainflow cycles by range, in equal parts of the largest one";
  const Eigen::Index bins = report.evaluation.tables.front().counts.rows();
  if (bins > most_range_columns)
    return title + "\nare in the result (-o) where there are more than " +
           std::to_string(most_range_columns) + " bins\n";
  Table table = channel_table();
  table.add_column("largest", "of unit");
  for (Eigen::Index i = 0; i < bins; ++i)
    table.add_column("to " + general(static_cast<double>(i + 1) / static_cast<double>(bins), 3),
                     "1");
  for (std::size_t c = 0; c < report.channels.size(); ++c) {
    const loads::RainflowTable& one = report.evaluation.tables[c];
    std::vector<std::string> row{report.channels[c].name, report.channels[c].unit,
                                 general(one.range_edges(bins), digits)};
    for (Eigen::Index i = 0; i < bins; ++i) row.push_back(general(one.counts.row(i).sum(), 6));
    table.add_row(row);
  }
  return title + "\n\n" + table.text();
}

}  // namespace

std::string load_tables(const io::LoadReport& report, const io::LoadOptions& options) {
  return headline(report) + "\n" + statistics_table(report, options) + "\n" + event_table(report) +
         "\n" + harmonic_table(report) + "\n" + rainflow_table(report) + "\n";
}

std::string lifetime_table(const std::vector<io::LoadReport>& reports,
                           const io::LifetimeReport& lifetime, const io::LoadOptions& options) {
  if (lifetime.damage.empty()) return "";
  double hours = 0.0;
  for (const double one : lifetime.hours) hours += one;
  std::string text = "lifetime of " + general(hours, 6) + " h: damage-equivalent loads of ";
  text += options.equivalent_cycles
              ? general(*options.equivalent_cycles, 4) + " cycles"
              : "cycles at " + general(options.evaluation.frequency, 4) + " Hz";
  Table table = channel_table();
  add_exponents(table, options);
  const std::vector<turbine::Channel>& channels = reports.front().channels;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    std::vector<std::string> row{channels[c].name, channels[c].unit};
    for (const double load : lifetime.damage[c]) row.push_back(general(load, digits));
    table.add_row(row);
  }
  return text + "\n\n" + table.text() + "\n";
}

}  // namespace samara::drivers
