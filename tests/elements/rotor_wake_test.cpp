// Shapes and couplings of the finite-state wake against figures of an independent implementation
// and against the formulas of Peters & He (1991) in the axes of the wake.
#include "samara/elements/rotor_wake.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/math/quadrature.hpp"

namespace {

using namespace samara;
using elements::WakeShape;

/// Shapes of one harmonic.
std::vector<WakeShape> shapes_of(int harmonic, int count) {
  std::vector<int> counts(static_cast<std::size_t>(harmonic), 0);
  counts.push_back(count);
  return elements::make_wake_shapes(counts);
}

Eigen::MatrixXd couplings(const std::vector<WakeShape>& shapes) {
  const auto size = static_cast<Eigen::Index>(shapes.size());
  Eigen::MatrixXd L(size, size);
  for (Eigen::Index j = 0; j < size; ++j)
    for (Eigen::Index n = 0; n < size; ++n)
      L(j, n) = elements::wake_coupling(shapes[static_cast<std::size_t>(j)],
                                        shapes[static_cast<std::size_t>(n)]);
  return L;
}

/// Decay rates in V/R with a wake that leaves along the axis, rising.
std::vector<double> decays(int harmonic, int count) {
  const std::vector<WakeShape> shapes = shapes_of(harmonic, count);
  Eigen::MatrixXd A = couplings(shapes).inverse();
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    A.row(i) /= shapes[static_cast<std::size_t>(i)].mass();
  const Eigen::VectorXcd values = A.eigenvalues();
  std::vector<double> rates;
  for (Eigen::Index i = 0; i < values.size(); ++i) rates.push_back(values(i).real());
  std::sort(rates.begin(), rates.end());
  return rates;
}

double radial(const WakeShape& shape, double r) {
  return elements::wake_shape_at<double>(shape, r, 0.0)[0];
}

/// Integral from 0 to 1 over r = sin(angle), which makes square roots of 1 - r^2 smooth.
template <class Function>
double integrate(const Function& function) {
  double sum = 0.0;
  constexpr int intervals = 24;
  const math::QuadratureRule rule = math::gauss_rule(6);
  for (int i = 0; i < intervals; ++i)
    for (std::size_t k = 0; k < rule.points.size(); ++k) {
      const double width = 0.5 * std::numbers::pi / intervals;
      const double angle = width * (i + rule.points[k]);
      sum += width * rule.weights[k] * std::cos(angle) * function(std::sin(angle));
    }
  return sum;
}

BOOST_AUTO_TEST_SUITE(rotor_wake)

BOOST_AUTO_TEST_CASE(shapes_are_orthonormal) {
  for (const int harmonic : {0, 1, 2, 5}) {
    const std::vector<WakeShape> shapes = shapes_of(harmonic, 4);
    for (std::size_t i = 0; i < shapes.size(); ++i)
      for (std::size_t j = 0; j < shapes.size(); ++j) {
        const double product = integrate([&](double r) {
          return radial(shapes[i], r) * radial(shapes[j], r) * std::sqrt(1.0 - r * r) * r;
        });
        BOOST_TEST(std::abs(product - (i == j ? 1.0 : 0.0)) < 1e-9);
      }
  }
}

BOOST_AUTO_TEST_CASE(decay_rates_of_an_axial_wake) {
  const std::vector<std::vector<double>> expected{
      {2.0061, 5.1544, 11.4442}, {3.4534, 6.7227, 14.5549}, {4.7687, 8.2356, 17.6898}};
  for (int harmonic = 0; harmonic < 3; ++harmonic) {
    const std::vector<double> rates = decays(harmonic, 3);
    for (std::size_t i = 0; i < 3; ++i)
      BOOST_TEST(std::abs(rates[i] - expected[static_cast<std::size_t>(harmonic)][i]) < 6e-5);
  }
  BOOST_TEST(std::abs(decays(0, 1)[0] - 4.0 / 3.0 * 0.5 * std::numbers::pi) < 1e-12);
  BOOST_TEST(std::abs(couplings(shapes_of(0, 1))(0, 0) - 0.75) < 1e-14);
}

/// An actuator disk: the mean velocity of a uniform load tends to that of the momentum theory.
BOOST_AUTO_TEST_CASE(uniform_load_induces_a_uniform_velocity) {
  struct Expected {
    int shapes;
    double error;
  };
  for (const Expected& expected :
       {Expected{1, 0.1250}, {2, 0.0498}, {4, 0.0175}, {6, 0.0091}, {12, 0.0028}}) {
    const int count = expected.shapes;
    const std::vector<WakeShape> shapes = shapes_of(0, count);
    Eigen::VectorXd load(count);  // t with V = 1 and a thrust whose w_m is 2/sqrt(3) load(0)
    for (int i = 0; i < count; ++i)
      load(i) = integrate(
          [&](double r) { return 2.0 * r * radial(shapes[static_cast<std::size_t>(i)], r); });
    const Eigen::VectorXd alpha = couplings(shapes) * load;
    const double mean = integrate([&](double r) {
      double w = 0.0;
      for (int i = 0; i < count; ++i)
        w += alpha(i) * radial(shapes[static_cast<std::size_t>(i)], r);
      return 2.0 * r * w;
    });
    BOOST_TEST(std::abs(mean / (2.0 / std::numbers::sqrt3 * load(0)) - 1.0 - expected.error) <
               6e-5);
  }
}

/// Skewed wake: the couplings in the axes of the wake are [X^|m-r| +- (-1)^min(r,m) X^(m+r)] Gamma
/// for cosines and sines, and X^m Gamma in the mean row. Here the wake leaves at an azimuth of 1.1.
BOOST_AUTO_TEST_CASE(couplings_in_fixed_axes_are_those_in_the_axes_of_the_wake) {
  constexpr double X = 0.37;
  constexpr double azimuth = 1.1;
  const std::vector<WakeShape> shapes = elements::make_wake_shapes({3, 2, 2, 1, 1});
  for (const WakeShape& row : shapes)
    for (const WakeShape& column : shapes) {
      const int r = row.harmonic;
      const int m = column.harmonic;
      const double t_c = 0.7;  // in fixed axes
      const double t_s = m == 0 ? 0.0 : -0.4;
      // In the axes of the wake: f = t_c cos(m psi) + t_s sin(m psi), psi = azimuth + psi'.
      const double c = t_c * std::cos(m * azimuth) + t_s * std::sin(m * azimuth);
      const double s = t_s * std::cos(m * azimuth) - t_c * std::sin(m * azimuth);
      const double gain = elements::wake_coupling(row, column);
      const double sign = std::min(r, m) % 2 == 0 ? 1.0 : -1.0;
      const double direct = std::pow(X, std::abs(m - r));
      const double crossed = sign * std::pow(X, m + r);
      const double of_cosine = r == 0 ? std::pow(X, m) * gain * c : (direct + crossed) * gain * c;
      const double of_sine = r == 0 ? 0.0 : (direct - crossed) * gain * s;
      const auto terms = elements::wake_coupling_terms<double>(r, m, X * std::cos(azimuth),
                                                               X * std::sin(azimuth), t_c, t_s);
      const double cosine = of_cosine * std::cos(r * azimuth) - of_sine * std::sin(r * azimuth);
      const double sine = of_cosine * std::sin(r * azimuth) + of_sine * std::cos(r * azimuth);
      BOOST_TEST(std::abs(gain * terms[0] - cosine) < 1e-13 * (1.0 + std::abs(gain)));
      BOOST_TEST(std::abs(gain * terms[1] - sine) < 1e-13 * (1.0 + std::abs(gain)));
    }
}

/// The induced velocity of an evenly loaded disk in a skewed wake grows to the downstream side.
BOOST_AUTO_TEST_CASE(downstream_side_has_the_larger_induction) {
  const std::vector<WakeShape> shapes = elements::make_wake_shapes({1, 1});
  const auto terms = elements::wake_coupling_terms<double>(1, 0, 0.3, 0.0, 1.0, 0.0);
  BOOST_TEST(elements::wake_coupling(shapes[1], shapes[0]) * terms[0] > 0.0);
  BOOST_TEST(terms[1] == 0.0);
}

BOOST_AUTO_TEST_CASE(flow_of_axial_and_of_edgewise_wind) {
  const auto axial = elements::disk_flow<double>(Vector3(0.0, 0.0, 10.0), 1.5, 0.0);
  const double mean = 2.0 / std::numbers::sqrt3 * 1.5;
  BOOST_TEST(std::abs(axial.mean - mean) < 1e-14);
  BOOST_TEST(std::abs(axial.speed - (10.0 - mean)) < 1e-13);
  BOOST_TEST(std::abs(axial.carrying - (10.0 - 2.0 * mean)) < 1e-13);
  BOOST_TEST(axial.z1 == 0.0);
  // Skew angle of 60 degrees: tan 30.
  const auto skewed = elements::disk_flow<double>(
      Vector3(-10.0 * std::sin(std::numbers::pi / 3), 0.0, 5.0), 0.0, 0.0);
  BOOST_TEST(std::abs(skewed.z1 + std::tan(std::numbers::pi / 6)) < 1e-14);
  BOOST_TEST(std::abs(skewed.carrying - 10.0) < 1e-13);
}

/// V_T w_m = T/(2 rho A): closed forms of axial wind, hover and climb.
BOOST_AUTO_TEST_CASE(steady_flow_balances_the_load_within_the_range) {
  constexpr double to_t = 0.5 * std::numbers::sqrt3;
  const auto steady = [&](double wind, double w, double speed) {
    return elements::find_steady_wake(Vector3(0.0, 0.0, wind), speed * to_t * w, 1e-6);
  };
  BOOST_TEST(std::abs(steady(10.0, 2.0, 8.0).t - 2.0 * to_t) < 1e-9);
  BOOST_TEST(std::abs(steady(0.0, 3.0, 3.0).t - 3.0 * to_t) < 1e-6);
  BOOST_TEST(std::abs(steady(-4.0, 1.0, 5.0).t - to_t) < 1e-9);          // climb against the thrust
  BOOST_TEST(std::abs(steady(10.0, -2.0, 12.0).t + 2.0 * to_t) < 1e-9);  // a propeller
  BOOST_TEST(steady(10.0, 4.0, 6.0).is_in_range);
  const elements::SteadyWake beyond = steady(10.0, 5.0, 5.0);
  BOOST_TEST(!beyond.is_in_range);
  BOOST_TEST(std::abs(beyond.t / to_t - 10.0 * 0.7 / 1.7) < 0.02);  // (1 - 2 a)/(1 - a) = 0.3
  // The flow through the disk is reversed: V_T w_m = T/(2 rho A) again, but no wind turbine.
  const auto reversed = elements::disk_flow<double>(Vector3(0.0, 0.0, 10.0), to_t * 11.0, 0.0);
  BOOST_TEST(reversed.share > 1.0);
  BOOST_TEST(!elements::is_in_range(reversed, 0.1));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
