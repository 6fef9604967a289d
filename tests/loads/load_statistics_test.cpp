#include "samara/loads/load_statistics.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "load_series_examples.hpp"

using namespace samara;
using namespace samara::test;
using loads::ChannelStatistics;
using loads::LoadSeries;

namespace {

constexpr double round_off = 1e-13;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

ChannelStatistics statistics_of(const std::vector<double>& times,
                                const std::vector<double>& values) {
  return loads::compute_statistics(one_channel(column(times), column(values))).front();
}

/// n rows of a period of 2 s of 3 + 0.5 cos.
LoadSeries one_period(Eigen::Index n) {
  LoadSeries series;
  series.names = {"load"};
  series.period = 2.0;
  series.times.setZero(n);
  series.values.setZero(n, 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    series.times(k) = series.period * static_cast<double>(k) / static_cast<double>(n);
    series.values(k, 0) = 3.0 + 0.5 * std::cos(phase);
  }
  return series;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(load_statistics)

/// Weights by hand: 1/2, 2 and 3/2 of 4 s.
BOOST_AUTO_TEST_CASE(uneven_steps_weigh_by_their_length) {
  const ChannelStatistics one = statistics_of({10.0, 11.0, 14.0}, {2.0, 4.0, 0.0});
  BOOST_TEST(std::abs(one.mean - 2.25) < round_off);
  BOOST_TEST(std::abs(one.standard_deviation - std::sqrt(3.4375)) < round_off);
  BOOST_TEST(one.minimum == 0.0);
  BOOST_TEST(one.maximum == 4.0);
  BOOST_TEST(one.range == 4.0);
  BOOST_TEST(one.time_of_minimum == 14.0);
  BOOST_TEST(one.time_of_maximum == 11.0);
  BOOST_TEST(one.row_of_minimum == 2);
  BOOST_TEST(one.row_of_maximum == 1);
}

BOOST_AUTO_TEST_CASE(rows_on_a_straight_line_do_not_change_the_mean) {
  const ChannelStatistics coarse = statistics_of({0.0, 2.0, 3.0}, {1.0, 5.0, -2.0});
  const ChannelStatistics fine =
      statistics_of({0.0, 0.1, 0.2, 1.5, 2.0, 2.9, 3.0}, {1.0, 1.2, 1.4, 4.0, 5.0, -1.3, -2.0});
  BOOST_TEST(std::abs(coarse.mean - fine.mean) < round_off);
}

/// The standard deviation of a ramp of height 1 is 1/sqrt(12); the trapezoidal rule of its square
/// is of second order.
BOOST_AUTO_TEST_CASE(standard_deviation_of_a_ramp_with_uneven_steps_is_of_second_order) {
  const auto error_with = [](int steps) {
    std::vector<double> times;
    for (int k = 0; k <= steps; ++k) times.push_back(std::pow(static_cast<double>(k) / steps, 1.5));
    return std::abs(statistics_of(times, times).standard_deviation - 1.0 / std::sqrt(12.0));
  };
  BOOST_TEST(error_with(100) < 1e-3);
  BOOST_TEST(std::log2(error_with(100) / error_with(200)) > 1.9);
}

BOOST_AUTO_TEST_CASE(a_period_counts_its_last_step_too) {
  const ChannelStatistics one = loads::compute_statistics(one_period(8)).front();
  BOOST_TEST(std::abs(one.mean - 3.0) < round_off);
  BOOST_TEST(std::abs(one.standard_deviation - 0.5 / std::sqrt(2.0)) < round_off);
  BOOST_TEST(loads::duration(one_period(8)) == 2.0);
}

BOOST_AUTO_TEST_CASE(one_row_is_a_period_that_does_not_change) {
  const ChannelStatistics one = loads::compute_statistics(one_period(1)).front();
  BOOST_TEST(one.mean == 3.5);
  BOOST_TEST(one.standard_deviation == 0.0);
  BOOST_TEST(one.range == 0.0);
}

/// Squares of 1e9 leave nothing of swings of 1e-3 (double precision holds 1e-7 at 1e9).
BOOST_AUTO_TEST_CASE(small_swings_about_a_large_mean_keep_their_digits) {
  LoadSeries series = one_period(100);
  series.values.array() = 1e9 + 1e-3 * (series.values.array() - 3.0);
  const ChannelStatistics one = loads::compute_statistics(series).front();
  BOOST_TEST(std::abs(one.standard_deviation / (0.5e-3 / std::sqrt(2.0)) - 1.0) < 1e-3);
}

BOOST_AUTO_TEST_CASE(extreme_events_have_the_first_row_of_each_extreme) {
  LoadSeries series;
  series.names = {"flap", "edge"};
  series.times = column({0.0, 0.5, 2.0, 2.5});
  series.values.resize(4, 2);
  series.values << 1.0, 7.0, 3.0, 8.0, -4.0, 9.0, 3.0, 5.0;
  const std::vector<loads::ExtremeEvent> events = loads::find_extreme_events(series);
  BOOST_REQUIRE(events.size() == 4U);
  const std::vector<Eigen::Index> rows = {2, 1, 3, 2};
  for (std::size_t i = 0; i < events.size(); ++i) {
    BOOST_TEST(events[i].channel == static_cast<Eigen::Index>(i / 2));
    BOOST_TEST(events[i].is_maximum == (i % 2 == 1));
    BOOST_TEST(events[i].row == rows[i]);
    BOOST_TEST(events[i].time == series.times(rows[i]));
  }
  // The edge load at the time of the smallest flap load.
  BOOST_TEST(series.values(events[0].row, 1) == 9.0);
}

BOOST_AUTO_TEST_CASE(what_has_no_statistics_is_refused) {
  const auto refuse = [](const std::vector<double>& times, const std::vector<double>& values,
                         const std::string& part) {
    check_refused([&] { statistics_of(times, values); }, part);
  };
  refuse({}, {}, "too few rows: 0");
  refuse({0.0}, {1.0}, "too few rows: 1");
  refuse({0.0, 1.0, 2.0}, {1.0, not_a_number, 1.0},
         "load: row 2 (time 1 s) is not a finite number");
  refuse({0.0, not_a_number}, {1.0, 2.0}, "time: row 2 is not a finite number");
  refuse({0.0, 1.0, 1.0}, {1.0, 2.0, 3.0}, "times must grow");
  refuse({0.0, 1.0, 0.5}, {1.0, 2.0, 3.0}, "time: row 3 has 0.5 s after 1 s");
}

BOOST_AUTO_TEST_CASE(errors_of_a_series_come_all_at_once) {
  LoadSeries series;
  series.names = {"flap", "edge"};
  series.times = column({0.0, 1.0, 1.0});
  series.values = Eigen::MatrixXd::Constant(3, 2, not_a_number);
  for (const char* part : {"times must grow", "flap: row 1", "edge: row 1"})
    check_refused([&] { loads::check(series); }, part);
}

BOOST_AUTO_TEST_CASE(a_series_without_channels_is_refused) {
  LoadSeries series;
  series.times = column({0.0, 1.0});
  series.values.resize(2, 0);
  check_refused([&] { loads::check(series); }, "no channel");
}

BOOST_AUTO_TEST_CASE(a_period_must_not_repeat_its_first_row) {
  LoadSeries series = one_period(4);
  series.period = series.times(3);
  check_refused([&] { loads::check(series); }, "must not be repeated");
  series.period = not_a_number;
  check_refused([&] { loads::check(series); }, "the period must be");
}

BOOST_AUTO_TEST_CASE(columns_of_different_lengths_are_a_defect) {
  LoadSeries series = one_period(4);
  series.times = column({0.0, 1.0});
  BOOST_CHECK_THROW(loads::check(series), InternalError);
}

BOOST_AUTO_TEST_SUITE_END()
