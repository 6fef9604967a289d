// Lyapunov-Floquet coordinates of systems whose Floquet solutions are known in closed form.
#include "samara/linear/lyapunov_floquet.hpp"

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"

namespace {

using namespace samara;
using Eigen::MatrixXd;
using linear::AzimuthSeries;
using linear::LyapunovFloquet;
using linear::StateSpace;

/// A(psi) with an input on every state and every state an output.
AzimuthSeries series_of(const std::function<MatrixXd(double)>& A, int harmonics) {
  return {[&A](double psi) {
            const MatrixXd matrix = A(psi);
            const MatrixXd one = MatrixXd::Identity(matrix.rows(), matrix.rows());
            return StateSpace{matrix, one, one, 0.0 * one};
          },
          4 * harmonics + 4, harmonics};
}

/// x_dot = A(t) x of L. Markus and H. Yamabe (Osaka Math. J. 12 (1960), 305-317): the eigenvalues
/// of A have negative real parts at any time, and yet x grows as exp((a - 1) t) for a > 1:
///     Phi(t) = (e^((a-1)t) cos t, e^(-t) sin t; -e^((a-1)t) sin t, e^(-t) cos t).
MatrixXd yamabe(double a, double t) {
  const double c = std::cos(t);
  const double s = std::sin(t);
  MatrixXd A(2, 2);
  A << -1.0 + a * c * c, 1.0 - a * s * c, -1.0 - a * s * c, -1.0 + a * s * s;
  return A;
}

std::vector<std::complex<double>> exponents(const LyapunovFloquet& floquet) {
  const Eigen::EigenSolver<MatrixXd> solver(floquet.form(0.0).A, false);
  std::vector<std::complex<double>> values;
  for (const std::complex<double> value : solver.eigenvalues()) values.push_back(value);
  return values;
}

/// P solves the equation that makes A constant, P' Omega = A P - P Lambda, and Q the adjoint one.
void check_frames(const LyapunovFloquet& floquet, const AzimuthSeries& series, double speed,
                  double tolerance) {
  constexpr double h = 1e-3;
  for (const double psi : {0.3, 2.0, 5.9}) {
    const StateSpace here = floquet.transformation(psi);
    const auto rate = [&](MatrixXd StateSpace::*part) {
      return MatrixXd(
          (8.0 * (floquet.transformation(psi + h).*part - floquet.transformation(psi - h).*part) -
           (floquet.transformation(psi + 2.0 * h).*part -
            floquet.transformation(psi - 2.0 * h).*part)) *
          speed / (12.0 * h));
    };
    const MatrixXd A = series.at(psi).A;
    const MatrixXd &Lambda = here.A, &Q = here.B, &P = here.C;
    BOOST_TEST((rate(&StateSpace::C) - A * P + P * Lambda).norm() < tolerance * A.norm());
    BOOST_TEST((rate(&StateSpace::B) + Q * A - Lambda * Q).norm() < tolerance * A.norm());
    BOOST_TEST((P * Q - MatrixXd::Identity(A.rows(), A.rows())).norm() < 1e-7);
    const StateSpace turned = floquet.transformation(psi + 2.0 * std::numbers::pi);
    BOOST_TEST((turned.C - P).norm() < 1e-9);
    BOOST_TEST((turned.B - Q).norm() < 1e-9);
    BOOST_TEST((floquet.form(psi).C - series.at(psi).C * P).norm() < 1e-12);
  }
}

BOOST_AUTO_TEST_SUITE(lyapunov_floquet)

BOOST_AUTO_TEST_CASE(positive_multipliers_have_their_growth) {
  constexpr double a = 1.5;
  const AzimuthSeries series = series_of([](double psi) { return yamabe(a, psi); }, 2);
  const LyapunovFloquet floquet(series, 1.0, 16, 0);
  BOOST_TEST(floquet.states().size() == 2U);
  std::vector<std::complex<double>> found = exponents(floquet);
  std::ranges::sort(found, {}, [](const auto& value) { return value.real(); });
  BOOST_TEST(std::abs(found[0] + 1.0) < 1e-7);
  BOOST_TEST(std::abs(found[1] - (a - 1.0)) < 1e-7);
  check_frames(floquet, series, 1.0, 1e-6);
}

// Over half the revolution the multipliers are negative. The coordinates of one mode are two then,
// and what they stand for is periodic all the same.
BOOST_AUTO_TEST_CASE(negative_multipliers_take_two_coordinates) {
  constexpr double a = 1.5;
  const auto A = [](double psi) { return yamabe(a, 0.5 * psi); };
  const AzimuthSeries series = series_of(A, 1);
  const LyapunovFloquet floquet(series, 2.0, 16, 0);
  BOOST_TEST(floquet.states().size() == 4U);
  for (const std::complex<double>& value : exponents(floquet)) {
    BOOST_TEST(std::abs(std::abs(value.imag()) - 1.0) < 1e-9);  // half the rotor speed
    BOOST_TEST(std::min(std::abs(value.real() + 1.0), std::abs(value.real() - (a - 1.0))) < 1e-7);
  }
  check_frames(floquet, series, 2.0, 1e-6);
}

// The exponent is known but for multiples of the speed: taken is the one of the motion.
BOOST_AUTO_TEST_CASE(a_constant_system_stays_as_it_is) {
  constexpr double omega = 3.7;
  MatrixXd A(2, 2);
  A << 0.0, 1.0, -omega * omega, -0.1;
  const AzimuthSeries series = series_of([&A](double) { return A; }, 0);
  const LyapunovFloquet floquet(series, 1.0, 8, 0);
  const std::complex<double> exact(-0.05, std::sqrt(omega * omega - 0.0025));
  for (const std::complex<double>& value : exponents(floquet))
    BOOST_TEST(std::min(std::abs(value - exact), std::abs(value - std::conj(exact))) < 1e-10);
  const MatrixXd P = floquet.transformation(0.0).C;
  BOOST_TEST((floquet.transformation(2.5).C - P).norm() < 1e-9 * P.norm());
  check_frames(floquet, series, 1.0, 1e-8);
}

// Where a pair of multipliers meets on the real axis it is one block or two, and never half of one.
BOOST_AUTO_TEST_CASE(pairs_that_nearly_meet_lose_no_mode) {
  for (const double turns : {0.5, 1.0, 1.5})
    for (const double apart : {0.0, 1e-8, 1.2e-7, 2.5e-7, 6e-7, 2e-6, 1e-5, 1e-4, 1e-3}) {
      const double omega = turns * (1.0 + apart);
      MatrixXd A(2, 2);
      A << 0.0, 1.0, -omega * omega, 0.0;
      const AzimuthSeries series = series_of([&A](double) { return A; }, 0);
      const LyapunovFloquet floquet(series, 1.0, 8, 0);
      const StateSpace map = floquet.transformation(1.3);
      BOOST_TEST((map.C * map.B - MatrixXd::Identity(2, 2)).norm() < 1e-6,
                 turns << " and " << apart << ": " << floquet.states().size() << " states");
      BOOST_TEST(map.C.norm() * map.B.norm() < 100.0);
    }
}

// A free mass: one mode with a double multiplier and no second shape. It stays one block.
BOOST_AUTO_TEST_CASE(a_free_motion_is_no_two_modes) {
  MatrixXd A = MatrixXd::Zero(4, 4);
  A.topRightCorner(2, 2).setIdentity();
  A(3, 1) = -7.0;
  A(3, 3) = -0.3;
  A(2, 1) = 0.4;
  const AzimuthSeries series = series_of([&A](double) { return A; }, 0);
  const LyapunovFloquet floquet(series, 1.3, 8, 0);
  BOOST_TEST(floquet.states().size() == 4U);
  const MatrixXd Lambda = floquet.form(1.0).A;
  BOOST_TEST(floquet.states().front().name == "mode 1");
  BOOST_TEST(Lambda.topLeftCorner(2, 2).norm() > 0.1);                                  // speed
  BOOST_TEST((Lambda.topLeftCorner(2, 2) * Lambda.topLeftCorner(2, 2)).norm() < 1e-9);  // no more
  check_frames(floquet, series, 1.3, 1e-8);
}

// A pendulum whose length changes, with damping: no closed form, but P and Q must do.
BOOST_AUTO_TEST_CASE(frames_follow_a_parametric_oscillator) {
  const auto A = [](double psi) {
    MatrixXd matrix = MatrixXd::Zero(4, 4);
    matrix.topRightCorner(2, 2).setIdentity();
    matrix.bottomLeftCorner(2, 2) << -4.0 - 1.2 * std::cos(psi), 0.8 * std::sin(psi),
        0.8 * std::sin(psi), -30.0 + 3.0 * std::cos(2.0 * psi);
    matrix.bottomRightCorner(2, 2) << -0.1, 0.5 * std::cos(psi), -0.5 * std::cos(psi), -0.2;
    return matrix;
  };
  const AzimuthSeries series = series_of(A, 2);
  const LyapunovFloquet floquet(series, 1.1, 24, 0);
  BOOST_TEST(floquet.states().size() == 4U);
  check_frames(floquet, series, 1.1, 1e-6);
  const LyapunovFloquet slow(series, 1.1, 24, 2);
  BOOST_TEST(slow.states().size() == 2U);
  BOOST_TEST((slow.form(1.0).A - floquet.form(1.0).A.topLeftCorner(2, 2)).norm() < 1e-12);
}

// Two oscillators, of which the fast one is left out: its static answer stays.
BOOST_AUTO_TEST_CASE(what_is_left_out_answers_at_once) {
  MatrixXd A = MatrixXd::Zero(4, 4);
  A.topRightCorner(2, 2).setIdentity();
  A.bottomLeftCorner(2, 2).diagonal() << -4.0, -900.0;
  A.bottomRightCorner(2, 2).diagonal() << -0.1, -0.4;
  MatrixXd B = MatrixXd::Zero(4, 1);
  B(2, 0) = 1.0;
  B(3, 0) = 1.0;
  MatrixXd C(1, 4);
  C << 1.0, 1.0, 0.0, 0.0;
  const AzimuthSeries series(
      [&](double) {
        return StateSpace{A, B, C, MatrixXd::Constant(1, 1, 0.25)};
      },
      1, 0);
  const LyapunovFloquet floquet(series, 1.0, 8, 2);
  const StateSpace small = floquet.form(0.4);
  BOOST_TEST(small.A.rows() == 2);
  BOOST_TEST(std::abs(small.D(0, 0) - 0.25 - 1.0 / 900.0) < 1e-9);
  const double still = (small.D - small.C * small.A.partialPivLu().solve(small.B))(0, 0);
  BOOST_TEST(std::abs(still - 0.25 - 0.25 - 1.0 / 900.0) < 1e-9);
  BOOST_TEST(LyapunovFloquet(series, 1.0, 8, 0).remark().empty());
  BOOST_CHECK_THROW(LyapunovFloquet(series, 1.0, 8, 1), InputError);
}

BOOST_AUTO_TEST_CASE(modes_that_are_gone_in_a_revolution_are_not_made_up) {
  MatrixXd A = MatrixXd::Zero(4, 4);
  A.topRightCorner(2, 2).setIdentity();
  A.bottomLeftCorner(2, 2).diagonal() << -4.0, -5e3;
  A.bottomRightCorner(2, 2).diagonal() << -0.1, -150.0;
  const AzimuthSeries series = series_of([&A](double) { return A; }, 0);
  BOOST_TEST(LyapunovFloquet(series, 1.0, 8, 0).states().size() == 2U);
  BOOST_CHECK_EXCEPTION(LyapunovFloquet(series, 1.0, 8, 4), InputError, [](const InputError& e) {
    return std::string(e.what()).find("has 2 of 4 states") != std::string::npos;
  });
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace
