// Independent solutions of the rotating uniform beam by Ritz's method in displacements with
// polynomials over its whole length (Hamilton's principle, quadratic about the steady state;
// nothing of the mixed element is used). With a dozen functions the first modes are exact to nine
// digits.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Dense>

#include "samara/math/quadrature.hpp"

namespace samara::test {

/// Inextensible, unshearable, with rotary inertia.
struct RitzBeam {
  double length = 1.0;
  double hub_radius = 0.0;
  double speed = 0.0;
  double mass = 1.0;
  double inertia1 = 0.0;  ///< rotary, about b1, b2, b3
  double inertia2 = 0.0;
  double inertia3 = 0.0;
  double bending = 1.0;  ///< EI of the bending considered
};

/// Share of a teetering hub for each of its two blades, about h1, h2, h3.
struct RitzHub {
  bool teeters = false;
  double inertia1 = 0.0;
  double inertia2 = 0.0;
  double inertia3 = 0.0;
};

/// Frequencies [rad/s] of flap (out of the plane of rotation). Per length, with w' small:
///   V = EI w''^2 / 2 + T w'^2 / 2 + (I3 - I1) Omega^2 w'^2 / 2,  T = m Omega^2 int (R + s) ds
///   K = m w_t^2 / 2 + I2 w_t'^2 / 2
/// and of lead-lag: - m Omega^2 v^2 / 2 instead of the rotary term in V, I3 instead of I2 in K.
/// A teetering hub adds w = beta (R + x) with, of one blade's half of the hub,
///   V = (I_h2 - I_h3) Omega^2 beta^2 / 4 + T(0) R beta^2 / 2,  K = I_h1 beta_t^2 / 4.
inline std::vector<double> ritz_frequencies(const RitzBeam& beam, bool lead_lag,
                                            const RitzHub& hub = {}, int functions = 14) {
  const int n = functions + (hub.teeters ? 1 : 0);
  const double l = beam.length;
  const double turn = beam.speed * beam.speed;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
  const math::QuadratureRule rule = math::gauss_rule(functions + 6);
  for (std::size_t q = 0; q < rule.points.size(); ++q) {
    const double xi = rule.points[q];
    const double dx = rule.weights[q] * l;
    const double x = xi * l;
    // Legendre polynomials of 2 xi - 1 with two derivatives by xi, times xi^2.
    std::vector<double> p(static_cast<std::size_t>(functions) + 1, 1.0);
    std::vector<double> p1(p.size(), 0.0);
    std::vector<double> p2(p.size(), 0.0);
    const double s = 2.0 * xi - 1.0;
    p[1] = s;
    p1[1] = 2.0;
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
      const double a = static_cast<double>(2 * k + 1) / static_cast<double>(k + 1);
      const double b = static_cast<double>(k) / static_cast<double>(k + 1);
      p[k + 1] = a * s * p[k] - b * p[k - 1];
      p1[k + 1] = a * (2.0 * p[k] + s * p1[k]) - b * p1[k - 1];
      p2[k + 1] = a * (4.0 * p1[k] + s * p2[k]) - b * p2[k - 1];
    }
    Eigen::VectorXd w(n);
    Eigen::VectorXd w1(n);
    Eigen::VectorXd w2(n);
    for (int k = 0; k < functions; ++k) {
      const auto at = static_cast<std::size_t>(k);
      w(k) = xi * xi * p[at];
      w1(k) = (2.0 * xi * p[at] + xi * xi * p1[at]) / l;
      w2(k) = (2.0 * p[at] + 4.0 * xi * p1[at] + xi * xi * p2[at]) / (l * l);
    }
    if (hub.teeters) {
      w(n - 1) = (beam.hub_radius + x) / l;
      w1(n - 1) = 1.0 / l;
      w2(n - 1) = 0.0;
    }
    const double tension = beam.mass * turn * (beam.hub_radius * (l - x) + 0.5 * (l * l - x * x));
    const double rotary = lead_lag ? 0.0 : (beam.inertia3 - beam.inertia1) * turn;
    K += dx * (beam.bending * w2 * w2.transpose() + (tension + rotary) * w1 * w1.transpose());
    if (lead_lag) K -= dx * beam.mass * turn * w * w.transpose();
    M += dx * (beam.mass * w * w.transpose() +
               (lead_lag ? beam.inertia3 : beam.inertia2) * w1 * w1.transpose());
  }
  if (hub.teeters) {  // the last function has beta = 1 / l
    const double root_tension = beam.mass * turn * (beam.hub_radius * l + 0.5 * l * l);
    K(n - 1, n - 1) +=
        (0.5 * (hub.inertia2 - hub.inertia3) * turn + root_tension * beam.hub_radius) / (l * l);
    M(n - 1, n - 1) += 0.5 * hub.inertia1 / (l * l);
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, M);
  std::vector<double> found;
  for (const double value : solver.eigenvalues()) found.push_back(std::sqrt(std::max(value, 0.0)));
  return found;
}

/// Stretches, shears and twists. Section moments of inertia with I1 = I2 + I3 or not.
struct ShearBeam {
  double length = 1.0;
  double speed = 0.0;
  double mass = 1.0;
  double inertia1 = 0.0, inertia2 = 0.0, inertia3 = 0.0;
  double EA = 1.0, GA = 1.0, GJ = 1.0, EI = 1.0;
};

/// Frequencies [rad/s], ascending, on a hub of radius 0. The steady state is the stretch 1 + e(x) =
/// cos(k x) / cos(k l), k = Omega sqrt(m / EA), with the force N = EA e. Quadratic about it:
/// lead-lag (u, v, t):
///   V = { EA u'^2 + GA (v' - (1 + e) t)^2 + N (2 v' t - (1 + e) t^2) + EI t'^2
///         - m Omega^2 (u^2 + v^2) } / 2,
///   K = { m (u_t^2 + v_t^2) + I3 t_t^2 } / 2 + m Omega (u v_t - v u_t)
/// flap (w, t, twist f):
///   V = { GA (w' - (1 + e) t)^2 + N (2 w' t - (1 + e) t^2) + EI t'^2 + (I3 - I1) Omega^2 t^2
///         + GJ f'^2 + (I3 - I2) Omega^2 f^2 } / 2,
///   K = { m w_t^2 + I2 t_t^2 + I1 f_t^2 } / 2 + (I1 + I2 - I3) Omega f t_t
inline std::vector<double> shear_beam_frequencies(const ShearBeam& beam, bool lead_lag,
                                                  int functions = 16) {
  const int n = functions;
  const double l = beam.length;
  const double turn = beam.speed * beam.speed;
  const double k = beam.speed * std::sqrt(beam.mass / beam.EA);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(3 * n, 3 * n);  // M q'' + G q' + K q = 0
  const math::QuadratureRule rule = math::gauss_rule(functions + 8);
  for (std::size_t q = 0; q < rule.points.size(); ++q) {
    const double xi = rule.points[q];
    const double dx = rule.weights[q] * l;
    const double stretch = std::cos(k * xi * l) / std::cos(k * l);
    const double N = beam.EA * (stretch - 1.0);
    Eigen::VectorXd b(n);  // x P_k, zero at the root
    Eigen::VectorXd b1(n);
    double p = 1.0, p1 = 0.0, before = 0.0, before1 = 0.0;
    const double s = 2.0 * xi - 1.0;
    for (int j = 0; j < n; ++j) {
      b(j) = xi * p;
      b1(j) = (p + xi * p1) / l;
      const double a = (2.0 * j + 1.0) / (j + 1.0);
      const double c = j / (j + 1.0);
      const double next = a * s * p - c * before;
      const double next1 = a * (2.0 * p + s * p1) - c * before1;
      before = p;
      before1 = p1;
      p = next;
      p1 = next1;
    }
    const Eigen::MatrixXd bb = dx * b * b.transpose();
    const Eigen::MatrixXd dd = dx * b1 * b1.transpose();
    const Eigen::MatrixXd db = dx * b1 * b.transpose();
    const auto block = [n](Eigen::MatrixXd& matrix, int i, int j) {
      return matrix.block(i * n, j * n, n, n);
    };
    const int w = lead_lag ? 1 : 0;  // the deflection, then the rotation of the section
    const int t = w + 1;
    block(K, w, w) += beam.GA * dd;
    block(K, w, t) += (N - beam.GA * stretch) * db;
    block(K, t, w) += (N - beam.GA * stretch) * db.transpose();
    block(K, t, t) += (beam.GA * stretch - N) * stretch * bb + beam.EI * dd;
    block(M, w, w) += beam.mass * bb;
    if (lead_lag) {
      block(K, 0, 0) += beam.EA * dd - beam.mass * turn * bb;
      block(K, 1, 1) -= beam.mass * turn * bb;
      block(M, 0, 0) += beam.mass * bb;
      block(M, 2, 2) += beam.inertia3 * bb;
      block(G, 0, 1) -= 2.0 * beam.mass * beam.speed * bb;
      block(G, 1, 0) += 2.0 * beam.mass * beam.speed * bb;
    } else {
      block(K, 1, 1) += (beam.inertia3 - beam.inertia1) * turn * bb;
      block(K, 2, 2) += beam.GJ * dd + (beam.inertia3 - beam.inertia2) * turn * bb;
      block(M, 1, 1) += beam.inertia2 * bb;
      block(M, 2, 2) += beam.inertia1 * bb;
      const double couple = (beam.inertia1 + beam.inertia2 - beam.inertia3) * beam.speed;
      block(G, 1, 2) += couple * bb;
      block(G, 2, 1) -= couple * bb;
    }
  }
  // Eigenvalues of the inverse, so that the lowest modes are the largest, time in units of the
  // first.
  const double unit = std::sqrt(beam.EI / (beam.mass * l * l * l * l));
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  const Eigen::PartialPivLU<Eigen::MatrixXd> stiffness(K);
  inverse.topLeftCorner(3 * n, 3 * n) = -unit * stiffness.solve(G);
  inverse.topRightCorner(3 * n, 3 * n) = -unit * unit * stiffness.solve(M);
  inverse.bottomLeftCorner(3 * n, 3 * n).setIdentity();
  std::vector<double> found;
  for (const std::complex<double>& value : inverse.eigenvalues())
    if ((1.0 / value).imag() > 0.0) found.push_back(unit * (1.0 / value).imag());
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace samara::test
