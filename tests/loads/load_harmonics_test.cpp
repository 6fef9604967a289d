#include "samara/loads/load_harmonics.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "load_series_examples.hpp"

using namespace samara;
using namespace samara::test;
using loads::LoadHarmonics;
using loads::LoadSeries;

namespace {

/// Tolerance of amplitudes of the order of one; least squares of about a thousand rows.
constexpr double tolerance = 1e-10;
constexpr double degree = std::numbers::pi / 180.0;

const Eigen::VectorXd amplitudes = column({-2.0, 1.5, 0.3, 0.0, 0.02});
const Eigen::VectorXd phases = column({0.0, 0.7, -2.5, 0.0, 3.0});

/// sum_k amplitude_k cos(k azimuth + phase_k)
double signal(double azimuth_deg) {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < amplitudes.size(); ++k)
    sum += amplitudes(k) * std::cos(static_cast<double>(k) * azimuth_deg * degree + phases(k));
  return sum;
}

/// A rotor whose speed swings by a third: 40 deg/s about 120 deg/s; `rows` rows of 0.02 s.
Eigen::VectorXd uneven_azimuth(Eigen::Index rows) {
  Eigen::VectorXd azimuth(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = 0.02 * static_cast<double>(i);
    azimuth(i) = 17.0 + 120.0 * t + 57.0 * (1.0 - std::cos(0.7 * t));
  }
  return azimuth;
}

/// Channels: the series, and its negative.
LoadSeries series_of(const Eigen::VectorXd& azimuth) {
  LoadSeries series;
  series.names = {"series", "negative"};
  series.times = Eigen::VectorXd::LinSpaced(azimuth.size(), 0.0,
                                            0.02 * static_cast<double>(azimuth.size() - 1));
  series.values.resize(azimuth.size(), 2);
  series.values.col(0) = azimuth.unaryExpr(&signal);
  series.values.col(1) = -series.values.col(0);
  return series;
}

Eigen::VectorXd wrapped(const Eigen::VectorXd& azimuth) {
  return azimuth.unaryExpr([](double angle) { return angle - 360.0 * std::floor(angle / 360.0); });
}

/// The largest error of amplitude times exp(i phase), where a phase without amplitude does not
/// count.
double error_of(const LoadHarmonics& found) {
  double worst = 0.0;
  for (Eigen::Index k = 0; k < amplitudes.size(); ++k) {
    const auto value = [](double amplitude, double phase) {
      return Eigen::Vector2d(amplitude * std::cos(phase), amplitude * std::sin(phase));
    };
    const Eigen::Vector2d expected = value(amplitudes(k), phases(k));
    worst = std::max(worst, (value(found.amplitudes(k, 0), found.phases(k, 0)) - expected).norm());
    worst = std::max(worst, (value(found.amplitudes(k, 1), found.phases(k, 1)) + expected).norm());
  }
  return worst;
}

/// Equal steps of azimuth over one revolution, without its end.
Eigen::VectorXd one_revolution(Eigen::Index rows) {
  return Eigen::VectorXd::LinSpaced(rows, 0.0, 360.0 * (1.0 - 1.0 / static_cast<double>(rows)));
}

LoadSeries periodic_series(const Eigen::VectorXd& azimuth) {
  LoadSeries series = series_of(azimuth);
  series.period = 0.02 * static_cast<double>(azimuth.size());
  return series;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(load_harmonics)

BOOST_AUTO_TEST_CASE(harmonics_of_a_series_are_found_though_the_azimuth_advances_unevenly) {
  const Eigen::VectorXd azimuth = uneven_azimuth(1000);
  const LoadHarmonics found = loads::compute_harmonics(series_of(azimuth), azimuth, 4);
  BOOST_TEST(error_of(found) < tolerance);
  BOOST_TEST(found.phases(0, 0) == 0.0);
  BOOST_TEST(found.amplitudes(0, 1) > 0.0);
  const double span = azimuth(999) - azimuth(0);
  BOOST_TEST(found.revolutions == static_cast<int>(span / 360.0));
  const double begin = azimuth(999) - 360.0 * found.revolutions;
  BOOST_TEST(azimuth(found.first_row) > begin);
  BOOST_TEST(azimuth(found.first_row - 1) <= begin);
}

BOOST_AUTO_TEST_CASE(an_azimuth_may_jump_back_by_a_revolution) {
  const Eigen::VectorXd azimuth = uneven_azimuth(1000);
  const LoadSeries series = series_of(azimuth);
  const LoadHarmonics straight = loads::compute_harmonics(series, azimuth, 4);
  const Eigen::VectorXd about_zero = wrapped(azimuth).array() - 180.0;
  const LoadHarmonics jumping = loads::compute_harmonics(series, wrapped(azimuth), 4);
  BOOST_TEST(error_of(jumping) < tolerance);
  BOOST_TEST(jumping.revolutions == straight.revolutions);
  BOOST_TEST(jumping.first_row == straight.first_row);
  // From -180 deg on it is another zero: odd harmonics change their sign.
  const LoadHarmonics turned = loads::compute_harmonics(series, about_zero, 4);
  BOOST_TEST((turned.amplitudes - straight.amplitudes).norm() < tolerance);
}

BOOST_AUTO_TEST_CASE(what_came_before_the_last_whole_revolutions_does_not_matter) {
  const Eigen::VectorXd azimuth = uneven_azimuth(1000);
  LoadSeries series = series_of(azimuth);
  const Eigen::Index first = loads::compute_harmonics(series, azimuth, 4).first_row;
  BOOST_REQUIRE(first > 10);
  series.values.topRows(first).setConstant(1e6);
  BOOST_TEST(error_of(loads::compute_harmonics(series, azimuth, 4)) < tolerance);
}

BOOST_AUTO_TEST_CASE(a_rotor_that_starts_from_rest_counts_from_where_it_turns) {
  Eigen::VectorXd azimuth = uneven_azimuth(1000);
  azimuth.array() -= azimuth(100);
  azimuth.head(100).setZero();
  LoadSeries series = series_of(azimuth);
  series.values.topRows(100).setConstant(1e6);
  BOOST_TEST(error_of(loads::compute_harmonics(series, azimuth, 4)) < tolerance);
}

/// With equal steps least squares are the discrete Fourier transform: harmonics beyond do not leak.
BOOST_AUTO_TEST_CASE(harmonics_beyond_those_asked_for_do_not_leak_over_equal_steps) {
  const Eigen::VectorXd azimuth = Eigen::VectorXd::LinSpaced(1001, 90.0, 90.0 + 5.0 * 360.0);
  const LoadHarmonics all = loads::compute_harmonics(series_of(azimuth), azimuth, 4);
  const LoadHarmonics few = loads::compute_harmonics(series_of(azimuth), azimuth, 1);
  BOOST_TEST(few.revolutions == 5);
  BOOST_TEST(few.first_row == 1);
  BOOST_TEST((few.amplitudes - all.amplitudes.topRows(2)).norm() < tolerance);
}

/// Over uneven steps the weights make it Fourier's integral, to second order.
BOOST_AUTO_TEST_CASE(leakage_over_uneven_steps_falls_with_the_square_of_the_step) {
  const auto leakage = [](int rows) {
    Eigen::VectorXd azimuth(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double s = 2.0 * std::numbers::pi * static_cast<double>(i) / rows;
      azimuth(i) = (s + 0.3 * std::sin(s)) / degree;
    }
    const LoadHarmonics found = loads::compute_harmonics(periodic_series(azimuth), azimuth, 1);
    return std::abs(found.amplitudes(1, 0) - amplitudes(1));
  };
  BOOST_TEST(leakage(100) < 1e-3);
  BOOST_TEST(std::log2(leakage(100) / leakage(200)) > 1.9);
}

BOOST_AUTO_TEST_CASE(a_periodic_series_is_one_revolution) {
  // Nine rows are what four harmonics need.
  for (const Eigen::Index rows : {9, 10, 64}) {
    const Eigen::VectorXd azimuth = one_revolution(rows);
    const LoadHarmonics found = loads::compute_harmonics(periodic_series(azimuth), azimuth, 4);
    BOOST_TEST(error_of(found) < tolerance);
    BOOST_TEST(found.revolutions == 1);
    BOOST_TEST(found.first_row == 0);
  }
  const Eigen::VectorXd two = one_revolution(2);
  BOOST_TEST(loads::compute_harmonics(periodic_series(two), two, 0).revolutions == 1);
}

BOOST_AUTO_TEST_CASE(what_has_no_harmonics_is_refused) {
  const auto refuse = [](const LoadSeries& series, const Eigen::VectorXd& azimuth, int harmonics,
                         const std::string& part) {
    check_refused([&] { loads::compute_harmonics(series, azimuth, harmonics); }, part);
  };
  const Eigen::VectorXd turn = one_revolution(36);
  refuse(series_of(turn), turn, 2, "grows by 350 deg");
  refuse(series_of(turn), turn, -1, "must be >= 0, not -1");
  refuse(periodic_series(turn), turn, 18, "36 rows do not separate 18 harmonics");
  refuse(periodic_series(turn), turn, 20, "36 rows do not separate 20 harmonics");
  // Many rows at the same few azimuths tell no more.
  const Eigen::VectorXd coarse = Eigen::VectorXd::LinSpaced(101, 0.0, 9000.0);
  refuse(series_of(coarse), coarse, 2, "do not separate 2 harmonics");
  refuse(series_of(turn), Eigen::VectorXd::Zero(36), 1, "grows by 0 deg");
  refuse(series_of(turn), -turn, 1, "grows by 0 deg");
  refuse(periodic_series(turn), -turn, 1, "must grow");
  Eigen::VectorXd broken = turn;
  broken(3) = std::numeric_limits<double>::infinity();
  refuse(series_of(turn), broken, 1, "azimuth: row 4");
  BOOST_CHECK_THROW(loads::compute_harmonics(series_of(turn), turn.head(3), 1), InternalError);
}

BOOST_AUTO_TEST_SUITE_END()
