#include "samara/elements/beam_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "samara/elements/beam_tip.hpp"
#include "samara/math/autodiff.hpp"

#include "jet.hpp"

namespace {

using namespace samara;
using namespace samara::elements;
using Complex = std::complex<double>;

template <class T>
using State = Eigen::Matrix<T, point_size, 1>;

/// Entries of order 1 to 100 after some hundred operations.
constexpr double round_off = 1e-12;

/// Tangents by automatic differentiation against the complex step, relative to the row's norm.
constexpr double tangent_tolerance = 1e-11;
constexpr double complex_step = 1e-30;

constexpr int inputs = 2 * point_size + 9;  // z, z_dot, v_a, omega_a, gravity
using Inputs = Eigen::Matrix<double, inputs, 1>;

double uniform(std::minstd_rand& random, double size) {
  return std::uniform_real_distribution<double>(-size, size)(random);
}

template <int n>
Eigen::Matrix<double, n, 1> random_array(std::minstd_rand& random, double size) {
  Eigen::Matrix<double, n, 1> v;
  for (int i = 0; i < n; ++i) v(i) = uniform(random, size);
  return v;
}

/// A full symmetric matrix, positive definite.
Matrix6 random_definite(std::minstd_rand& random) {
  Matrix6 factor;
  for (int i = 0; i < 6; ++i) factor.col(i) = random_array<6>(random, 1.0);
  return factor * factor.transpose() + 0.1 * Matrix6::Identity();
}

/// A point mass at `c` of the section.
struct Particle {
  double mass = 0.0;
  Vector3 c = Vector3::Zero();
};

const std::vector<Particle> particles{{2.0, Vector3(0.3, 0.5, -0.4)},
                                      {1.0, Vector3(-0.2, -0.7, 0.6)},
                                      {0.5, Vector3(0.1, 0.2, 0.9)},
                                      {1.5, Vector3(-0.6, 0.3, 0.2)}};

/// Section mass (3) of point masses: P = sum m (V + Omega x c), H = sum m c x (V + Omega x c).
Matrix6 mass_of(const std::vector<Particle>& all) {
  Matrix6 mass = Matrix6::Zero();
  for (const Particle& p : all) {
    const Matrix3 across = math::skew<double>(p.c);
    mass.topLeftCorner<3, 3>() += p.mass * Matrix3::Identity();
    mass.topRightCorner<3, 3>() -= p.mass * across;
    mass.bottomLeftCorner<3, 3>() += p.mass * across;
    mass.bottomRightCorner<3, 3>() -= p.mass * across * across;
  }
  return mass;
}

/// Twist about b1 and a direction of b1 of its own, full mass and compliance, all strains damped.
BeamPoint random_point(std::minstd_rand& random) {
  BeamPoint point;
  point.x = random_array<3>(random, 3.0);
  point.C_ab = turned_by<double>(random_array<3>(random, 1.0));
  point.compliance = 0.05 * random_definite(random);
  point.mass = mass_of(particles);
  for (int i = 0; i < 6; ++i) point.damping(i) = 0.02 * (i + 1);
  return point;
}

Attachment<double> random_attachment(std::minstd_rand& random) {
  Attachment<double> a;
  a.v = random_array<3>(random, 3.0);
  a.omega = random_array<3>(random, 2.0);
  a.gravity = random_array<3>(random, 10.0);
  return a;
}

/// The terms as named blocks of three, for loops over all of them.
template <class T>
std::vector<std::pair<std::string, Vec3<T>>> blocks_of(const PointTerms<T>& terms) {
  return {{"force_flux", terms.force_flux},   {"force_load", terms.force_load},
          {"moment_flux", terms.moment_flux}, {"moment_load", terms.moment_load},
          {"stretch", terms.stretch},         {"turn", terms.turn},
          {"velocity", terms.velocity},       {"spin", terms.spin}};
}

template <class T>
std::vector<std::pair<std::string, Vec3<T>>> blocks_of(const TipTerms<T>& terms) {
  return {{"velocity", terms.velocity},
          {"spin", terms.spin},
          {"force", terms.force},
          {"moment", terms.moment}};
}

/// Largest difference of the derivatives of `terms(z, z_dot, a)` by automatic differentiation and
/// by the complex step, relative to the largest entry of its row.
template <class Terms>
double tangent_error(const Inputs& at, const Terms& terms) {
  const auto evaluate = [&terms](const auto& x) {
    using T = typename std::decay_t<decltype(x)>::Scalar;
    const State<T> z = x.template head<point_size>();
    const State<T> z_dot = x.template segment<point_size>(point_size);
    Attachment<T> a;
    a.v = x.template segment<3>(2 * point_size);
    a.omega = x.template segment<3>(2 * point_size + 3);
    a.gravity = x.template segment<3>(2 * point_size + 6);
    return blocks_of(terms(z, z_dot, a));
  };
  using Dual = math::Dual<inputs>;
  Eigen::Matrix<Dual, inputs, 1> dual;
  for (int i = 0; i < inputs; ++i) dual(i) = math::independent<inputs>(at(i), i);
  const auto by_dual = evaluate(dual);
  std::vector<Eigen::Matrix<double, 3, inputs>> by_step(by_dual.size());
  for (int i = 0; i < inputs; ++i) {
    Eigen::Matrix<Complex, inputs, 1> stepped = at.cast<Complex>();
    stepped(i) += Complex(0.0, complex_step);
    const auto blocks = evaluate(stepped);
    for (std::size_t b = 0; b < blocks.size(); ++b)
      by_step[b].col(i) = blocks[b].second.imag() / complex_step;
  }
  double worst = 0.0;
  for (std::size_t b = 0; b < by_dual.size(); ++b) {
    for (int row = 0; row < 3; ++row) {
      const Inputs derivative = by_dual[b].second(row).derivatives();
      const Inputs expected = by_step[b].row(row).transpose();
      const double scale = expected.cwiseAbs().maxCoeff();
      BOOST_TEST_REQUIRE(scale > 0.0, by_dual[b].first << " depends on nothing");
      worst = std::max(worst, (derivative - expected).cwiseAbs().maxCoeff() / scale);
    }
  }
  return worst;
}

Inputs random_inputs(std::minstd_rand& random) {
  Inputs x = random_array<inputs>(random, 2.0);
  x.segment<3>(3) = 2.0 * random_array<3>(random, 1.0).normalized();  // a turn of 90 degrees
  x.tail<3>() *= 5.0;
  return x;
}

// ---- a trajectory of the attachment frame and of a section in it
// ---------------------------------

/// Value at time t of a curve through `c[0]` with velocity c[1], acceleration 2 c[2], ...
template <class T>
Vec3<T> curve(const std::array<Vector3, 4>& c, const T& t) {
  Vec3<T> p;
  for (int i = 0; i < 3; ++i) {
    p(i) = T(c[3](i));
    for (int k = 2; k >= 0; --k) p(i) = p(i) * t + T(c[static_cast<std::size_t>(k)](i));
  }
  return p;
}

struct Trajectory {
  std::array<Vector3, 4> origin, turn, u, theta;
  BeamPoint point;

  /// Components in the inertial basis of a vector given in a, and in B.
  template <class T>
  Mat3<T> from_a(const T& t) const {
    return turned_by<T>(curve<T>(turn, t));
  }
  template <class T>
  Mat3<T> from_B(const T& t) const {  // NOLINT: B is a basis
    const Mat3<T> relative = turned_by<T>(curve<T>(theta, t));
    return from_a<T>(t) * relative * point.C_ab.cast<T>();
  }
  /// Inertial position of the point `c` of the section.
  template <class T>
  Vec3<T> place(const T& t, const Vector3& c) const {
    const Vec3<T> in_a = curve<T>(u, t) + point.x.cast<T>();
    return curve<T>(origin, t) + from_a<T>(t) * in_a + from_B<T>(t) * c.cast<T>();
  }
  /// V, Omega: inertial velocity and angular velocity in B.
  template <class T>
  Vec6<T> velocity(const T& t) const {
    const Jet<T> time(t, T(1.0));
    const Mat3<T> C = from_B<T>(t);
    Vec6<T> v;
    v.template head<3>() = C.transpose() * rate_of<T, 3, 1>(place<Jet<T>>(time, Vector3::Zero()));
    v.template tail<3>() =
        axial<T>(Mat3<T>(C.transpose() * rate_of<T, 3, 3>(from_B<Jet<T>>(time))));
    return v;
  }
};

Trajectory random_trajectory(std::minstd_rand& random) {
  Trajectory path;
  for (std::array<Vector3, 4>* c : {&path.origin, &path.turn, &path.u, &path.theta})
    for (Vector3& coefficient : *c) coefficient = random_array<3>(random, 1.0);
  path.point = random_point(random);
  return path;
}

/// The attachment frame's motion and the section's state on a trajectory at t = 0.
struct Moment {
  State<double> z = State<double>::Zero();
  State<double> z_dot = State<double>::Zero();
  Attachment<double> a;
};

Moment moment_of(const Trajectory& path) {
  const Jet<double> time(0.0, 1.0);
  Moment now;
  now.z.segment<3>(0) = path.u[0];
  now.z.segment<3>(3) = path.theta[0];
  now.z_dot.segment<3>(0) = path.u[1];
  now.z_dot.segment<3>(3) = path.theta[1];
  const Vec6<Jet<double>> velocity = path.velocity<Jet<double>>(time);
  now.z.segment<6>(6) = value_of<double, 6, 1>(velocity);
  now.z_dot.segment<6>(6) = rate_of<double, 6, 1>(velocity);
  const Matrix3 A = path.from_a<double>(0.0);
  now.a.v = A.transpose() * path.origin[1];
  now.a.omega =
      axial<double>(Matrix3(A.transpose() * rate_of<double, 3, 3>(path.from_a<Jet<double>>(time))));
  return now;
}

/// Inertial acceleration of the point `c` of the section.
Vector3 acceleration_of(const Trajectory& path, const Vector3& c) {
  using Twice = Jet<Jet<double>>;
  const Twice time(Jet<double>(0.0, 1.0), Jet<double>(1.0, 0.0));
  const Vec3<Twice> place = path.place<Twice>(time, c);
  return rate_of<double, 3, 1>(rate_of<Jet<double>, 3, 1>(place));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(beam_point)

BOOST_AUTO_TEST_CASE(rigid_placement_produces_no_strain) {
  std::minstd_rand random(1);
  for (int trial = 0; trial < 10; ++trial) {
    const BeamPoint point = random_point(random);
    const Vector3 theta = random_array<3>(random, 2.0);
    const Matrix3 turn = turned_by<double>(theta);
    State<double> z = State<double>::Zero();
    z.segment<3>(0) = random_array<3>(random, 5.0) + turn * point.x - point.x;
    z.segment<3>(3) = theta;
    const PointTerms<double> terms = beam_point_terms<double>(point, z, State<double>::Zero(), {});
    // u' of the turned line, and theta' = 0.
    const Vector3 slope = (turn - Matrix3::Identity()) * point.C_ab.col(0);
    BOOST_TEST((terms.stretch - slope).norm() < round_off);
    BOOST_TEST(terms.turn.norm() == 0.0);
    BOOST_TEST(terms.force_flux.norm() == 0.0);
    BOOST_TEST(terms.moment_flux.norm() == 0.0);
    BOOST_TEST(terms.force_load.norm() == 0.0);
    BOOST_TEST(terms.moment_load.norm() == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(rigid_motion_with_the_attachment_satisfies_the_kinematic_rows) {
  std::minstd_rand random(2);
  const BeamPoint point = random_point(random);
  const Attachment<double> a = random_attachment(random);
  State<double> z = State<double>::Zero();
  const Vector3 v = a.v + a.omega.cross(point.x);
  z.segment<3>(6) = point.C_ab.transpose() * v;
  z.segment<3>(9) = point.C_ab.transpose() * a.omega;
  const PointTerms<double> terms = beam_point_terms<double>(point, z, State<double>::Zero(), a);
  BOOST_TEST(terms.velocity.norm() < round_off);
  BOOST_TEST(terms.spin.norm() < round_off);
}

BOOST_AUTO_TEST_CASE(kinematic_rows_vanish_on_any_trajectory_in_any_moving_frame) {
  std::minstd_rand random(3);
  for (int trial = 0; trial < 10; ++trial) {
    const Trajectory path = random_trajectory(random);
    const Moment now = moment_of(path);
    const PointTerms<double> terms = beam_point_terms<double>(path.point, now.z, now.z_dot, now.a);
    BOOST_TEST(terms.velocity.norm() < round_off);
    BOOST_TEST(terms.spin.norm() < round_off);
    State<double> other = now.z;
    other.segment<6>(6).array() += 0.5;
    const PointTerms<double> off = beam_point_terms<double>(path.point, other, now.z_dot, now.a);
    BOOST_TEST((off.velocity - Vector3::Constant(0.5)).norm() < round_off);
    BOOST_TEST((off.spin - Vector3::Constant(0.5)).norm() < round_off);
  }
}

BOOST_AUTO_TEST_CASE(loads_are_newtons_law_of_the_particles_of_the_section) {
  // sum m (acceleration - g) and its moment about the reference line, in any moving frame.
  std::minstd_rand random(4);
  for (int trial = 0; trial < 10; ++trial) {
    const Trajectory path = random_trajectory(random);
    Moment now = moment_of(path);
    now.a.gravity = random_array<3>(random, 10.0);
    const PointTerms<double> terms = beam_point_terms<double>(path.point, now.z, now.z_dot, now.a);
    const Matrix3 A = path.from_a<double>(0.0);
    const Matrix3 R = A.transpose() * path.from_B<double>(0.0);
    Vector3 force = Vector3::Zero();
    Vector3 moment = Vector3::Zero();
    for (const Particle& p : particles) {
      const Vector3 asked = p.mass * (A.transpose() * acceleration_of(path, p.c) - now.a.gravity);
      force += asked;
      moment += (R * p.c).cross(asked);
    }
    BOOST_TEST((terms.force_load - force).norm() < round_off * (1.0 + force.norm()));
    BOOST_TEST((terms.moment_load - moment).norm() < round_off * (1.0 + moment.norm()));
  }
}

BOOST_AUTO_TEST_CASE(a_superposed_rotation_turns_every_term_with_it) {
  std::minstd_rand random(5);
  for (int trial = 0; trial < 10; ++trial) {
    const BeamPoint point = random_point(random);
    const Attachment<double> a = random_attachment(random);
    State<double> z = random_array<point_size>(random, 1.0);
    State<double> z_dot = random_array<point_size>(random, 1.0);
    const Matrix3 turn = turned_by<double>(random_array<3>(random, 0.8));
    const Vector3 theta = z.segment<3>(3);
    const Vector3 theta_dot = z_dot.segment<3>(3);
    const Vector3 place = point.x + z.segment<3>(0);
    const Vector3 rate = z_dot.segment<3>(0);
    State<double> z_turned = z;
    State<double> z_turned_dot = z_dot;
    z_turned.segment<3>(0) = turn * place - point.x;
    z_turned_dot.segment<3>(0) = turn * rate;
    z_turned.segment<3>(3) = parameters_of(turn * turned_by<double>(theta));
    // The rate of the composed parameters, by a central difference with Richardson's extrapolation.
    const auto composed = [&](double h) {
      return parameters_of(turn * turned_by<double>(Vector3(theta + h * theta_dot)));
    };
    const auto central = [&](double h) {
      return Vector3((composed(h) - composed(-h)) / (2.0 * h));
    };
    const double h = 1e-3;
    z_turned_dot.segment<3>(3) =
        (64.0 * central(h / 4.0) - 20.0 * central(h / 2.0) + central(h)) / 45.0;
    const Attachment<double> a_turned{turn * a.v, turn * a.omega, turn * a.gravity};

    const PointTerms<double> terms = beam_point_terms<double>(point, z, z_dot, a);
    const PointTerms<double> turned =
        beam_point_terms<double>(point, z_turned, z_turned_dot, a_turned);
    BOOST_TEST((turned.force_flux - turn * terms.force_flux).norm() < round_off);
    BOOST_TEST((turned.moment_flux - turn * terms.moment_flux).norm() < round_off);
    BOOST_TEST((turned.force_load - turn * terms.force_load).norm() < 10.0 * round_off);
    BOOST_TEST((turned.moment_load - turn * terms.moment_load).norm() < 10.0 * round_off);
    const Vector3 e1 = point.C_ab.col(0);
    BOOST_TEST((turned.stretch + e1 - turn * (terms.stretch + e1)).norm() < round_off);
    BOOST_TEST((turned.velocity - terms.velocity).norm() < round_off);
    // The difference of theta's composed rate leaves about 1e-12 of round-off over the step.
    BOOST_TEST((turned.spin - terms.spin).norm() < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(stretch_is_the_slope_of_the_deformed_line) {
  // (x + u)' = R (e1 + gamma), gamma = S^-1 {F; M} with its couplings.
  std::minstd_rand random(6);
  const BeamPoint point = random_point(random);
  const State<double> z = random_array<point_size>(random, 1.0);
  const PointTerms<double> terms = beam_point_terms<double>(point, z, State<double>::Zero(), {});
  const Vector6 load = z.tail<6>();
  const Vector3 gamma = (point.compliance * load).head<3>();
  const Matrix3 R = turned_by<double>(Vector3(z.segment<3>(3))) * point.C_ab;
  const Vector3 slope = R * (Vector3::UnitX() + gamma) - point.C_ab.col(0);
  BOOST_TEST((terms.stretch - slope).norm() < round_off);
}

BOOST_AUTO_TEST_CASE(turn_is_the_slope_of_theta_that_curves_the_line_by_kappa) {
  // skew(kappa) = C_ba (turn^T turn') C_ab along theta' = the term, theta' by the jet.
  std::minstd_rand random(7);
  for (int trial = 0; trial < 10; ++trial) {
    const BeamPoint point = random_point(random);
    State<double> z = random_array<point_size>(random, 1.0);
    z.segment<3>(3) *= 2.0;
    const PointTerms<double> terms = beam_point_terms<double>(point, z, State<double>::Zero(), {});
    const Vector6 load = z.tail<6>();
    const Vector3 kappa = (point.compliance * load).tail<3>();
    Vec3<Jet<double>> theta;
    for (int i = 0; i < 3; ++i) theta(i) = Jet<double>(z(3 + i), terms.turn(i));
    const Mat3<Jet<double>> turn = turned_by<Jet<double>>(theta);
    const Matrix3 curved = value_of<double, 3, 3>(turn).transpose() * rate_of<double, 3, 3>(turn);
    const Vector3 found = point.C_ab.transpose() * axial<double>(curved);
    BOOST_TEST((found - kappa).norm() < round_off);
  }
}

BOOST_AUTO_TEST_CASE(moment_of_the_section_force_acts_on_the_deformed_line) {
  // At rest: moment load = - (x + u)' x R F, with which a beam's balance about any point closes.
  std::minstd_rand random(8);
  BeamPoint point = random_point(random);
  point.mass.setZero();
  State<double> z = random_array<point_size>(random, 1.0);
  const PointTerms<double> terms = beam_point_terms<double>(point, z, State<double>::Zero(), {});
  const Vector3 slope = terms.stretch + point.C_ab.col(0);
  BOOST_TEST((terms.moment_load + slope.cross(terms.force_flux)).norm() < round_off);
  BOOST_TEST(terms.force_load.norm() == 0.0);
}

BOOST_AUTO_TEST_CASE(weight_pulls_along_gravity_at_the_mass_centre) {
  BeamPoint point;
  const Vector3 c(0.0, 0.2, -0.1);
  point.mass = mass_of({{3.0, c}});
  Attachment<double> a;
  a.gravity = Vector3(-9.0, 0.0, 0.0);
  const PointTerms<double> terms =
      beam_point_terms<double>(point, State<double>::Zero(), State<double>::Zero(), a);
  // The load is what the section asks for: minus the weight and minus its moment about the line.
  BOOST_TEST((terms.force_load - Vector3(27.0, 0.0, 0.0)).norm() < round_off);
  BOOST_TEST((terms.moment_load - c.cross(Vector3(27.0, 0.0, 0.0))).norm() < round_off);
}

BOOST_AUTO_TEST_CASE(damping_adds_mu_times_the_rate_of_the_load_and_leaves_the_strains) {
  std::minstd_rand random(9);
  BeamPoint point = random_point(random);
  const State<double> z = random_array<point_size>(random, 1.0);
  State<double> z_dot = random_array<point_size>(random, 1.0);
  const PointTerms<double> damped = beam_point_terms<double>(point, z, z_dot, {});
  const Vector6 extra = point.damping.cwiseProduct(z_dot.tail<6>());
  point.damping.setZero();
  const PointTerms<double> plain = beam_point_terms<double>(point, z, z_dot, {});
  const Matrix3 R = turned_by<double>(Vector3(z.segment<3>(3))) * point.C_ab;
  BOOST_TEST((damped.force_flux - plain.force_flux - R * extra.head<3>()).norm() < round_off);
  BOOST_TEST((damped.moment_flux - plain.moment_flux - R * extra.tail<3>()).norm() < round_off);
  BOOST_TEST((damped.stretch - plain.stretch).norm() == 0.0);
  BOOST_TEST((damped.turn - plain.turn).norm() == 0.0);
  const Vector3 slope = plain.stretch + point.C_ab.col(0);
  const Vector3 force = R * extra.head<3>();
  BOOST_TEST((damped.moment_load - plain.moment_load + slope.cross(force)).norm() < round_off);
}

BOOST_AUTO_TEST_CASE(tangents_are_those_of_the_complex_step) {
  std::minstd_rand random(10);
  for (int trial = 0; trial < 5; ++trial) {
    const BeamPoint point = random_point(random);
    const double error = tangent_error(random_inputs(random),
                                       [&point](const auto& z, const auto& z_dot, const auto& a) {
                                         return beam_point_terms(point, z, z_dot, a);
                                       });
    BOOST_TEST(error < tangent_tolerance);
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(beam_tip)

BOOST_AUTO_TEST_CASE(the_load_behind_a_rigid_mass_is_newtons_and_eulers_law_in_any_moving_frame) {
  std::minstd_rand random(11);
  for (int trial = 0; trial < 10; ++trial) {
    Trajectory path = random_trajectory(random);
    path.point.C_ab.setIdentity();
    Moment now = moment_of(path);
    now.a.gravity = random_array<3>(random, 10.0);
    now.z.tail<6>() = random_array<6>(random, 5.0);
    // Particles make a rigid body of any centre and inertia.
    std::vector<Particle> particles;
    for (int i = 0; i < 4; ++i) particles.push_back({1.0 + 0.5 * i, random_array<3>(random, 0.7)});
    const TipTerms<double> terms = beam_tip_terms<double>(
        path.point.x, Matrix3::Identity(), mass_of(particles), now.z, now.z_dot, now.a);
    BOOST_TEST(terms.velocity.norm() < round_off);
    BOOST_TEST(terms.spin.norm() < round_off);
    const Matrix3 C_an = path.from_a<double>(0.0).transpose();
    const Matrix3 R = turned_by<double>(Vector3(now.z.segment<3>(3)));
    Vector3 force = now.z.segment<3>(12);
    Vector3 moment = now.z.tail<3>();
    for (const Particle& p : particles) {  // each feels minus the load and its weight
      const Vector3 asked = p.mass * (C_an * acceleration_of(path, p.c) - now.a.gravity);
      force += asked;
      moment += Vector3(R * p.c).cross(asked);
    }
    BOOST_TEST((terms.force - force).norm() < round_off * (1.0 + force.norm()));
    BOOST_TEST((terms.moment - moment).norm() < round_off * (1.0 + moment.norm()));
  }
}

BOOST_AUTO_TEST_CASE(a_free_end_carries_no_load) {
  std::minstd_rand random(12);
  const State<double> z = random_array<point_size>(random, 1.0);
  const TipTerms<double> terms =
      beam_tip_terms<double>(Vector3::UnitX(), Matrix3::Identity(), Matrix6::Zero(), z,
                             random_array<point_size>(random, 1.0), random_attachment(random));
  BOOST_TEST((terms.force - z.segment<3>(12)).norm() == 0.0);
  BOOST_TEST((terms.moment - z.segment<3>(15)).norm() == 0.0);
}

BOOST_AUTO_TEST_CASE(tangents_are_those_of_the_complex_step) {
  std::minstd_rand random(13);
  for (int trial = 0; trial < 5; ++trial) {
    const Vector3 x = random_array<3>(random, 3.0);
    const Matrix6 mass =
        mass_of({{2.5, random_array<3>(random, 0.5)}, {1.5, random_array<3>(random, 0.5)}});
    const Matrix3 reference =
        math::direction_cosines<double>(random_array<3>(random, 4.0)).transpose();
    const double error =
        tangent_error(random_inputs(random),
                      [&x, &reference, &mass](const auto& z, const auto& z_dot, const auto& a) {
                        return beam_tip_terms(x, reference, mass, z, z_dot, a);
                      });
    BOOST_TEST(error < tangent_tolerance);
  }
}

BOOST_AUTO_TEST_SUITE_END()
