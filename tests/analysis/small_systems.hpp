// Periodic systems of a few unknowns, each with a solution that needs no program: the analyses see
// them through the same interface as a turbine.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "samara/analysis/periodic_solution.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/system/periodic_system.hpp"

namespace samara::test {

using system::EnergyGroup;
using system::Frame;
using system::Owner;
using system::PartKind;
using system::RowRole;
using system::UnknownRole;

inline constexpr double pi = std::numbers::pi;

/// Dense functions of a few unknowns. Row i stands in the place of unknown i.
class SmallSystem : public system::PeriodicSystem {
 public:
  MPI_Comm comm() const override { return PETSC_COMM_SELF; }
  PetscInt size() const override { return static_cast<PetscInt>(unknowns_.size()); }
  double period() const override { return period_; }
  const std::vector<system::Unknown>& unknowns() const override { return unknowns_; }
  const std::vector<RowRole>& rows() const override { return rows_; }
  const std::vector<bool>& differential() const override { return differential_; }
  bool constraints_are_autonomous() const override { return autonomous_; }
  const system::RotorSymmetry& symmetry() const override { return symmetry_; }
  const std::vector<EnergyGroup>& energy_groups() const override { return groups_; }
  const std::vector<system::UnconstrainedCoordinate>& unconstrained_coordinates() const override {
    return unconstrained_;
  }

  void reference_state(double, Vec z) const override { petsc::check(VecSet(z, 0.0)); }
  petsc::Handle<Vec> make_state() const override {
    return petsc::make_vector(PETSC_COMM_SELF, size(), size());
  }
  petsc::Handle<Mat> make_jacobian() const override { return make_matrix(); }
  petsc::Handle<Mat> make_mass() const override { return make_matrix(); }

  /// Where states or auxiliaries are declared: from the tangents at some states and times.
  std::vector<std::vector<PetscInt>> pattern() const override {
    const auto n = static_cast<Eigen::Index>(size());
    const auto is_first_order = [](const system::Unknown& unknown) {
      return unknown.role == UnknownRole::state || unknown.role == UnknownRole::auxiliary;
    };
    if (std::ranges::none_of(unknowns_, is_first_order)) return {};
    Eigen::MatrixXd sizes = Eigen::MatrixXd::Zero(n, n);
    for (const double t : {0.1, 0.53, 1.7}) {
      const Eigen::VectorXd z = Eigen::VectorXd::LinSpaced(n, 0.3, 0.9 + t);
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
      Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
      tangents_at(t, z, 0.5 * z, K, M);
      sizes += K.cwiseAbs() + M.cwiseAbs();
    }
    std::vector<std::vector<PetscInt>> columns(static_cast<std::size_t>(n));
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        if (sizes(i, j) > 0.0)
          columns[static_cast<std::size_t>(i)].push_back(static_cast<PetscInt>(j));
    return columns;
  }

  void residual(double t, Vec z, Vec z_dot, Vec r) const override {
    const Eigen::VectorXd value = residual_at(t, values_of(z), values_of(z_dot));
    const petsc::WriteView view(r);
    Eigen::Map<Eigen::VectorXd>(view.data(), value.size()) = value;
  }

  void tangents(double t, Vec z, Vec z_dot, double shift, Mat jacobian, Mat mass) const override {
    const auto n = static_cast<Eigen::Index>(size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    tangents_at(t, values_of(z), values_of(z_dot), K, M);
    put(K + shift * M, jacobian);
    if (mass != nullptr) put(M, mass);
  }

  /// Values of a vector of the system's size.
  Eigen::VectorXd values_of(Vec vector) const {
    const petsc::ReadView view(vector);
    return Eigen::Map<const Eigen::VectorXd>(view.data(), size());
  }

  /// r, and K and M (both come as zeros).
  virtual Eigen::VectorXd residual_at(double t, const Eigen::VectorXd& z,
                                      const Eigen::VectorXd& z_dot) const {
    const auto n = static_cast<Eigen::Index>(size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    tangents_at(t, z, z_dot, K, M);
    return K * z + M * z_dot;
  }
  virtual void tangents_at(double t, const Eigen::VectorXd& z, const Eigen::VectorXd& z_dot,
                           Eigen::MatrixXd& K, Eigen::MatrixXd& M) const = 0;

 protected:
  /// Adds an unknown and the row in its place; velocities and positions are differential.
  void add(const std::string& name, UnknownRole role, RowRole row, const std::string& unit = "") {
    unknowns_.push_back({Owner(PartKind::body, ""), "", name, unit, role});
    rows_.push_back(row);
    differential_.push_back(role != UnknownRole::internal && role != UnknownRole::auxiliary);
    symmetry_.source.push_back(static_cast<PetscInt>(symmetry_.source.size()));
    symmetry_.sign.push_back(1.0);
  }
  void add_position(const std::string& name) {
    add(name, UnknownRole::position, RowRole::kinematic);
  }
  void add_velocity(const std::string& name) { add(name, UnknownRole::velocity, RowRole::balance); }
  void add_state(const std::string& part, const std::string& name, int instance = 0) {
    add(name, UnknownRole::state, RowRole::evolution);
    unknowns_.back().owner = Owner(PartKind::law, part, instance);
  }
  void add_auxiliary(const std::string& name) {
    add(name, UnknownRole::auxiliary, RowRole::definition);
  }
  void add_kinetic(const std::string& part, PetscInt unknown, double mass) {
    add_energy(EnergyGroup::Kind::kinetic, {PartKind::body, part}, "", {unknown}, {mass});
  }
  void add_energy(EnergyGroup::Kind kind, const Owner& owner, const std::string& direction,
                  const std::vector<PetscInt>& unknowns, const std::vector<double>& weight) {
    EnergyGroup group;
    group.kind = kind;
    group.owner = owner;
    group.direction = direction;
    group.frame = owner.instance > 0 ? Frame::rotating : Frame::fixed;
    group.unknowns = unknowns;
    group.weight = weight;
    groups_.push_back(group);
  }

  double period_ = 0.0;
  bool autonomous_ = true;
  std::vector<system::Unknown> unknowns_;
  std::vector<RowRole> rows_;
  std::vector<bool> differential_;
  system::RotorSymmetry symmetry_;
  std::vector<EnergyGroup> groups_;
  std::vector<system::UnconstrainedCoordinate> unconstrained_;

 private:
  petsc::Handle<Mat> make_matrix() const {
    petsc::Handle<Mat> matrix;
    petsc::check(MatCreateSeqAIJ(PETSC_COMM_SELF, size(), size(), size(), nullptr, matrix.fill()));
    return matrix;
  }
  static void put(const Eigen::MatrixXd& values, Mat matrix) {
    for (PetscInt i = 0; i < static_cast<PetscInt>(values.rows()); ++i)
      for (PetscInt j = 0; j < static_cast<PetscInt>(values.cols()); ++j)
        petsc::check(MatSetValue(matrix, i, j, values(i, j), INSERT_VALUES));
    petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  }
};

/// The steady state z = 0.
inline analysis::PeriodicSolution rest(const system::PeriodicSystem& system) {
  return {Eigen::MatrixXd::Zero(system.size(), 1), system.period()};
}

/// x'' + (a - 2 q cos 2t) x = 0, T = pi: unknowns x, v.
class Mathieu final : public SmallSystem {
 public:
  Mathieu(double a, double q) : a_(a), q_(q) {
    period_ = pi;
    add_position("x");
    add_velocity("v");
    add_kinetic("mass", 1, 1.0);
  }
  void tangents_at(double t, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K << 0.0, 1.0, a_ - 2.0 * q_ * std::cos(2.0 * t), 0.0;
    M << -1.0, 0.0, 0.0, 1.0;
  }
  /// z' = A z.
  Eigen::MatrixXd explicit_form(double t) const {
    Eigen::Matrix2d A;
    A << 0.0, 1.0, -(a_ - 2.0 * q_ * std::cos(2.0 * t)), 0.0;
    return A;
  }

 private:
  double a_;
  double q_;
};

/// A mass m1 at w on a spring that carries a mass m2 by a rigid gear of changing ratio c(t),
/// u = c(t) w. Unknowns w, u, their velocities, the spring's load F (w = f F) and the gear's load
/// N: two constraints, one of them rigid and changing with time, and one degree of freedom.
///     (m1 + m2 c^2) w'' + 2 m2 c c' w' + (1 / f + m2 c c'') w = 0
class ChangingGear final : public SmallSystem {
 public:
  static constexpr double m1 = 1.0;
  static constexpr double m2 = 2.0;
  static constexpr double f = 0.05;
  static constexpr double speed = 3.0;

  ChangingGear() {
    period_ = 2.0 * pi / speed;
    autonomous_ = false;
    add("w", UnknownRole::position, RowRole::constraint);
    add("u", UnknownRole::position, RowRole::constraint);
    add("w speed", UnknownRole::velocity, RowRole::kinematic);
    add("u speed", UnknownRole::velocity, RowRole::kinematic);
    add("F", UnknownRole::internal, RowRole::balance);
    add("N", UnknownRole::internal, RowRole::balance);
    add_kinetic("one", 2, m1);
    add_kinetic("other", 3, m2);
  }
  static double c(double t) {
    return 1.0 + 0.4 * std::cos(speed * t) + 0.2 * std::sin(2.0 * speed * t);
  }
  static double c_rate(double t) {
    return speed * (-0.4 * std::sin(speed * t) + 0.4 * std::cos(2.0 * speed * t));
  }
  static double c_second(double t) {
    return speed * speed * (-0.4 * std::cos(speed * t) - 0.8 * std::sin(2.0 * speed * t));
  }
  void tangents_at(double t, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K(0, 0) = 1.0;  // w - f F
    K(0, 4) = -f;
    K(1, 1) = 1.0;  // u - c w
    K(1, 0) = -c(t);
    K(2, 2) = 1.0;  // w speed - w'
    M(2, 0) = -1.0;
    K(3, 3) = 1.0;
    M(3, 1) = -1.0;
    M(4, 2) = m1;  // m1 w'' + F - c N
    K(4, 4) = 1.0;
    K(4, 5) = -c(t);
    M(5, 3) = m2;  // m2 u'' + N
    K(5, 5) = 1.0;
  }
  /// In (w, w').
  static Eigen::MatrixXd explicit_form(double t) {
    const double inertia = m1 + m2 * c(t) * c(t);
    Eigen::Matrix2d A;
    A << 0.0, 1.0, -(1.0 / f + m2 * c(t) * c_second(t)) / inertia,
        -2.0 * m2 * c(t) * c_rate(t) / inertia;
    return A;
  }
};

/// A mass on springs that are alike in all directions, with a damper, in axes that turn with
/// `speed`: fixed-frame exponents -c/2 +- i w, and in the turning axes w - speed and w + speed.
/// Unknowns x, y, and the inertial velocity in the turning axes.
class TurningMass final : public SmallSystem {
 public:
  TurningMass(double frequency, double damping, double speed)
      : stiffness_(frequency * frequency), damping_(damping), speed_(speed) {
    period_ = 2.0 * pi / speed;
    add_position("x");
    add_position("y");
    add_velocity("V1");
    add_velocity("V2");
    add_energy(EnergyGroup::Kind::kinetic, {PartKind::body, "mass"}, "", {2, 3},
               {1.0, 0.0, 0.0, 1.0});
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    // V = p' + speed x p;  V' + speed x V + damping V + stiffness p = 0
    K << 0.0, speed_, 1.0, 0.0,              //
        -speed_, 0.0, 0.0, 1.0,              //
        stiffness_, 0.0, damping_, -speed_,  //
        0.0, stiffness_, speed_, damping_;
    M.diagonal() << -1.0, -1.0, 1.0, 1.0;
  }

 private:
  double stiffness_;
  double damping_;
  double speed_;
};

/// Ground resonance: `blades` lead-lag hinges on a hub that moves in its plane on springs which
/// differ in the two directions (Hammond 1974, J. American Helicopter Society 19). Every blade at
/// psi_k = speed t + 2 pi k / blades. Periodic coefficients for any number of blades.
///     zeta_k'' + c zeta_k' + b zeta_k = e (x'' sin psi_k - y'' cos psi_k)
///     x'' + c_x x' + k_x x = g sum { (zeta'' - speed^2 zeta) sin psi + 2 speed zeta' cos psi }
///     y'' + c_y y' + k_y y = -g sum { (zeta'' - speed^2 zeta) cos psi - 2 speed zeta' sin psi }
class GroundResonance final : public SmallSystem {
 public:
  static constexpr double speed = 2.0;

  explicit GroundResonance(int blades) : blades_(blades) {
    period_ = 2.0 * pi / speed;
    for (int i = 0; i < coordinates(); ++i)
      add_position(i < blades ? "zeta " + std::to_string(i + 1) : i == blades ? "x" : "y");
    for (int i = 0; i < coordinates(); ++i) add_velocity("speed " + std::to_string(i + 1));
    for (int i = 0; i < coordinates(); ++i)
      add_energy(EnergyGroup::Kind::kinetic,
                 i < blades ? Owner(PartKind::body, "blade", i + 1) : Owner(PartKind::body, "hub"),
                 "", {static_cast<PetscInt>(coordinates() + i)}, {1.0});
    // Blade k + 1 of P z is blade k of z.
    symmetry_.sectors = blades;
    for (int k = 0; k < blades; ++k)
      for (const int first : {0, coordinates()})
        symmetry_.source[static_cast<std::size_t>(first + (k + 1) % blades)] = first + k;
  }
  int coordinates() const { return blades_ + 2; }

  /// M q'' + C q' + S q = 0.
  void matrices(double t, Eigen::MatrixXd& M, Eigen::MatrixXd& C, Eigen::MatrixXd& S) const {
    const int n = coordinates();
    const int x = blades_;
    const int y = blades_ + 1;
    const double e = 0.3;
    const double g = 0.25;
    M = Eigen::MatrixXd::Identity(n, n);
    C = Eigen::MatrixXd::Zero(n, n);
    S = Eigen::MatrixXd::Zero(n, n);
    C(x, x) = 0.05;
    C(y, y) = 0.03;
    S(x, x) = 1.7;
    S(y, y) = 2.9;
    for (int k = 0; k < blades_; ++k) {
      const double psi = speed * t + 2.0 * pi * k / blades_;
      const double s = std::sin(psi);
      const double c = std::cos(psi);
      C(k, k) = 0.04;
      S(k, k) = 0.61;
      M(k, x) = -e * s;
      M(k, y) = e * c;
      M(x, k) = -g * s;
      S(x, k) = g * speed * speed * s;
      C(x, k) = -2.0 * g * speed * c;
      M(y, k) = g * c;
      S(y, k) = -g * speed * speed * c;
      C(y, k) = -2.0 * g * speed * s;
    }
  }
  void tangents_at(double t, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    const int n = coordinates();
    Eigen::MatrixXd inertia;
    Eigen::MatrixXd damping;
    Eigen::MatrixXd stiffness;
    matrices(t, inertia, damping, stiffness);
    K.topRightCorner(n, n).setIdentity();
    M.topLeftCorner(n, n) = -Eigen::MatrixXd::Identity(n, n);
    K.bottomLeftCorner(n, n) = stiffness;
    K.bottomRightCorner(n, n) = damping;
    M.bottomRightCorner(n, n) = inertia;
  }
  Eigen::MatrixXd explicit_form(double t) const {
    const int n = coordinates();
    Eigen::MatrixXd inertia;
    Eigen::MatrixXd damping;
    Eigen::MatrixXd stiffness;
    matrices(t, inertia, damping, stiffness);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n).setIdentity();
    A.bottomLeftCorner(n, n) = -inertia.lu().solve(stiffness);
    A.bottomRightCorner(n, n) = -inertia.lu().solve(damping);
    return A;
  }

 private:
  int blades_;
};

/// x'' + c x' + x + b x^3 = f cos(w t) + f0.
class Duffing final : public SmallSystem {
 public:
  static constexpr double c = 0.3;
  static constexpr double b = 0.8;
  static constexpr double f = 0.8;
  static constexpr double w = 0.6;

  explicit Duffing(double constant_load = 0.0) : constant_load_(constant_load) {
    period_ = 2.0 * pi / w;
    add_position("x");
    add_velocity("v");
    add_kinetic("mass", 1, 1.0);
  }
  double load(double t) const { return f * std::cos(w * t) + constant_load_; }
  Eigen::VectorXd residual_at(double t, const Eigen::VectorXd& z,
                              const Eigen::VectorXd& z_dot) const override {
    Eigen::Vector2d r;
    r << z(1) - z_dot(0), z_dot(1) + c * z(1) + z(0) + b * z(0) * z(0) * z(0) - load(t);
    return r;
  }
  void tangents_at(double, const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K << 0.0, 1.0, 1.0 + 3.0 * b * z(0) * z(0), c;
    M << -1.0, 0.0, 0.0, 1.0;
  }

 private:
  double constant_load_;
};

/// A mass on a slide that nothing holds: m x'' + c x' = f0 + f1 cos(w t).
class FreeSlide final : public SmallSystem {
 public:
  static constexpr double m = 2.0;
  static constexpr double c = 0.7;
  static constexpr double f0 = 5.0;
  static constexpr double f1 = 3.0;
  static constexpr double w = 1.5;

  FreeSlide() {
    period_ = 2.0 * pi / w;
    add_position("x");
    add_velocity("v");
    add_kinetic("mass", 1, m);
    unconstrained_.push_back({"slide", 0, 1, "N"});
  }
  Eigen::VectorXd residual_at(double t, const Eigen::VectorXd& z,
                              const Eigen::VectorXd& z_dot) const override {
    Eigen::Vector2d r;
    r << z(1) - z_dot(0), m * z_dot(1) + c * z(1) - f0 - f1 * std::cos(w * t);
    return r;
  }
  void tangents_at(double, const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K << 0.0, 1.0, 0.0, c;
    M << -1.0, 0.0, 0.0, m;
  }
};

/// A load on springs at rest, stated by their force: 0 = force(w) - load. Unknowns N = force(w), w.
class LoadedSpring : public SmallSystem {
 public:
  explicit LoadedSpring(double load) : load_(load) {
    add("N", UnknownRole::internal, RowRole::constraint);
    add("w", UnknownRole::position, RowRole::balance);
  }
  virtual double force(double w) const = 0;
  virtual double stiffness(double w) const = 0;

  Eigen::VectorXd residual_at(double, const Eigen::VectorXd& z,
                              const Eigen::VectorXd&) const override {
    return Eigen::Vector2d(z(0) - force(z(1)), z(0) - load_);
  }
  void tangents_at(double, const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd&) const override {
    K << 1.0, -stiffness(z(1)), 1.0, 0.0;
  }

 private:
  double load_;
};

/// Two shallow bars of rise h that a load presses flat and beyond, Green's strain:
/// force = k w (w - h) (w - 2 h), with limit points at w = h (1 -+ 1/sqrt(3)).
class ShallowTruss final : public LoadedSpring {
 public:
  static constexpr double k = 2.0;
  static constexpr double h = 1.0;

  explicit ShallowTruss(double load) : LoadedSpring(load) {}
  double force(double w) const override { return k * w * (w - h) * (w - 2.0 * h); }
  double stiffness(double w) const override {
    return k * (3.0 * w * w - 6.0 * h * w + 2.0 * h * h);
  }
  std::unique_ptr<system::PeriodicSystem> unloaded() const override {
    return std::make_unique<ShallowTruss>(0.0);
  }
};

/// force = w - w^2: no more than 1/4, at w = 1/2. Where w is more than `range` it is out of range.
class SofteningSpring final : public LoadedSpring {
 public:
  SofteningSpring(double load, double range) : LoadedSpring(load), range_(range) {}
  double force(double w) const override {
    if (w > range_) throw DomainError("the spring: too long");
    return w - w * w;
  }
  double stiffness(double w) const override { return 1.0 - 2.0 * w; }
  std::unique_ptr<system::PeriodicSystem> unloaded() const override {
    return std::make_unique<SofteningSpring>(0.0, range_);
  }

 private:
  double range_;
};

/// A load on a spring and on a lag that pushes back: N = k w, N + g x = load, T x' + x + h x^3 = w.
/// At rest load = k w + g x with w = x + h x^3.
class LaggingSupport final : public SmallSystem {
 public:
  static constexpr double k = 2.0;
  static constexpr double g = 30.0;
  static constexpr double h = 1e4;

  explicit LaggingSupport(double load) : load_(load) {
    add("N", UnknownRole::internal, RowRole::constraint);
    add("w", UnknownRole::position, RowRole::balance);
    add_state("lag", "x");
    unknowns_.back().scale = 1e-3;
  }
  Eigen::VectorXd residual_at(double, const Eigen::VectorXd& z,
                              const Eigen::VectorXd& z_dot) const override {
    return Eigen::Vector3d(z(0) - k * z(1), z(0) + g * z(2) - load_,
                           0.5 * z_dot(2) + z(2) + h * z(2) * z(2) * z(2) - z(1));
  }
  void tangents_at(double, const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::MatrixXd& K,
                   Eigen::MatrixXd& M) const override {
    K << 1.0, -k, 0.0, 1.0, 0.0, g, 0.0, -1.0, 1.0 + 3.0 * h * z(2) * z(2);
    M(2, 2) = 0.5;
  }
  std::unique_ptr<system::PeriodicSystem> unloaded() const override {
    return std::make_unique<LaggingSupport>(0.0);
  }
  /// x at rest under a load, by bisection.
  static double state_under(double load) {
    double low = 0.0;
    double high = load / g;
    for (int i = 0; i < 200; ++i) {
      const double x = 0.5 * (low + high);
      (k * (x + h * x * x * x) + g * x < load ? low : high) = x;
    }
    return low;
  }

 private:
  double load_;
};

/// y' = g(t, y) from y at t = 0 over `span` by the classical Runge-Kutta rule in `steps` steps; y
/// may be a vector or a matrix.
template <class Y, class G>
Y runge_kutta(const G& g, Y y, double start, double span, int steps) {
  const double h = span / steps;
  for (int k = 0; k < steps; ++k) {
    const double t = start + k * h;
    const Y k1 = g(t, y);
    const Y k2 = g(t + 0.5 * h, Y(y + 0.5 * h * k1));
    const Y k3 = g(t + 0.5 * h, Y(y + 0.5 * h * k2));
    const Y k4 = g(t + h, Y(y + h * k3));
    y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return y;
}

/// Eigenvalues of the monodromy matrix of z' = A(t) z by Runge-Kutta.
template <class A>
Eigen::VectorXcd reference_multipliers(const A& form, double period, int steps) {
  const Eigen::Index n = form(0.0).rows();
  const Eigen::MatrixXd monodromy = runge_kutta<Eigen::MatrixXd>(
      [&form](double t, const Eigen::MatrixXd& y) { return Eigen::MatrixXd(form(t) * y); },
      Eigen::MatrixXd::Identity(n, n), 0.0, period, steps);
  return monodromy.eigenvalues();
}

}  // namespace samara::test
