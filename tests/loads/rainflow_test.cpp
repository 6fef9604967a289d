#include "samara/loads/rainflow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "load_series_examples.hpp"

using namespace samara;
using namespace samara::test;
using loads::Cycle;

namespace {

/// ASTM E1049-85, figures 6 and 7.
const Eigen::VectorXd astm = column({-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0});

/// Cycles by range and mean, in units of `unit`: what is counted, in whatever order and in however
/// many parts.
using Counts = std::map<std::pair<long, long>, double>;

constexpr double unit = 1e-9;

Counts counts_of(const std::vector<Cycle>& cycles, double times = 1.0, Counts counts = {}) {
  for (const Cycle& cycle : cycles)
    counts[{std::lround(cycle.range / unit), std::lround(cycle.mean / unit)}] +=
        times * cycle.count;
  std::erase_if(counts, [](const auto& entry) { return entry.second == 0.0; });
  return counts;
}

std::map<double, double> counts_by_range(const std::vector<Cycle>& cycles) {
  std::map<double, double> counts;
  for (const Cycle& cycle : cycles) counts[cycle.range] += cycle.count;
  return counts;
}

double total(const std::vector<Cycle>& cycles) {
  double sum = 0.0;
  for (const Cycle& cycle : cycles) sum += cycle.count;
  return sum;
}

/// Real numbers, or whole ones with many ties.
Eigen::VectorXd random_values(Eigen::Index size, unsigned seed, bool whole) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-4.0, 4.0);
  Eigen::VectorXd values(size);
  for (double& entry : values) entry = whole ? std::round(value(random)) : value(random);
  return values;
}

Eigen::VectorXd turned_by(const Eigen::VectorXd& values, Eigen::Index rows) {
  Eigen::VectorXd turned(values.size());
  turned << values.tail(values.size() - rows), values.head(rows);
  return turned;
}

Eigen::VectorXd repeated(const Eigen::VectorXd& values, int times) {
  return values.replicate(times, 1);
}

/// Peaks, valleys and both ends, by comparing each value with its neighbours.
std::vector<double> naive_turning_points(const Eigen::VectorXd& values) {
  std::vector<double> distinct;
  for (const double value : values)
    if (distinct.empty() || distinct.back() != value) distinct.push_back(value);
  std::vector<double> points;
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    const bool is_end = i == 0 || i + 1 == distinct.size();
    if (is_end || (distinct[i] > distinct[i - 1]) != (distinct[i + 1] > distinct[i]))
      points.push_back(distinct[i]);
  }
  return points;
}

/// The four-point method (Amzallag et al., Int. J. Fatigue 16 (1994), 287-293), searched from the
/// beginning again after each cycle: an inner range that both its neighbours cover is a cycle. What
/// is left counts half.
std::vector<Cycle> four_point_count(const Eigen::VectorXd& values) {
  std::vector<double> points = naive_turning_points(values);
  std::vector<Cycle> cycles;
  const auto range = [&points](std::size_t i) { return std::abs(points[i + 1] - points[i]); };
  for (bool found = true; found;) {
    found = false;
    for (std::size_t i = 0; i + 3 < points.size() && !found; ++i) {
      if (range(i + 1) > range(i) || range(i + 1) > range(i + 2)) continue;
      found = true;
      cycles.push_back({range(i + 1), 0.5 * (points[i + 1] + points[i + 2]), 1.0});
      points.erase(points.begin() + static_cast<long>(i) + 1,
                   points.begin() + static_cast<long>(i) + 3);
    }
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    cycles.push_back({range(i), 0.5 * (points[i] + points[i + 1]), 0.5});
  return cycles;
}

/// Rychlik's definition (Int. J. Fatigue 9 (1987), 119-121) on a circle: a peak belongs to the
/// higher of the lowest values before and after it, up to where the load gets above the peak.
std::vector<Cycle> rychlik_count(const Eigen::VectorXd& values) {
  const Eigen::Index n = values.size();
  const auto at = [&](Eigen::Index i) { return values(((i % n) + n) % n); };
  std::vector<Cycle> cycles;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double peak = at(i);
    if (at(i - 1) > peak || at(i + 1) > peak) continue;
    const auto lowest = [&](Eigen::Index direction) {
      double low = peak;
      for (Eigen::Index k = 1; k < n && at(i + direction * k) <= peak; ++k)
        low = std::min(low, at(i + direction * k));
      return low;
    };
    const double valley = std::max(lowest(1), lowest(-1));
    cycles.push_back({peak - valley, 0.5 * (peak + valley), 1.0});
  }
  return cycles;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(rainflow)

/// Counts after ASTM E1049-85, figure 6; means as MathWorks print them for `rainflow` of the same
/// load (Signal Processing Toolbox, reference page).
BOOST_AUTO_TEST_CASE(the_example_of_the_standard_is_counted_as_in_the_standard) {
  const std::vector<Cycle> cycles = loads::count_cycles(astm);
  const std::map<double, double> expected = {
      {3.0, 0.5}, {4.0, 1.5}, {6.0, 0.5}, {8.0, 1.0}, {9.0, 0.5}};
  BOOST_TEST((counts_by_range(cycles) == expected));
  const std::vector<Cycle> with_means = {{3.0, -0.5, 0.5}, {4.0, -1.0, 0.5}, {4.0, 1.0, 1.0},
                                         {8.0, 1.0, 0.5},  {9.0, 0.5, 0.5},  {8.0, 0.0, 0.5},
                                         {6.0, 1.0, 0.5}};
  BOOST_TEST((counts_of(cycles) == counts_of(with_means)));
}

/// ASTM E1049-85, figure 7: the same load, repeated.
BOOST_AUTO_TEST_CASE(the_repeated_example_of_the_standard_has_four_cycles) {
  const std::map<double, double> expected = {{3.0, 1.0}, {4.0, 1.0}, {7.0, 1.0}, {9.0, 1.0}};
  BOOST_TEST((counts_by_range(loads::count_periodic_cycles(astm.head(8))) == expected));
  // The first point once more at the end adds nothing.
  BOOST_TEST((counts_by_range(loads::count_periodic_cycles(astm)) == expected));
}

/// Printed by the Python package `rainflow` 3.1.0 (P. Janiszewski) for the series of its page.
BOOST_AUTO_TEST_CASE(a_sum_of_sines_is_counted_as_another_program_does) {
  Eigen::VectorXd values(201);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double t = 4.0 * static_cast<double>(i) / 200.0;
    values(i) = 0.2 + 0.5 * std::sin(t) + 0.2 * std::cos(10.0 * t) + 0.2 * std::sin(4.0 * t);
  }
  const std::vector<std::pair<double, double>> printed = {
      {0.04258965150708488, 0.5}, {0.10973439445727551, 1.0}, {0.11294628078612906, 0.5},
      {0.2057106991158965, 1.0},  {0.21467990941625242, 1.0}, {0.4388985979776988, 1.0},
      {0.48305748051348263, 0.5}, {0.5286423866535466, 0.5},  {0.7809330293159786, 0.5},
      {1.4343610172143002, 0.5}};
  const std::map<double, double> counted = counts_by_range(loads::count_cycles(values));
  BOOST_REQUIRE(counted.size() == printed.size());
  auto own = counted.begin();
  for (const auto& [range, count] : printed) {
    BOOST_TEST(std::abs(own->first - range) < 1e-14);
    BOOST_TEST(own->second == count);
    ++own;
  }
}

BOOST_AUTO_TEST_CASE(random_loads_are_counted_as_by_the_four_point_method) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    const Eigen::VectorXd values = random_values(2 + seed % 57, seed, seed % 2 == 0);
    if (values.minCoeff() == values.maxCoeff()) continue;
    BOOST_TEST_INFO("seed " << seed);
    BOOST_TEST((counts_of(loads::count_cycles(values)) == counts_of(four_point_count(values))));
  }
}

/// One period more adds the cycles of a period.
BOOST_AUTO_TEST_CASE(periodic_cycles_are_what_another_period_adds) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Eigen::VectorXd values = random_values(2 + seed % 29, seed, seed % 2 == 0);
    const Counts added = counts_of(four_point_count(repeated(values, 4)), 1.0,
                                   counts_of(four_point_count(repeated(values, 3)), -1.0));
    BOOST_TEST_INFO("seed " << seed);
    BOOST_TEST((counts_of(loads::count_periodic_cycles(values)) == added));
  }
}

BOOST_AUTO_TEST_CASE(periodic_cycles_are_those_of_rychliks_definition) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Eigen::VectorXd values = random_values(2 + seed % 43, seed, false);
    BOOST_TEST_INFO("seed " << seed);
    BOOST_TEST(
        (counts_of(loads::count_periodic_cycles(values)) == counts_of(rychlik_count(values))));
  }
}

BOOST_AUTO_TEST_CASE(every_range_between_turning_points_counts_half_a_cycle) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Eigen::VectorXd values = random_values(40, seed, seed % 2 == 0);
    const auto points = static_cast<double>(loads::find_turning_points(values).size());
    BOOST_TEST(total(loads::count_cycles(values)) == 0.5 * (points - 1.0));
    for (const Cycle& cycle : loads::count_periodic_cycles(values)) BOOST_TEST(cycle.count == 1.0);
  }
}

BOOST_AUTO_TEST_CASE(periodic_cycles_do_not_depend_on_start_direction_or_sign) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Eigen::VectorXd values = random_values(30, seed, seed % 2 == 0);
    const Counts counts = counts_of(loads::count_periodic_cycles(values));
    BOOST_TEST((counts_of(loads::count_periodic_cycles(turned_by(values, seed % 30))) == counts));
    BOOST_TEST((counts_of(loads::count_periodic_cycles(values.reverse())) == counts));
    std::vector<Cycle> negative = loads::count_periodic_cycles(-values);
    for (Cycle& cycle : negative) cycle.mean = -cycle.mean;
    BOOST_TEST((counts_of(negative) == counts));
  }
}

BOOST_AUTO_TEST_CASE(ranges_and_means_scale_and_shift_with_the_load) {
  const Eigen::VectorXd values = random_values(60, 5, false);
  std::vector<Cycle> cycles = loads::count_cycles(values);
  for (Cycle& cycle : cycles) {
    cycle.range *= 8.0;
    cycle.mean = 8.0 * cycle.mean - 3.0;
  }
  const Eigen::VectorXd other = 8.0 * values.array() - 3.0;
  BOOST_TEST((counts_of(loads::count_cycles(other)) == counts_of(cycles)));
}

BOOST_AUTO_TEST_CASE(turning_points_are_those_of_a_comparison_of_neighbours) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Eigen::VectorXd values = random_values(40, seed, true);
    BOOST_TEST((loads::find_turning_points(values) == naive_turning_points(values)));
  }
}

BOOST_AUTO_TEST_CASE(a_plateau_is_one_turning_point) {
  const std::vector<double> expected = {0.0, 2.0, 1.0, 3.0};
  BOOST_TEST((loads::find_turning_points(
                  column({0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 1.0, 1.0, 2.0, 3.0, 3.0})) == expected));
}

BOOST_AUTO_TEST_CASE(a_constant_has_no_cycles) {
  const Eigen::VectorXd constant = Eigen::VectorXd::Constant(5, 7.0);
  BOOST_TEST(loads::find_turning_points(constant).size() == 1U);
  BOOST_TEST(loads::count_cycles(constant).empty());
  BOOST_TEST(loads::count_periodic_cycles(constant).empty());
  BOOST_TEST(loads::count_periodic_cycles(column({1.0})).empty());
}

/// Three periods of amplitude 1 with a ripple of 0.01 in alternate rows, which turns the load back
/// where it is slow, and moves its extremes by no more than itself.
BOOST_AUTO_TEST_CASE(a_gate_leaves_a_ripple_out) {
  const double ripple = 0.01;
  const Eigen::Index rows = 240;
  Eigen::VectorXd values(rows);
  for (Eigen::Index i = 0; i < rows; ++i)
    values(i) = std::cos(6.0 * std::numbers::pi * static_cast<double>(i) / rows) +
                (i % 2 == 0 ? ripple : -ripple);
  BOOST_TEST(loads::count_periodic_cycles(values).size() > 3U);
  const std::vector<Cycle> cycles = loads::count_periodic_cycles(values, 0.02);
  BOOST_REQUIRE(cycles.size() == 3U);
  for (const Cycle& cycle : cycles) BOOST_TEST(std::abs(cycle.range - 2.0) <= 2.0 * ripple);
}

BOOST_AUTO_TEST_CASE(a_gate_keeps_the_extremes_and_nothing_below_it) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Eigen::VectorXd values = random_values(50, seed, seed % 2 == 0);
    const double gate = 0.01 * (seed % 100);
    const std::vector<double> points = loads::find_turning_points(values, gate);
    BOOST_TEST(*std::max_element(points.begin(), points.end()) == values.maxCoeff());
    BOOST_TEST(*std::min_element(points.begin(), points.end()) == values.minCoeff());
    const double least = gate * (values.maxCoeff() - values.minCoeff());
    for (std::size_t i = 1; i < points.size(); ++i)
      BOOST_TEST(std::abs(points[i] - points[i - 1]) > least);
    for (std::size_t i = 2; i < points.size(); ++i)
      BOOST_TEST((points[i] > points[i - 1]) != (points[i - 1] > points[i - 2]));
  }
}

BOOST_AUTO_TEST_CASE(a_channel_of_a_series_is_counted_by_its_kind) {
  loads::LoadSeries series;
  series.names = {"constant", "load"};
  series.times = Eigen::VectorXd::LinSpaced(9, 0.0, 8.0);
  series.values = Eigen::MatrixXd::Zero(9, 2);
  series.values.col(1) = astm;
  BOOST_TEST(loads::count_cycles(series, 0).empty());
  BOOST_TEST((counts_of(loads::count_cycles(series, 1)) == counts_of(loads::count_cycles(astm))));
  series.period = 9.0;
  BOOST_TEST(
      (counts_of(loads::count_cycles(series, 1)) == counts_of(loads::count_periodic_cycles(astm))));
  BOOST_CHECK_THROW(loads::count_cycles(series, 2), InternalError);
}

/// Ranges to 9 and means from -1 to 1, in three and two bins.
BOOST_AUTO_TEST_CASE(a_table_has_every_cycle_in_its_bin) {
  const loads::RainflowTable table = loads::tabulate_cycles(loads::count_cycles(astm), 3, 2);
  BOOST_TEST((table.range_edges - column({0.0, 3.0, 6.0, 9.0})).norm() < 1e-14);
  BOOST_TEST((table.mean_edges - column({-1.0, 0.0, 1.0})).norm() < 1e-14);
  Eigen::MatrixXd expected(3, 2);
  expected << 0.0, 0.0, 1.0, 1.0, 0.0, 2.0;
  BOOST_TEST((table.counts - expected).norm() == 0.0);
}

BOOST_AUTO_TEST_CASE(a_table_of_equal_means_is_as_wide_as_the_largest_range) {
  const loads::RainflowTable table = loads::tabulate_cycles({{4.0, 1.0, 2.0}}, 2, 2);
  BOOST_TEST((table.mean_edges - column({-1.0, 1.0, 3.0})).norm() < 1e-14);
  BOOST_TEST(table.counts(1, 1) == 2.0);
  BOOST_TEST(loads::tabulate_cycles({}, 2, 2).counts.sum() == 0.0);
}

BOOST_AUTO_TEST_CASE(a_table_loses_no_cycle) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const std::vector<Cycle> cycles = loads::count_cycles(random_values(100, seed, false));
    BOOST_TEST(loads::tabulate_cycles(cycles, 7, 13).counts.sum() == total(cycles));
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_counted_is_refused) {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  check_refused([] { loads::count_cycles(Eigen::VectorXd()); }, "no values");
  check_refused([] { loads::count_periodic_cycles(Eigen::VectorXd()); }, "no values");
  check_refused([&] { loads::count_cycles(column({0.0, not_a_number})); }, "row 2");
  check_refused([&] { loads::count_periodic_cycles(column({not_a_number})); }, "row 1");
  check_refused([] { loads::count_cycles(astm, 1.0); }, "gate");
  check_refused([] { loads::count_cycles(astm, -0.1); }, "gate");
  check_refused([] { loads::tabulate_cycles({}, 0, 5); }, "bins");
}

BOOST_AUTO_TEST_SUITE_END()
