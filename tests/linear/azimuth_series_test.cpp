// Series in the azimuth with the azimuths and harmonics that they need.
#include "samara/linear/azimuth_series.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <boost/test/unit_test.hpp>

using namespace samara;
using linear::AzimuthSeries;
using linear::StateSpace;

namespace {

constexpr double pi = std::numbers::pi;

/// A(psi) = 1/(1 - b cos psi): harmonics fall by (1 - sqrt(1 - b^2))/b each.
StateSpace geometric(double b, double psi) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  return {one / (1.0 - b * std::cos(psi)), one, one, 0.0 * one};
}

double largest_error(const AzimuthSeries& series, double b) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0.0, 2.0 * pi);
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double psi = any(random);
    worst = std::max(worst, std::abs(series.state_matrix(psi)(0, 0) - geometric(b, psi).A(0, 0)));
  }
  return worst * (1.0 - b);  // relative to the largest entry
}

}  // namespace

BOOST_AUTO_TEST_SUITE(azimuth_series)

BOOST_AUTO_TEST_CASE(the_error_at_any_azimuth_is_below_the_tolerance) {
  for (const double b : {0.0, 0.1, 0.5, 0.9, 0.99})
    for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
      BOOST_TEST_CONTEXT("b " << b << ", tolerance " << tolerance) {
        std::set<double> asked;
        const AzimuthSeries series = AzimuthSeries::resolve(
            [&](double psi) {
              asked.insert(psi);
              return geometric(b, psi);
            },
            {.tolerance = tolerance});
        BOOST_TEST(series.residual() <= tolerance);
        BOOST_TEST(largest_error(series, b) <= 2.0 * tolerance);
        // Half as many azimuths are too few, and so are much fewer harmonics.
        const auto azimuths = static_cast<int>(series.azimuths().size());
        if (azimuths > 12) {
          const AzimuthSeries coarse([&](double psi) { return geometric(b, psi); }, azimuths / 2,
                                     (azimuths / 2 - 1) / 2);
          BOOST_TEST(coarse.residual() > tolerance);
        }
        const double ratio = b > 0.0 ? (1.0 - std::sqrt(1.0 - b * b)) / b : 0.0;
        BOOST_TEST(std::pow(ratio, series.harmonics()) >= 1e-3 * tolerance * (b > 0.0 ? 1.0 : 0.0));
        // Azimuths of before are asked for again, not others: at most N + 4.
        BOOST_TEST(static_cast<int>(asked.size()) <= azimuths + 4);
      }
    }
}

/// The azimuths of each series that is tried for a form with an error of the given size, which is
/// the same where an azimuth is asked for again.
std::pair<AzimuthSeries, std::vector<int>> series_with_noise(double size, double tolerance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-size, size);
  std::map<double, StateSpace> known;
  std::vector<int> tried;
  AzimuthSeries series = AzimuthSeries::resolve(
      [&](double psi) {
        const auto found = known.find(psi);
        if (found != known.end()) return found->second;
        StateSpace form = geometric(0.5, psi);
        form.A(0, 0) += noise(random);
        return known.emplace(psi, form).first->second;
      },
      {.tolerance = tolerance}, [&](int azimuths) { tried.push_back(azimuths); });
  return {std::move(series), std::move(tried)};
}

BOOST_AUTO_TEST_CASE(round_off_ends_the_choice_of_azimuths) {
  const auto [series, tried] = series_with_noise(1e-9, 1e-12);
  BOOST_TEST(tried.back() <= 96);
  BOOST_TEST(static_cast<int>(series.azimuths().size()) == tried.back());
  BOOST_TEST(series.residual() < 1e-8);
  BOOST_TEST(series.residual() > 1e-12);
}

BOOST_AUTO_TEST_CASE(a_large_residual_that_stays_ends_the_choice_of_azimuths) {
  const auto [series, tried] = series_with_noise(1e-4, 1e-6);
  BOOST_TEST(tried.back() <= 192);
  BOOST_TEST(series.residual() > 1e-5);
}

BOOST_AUTO_TEST_CASE(what_is_given_is_kept) {
  const auto form = [](double psi) { return geometric(0.9, psi); };
  const AzimuthSeries few = AzimuthSeries::resolve(
      form, {.azimuths = 10, .automatic_azimuths = false, .tolerance = 1e-9});
  BOOST_TEST(few.azimuths().size() == 10u);
  BOOST_TEST(few.harmonics() == 4);
  BOOST_TEST(few.residual() > 1e-3);
  const AzimuthSeries both = AzimuthSeries::resolve(
      form,
      {.azimuths = 40, .automatic_azimuths = false, .harmonics = 7, .automatic_harmonics = false});
  BOOST_TEST(both.azimuths().size() == 40u);
  BOOST_TEST(both.harmonics() == 7);
  // More azimuths do not help where harmonics are missing.
  const AzimuthSeries cut = AzimuthSeries::resolve(
      form, {.harmonics = 20, .automatic_harmonics = false, .tolerance = 1e-9});
  BOOST_TEST(cut.harmonics() == 20);
  BOOST_TEST(cut.residual() > 1e-9);
  BOOST_TEST(cut.azimuths().size() == 192u);
}

BOOST_AUTO_TEST_SUITE_END()
