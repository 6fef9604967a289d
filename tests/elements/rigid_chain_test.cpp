// Kane's rows against Lagrange's equations of the same bodies, written from positions and rotation
// matrices of the configuration coordinates alone and differentiated by nested jets.
#include "samara/elements/rigid_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "samara/math/autodiff.hpp"

#include "chain_walk.hpp"
#include "jet.hpp"

namespace {

using namespace samara;
using namespace samara::elements;
using namespace samara::test;
using Complex = std::complex<double>;

/// Generalized forces of 1e2 to 1e4 N, some thousand operations; relative to their largest part.
constexpr double round_off = 1e-12;

/// Tangents by automatic differentiation against the complex step, relative to the row's norm.
constexpr double tangent_tolerance = 1e-11;
constexpr double complex_step = 1e-30;

/// Coordinates: u_hat and theta_hat of the tower top, components along (n3, n1, n2); q_y; q_h; q_s;
/// q_g.
constexpr int coordinates = 10;
constexpr int at_yaw = 6;
constexpr int at_teeter = 7;
constexpr int at_torsion = 8;
constexpr int at_generator = 9;
template <class T>
using Coordinates = Eigen::Matrix<T, coordinates, 1>;

/// In the order of ChainRows: U8 U6 U7, U5 U3 U4, U1, U2, U_s, U_g.
template <class T>
using Speeds = Eigen::Matrix<T, coordinates, 1>;

double uniform(std::minstd_rand& random, double size) {
  return std::uniform_real_distribution<double>(-size, size)(random);
}

template <int n>
Eigen::Matrix<double, n, 1> random_array(std::minstd_rand& random, double size) {
  Eigen::Matrix<double, n, 1> v;
  for (int i = 0; i < n; ++i) v(i) = uniform(random, size);
  return v;
}

RigidBody random_body(std::minstd_rand& random, double mass) {
  RigidBody body;
  body.mass = mass;
  body.center = random_array<3>(random, 1.5);
  Matrix3 factor;
  for (int i = 0; i < 3; ++i) factor.col(i) = random_array<3>(random, 3.0);
  // Any symmetric second moment J >= 0 makes the inertia tr(J) I - J of a real body.
  const Matrix3 J = factor * factor.transpose();
  body.inertia = J.trace() * Matrix3::Identity() - J;
  return body;
}

/// Which joints are free.
struct Joints {
  bool yaw = true;
  bool teeter = true;
  bool torsion = true;
  bool generator = true;
};

std::vector<Joints> all_joints() {
  std::vector<Joints> all;
  for (int i = 0; i < 16; ++i)
    all.push_back({(i & 1) != 0, (i & 2) != 0, (i & 4) != 0, (i & 8) != 0});
  return all;
}

/// Every mass, centre, inertia, angle, spring and damper is there, and the hinge is tilted.
RigidChain random_chain(std::minstd_rand& random, const Joints& joints) {
  RigidChain chain;
  chain.gravity = 9.81;
  chain.yaw = {joints.yaw, 300.0, 20.0};
  chain.teeter = {joints.teeter, 500.0, 30.0};
  chain.torsion = {joints.torsion, 700.0, 40.0};
  chain.generator = {joints.generator, 0.0, 50.0};
  chain.generator_inertia = 6.0;
  chain.gear_ratio = joints.torsion ? -2.3 : 3.1;
  chain.generator_torque = {70.0, 3.0, 5.0, {}};
  chain.rotor_torque = {90.0, -25.0, 1.7, {}};
  chain.tower_top = random_body(random, 2.0);
  chain.nacelle = random_body(random, 7.0);
  chain.shaft = random_body(random, 3.0);
  chain.hub = random_body(random, 5.0);
  chain.height = 1.2;
  chain.tilt = 0.2;
  chain.overhang = 2.4;
  chain.undersling = -0.6;
  chain.teeter_axis = Vector3(0.9, 0.2, -0.5).normalized();
  return chain;
}

/// The angle of a joint that is not free: mean + amplitude cos(2.3 t + phase).
struct Wave {
  double mean = 0.0;
  double amplitude = 0.0;
  double phase = 0.0;
};

/// Prescribed motion: psi = psi_0 + Omega t, and the angles of joints that are not free.
struct Prescribed {
  double azimuth = 0.0;
  double speed = 0.0;
  std::array<Wave, 4> waves{};  ///< q_y, q_h, q_s, q_g
};

/// Turns of vectors about one axis of a basis, by hand.
template <class T>
Mat3<T> about_1(const T& angle) {
  using std::cos;
  using std::sin;
  Mat3<T> m;
  m << T(1.0), T(0.0), T(0.0), T(0.0), cos(angle), -sin(angle), T(0.0), sin(angle), cos(angle);
  return m;
}
template <class T>
Mat3<T> about_2(const T& angle) {
  using std::cos;
  using std::sin;
  Mat3<T> m;
  m << cos(angle), T(0.0), sin(angle), T(0.0), T(1.0), T(0.0), -sin(angle), T(0.0), cos(angle);
  return m;
}
template <class T>
Mat3<T> about_3(const T& angle) {
  using std::cos;
  using std::sin;
  Mat3<T> m;
  m << cos(angle), -sin(angle), T(0.0), sin(angle), cos(angle), T(0.0), T(0.0), T(0.0), T(1.0);
  return m;
}
/// About the unit vector e: e e^T + cos (I - e e^T) + sin skew(e).
template <class T>
Mat3<T> about(const Vector3& e, const T& angle) {
  using std::cos;
  using std::sin;
  const Matrix3 along = e * e.transpose();
  Matrix3 across;
  across << 0.0, -e(2), e(1), e(2), 0.0, -e(0), -e(1), e(0), 0.0;
  Mat3<T> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      m(i, j) = T(along(i, j)) + cos(angle) * T((i == j ? 1.0 : 0.0) - along(i, j)) +
                sin(angle) * T(across(i, j));
  return m;
}

/// From components along (n3, n1, n2) to components along (n1, n2, n3).
template <class T>
Vec3<T> in_N(const Vec3<T>& a) {  // NOLINT: N is a frame
  return Vec3<T>(a(1), a(2), a(0));
}

/// Places and bases of all bodies in N; the columns of a basis are its unit vectors.
template <class T>
struct Configuration {
  Vec3<T> top, top_center, nacelle_center, shaft_center, hub_center, apex;
  Mat3<T> R_T, R_Y, R_L, R_G, R_S, R_H;  // L: low-speed end of the gear, G: the generator
};

template <class T>
Configuration<T> configuration_of(const RigidChain& chain, const Prescribed& prescribed,
                                  const Coordinates<T>& q, const T& t) {
  const auto angle_of = [&](const Hinge& hinge, int i) {
    using std::cos;
    const Wave& wave = prescribed.waves[static_cast<std::size_t>(i - at_yaw)];
    if (hinge.free) return q(i);
    return T(T(wave.mean) + T(wave.amplitude) * cos(T(2.3) * t + T(wave.phase)));
  };
  const auto fixed = [](const Vector3& v) { return Vec3<T>(v.cast<T>()); };
  Configuration<T> c;
  c.top = in_N<T>(q.template segment<3>(0));
  c.R_T = turned_by<T>(in_N<T>(q.template segment<3>(3)));
  c.R_Y = c.R_T * about_3<T>(angle_of(chain.yaw, at_yaw));
  T azimuth = T(prescribed.azimuth) + T(prescribed.speed) * t;
  azimuth += angle_of(chain.generator, at_generator);
  c.R_L = c.R_Y * about_1<T>(T(chain.tilt)) * about_2<T>(azimuth);
  c.R_G = c.R_Y * about_1<T>(T(chain.tilt)) * about_2<T>(azimuth * T(chain.gear_ratio));
  azimuth += angle_of(chain.torsion, at_torsion);
  c.R_S = c.R_Y * about_1<T>(T(chain.tilt)) * about_2<T>(azimuth);
  c.R_H = c.R_S * about<T>(chain.teeter_axis, angle_of(chain.teeter, at_teeter));
  const Vec3<T> bearing = c.top + c.R_Y * fixed(Vector3(0.0, 0.0, chain.height));
  const Vec3<T> pin = bearing + c.R_S * fixed(Vector3(0.0, chain.overhang, 0.0));
  c.top_center = c.top + c.R_T * fixed(chain.tower_top.center);
  c.nacelle_center = c.top + c.R_Y * fixed(chain.nacelle.center);
  c.shaft_center = bearing + c.R_S * fixed(chain.shaft.center);
  c.hub_center = pin + c.R_H * fixed(chain.hub.center);
  c.apex = pin + c.R_H * fixed(Vector3(0.0, chain.undersling, 0.0));
  return c;
}

/// The configuration along q + q_dot t with its rates.
template <class T>
Configuration<Jet<T>> moving(const RigidChain& chain, const Prescribed& prescribed,
                             const Coordinates<T>& q, const Coordinates<T>& q_dot, const T& t) {
  Coordinates<Jet<T>> path;
  for (int i = 0; i < coordinates; ++i) path(i) = Jet<T>(q(i), q_dot(i));
  return configuration_of<Jet<T>>(chain, prescribed, path, Jet<T>(t, T(1.0)));
}

/// m v.v / 2 + tr(R_dot J R_dot^T) / 2 with the second moment J = tr(I) / 2 - I of the body.
template <class T>
T kinetic_energy(const RigidBody& body, const Vec3<Jet<T>>& center, const Mat3<Jet<T>>& basis) {
  const Vec3<T> v = rate_of<T, 3, 1>(center);
  const Mat3<T> basis_dot = rate_of<T, 3, 3>(basis);
  const Matrix3 J = 0.5 * body.inertia.trace() * Matrix3::Identity() - body.inertia;
  const Mat3<T> turned = basis_dot * J.cast<T>();
  T energy(0.0);
  for (int i = 0; i < 3; ++i) {
    energy += v(i) * v(i) * T(0.5 * body.mass);
    for (int j = 0; j < 3; ++j) energy += turned(i, j) * basis_dot(i, j) * T(0.5);
  }
  return energy;
}

template <class T>
T kinetic_energy(const RigidChain& chain, const Prescribed& prescribed, const Coordinates<T>& q,
                 const Coordinates<T>& q_dot, const T& t) {
  const Configuration<Jet<T>> c = moving<T>(chain, prescribed, q, q_dot, t);
  RigidBody generator;
  generator.inertia(1, 1) = chain.generator_inertia;
  return kinetic_energy<T>(generator, c.top, c.R_G) +
         kinetic_energy<T>(chain.tower_top, c.top_center, c.R_T) +
         kinetic_energy<T>(chain.nacelle, c.nacelle_center, c.R_Y) +
         kinetic_energy<T>(chain.shaft, c.shaft_center, c.R_S) +
         kinetic_energy<T>(chain.hub, c.hub_center, c.R_H);
}

template <class T>
T potential_energy(const RigidChain& chain, const Prescribed& prescribed, const Coordinates<T>& q,
                   const T& t) {
  const Configuration<T> c = configuration_of<T>(chain, prescribed, q, t);
  T energy =
      (c.top_center(2) * T(chain.tower_top.mass) + c.nacelle_center(2) * T(chain.nacelle.mass) +
       c.shaft_center(2) * T(chain.shaft.mass) + c.hub_center(2) * T(chain.hub.mass)) *
      T(chain.gravity);
  if (chain.yaw.free) energy += q(at_yaw) * q(at_yaw) * T(0.5 * chain.yaw.stiffness);
  if (chain.teeter.free) energy += q(at_teeter) * q(at_teeter) * T(0.5 * chain.teeter.stiffness);
  if (chain.torsion.free)
    energy += q(at_torsion) * q(at_torsion) * T(0.5 * chain.torsion.stiffness);
  return energy;
}

/// Angular velocity, components in the turning basis.
template <class T>
Vec3<T> spin_of(const Mat3<Jet<T>>& basis) {
  return axial<T>(Mat3<T>(value_of<T, 3, 3>(basis).transpose() * rate_of<T, 3, 3>(basis)));
}

/// The generalized speeds (8) and those of the shaft by their definitions.
template <class T>
Speeds<T> speeds_of(const RigidChain& chain, const Prescribed& prescribed, const Coordinates<T>& q,
                    const Coordinates<T>& q_dot, const T& t) {
  const Configuration<Jet<T>> c = moving<T>(chain, prescribed, q, q_dot, t);
  const Vec3<T> v_T = value_of<T, 3, 3>(c.R_T).transpose() * rate_of<T, 3, 1>(c.top);
  const Vec3<T> omega_T = spin_of<T>(c.R_T);
  const Vec3<T> omega_H = spin_of<T>(c.R_H);
  Speeds<T> U;
  U << v_T(2), v_T(0), v_T(1), omega_T(2), omega_T(0), omega_T(1), spin_of<T>(c.R_Y)(2), T(0.0),
      spin_of<T>(c.R_S)(1), spin_of<T>(c.R_L)(1);
  for (int i = 0; i < 3; ++i) U(7) += omega_H(i) * T(chain.teeter_axis(i));
  return U;
}

/// v_top (N), omega_T (T), v_apex (H), omega_H (H): where loads are applied.
template <class T>
Eigen::Matrix<T, 12, 1> load_speeds(const RigidChain& chain, const Prescribed& prescribed,
                                    const Coordinates<T>& q, const Coordinates<T>& q_dot,
                                    const T& t) {
  const Configuration<Jet<T>> c = moving<T>(chain, prescribed, q, q_dot, t);
  Eigen::Matrix<T, 12, 1> v;
  v << rate_of<T, 3, 1>(c.top), value_of<T, 3, 3>(c.R_T) * spin_of<T>(c.R_T),
      value_of<T, 3, 3>(c.R_H).transpose() * rate_of<T, 3, 1>(c.apex), spin_of<T>(c.R_H);
  return v;
}

struct Instant {
  Prescribed prescribed;
  double t = 0.0;
  Coordinates<double> q, q_dot, q_ddot;
  Vector6 top_load, hub_load;
};

Instant random_instant(std::minstd_rand& random, const RigidChain& chain, bool moves) {
  Instant now;
  now.prescribed = {uniform(random, 3.0), 2.0 + uniform(random, 1.0)};
  if (moves)
    for (Wave& wave : now.prescribed.waves)
      wave = {uniform(random, 0.6), uniform(random, 0.5), uniform(random, 3.0)};
  now.t = uniform(random, 2.0);
  now.q = random_array<coordinates>(random, 1.0);
  now.q_dot = random_array<coordinates>(random, 1.0);
  now.q_ddot = random_array<coordinates>(random, 1.0);
  now.top_load = random_array<6>(random, 100.0);
  now.hub_load = random_array<6>(random, 100.0);
  if (!chain.yaw.free) now.q(at_yaw) = now.q_dot(at_yaw) = now.q_ddot(at_yaw) = 0.0;
  if (!chain.teeter.free) now.q(at_teeter) = now.q_dot(at_teeter) = now.q_ddot(at_teeter) = 0.0;
  if (!chain.torsion.free) now.q(at_torsion) = now.q_dot(at_torsion) = now.q_ddot(at_torsion) = 0.0;
  if (!chain.generator.free)
    now.q(at_generator) = now.q_dot(at_generator) = now.q_ddot(at_generator) = 0.0;
  return now;
}

/// q, q_dot, t as jets: the rate is along time, the inner rate along q_dot(i).
struct SecondOrder {
  using T = Jet<Jet<double>>;
  Coordinates<T> q, q_dot;
  T t;
};

SecondOrder along_time_and_speed(const Instant& now, int i) {
  using Inner = Jet<double>;
  SecondOrder s;
  for (int j = 0; j < coordinates; ++j) {
    s.q(j) = {Inner(now.q(j)), Inner(now.q_dot(j))};
    s.q_dot(j) = {Inner(now.q_dot(j), i == j ? 1.0 : 0.0), Inner(now.q_ddot(j))};
  }
  s.t = {Inner(now.t), Inner(1.0)};
  return s;
}

ChainState<double> state_of(const RigidChain& chain, const Instant& now, std::minstd_rand& random) {
  const SecondOrder s = along_time_and_speed(now, -1);
  const Speeds<SecondOrder::T> U =
      speeds_of<SecondOrder::T>(chain, now.prescribed, s.q, s.q_dot, s.t);
  ChainState<double> state;
  state.theta = now.q.segment<3>(3);
  for (int i = 0; i < 6; ++i) {
    state.top_velocity(i) = U(i).value.value;
    state.top_velocity_dot(i) = U(i).rate.value;
  }
  // A locked joint's own coordinate must not matter.
  const auto joint = [&](bool free, int i) {
    JointState<double> own;
    own.speed = U(i).value.value;
    own.speed_dot = U(i).rate.value;
    const Wave& wave = now.prescribed.waves[static_cast<std::size_t>(i - at_yaw)];
    const double turned = 2.3 * now.t + wave.phase;
    own.prescribed.angle = wave.mean + wave.amplitude * std::cos(turned);
    own.prescribed.rate = -2.3 * wave.amplitude * std::sin(turned);
    own.prescribed.acceleration = -2.3 * 2.3 * wave.amplitude * std::cos(turned);
    own.angle = free ? now.q(i) : uniform(random, 1.0);
    own.angle_dot = free ? now.q_dot(i) : uniform(random, 1.0);
    return own;
  };
  state.yaw = joint(chain.yaw.free, at_yaw);
  state.teeter = joint(chain.teeter.free, at_teeter);
  state.torsion = joint(chain.torsion.free, at_torsion);
  state.generator = joint(chain.generator.free, at_generator);
  state.top_load = now.top_load;
  state.hub_load = now.hub_load;
  state.azimuth = now.prescribed.azimuth + now.prescribed.speed * now.t;
  state.speed = now.prescribed.speed;
  return state;
}

/// One of Lagrange's equations, and the largest of its parts.
struct Balance {
  double value = 0.0;
  double scale = 0.0;

  void add(double part) {
    value += part;
    scale = std::max(scale, std::abs(part));
  }
};

/// Against the turning of the generator, at the speed that it has in the nacelle.
double generator_torque_of(const RigidChain& chain, const Instant& now) {
  const double turning = now.prescribed.speed + now.q_dot(at_generator);
  return chain.generator_torque.torque +
         chain.generator_torque.slope *
             (std::abs(chain.gear_ratio) * turning - chain.generator_torque.speed);
}

/// d/dt(dT/dq_dot) - dT/dq + dV/dq + dD/dq_dot - Q of coordinate i; 0 in motion.
Balance lagrange(const RigidChain& chain, const Instant& now, int i) {
  Balance balance;
  const SecondOrder s = along_time_and_speed(now, i);
  balance.add(kinetic_energy<SecondOrder::T>(chain, now.prescribed, s.q, s.q_dot, s.t).rate.rate);

  using Inner = Jet<double>;
  Coordinates<Inner> q = now.q.cast<Inner>();
  Coordinates<Inner> q_dot = now.q_dot.cast<Inner>();
  q(i).rate = 1.0;
  balance.add(-kinetic_energy<Inner>(chain, now.prescribed, q, q_dot, Inner(now.t)).rate);
  balance.add(potential_energy<Inner>(chain, now.prescribed, q, Inner(now.t)).rate);
  if (i == at_yaw) balance.add(chain.yaw.damping * now.q_dot(i));
  if (i == at_teeter) balance.add(chain.teeter.damping * now.q_dot(i));
  if (i == at_torsion) balance.add(chain.torsion.damping * now.q_dot(i));
  if (i == at_generator) balance.add(chain.generator.damping * now.q_dot(i));

  q(i).rate = 0.0;
  q_dot(i).rate = 1.0;
  const Eigen::Matrix<double, 12, 1> partial =
      rate_of<double, 12, 1>(load_speeds<Inner>(chain, now.prescribed, q, q_dot, Inner(now.t)));
  // The tower's end load acts on the next body with the opposite sign; its components are in a.
  const Vector3 top_force = in_N<double>(now.top_load.head<3>());
  const Vector3 top_moment = in_N<double>(now.top_load.tail<3>());
  balance.add(partial.segment<3>(0).dot(top_force));
  balance.add(partial.segment<3>(3).dot(top_moment));
  balance.add(-partial.segment<3>(6).dot(now.hub_load.head<3>()));
  balance.add(-partial.segment<3>(9).dot(now.hub_load.tail<3>()));
  // The torques: of the generator on its own angle, against its turning, of the rotor along h2.
  if (i == at_generator) balance.add(std::abs(chain.gear_ratio) * generator_torque_of(chain, now));
  const double spin = load_speeds<double>(chain, now.prescribed, now.q, now.q_dot, now.t)(10);
  balance.add(-partial(10) * (chain.rotor_torque.torque +
                              chain.rotor_torque.slope * (spin - chain.rotor_torque.speed)));
  return balance;
}

/// Kane's rows times dU/dq_dot(i).
double kane(const RigidChain& chain, const Instant& now, const ChainRows<double>& rows, int i) {
  using Inner = Jet<double>;
  const Coordinates<Inner> q = now.q.cast<Inner>();
  Coordinates<Inner> q_dot = now.q_dot.cast<Inner>();
  q_dot(i).rate = 1.0;
  const Speeds<double> partial = rate_of<double, coordinates, 1>(
      speeds_of<Inner>(chain, now.prescribed, q, q_dot, Inner(now.t)));
  double sum = partial.head<6>().dot(rows.top);
  if (chain.yaw.free) sum += partial(6) * rows.yaw.balance;
  if (chain.teeter.free) sum += partial(7) * rows.teeter.balance;
  if (chain.torsion.free) sum += partial(8) * rows.torsion.balance;
  // The generator's is that of its rate against the nacelle.
  if (chain.generator.free && i == at_generator) sum += rows.generator.balance;
  return sum;
}

bool moves(const RigidChain& chain, int i) {
  if (i == at_yaw) return chain.yaw.free;
  if (i == at_teeter) return chain.teeter.free;
  if (i == at_torsion) return chain.torsion.free;
  if (i == at_generator) return chain.generator.free;
  return true;
}

void compare_with_lagrange(const Joints& joints, bool prescribed = false) {
  std::minstd_rand random(1);
  for (int trial = 0; trial < 4; ++trial) {
    const RigidChain chain = random_chain(random, joints);
    const Instant now = random_instant(random, chain, prescribed);
    HubMotion<double> hub;
    const ChainRows<double> rows = rigid_chain<double>(chain, state_of(chain, now, random), hub);
    for (int i = 0; i < coordinates; ++i) {
      if (!moves(chain, i)) continue;
      const Balance balance = lagrange(chain, now, i);
      BOOST_TEST(std::abs(kane(chain, now, rows, i) + balance.value) < round_off * balance.scale,
                 "coordinate " << i << ": Kane " << kane(chain, now, rows, i) << ", Lagrange "
                               << -balance.value);
    }
  }
}

/// A chain state as one array, so that every quantity can be stepped.
constexpr int chain_inputs = 43;
template <class T>
ChainState<T> chain_state_of(const Eigen::Matrix<T, chain_inputs, 1>& x) {
  ChainState<T> state;
  state.theta = x.template segment<3>(0);
  state.top_velocity = x.template segment<6>(3);
  state.top_velocity_dot = x.template segment<6>(9);
  state.yaw = {x(15), x(16), x(17), x(18)};
  state.teeter = {x(19), x(20), x(21), x(22)};
  state.top_load = x.template segment<6>(23);
  state.hub_load = x.template segment<6>(29);
  state.torsion = {x(35), x(36), x(37), x(38)};
  state.generator = {x(39), x(40), x(41), x(42)};
  state.azimuth = 0.8;
  state.speed = 2.3;
  return state;
}

/// All results of the chain as one array: 14 rows and the hub's motion.
constexpr int chain_results = 23;
template <class T>
Eigen::Matrix<T, chain_results, 1> chain_results_of(const RigidChain& chain,
                                                    const Eigen::Matrix<T, chain_inputs, 1>& x) {
  HubMotion<T> hub;
  const ChainRows<T> rows = rigid_chain<T>(chain, chain_state_of<T>(x), hub);
  Eigen::Matrix<T, chain_results, 1> all;
  all.template head<6>() = rows.top;
  all(6) = rows.yaw.kinematic;
  all(7) = rows.yaw.balance;
  all(8) = rows.teeter.kinematic;
  all(9) = rows.teeter.balance;
  all(10) = rows.torsion.kinematic;
  all(11) = rows.torsion.balance;
  all(12) = rows.generator.kinematic;
  all(13) = rows.generator.balance;
  all.template segment<3>(14) = hub.velocity;
  all.template segment<3>(17) = hub.omega;
  all.template segment<3>(20) = hub.gravity;
  return all;
}

/// A state in which nothing moves.
ChainState<double> state_at_rest() {
  return chain_state_of<double>(Eigen::Matrix<double, chain_inputs, 1>::Zero());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(rigid_chain_rows)

BOOST_AUTO_TEST_CASE(kane_is_lagrange_with_all_joints_free) { compare_with_lagrange({}); }

BOOST_AUTO_TEST_CASE(kane_is_lagrange_whichever_joints_are_locked) {
  for (const Joints& joints : all_joints()) compare_with_lagrange(joints);
}

BOOST_AUTO_TEST_CASE(kane_is_lagrange_whichever_joints_move_as_prescribed) {
  for (const Joints& joints : all_joints()) compare_with_lagrange(joints, true);
}

BOOST_AUTO_TEST_CASE(a_joint_that_is_not_free_stands_where_it_is_prescribed) {
  RigidChain chain;
  ChainState<double> state = state_at_rest();
  state.yaw.angle = 0.7;
  state.yaw.prescribed = {0.2, 0.3, 0.4};
  HubMotion<double> hub;
  const ChainRows<double> rows = rigid_chain<double>(chain, state, hub);
  BOOST_TEST(std::abs(rows.yaw.position - 0.5) < round_off);
  BOOST_TEST(std::abs(rows.yaw.kinematic + 0.3) < round_off);  // U1 = 0
}

BOOST_AUTO_TEST_CASE(kinematic_rows_vanish_in_every_motion) {
  std::minstd_rand random(3);
  for (const Joints& joints : all_joints()) {
    const RigidChain chain = random_chain(random, joints);
    const Instant now = random_instant(random, chain, true);
    HubMotion<double> hub;
    const ChainState<double> still = state_of(chain, now, random);
    const ChainRows<double> rows = rigid_chain<double>(chain, still, hub);
    BOOST_TEST(std::abs(rows.yaw.kinematic) < round_off);
    BOOST_TEST(std::abs(rows.teeter.kinematic) < round_off);
    BOOST_TEST(std::abs(rows.torsion.kinematic) < round_off);
    BOOST_TEST(std::abs(rows.generator.kinematic) < round_off);
    // Free: q_dot - (U - ...); locked: U - ....
    const auto check = [&](JointState<double> ChainState<double>::*joint,
                           JointRows<double> ChainRows<double>::*row, bool free) {
      ChainState<double> state = still;
      (state.*joint).speed += 0.25;
      const ChainRows<double> changed = rigid_chain<double>(chain, state, hub);
      BOOST_TEST(std::abs((changed.*row).kinematic - (free ? -0.25 : 0.25)) < round_off);
    };
    check(&ChainState<double>::yaw, &ChainRows<double>::yaw, joints.yaw);
    check(&ChainState<double>::teeter, &ChainRows<double>::teeter, joints.teeter);
    check(&ChainState<double>::torsion, &ChainRows<double>::torsion, joints.torsion);
    check(&ChainState<double>::generator, &ChainRows<double>::generator, joints.generator);
  }
}

BOOST_AUTO_TEST_CASE(the_hub_moves_as_its_differentiated_position) {
  std::minstd_rand random(4);
  for (const Joints& joints : all_joints()) {
    const RigidChain chain = random_chain(random, joints);
    const Instant now = random_instant(random, chain, true);
    HubMotion<double> hub;
    rigid_chain<double>(chain, state_of(chain, now, random), hub);
    const Eigen::Matrix<double, 12, 1> speeds =
        load_speeds<double>(chain, now.prescribed, now.q, now.q_dot, now.t);
    const Configuration<double> c = configuration_of<double>(chain, now.prescribed, now.q, now.t);
    BOOST_TEST((hub.velocity - speeds.segment<3>(6)).norm() < round_off * hub.velocity.norm());
    BOOST_TEST((hub.omega - speeds.segment<3>(9)).norm() < round_off * hub.omega.norm());
    const Vector3 gravity = c.R_H.transpose() * Vector3(0.0, 0.0, -chain.gravity);
    BOOST_TEST((hub.gravity - gravity).norm() < round_off * chain.gravity);
  }
}

BOOST_AUTO_TEST_CASE(tilt_raises_the_downwind_end_of_the_shaft) {
  RigidChain chain;
  chain.gravity = 10.0;
  chain.tilt = 0.1;
  HubMotion<double> hub;
  ChainState<double> state = state_at_rest();
  state.azimuth = 0.0;
  state.speed = 0.0;
  rigid_chain<double>(chain, state, hub);
  BOOST_TEST(std::abs(hub.gravity(0)) < round_off);
  BOOST_TEST(std::abs(hub.gravity(1) + 10.0 * std::sin(0.1)) < round_off);
  BOOST_TEST(std::abs(hub.gravity(2) + 10.0 * std::cos(0.1)) < round_off);
}

BOOST_AUTO_TEST_CASE(positive_azimuth_turns_h3_from_up_toward_n1) {
  RigidChain chain;
  chain.gravity = 10.0;
  HubMotion<double> hub;
  ChainState<double> state = state_at_rest();
  state.azimuth = 0.3;
  state.speed = 2.0;
  rigid_chain<double>(chain, state, hub);
  // h3 = n3 cos + n1 sin, h1 = n1 cos - n3 sin.
  BOOST_TEST(std::abs(hub.gravity(2) + 10.0 * std::cos(0.3)) < round_off);
  BOOST_TEST(std::abs(hub.gravity(0) - 10.0 * std::sin(0.3)) < round_off);
  BOOST_TEST((hub.omega - Vector3(0.0, 2.0, 0.0)).norm() < round_off);
}

BOOST_AUTO_TEST_CASE(the_tower_top_carries_the_weight_of_all_bodies_at_rest) {
  std::minstd_rand random(5);
  RigidChain chain = random_chain(random, {false, false, false, false});
  ChainState<double> state = state_at_rest();
  state.speed = 0.0;
  HubMotion<double> hub;
  const double weight = chain.gravity * (chain.tower_top.mass + chain.nacelle.mass +
                                         chain.shaft.mass + chain.hub.mass);
  state.top_load.head<3>() = Vector3(-weight, 0.0, 0.0);  // along n3
  const ChainRows<double> rows = rigid_chain<double>(chain, state, hub);
  BOOST_TEST(rows.top.head<3>().norm() < round_off * weight);
}

BOOST_AUTO_TEST_CASE(the_teeter_balance_of_a_centred_hub_is_that_of_the_papers_appendix) {
  // Appendix A for c_h = 0 and h1 the hinge, small angles: Euler's equation about h1,
  // -I1 U2_dot - C q_h_dot - (K + Omega^2 (I2 - I3)) q_h
  //   + Omega (I2 - I3) (sin(psi) U3 + cos(psi) U1), q_h_dot = U2 - cos(psi) U3 + sin(psi) U1.
  RigidChain chain;
  chain.yaw = {true, 0.0, 0.0};
  chain.teeter = {true, 40.0, 3.0};
  chain.hub.mass = 5.0;
  chain.hub.inertia = Vector3(50.0, 70.0, 30.0).asDiagonal();
  chain.overhang = 2.4;
  constexpr double psi = 0.8;
  constexpr double Omega = 2.3;
  constexpr double I1 = 50.0;
  constexpr double I2 = 70.0;
  constexpr double I3 = 30.0;
  Eigen::Matrix<double, chain_inputs, 1> gradient = Eigen::Matrix<double, chain_inputs, 1>::Zero();
  gradient(20) = -3.0;                                                      // U2
  gradient(22) = -I1;                                                       // U2_dot
  gradient(19) = -(40.0 + Omega * Omega * (I2 - I3));                       // q_h
  gradient(7) = 3.0 * std::cos(psi) + Omega * (I2 - I3) * std::sin(psi);    // U3
  gradient(16) = -3.0 * std::sin(psi) + Omega * (I2 - I3) * std::cos(psi);  // U1
  for (int i = 0; i < chain_inputs; ++i) {
    if (i == 32) continue;  // the blades' moment about h1, which the hub passes on as it is
    Eigen::Matrix<Complex, chain_inputs, 1> x = Eigen::Matrix<Complex, chain_inputs, 1>::Zero();
    x(i) = Complex(0.0, complex_step);
    const double slope = chain_results_of<Complex>(chain, x)(9).imag() / complex_step;
    BOOST_TEST(std::abs(slope - gradient(i)) < round_off * I1 * Omega * Omega,
               "input " << i << ": " << slope << " instead of " << gradient(i));
  }
}

BOOST_AUTO_TEST_CASE(a_yaw_spring_pulls_back_on_the_nacelle_and_forward_on_the_tower) {
  RigidChain chain;
  chain.yaw = {true, 100.0, 10.0};
  ChainState<double> state = state_at_rest();
  state.azimuth = 0.0;
  state.speed = 0.0;
  state.yaw.angle = 0.2;
  state.yaw.speed = 0.3;
  HubMotion<double> hub;
  const ChainRows<double> rows = rigid_chain<double>(chain, state, hub);
  BOOST_TEST(std::abs(rows.yaw.balance + 23.0) < round_off * 23.0);
  BOOST_TEST(std::abs(rows.top(3) - 23.0) < round_off * 23.0);  // row of U5, about t3
}

BOOST_AUTO_TEST_CASE(tangents_are_those_of_the_complex_step) {
  std::minstd_rand random(6);
  using Dual = math::Dual<chain_inputs>;
  for (const Joints& joints : all_joints()) {
    const RigidChain chain = random_chain(random, joints);
    Eigen::Matrix<double, chain_inputs, 1> x = random_array<chain_inputs>(random, 2.0);
    x.head<3>() = 2.0 * random_array<3>(random, 1.0).normalized();
    Eigen::Matrix<Dual, chain_inputs, 1> dual;
    for (int i = 0; i < chain_inputs; ++i) dual(i) = math::independent<chain_inputs>(x(i), i);
    const Eigen::Matrix<Dual, chain_results, 1> by_dual = chain_results_of<Dual>(chain, dual);
    Eigen::Matrix<double, chain_results, chain_inputs> by_step;
    for (int i = 0; i < chain_inputs; ++i) {
      Eigen::Matrix<Complex, chain_inputs, 1> stepped = x.cast<Complex>();
      stepped(i) += Complex(0.0, complex_step);
      by_step.col(i) = chain_results_of<Complex>(chain, stepped).imag() / complex_step;
    }
    for (int row = 0; row < chain_results; ++row) {
      const Eigen::Matrix<double, chain_inputs, 1> expected = by_step.row(row).transpose();
      const Eigen::Matrix<double, chain_inputs, 1> found = by_dual(row).derivatives();
      const double scale = expected.cwiseAbs().maxCoeff();
      const bool unused = (row == 7 && !joints.yaw) || (row == 9 && !joints.teeter) ||
                          (row == 11 && !joints.torsion) || (row == 13 && !joints.generator);
      BOOST_TEST((scale > 0.0) == !unused, "row " << row);
      BOOST_TEST((found - expected).cwiseAbs().maxCoeff() <= tangent_tolerance * scale,
                 "row " << row);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
