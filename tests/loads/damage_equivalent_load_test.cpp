#include "samara/loads/damage_equivalent_load.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "load_series_examples.hpp"

using namespace samara;
using namespace samara::test;
using loads::Cycle;
using loads::DamageOptions;
using loads::LoadCase;

namespace {

/// Relative, of powers and roots.
constexpr double round_off = 1e-12;

bool is_close(double a, double b) { return std::abs(a - b) <= round_off * std::abs(b); }

/// mean + amplitude cos, from a peak to a peak `periods` later, 40 rows a period.
Eigen::VectorXd cosine(int periods, double mean, double amplitude) {
  const Eigen::Index rows = 40 * periods + 1;
  Eigen::VectorXd values(rows);
  for (Eigen::Index i = 0; i < rows; ++i)
    values(i) = mean + amplitude * std::cos(std::numbers::pi * static_cast<double>(i) / 20.0);
  return values;
}

/// ASTM E1049-85, figure 6.
std::vector<Cycle> standard_example() {
  return loads::count_cycles(column({-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0}));
}

DamageOptions options_with(std::vector<double> exponents, double frequency = 1.0) {
  DamageOptions options;
  options.exponents = std::move(exponents);
  options.frequency = frequency;
  return options;
}

double one_load(const std::vector<Cycle>& cycles, double duration, const DamageOptions& options) {
  return loads::compute_damage_equivalent_loads(cycles, duration, options).front();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(damage_equivalent_load)

/// n cycles of range 2 A: 2 A (n / (f_eq T))^(1/m).
BOOST_AUTO_TEST_CASE(a_sine_has_its_range_times_the_root_of_the_ratio_of_cycles) {
  const double duration = 35.0;
  const DamageOptions options = options_with({1.0, 3.0, 4.0, 10.0, 12.0}, 0.7);
  const std::vector<Cycle> cycles = loads::count_cycles(cosine(12, 3.0, 5.0));
  const std::vector<double> loads =
      loads::compute_damage_equivalent_loads(cycles, duration, options);
  BOOST_REQUIRE(loads.size() == options.exponents.size());
  for (std::size_t i = 0; i < loads.size(); ++i)
    BOOST_TEST(
        is_close(loads[i], 10.0 * std::pow(12.0 / (0.7 * duration), 1.0 / options.exponents[i])));
}

/// sum n R = 23 and sum n R^2 = 151 of the counts in the standard's figure 6.
BOOST_AUTO_TEST_CASE(the_example_of_the_standard_has_the_sums_of_its_table) {
  const std::vector<double> loads = loads::compute_damage_equivalent_loads(
      standard_example(), 4.0, options_with({1.0, 2.0}, 0.5));
  BOOST_TEST(is_close(loads[0], 23.0 / 2.0));
  BOOST_TEST(is_close(loads[1], std::sqrt(151.0 / 2.0)));
}

BOOST_AUTO_TEST_CASE(loads_scale_with_the_series) {
  std::vector<Cycle> cycles = standard_example();
  const DamageOptions options = options_with({7.0});
  const double load = one_load(cycles, 8.0, options);
  for (Cycle& cycle : cycles) cycle.range *= 1e6;
  BOOST_TEST(is_close(one_load(cycles, 8.0, options), 1e6 * load));
}

/// (9e150)^400 is no number; the largest range is what is left for large exponents.
BOOST_AUTO_TEST_CASE(large_exponents_tend_to_the_largest_range) {
  std::vector<Cycle> cycles = standard_example();
  for (Cycle& cycle : cycles) cycle.range *= 1e150;
  const double load = one_load(cycles, 1.0, options_with({400.0}));
  BOOST_TEST(is_close(load, 9e150 * std::pow(0.5, 1.0 / 400.0)));
}

BOOST_AUTO_TEST_CASE(a_constant_does_no_damage) {
  BOOST_TEST(one_load({}, 10.0, options_with({4.0})) == 0.0);
  LoadCase rest;
  rest.duration = 10.0;
  rest.hours = 1.0;
  BOOST_TEST(loads::compute_lifetime_loads({rest}, options_with({4.0})).front() == 0.0);
}

/// A steady state of one revolution has the load of any number of revolutions.
BOOST_AUTO_TEST_CASE(one_revolution_stands_for_many) {
  const Eigen::VectorXd many = cosine(30, 1.0, 2.0);
  const DamageOptions options = options_with({5.0});
  const double steady = one_load(loads::count_periodic_cycles(many.head(40)), 4.8, options);
  BOOST_TEST(is_close(steady, one_load(loads::count_cycles(many), 30 * 4.8, options)));
}

/// R_g = R (L_ult - |L_MF|)/(L_ult - |mean|), by hand; tension and compression count alike.
BOOST_AUTO_TEST_CASE(goodmans_correction_brings_cycles_to_the_fixed_mean) {
  const std::vector<Cycle> cycles = {{2.0, 5.0, 1.0}, {2.0, -5.0, 0.5}, {3.0, 2.0, 1.0}};
  const std::vector<Cycle> to_zero = loads::correct_means(cycles, {10.0, 0.0});
  BOOST_TEST(is_close(to_zero[0].range, 4.0));
  BOOST_TEST(is_close(to_zero[1].range, 4.0));
  BOOST_TEST(is_close(to_zero[2].range, 3.75));
  BOOST_TEST(to_zero[0].mean == 0.0);
  BOOST_TEST(to_zero[1].count == 0.5);
  const std::vector<Cycle> to_two = loads::correct_means(cycles, {10.0, -2.0});
  BOOST_TEST(is_close(to_two[0].range, 3.2));
  BOOST_TEST(is_close(to_two[2].range, 3.0));
  BOOST_TEST(to_two[2].mean == -2.0);
}

BOOST_AUTO_TEST_CASE(goodmans_correction_is_part_of_the_load) {
  const std::vector<Cycle> cycles = loads::count_cycles(cosine(10, 6.0, 1.0));
  DamageOptions options = options_with({3.0, 8.0});
  options.goodman = loads::GoodmanCorrection{10.0, 0.0};
  for (const double load : loads::compute_damage_equivalent_loads(cycles, 10.0, options))
    BOOST_TEST(is_close(load, 2.0 * 10.0 / 4.0));
}

BOOST_AUTO_TEST_CASE(goodmans_correction_vanishes_for_a_large_ultimate_load) {
  DamageOptions options = options_with({6.0});
  const double without = one_load(standard_example(), 3.0, options);
  options.goodman = loads::GoodmanCorrection{1e15, 0.0};
  BOOST_TEST(is_close(one_load(standard_example(), 3.0, options), without));
}

/// A lifetime of one time series has the load of this time series, however many hours it takes.
BOOST_AUTO_TEST_CASE(a_lifetime_of_one_series_has_its_load) {
  const DamageOptions options = options_with({4.0, 10.0}, 2.0);
  const std::vector<double> once =
      loads::compute_damage_equivalent_loads(standard_example(), 8.0, options);
  const std::vector<double> life =
      loads::compute_lifetime_loads({{standard_example(), 8.0, 175000.0}}, options);
  const std::vector<double> parts = loads::compute_lifetime_loads(
      {{standard_example(), 8.0, 1000.0}, {standard_example(), 8.0, 174000.0}}, options);
  for (std::size_t i = 0; i < once.size(); ++i) {
    BOOST_TEST(is_close(life[i], once[i]));
    BOOST_TEST(is_close(parts[i], once[i]));
  }
}

/// sum_j f_j sum_i n_ji R_ji^m / N with f_j = 3600 hours_j / T_j, by hand: 1 cycle of 2 in 10 s for
/// 3 h, 5 cycles of 3 in 20 s for 1 h, m = 3.
BOOST_AUTO_TEST_CASE(a_lifetime_weighs_series_by_their_hours) {
  const std::vector<LoadCase> cases = {{{{2.0, 0.0, 1.0}}, 10.0, 3.0},
                                       {{{3.0, 0.0, 5.0}}, 20.0, 1.0},
                                       {{{1e3, 0.0, 1.0}}, 1.0, 0.0}};
  const double damage = 1080.0 * 8.0 + 180.0 * 5.0 * 27.0;
  const DamageOptions options = options_with({3.0});
  BOOST_TEST(is_close(loads::compute_lifetime_loads(cases, options).front(),
                      std::cbrt(damage / (4.0 * 3600.0))));
  BOOST_TEST(is_close(loads::compute_lifetime_loads(cases, options, 1e7).front(),
                      std::cbrt(damage / 1e7)));
}

/// Short-term loads by their m-th powers, weighted by time, with the same frequency.
BOOST_AUTO_TEST_CASE(lifetime_loads_follow_from_those_of_the_series) {
  DamageOptions options = options_with({9.0}, 1.3);
  options.goodman = loads::GoodmanCorrection{40.0, 1.0};
  const std::vector<Cycle> other = loads::count_cycles(cosine(7, 2.0, 6.0));
  const double a = one_load(standard_example(), 8.0, options);
  const double b = one_load(other, 30.0, options);
  const std::vector<LoadCase> cases = {{standard_example(), 8.0, 70.0}, {other, 30.0, 30.0}};
  BOOST_TEST(is_close(loads::compute_lifetime_loads(cases, options).front(),
                      std::pow(0.7 * std::pow(a, 9.0) + 0.3 * std::pow(b, 9.0), 1.0 / 9.0)));
}

BOOST_AUTO_TEST_CASE(what_has_no_equivalent_load_is_refused) {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const auto refuse = [](double duration, const DamageOptions& options, const std::string& part) {
    check_refused([&] { one_load(standard_example(), duration, options); }, part);
  };
  refuse(0.0, options_with({4.0}), "the duration of a time series must be > 0, not 0");
  refuse(not_a_number, options_with({4.0}), "duration");
  refuse(1.0, options_with({}), "no Woehler exponent");
  refuse(1.0, options_with({4.0, 0.0}), "a Woehler exponent must be >= 1, not 0");
  refuse(1.0, options_with({not_a_number}), "a Woehler exponent");
  refuse(1.0, options_with({4.0}, -1.0), "the frequency");
  DamageOptions goodman = options_with({4.0});
  goodman.goodman = loads::GoodmanCorrection{};
  refuse(1.0, goodman, "the ultimate load must be > 0");
  goodman.goodman = loads::GoodmanCorrection{1.0, 0.0};
  refuse(1.0, goodman, "reaches the ultimate load of 1");
  goodman.goodman = loads::GoodmanCorrection{10.0, -10.0};
  refuse(1.0, goodman, "a mean of -10 reaches the ultimate load");
}

BOOST_AUTO_TEST_CASE(a_lifetime_without_time_is_refused) {
  const auto refuse = [](const std::vector<LoadCase>& cases, std::optional<double> number,
                         const std::string& part) {
    check_refused([&] { loads::compute_lifetime_loads(cases, DamageOptions(), number); }, part);
  };
  refuse({}, {}, "the time of all time series must be > 0");
  refuse({{standard_example(), 8.0, 0.0}}, {}, "the time of all time series must be > 0");
  refuse({{standard_example(), 8.0, -1.0}}, {}, "hours");
  refuse({{standard_example(), 0.0, 1.0}}, {}, "duration");
  refuse({{standard_example(), 8.0, 1.0}}, 0.0, "the number of equivalent cycles");
}

BOOST_AUTO_TEST_SUITE_END()
