// Ground resonance of a helicopter on its landing gear, inputs/ground_resonance: the edges of
// instability against the multiblade equations (R. P. Coleman and A. M. Feingold, NACA report 1351,
// 1958), and with one lag damper out against an integration of the equations of single blades.
#include <cmath>
#include <complex>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include "cases.hpp"
#include "record.hpp"

using namespace samara;
using namespace samara::test;

namespace {

/// C. E. Hammond, Journal of the American Helicopter Society 19 (4), 1974, table 1.
struct Helicopter {
  static constexpr int blades = 4;
  static constexpr double mass = 94.9;       ///< of a blade [kg]
  static constexpr double moment = 289.1;    ///< about its hinge [kg m]
  static constexpr double inertia = 1084.7;  ///< [kg m^2]
  static constexpr double offset = 0.3048;   ///< of the hinge [m]
  static constexpr double hub_x = 8026.6;    ///< [kg]
  static constexpr double hub_y = 3283.6;
  static constexpr double spring = 1240481.8;  ///< both ways [N/m]
  static constexpr double damper_x = 51078.7;  ///< [N s/m]
  static constexpr double damper_y = 25539.3;
  double lag_damper = 4067.5;  ///< [N m s/rad]
  bool first_has_damper = true;

  /// Largest growth [1/s] in multiblade coordinates: x, y and the cyclic lag angles
  /// zeta_k = a cos psi_k + b sin psi_k, zeta against the turning; det(M s^2 + C s + K) = 0.
  double growth(double speed) const {
    const double half = 0.5 * blades * moment;
    const double free = speed * speed * offset * moment - speed * speed * inertia;
    Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
    Eigen::Matrix4d C = Eigen::Matrix4d::Zero();
    Eigen::Matrix4d K = Eigen::Matrix4d::Zero();
    M << hub_x + blades * mass, 0, 0, half, 0, hub_y + blades * mass, -half, 0, 0, -moment, inertia,
        0, moment, 0, 0, inertia;
    C.diagonal() << damper_x, damper_y, lag_damper, lag_damper;
    C(2, 3) = 2.0 * speed * inertia;
    C(3, 2) = -C(2, 3);
    K.diagonal() << spring, spring, free, free;
    K(2, 3) = lag_damper * speed;
    K(3, 2) = -K(2, 3);
    Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Zero();
    A.topRightCorner<4, 4>().setIdentity();
    A.bottomLeftCorner<4, 4>() = -M.lu().solve(K);
    A.bottomRightCorner<4, 4>() = -M.lu().solve(C);
    return A.eigenvalues().real().maxCoeff();
  }

  /// The equations of single blades: x, y, zeta_1 to zeta_4 and their rates.
  Eigen::MatrixXd first_order(double speed, double t) const {
    constexpr int n = 2 + blades;
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    M(0, 0) = hub_x + blades * mass;
    M(1, 1) = hub_y + blades * mass;
    C(0, 0) = damper_x;
    C(1, 1) = damper_y;
    K(0, 0) = K(1, 1) = spring;
    for (int k = 0; k < blades; ++k) {
      const int at = 2 + k;
      const double psi = speed * t + 2.0 * pi * k / blades;
      // The blade's centre moves by -zeta along e = (-sin psi, cos psi): its momentum's rate is
      // that of -moment zeta e.
      const Eigen::Vector2d e(-std::sin(psi), std::cos(psi));
      const Eigen::Vector2d outward(std::cos(psi), std::sin(psi));
      M.block<2, 1>(0, at) = -moment * e;
      C.block<2, 1>(0, at) = 2.0 * moment * speed * outward;
      K.block<2, 1>(0, at) = moment * speed * speed * e;
      M.block<1, 2>(at, 0) = -moment * e.transpose();
      M(at, at) = inertia;
      C(at, at) = k > 0 || first_has_damper ? lag_damper : 0.0;
      K(at, at) = speed * speed * offset * moment;
    }
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n).setIdentity();
    A.bottomLeftCorner(n, n) = -M.lu().solve(K);
    A.bottomRightCorner(n, n) = -M.lu().solve(C);
    return A;
  }

  /// The largest growth [1/s], by Runge-Kutta over a revolution.
  double integrated_growth(double speed) const {
    constexpr int steps = 800;
    const double period = 2.0 * pi / speed;
    const double h = period / steps;
    Eigen::MatrixXd Y = Eigen::MatrixXd::Identity(2 * (2 + blades), 2 * (2 + blades));
    for (int i = 0; i < steps; ++i) {
      const double t = i * h;
      const Eigen::MatrixXd middle = first_order(speed, t + 0.5 * h);
      const Eigen::MatrixXd k1 = first_order(speed, t) * Y;
      const Eigen::MatrixXd k2 = middle * (Y + 0.5 * h * k1);
      const Eigen::MatrixXd k3 = middle * (Y + 0.5 * h * k2);
      const Eigen::MatrixXd k4 = first_order(speed, t + h) * (Y + h * k3);
      Y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    return std::log(Y.eigenvalues().cwiseAbs().maxCoeff()) / period;
  }
};

analysis::Floquet floquet_at(double speed, const std::vector<std::string>& settings) {
  std::vector<std::string> all = settings;
  all.push_back("shaft.speed=" + std::to_string(speed));
  const io::Case input =
      io::read_case(std::string(SAMARA_SOURCE_DIR) + "/inputs/ground_resonance/hammond.yaml", all);
  return floquet_of(input);
}

double growth_of(const analysis::Floquet& floquet) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const analysis::Mode& mode : floquet.set.modes)
    largest = std::max(largest, mode.exponent.real());
  return largest;
}

/// Speed between two at which the growth is zero [rad/s].
double edge_between(double from, double to, const std::function<double(double)>& growth) {
  const bool grows = growth(from) > 0.0;
  BOOST_REQUIRE((growth(to) > 0.0) != grows);
  while (to - from > 1e-7 * from) {
    const double middle = 0.5 * (from + to);
    ((growth(middle) > 0.0) == grows ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

constexpr double rpm = pi / 30.0;

const Figures polynomial{"G1", "multiblade equations", "1 element of order 3, 400 steps"};
const Figures integrated{"G1", "Runge-Kutta, single blades", "1 element of order 3, 400 steps"};

std::string edge_name(const std::string& dampers, double from) {
  return "edge above " + in_short(from) + " rpm [rpm], " + dampers;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(ground_resonance)

BOOST_AUTO_TEST_CASE(edges_with_all_dampers_are_those_of_the_multiblade_equations) {
  // With Hammond's dampers nothing grows; with half of them a band of speeds does.
  for (const double speed : {150.0 * rpm, 255.0 * rpm, 400.0 * rpm}) {
    const double growth = growth_of(floquet_at(speed, {}));
    BOOST_TEST(growth < 0.0);
    BOOST_TEST(std::abs(growth - Helicopter().growth(speed)) < 1e-4 * speed);
  }
  Helicopter half;
  half.lag_damper *= 0.5;
  const std::vector<std::string> settings{"blades.hinges.0.damping=2033.75"};
  for (const auto& [from, to] : {std::pair(200.0, 230.0), std::pair(290.0, 320.0)}) {
    const double wanted =
        edge_between(from * rpm, to * rpm, [&](double speed) { return half.growth(speed); });
    const double found = edge_between(
        from * rpm, to * rpm, [&](double speed) { return growth_of(floquet_at(speed, settings)); });
    polynomial.check_relative(edge_name("dampers at half", from), found / rpm, wanted / rpm, 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(edges_with_one_damper_out_are_those_of_an_independent_integration) {
  Helicopter one_out;
  one_out.first_has_damper = false;
  const std::vector<std::string> settings{"blades.each={1: {hinges: {lag: {damping: 0}}}}"};
  BOOST_TEST(floquet_at(255.0 * rpm, {}).sectors == 4);
  BOOST_TEST(floquet_at(255.0 * rpm, settings).sectors == 1);
  for (const auto& [from, to] : {std::pair(180.0, 255.0), std::pair(255.0, 350.0)}) {
    const double wanted = edge_between(
        from * rpm, to * rpm, [&](double speed) { return one_out.integrated_growth(speed); });
    const double found = edge_between(
        from * rpm, to * rpm, [&](double speed) { return growth_of(floquet_at(speed, settings)); });
    integrated.check_relative(edge_name("one damper out", from), found / rpm, wanted / rpm, 1e-3);
  }
}

BOOST_AUTO_TEST_SUITE_END()
