// Systems with first-order states whose exponents are the roots of a polynomial or an integral.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Eigenvalues>

#include "small_systems.hpp"

namespace samara::test {

/// Roots of c_0 + c_1 s + ... + c_n s^n.
inline std::vector<std::complex<double>> roots_of(const std::vector<double>& c) {
  const auto n = static_cast<Eigen::Index>(c.size()) - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  companion.bottomLeftCorner(n - 1, n - 1).setIdentity();
  for (Eigen::Index i = 0; i < n; ++i)
    companion(i, n - 1) = -c[static_cast<std::size_t>(i)] / c.back();
  const Eigen::VectorXcd values = companion.eigenvalues();
  return {values.begin(), values.end()};
}

/// Constant coefficients, seen over a period or at rest.
class FirstOrderSystem : public SmallSystem {
 public:
  virtual std::vector<std::complex<double>> exponents() const = 0;

  /// y' = A y of the unknowns y that make a state.
  virtual std::vector<int> explicit_unknowns() const = 0;
  virtual Eigen::MatrixXd explicit_form() const = 0;

  /// A force amplitude cos(2 pi t / T) on a balance row.
  void force(PetscInt row, double amplitude) {
    forced_row_ = row;
    amplitude_ = amplitude;
  }
  Eigen::VectorXd residual_at(double t, const Eigen::VectorXd& z,
                              const Eigen::VectorXd& z_dot) const override {
    Eigen::VectorXd r = SmallSystem::residual_at(t, z, z_dot);
    if (amplitude_ != 0.0) r(forced_row_) -= amplitude_ * std::cos(2.0 * pi * t / period_);
    return r;
  }
  /// The steady state is the real part of these times exp(2 pi i t / T): (K + i w M)^-1 f.
  Eigen::VectorXcd forced_amplitudes() const {
    const auto n = static_cast<Eigen::Index>(size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd M = K;
    tangents_at(0.0, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), K, M);
    Eigen::VectorXcd f = Eigen::VectorXcd::Zero(n);
    f(forced_row_) = amplitude_;
    return (K + std::complex<double>(0.0, 2.0 * pi / period_) * M).lu().solve(f);
  }

 protected:
  explicit FirstOrderSystem(double period) { period_ = period; }

 private:
  PetscInt forced_row_ = 0;
  double amplitude_ = 0.0;
};

/// A lag in a balance row: m u'' + c u' + k u = g x, T x' + x = b u.
class LagInBalance final : public FirstOrderSystem {
 public:
  explicit LagInBalance(double period) : FirstOrderSystem(period) {
    add_position("u");
    add_velocity("v");
    add_state("lag", "x");
    add_kinetic("mass", 1, m);
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K << 0.0, 1.0, 0.0, k, c, -g, -b, 0.0, 1.0;
    M.diagonal() << -1.0, m, T;
  }
  std::vector<std::complex<double>> exponents() const override {
    return roots_of({k - g * b, c + k * T, m + c * T, m * T});
  }
  std::vector<int> explicit_unknowns() const override { return {0, 1, 2}; }
  Eigen::MatrixXd explicit_form() const override {
    Eigen::Matrix3d A;
    A << 0.0, 1.0, 0.0, -k / m, -c / m, g / m, b / T, 0.0, -1.0 / T;
    return A;
  }

 private:
  static constexpr double m = 2.0, c = 0.3, k = 5.0, g = 1.7, b = 0.8, T = 0.9;
};

/// A state in a kinematic row, and an auxiliary behind it: v = u' + x, x' + a x = b y, y = u.
/// m v' + c v + k u = 0.
class StateInKinematics final : public FirstOrderSystem {
 public:
  explicit StateInKinematics(double period) : FirstOrderSystem(period) {
    add_position("u");
    add_velocity("v");
    add_state("inflow", "x");
    add_auxiliary("y");
    unknowns_[2].scale = 4.0;
    add_kinetic("mass", 1, m);
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K << 0.0, 1.0, -1.0, 0.0,  //
        k, c, 0.0, 0.0,        //
        0.0, 0.0, a, -b,       //
        -2.0, 0.0, 0.0, 2.0;
    M.diagonal() << -1.0, m, 1.0, 0.0;
  }
  /// v = s u + x, x = b u / (s + a): (m s + c) (s (s + a) + b) + k (s + a) = 0.
  std::vector<std::complex<double>> exponents() const override {
    return roots_of({c * b + k * a, m * b + c * a + k, m * a + c, m});
  }
  std::vector<int> explicit_unknowns() const override { return {0, 1, 2}; }
  Eigen::MatrixXd explicit_form() const override {
    Eigen::Matrix3d A;
    A << 0.0, 1.0, -1.0, -k / m, -c / m, 0.0, b, 0.0, -a;
    return A;
  }

 private:
  static constexpr double m = 2.0, c = 0.3, k = 5.0, a = 0.7, b = 0.4;
};

/// A joint that an actuator drives by a gain: p = g x_1 in a constraint row, x_1' = x_2,
/// x_2' = w^2 (h u - x_1) - 2 zeta w x_2; a mass on a spring at the arm L: m (u + L p)'' + k u = 0.
/// The reaction R holds the joint. Here g = 1.
class DrivenJoint : public FirstOrderSystem {
 public:
  explicit DrivenJoint(double period) : FirstOrderSystem(period) {
    add("p", UnknownRole::position, RowRole::constraint);
    add_position("u");
    add("p'", UnknownRole::velocity, RowRole::kinematic);
    add_velocity("u'");
    add("R", UnknownRole::internal, RowRole::balance);
    add_state("actuator", "value");
    add_state("actuator", "rate");
    add_energy(EnergyGroup::Kind::kinetic, {PartKind::body, "mass"}, "", {2, 3},
               {m * L * L, m * L, m * L, m});
  }
  void tangents_at(double t, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K(0, 0) = 1.0;  // p - g x_1
    K(0, 5) = -gain(t);
    K(1, 3) = 1.0;  // u' is the rate of u
    M(1, 1) = -1.0;
    K(2, 2) = 1.0;
    M(2, 0) = -1.0;
    M(3, 3) = m;
    M(3, 2) = m * L;
    K(3, 1) = k;
    M(4, 2) = m * L * L;
    M(4, 3) = m * L;
    K(4, 4) = -1.0;
    M(5, 5) = 1.0;
    K(5, 6) = -1.0;
    M(6, 6) = 1.0;
    K(6, 6) = 2.0 * zeta * w;
    K(6, 5) = w * w;
    K(6, 1) = -w * w * h;
  }
  /// (m s^2 + k) (s^2 + 2 zeta w s + w^2) + m L h w^2 s^2 = 0
  std::vector<std::complex<double>> exponents() const override {
    return roots_of(
        {k * w * w, 2.0 * zeta * w * k, m * w * w + k + m * L * h * w * w, 2.0 * zeta * w * m, m});
  }
  /// u'' = -k u / m - L x_2'
  std::vector<int> explicit_unknowns() const override { return {1, 3, 5, 6}; }
  Eigen::MatrixXd explicit_form() const override {
    Eigen::Matrix4d A;
    A << 0.0, 1.0, 0.0, 0.0,                                         //
        -k / m - L * w * w * h, 0.0, L * w * w, 2.0 * L * zeta * w,  //
        0.0, 0.0, 0.0, 1.0,                                          //
        w * w * h, 0.0, -w * w, -2.0 * zeta * w;
    return A;
  }

 protected:
  virtual double gain(double) const { return 1.0; }
  static constexpr double m = 2.0, k = 5.0, L = 0.6, w = 3.0, zeta = 0.4, h = 0.25;
};

/// A rotor at a set speed, its torque from a filtered speed and an integral: q' = U, J U' + c U =
/// -K_P y - K_I x, y' = w (U - y), x' = y. Nothing restores the angle q.
class SpeedControl final : public FirstOrderSystem {
 public:
  explicit SpeedControl(double period) : FirstOrderSystem(period) {
    add_position("q");
    add_velocity("U");
    add_state("controller", "filtered speed");
    add_state("controller", "integral");
    add_kinetic("rotor", 1, J);
    // The integral takes the torque: what the mean of the angle would need is an offset of its
    // rate.
    unconstrained_.push_back({"rotor", 0, 3, "rad/s"});
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K << 0.0, 1.0, 0.0, 0.0,  //
        0.0, c, P, I,         //
        0.0, -w, w, 0.0,      //
        0.0, 0.0, -1.0, 0.0;
    M.diagonal() << -1.0, J, 1.0, 1.0;
  }
  /// s [(J s + c) (s + w) s + w (P s + I)] = 0
  std::vector<std::complex<double>> exponents() const override {
    std::vector<std::complex<double>> roots = roots_of({w * I, c * w + w * P, c + J * w, J});
    roots.emplace_back(0.0);
    return roots;
  }
  std::vector<int> explicit_unknowns() const override { return {0, 1, 2, 3}; }
  Eigen::MatrixXd explicit_form() const override {
    Eigen::Matrix4d A;
    A << 0.0, 1.0, 0.0, 0.0,          //
        0.0, -c / J, -P / J, -I / J,  //
        0.0, w, -w, 0.0,              //
        0.0, 0.0, 1.0, 0.0;
    return A;
  }

 private:
  static constexpr double J = 4.0, c = -0.2, w = 3.0, P = 1.5, I = 0.8;
};

/// The same joint with a gain that changes in time: g = 1 + 0.3 cos t.
class PeriodicJoint final : public DrivenJoint {
 public:
  PeriodicJoint() : DrivenJoint(2.0 * pi) { autonomous_ = false; }

  /// Rates of u, u', x_1, x_2: u'' = -k u / m - L (g'' x_1 + 2 g' x_2 + g x_2').
  using DrivenJoint::explicit_form;
  Eigen::MatrixXd explicit_form(double t) const {
    const Eigen::RowVector4d x_2(w * w * h, 0.0, -w * w, -2.0 * zeta * w);
    Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
    A(0, 1) = 1.0;
    A(1, 0) = -k / m;
    A(1, 2) = L * 0.3 * std::cos(t);
    A(1, 3) = 2.0 * L * 0.3 * std::sin(t);
    A.row(1) -= L * gain(t) * x_2;
    A(2, 3) = 1.0;
    A.row(3) = x_2;
    return A;
  }

 private:
  double gain(double t) const override { return 1.0 + 0.3 * std::cos(t); }
};

/// A filter that only measures, and rests: m u'' + c u' + k u = f, T x' + x = u'.
class RateFilter final : public FirstOrderSystem {
 public:
  explicit RateFilter(double period) : FirstOrderSystem(period) {
    add_position("u");
    add_velocity("v");
    add_state("filter", "x");
    unknowns_[2].scale = 0.1;
    add_kinetic("mass", 1, m);
  }
  Eigen::VectorXd residual_at(double t, const Eigen::VectorXd& z,
                              const Eigen::VectorXd& z_dot) const override {
    Eigen::VectorXd r = FirstOrderSystem::residual_at(t, z, z_dot);
    r(1) -= 3.7;
    return r;
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K << 0.0, 1.0, 0.0, k, c, 0.0, 0.0, -1.0, 1.0;
    M.diagonal() << -1.0, m, T;
  }
  std::vector<std::complex<double>> exponents() const override {
    std::vector<std::complex<double>> roots = roots_of({k, c, m});
    roots.emplace_back(-1.0 / T);
    return roots;
  }
  std::vector<int> explicit_unknowns() const override { return {0, 1, 2}; }
  Eigen::MatrixXd explicit_form() const override {
    Eigen::Matrix3d A;
    A << 0.0, 1.0, 0.0, -k / m, -c / m, 0.0, 0.0, 1.0 / T, -1.0 / T;
    return A;
  }

 private:
  static constexpr double m = 2.0, c = 0.3, k = 5.0, T = 0.9;
};

/// x' = (-1 + 2 cos t) x: no coordinate of second order. The multiplier is exp(-2 pi).
class PeriodicLag final : public SmallSystem {
 public:
  PeriodicLag() {
    period_ = 2.0 * pi;
    add_state("lag", "x");
  }
  void tangents_at(double t, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K << 1.0 - 2.0 * std::cos(t);
    M << 1.0;
  }
};

/// Blades with a lag each that the hub drives, and a lag in the fixed frame: for blade k at
/// psi_k = t + 2 pi k / B
///     u_k'' + 0.1 u_k' + 1.3 u_k = 0.5 x_k + 0.2 h sin psi_k,
///     x_k' + 0.7 x_k = 0.3 u_k + 0.4 h cos psi_k,    h' + 0.5 h = sum 0.2 (u_k sin psi_k + x_k).
class RotorWithLags final : public SmallSystem {
 public:
  explicit RotorWithLags(int blades) : blades_(blades) {
    period_ = 2.0 * pi;
    for (int k = 0; k < blades; ++k) {
      add_position("u");
      unknowns_.back().owner = Owner(PartKind::body, "blade", k + 1);
    }
    for (int k = 0; k < blades; ++k) {
      add_velocity("u'");
      unknowns_.back().owner = Owner(PartKind::body, "blade", k + 1);
      add_energy(EnergyGroup::Kind::kinetic, unknowns_.back().owner, "",
                 {static_cast<PetscInt>(blades + k)}, {1.0});
    }
    for (int k = 0; k < blades; ++k) {
      add_state("lag", "x", k + 1);
      unknowns_.back().frame = Frame::rotating;
    }
    add_state("inflow", "h");
    symmetry_.sectors = blades;
    for (int k = 0; k < blades; ++k)
      for (const int first : {0, blades, 2 * blades})
        symmetry_.source[static_cast<std::size_t>(first + (k + 1) % blades)] = first + k;
  }
  /// z' = A z with z = (u, u', x, h).
  Eigen::MatrixXd explicit_form(double t) const {
    const int B = blades_;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * B + 1, 3 * B + 1);
    for (int k = 0; k < B; ++k) {
      const double psi = t + 2.0 * pi * k / B;
      A(k, B + k) = 1.0;
      A(B + k, B + k) = -0.1;
      A(B + k, k) = -1.3;
      A(B + k, 2 * B + k) = 0.5;
      A(B + k, 3 * B) = 0.2 * std::sin(psi);
      A(2 * B + k, 2 * B + k) = -0.7;
      A(2 * B + k, k) = 0.3;
      A(2 * B + k, 3 * B) = 0.4 * std::cos(psi);
      A(3 * B, k) = 0.2 * std::sin(psi);
      A(3 * B, 2 * B + k) = 0.2;
    }
    A(3 * B, 3 * B) = -0.5;
    return A;
  }
  void tangents_at(double t, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K = -explicit_form(t);
    M.setIdentity();
    K.topRows(blades_) *= -1.0;
    M.topRows(blades_) *= -1.0;
  }

 private:
  int blades_;
};

}  // namespace samara::test
