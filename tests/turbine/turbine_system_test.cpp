// The assembled residual and its tangents at states in which everything moves, the renaming of
// blades, and what the unknowns are called.
#include "samara/turbine/turbine_system.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/base/error.hpp"
#include "samara/elements/beam_tip.hpp"
#include "samara/math/quadrature.hpp"

#include "../elements/chain_walk.hpp"
#include "bodies.hpp"

namespace {

using namespace samara;
using Complex = std::complex<double>;

constexpr int block = turbine::TurbineLayout::block;

/// Sums of some hundred products, relative to the largest entry of their row or part.
constexpr double round_off = 1e-12;

/// Tangents against the complex step, relative to the norm of their row.
constexpr double tangent_tolerance = 1e-11;
constexpr double complex_step = 1e-30;

/// Differences of eighth order of the assembled residual itself: what round-off over the step
/// leaves.
constexpr double difference_step = 2e-3;
constexpr double difference_tolerance = 1e-9;

// ---- the sum over points and nodes of docs/theory.md, section 2, for any scalar
// ------------------

template <class T>
using Array = Eigen::Matrix<T, Eigen::Dynamic, 1>;
template <class T>
using PointState = Eigen::Matrix<T, block, 1>;

/// A beam's unknowns, rows and attachment.
struct Place {
  const model::Beam* beam = nullptr;
  std::vector<int> points;
  std::vector<int> masses;
  int tip = 0;
  int root = 0;
  int blade = -1;  ///< -1: the tower
};

std::vector<Place> places_of(const turbine::TurbineSystem& system) {
  const model::Turbine& turbine = system.turbine();
  const turbine::TurbineLayout& layout = system.layout();
  std::vector<Place> places;
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
    const int blade = static_cast<int>(k);
    Place place{&turbine.blades[k],       {},   {}, layout.blade_tip(blade),
                layout.blade_root(blade), blade};
    for (int p = 0; p < place.beam->point_count(); ++p)
      place.points.push_back(layout.blade_point(blade, p));
    for (std::size_t m = 0; m < place.beam->mass_nodes.size(); ++m)
      place.masses.push_back(layout.blade_mass(blade, static_cast<int>(m)));
    places.push_back(place);
  }
  if (turbine.has_tower) {
    Place place{&turbine.tower, {}, {}, layout.tower_tip(), layout.tower_root(), -1};
    for (int p = 0; p < place.beam->point_count(); ++p)
      place.points.push_back(layout.tower_point(p));
    for (std::size_t m = 0; m < place.beam->mass_nodes.size(); ++m)
      place.masses.push_back(layout.tower_mass(static_cast<int>(m)));
    places.push_back(place);
  }
  return places;
}

template <class T>
elements::Attachment<T> attachment_of(const turbine::TurbineSystem& system, const Place& place,
                                      const test::HubMotion<T>& hub) {
  elements::Attachment<T> a;
  const model::Turbine& turbine = system.turbine();
  if (place.blade < 0) {
    a.gravity(0) = T(-turbine.chain.gravity);
    return a;
  }
  const model::BladeRoot& root = turbine.roots[static_cast<std::size_t>(place.blade)];
  const Mat3<T> C_aH = root.C_Ha.transpose().cast<T>();
  const Vec3<T> arm = root.position.cast<T>();
  a.v = C_aH * (hub.velocity + math::cross<T>(hub.omega, arm));
  a.omega = C_aH * hub.omega;
  a.gravity = C_aH * hub.gravity;
  return a;
}

template <class T>
void add_beam(const Place& place, const elements::Attachment<T>& a, const Array<T>& z,
              const Array<T>& z_dot, Array<T>& r) {
  const model::Beam& beam = *place.beam;
  const math::QuadratureRule rule = math::gauss_rule(beam.order);
  const std::vector<double> nodes = math::lobatto_nodes(beam.order);
  const int last = beam.point_count();
  // Rows of node n: strain, curvature with the point behind it, force, moment with the one before.
  // A beam that a mass cuts is two beams: the strains before it and the forces behind it are the
  // mass node's.
  const auto cut_at = [&](int n) {
    for (std::size_t m = 0; m < place.masses.size(); ++m)
      if (beam.mass_nodes[m].end * beam.order == n) return place.masses[m];
    return -1;
  };
  const auto strain_of = [&](int n, bool before) {
    if (before && cut_at(n) >= 0) return cut_at(n);
    return n < last ? place.points[static_cast<std::size_t>(n)] : place.tip;
  };
  const auto force_of = [&](int n, bool before) {
    if (!before && cut_at(n) >= 0) return cut_at(n) + 12;
    return n == 0 ? place.root : place.points[static_cast<std::size_t>(n) - 1] + 12;
  };
  for (int element = 0; element < beam.elements; ++element) {
    for (int j = 0; j < beam.order; ++j) {
      const int p = element * beam.order + j;
      const int first = place.points[static_cast<std::size_t>(p)];
      const PointState<T> state = z.template segment<block>(first);
      const PointState<T> state_dot = z_dot.template segment<block>(first);
      const elements::PointTerms<T> terms = elements::beam_point_terms<T>(
          beam.points[static_cast<std::size_t>(p)], state, state_dot, a);
      r.template segment<3>(first + 6) += terms.velocity;
      r.template segment<3>(first + 9) += terms.spin;
      const double xi = rule.points[static_cast<std::size_t>(j)];
      const double w = rule.weights[static_cast<std::size_t>(j)];
      for (int node = 0; node <= beam.order; ++node) {
        const T slope(w * math::lagrange_derivative(nodes, node, xi));
        const T value(w * beam.element_length(element) * math::lagrange(nodes, node, xi));
        const bool before = node == beam.order;
        const int strain = strain_of(element * beam.order + node, before);
        const int force = force_of(element * beam.order + node, before);
        for (int i = 0; i < 3; ++i) {
          r(strain + i) -= slope * state(i) + value * terms.stretch(i);
          r(strain + 3 + i) -= slope * state(3 + i) + value * terms.turn(i);
          r(force + i) += slope * terms.force_flux(i) + value * terms.force_load(i);
          r(force + 3 + i) += slope * terms.moment_flux(i) + value * terms.moment_load(i);
        }
      }
    }
  }
  for (int i = 0; i < 6; ++i) r(place.root + i) += z(place.root + i);
  const auto add_end = [&](int node, int first, const Vector3& x, const Matrix6& mass) {
    for (int i = 0; i < 6; ++i) {
      r(first + i) += z(first + i);
      r(force_of(node, true) + i) -= z(first + 12 + i);
    }
    const PointState<T> end = z.template segment<block>(first);
    const PointState<T> end_dot = z_dot.template segment<block>(first);
    const elements::TipTerms<T> terms =
        elements::beam_tip_terms<T>(x, Matrix3::Identity(), mass, end, end_dot, a);
    r.template segment<3>(first + 6) += terms.velocity;
    r.template segment<3>(first + 9) += terms.spin;
    if (place.blade < 0 && node == last) return;
    r.template segment<3>(first + 12) += terms.force;
    r.template segment<3>(first + 15) += terms.moment;
  };
  add_end(last, place.tip, beam.tip, beam.tip_mass);
  for (std::size_t m = 0; m < place.masses.size(); ++m) {
    const model::MassNode& mass = beam.mass_nodes[m];
    const int node = mass.end * beam.order;
    add_end(node, place.masses[m], mass.x, mass.mass);
    for (int i = 0; i < 6; ++i) r(strain_of(node, false) + i) -= z(place.masses[m] + i);
  }
}

/// r(t, z, z_dot) of any turbine.
template <class T>
Array<T> summed_residual(const turbine::TurbineSystem& system, double t, const Array<T>& z,
                         const Array<T>& z_dot) {
  const model::Turbine& turbine = system.turbine();
  const turbine::TurbineLayout& layout = system.layout();
  test::ChainState<T> chain;
  chain.theta.setZero();
  chain.top_velocity.setZero();
  chain.top_velocity_dot.setZero();
  chain.top_load.setZero();
  if (turbine.has_tower) {
    const int top = layout.tower_tip();
    chain.theta = z.template segment<3>(top + 3);
    chain.top_velocity = z.template segment<6>(top + 6);
    chain.top_velocity_dot = z_dot.template segment<6>(top + 6);
    chain.top_load = z.template segment<6>(top + 12);
  }
  const auto joint = [&](int first) {
    return elements::JointState<T>{z(first), z(first + 1), z_dot(first), z_dot(first + 1)};
  };
  chain.yaw = joint(layout.yaw());
  chain.teeter = joint(layout.teeter());
  chain.torsion = joint(layout.shaft_torsion());
  chain.generator = joint(layout.generator());
  const auto motion = [&](const model::PrescribedMotion& series) {
    const double rate = series.per_rev * turbine.speed;
    const double turned = rate * t + series.phase;
    return elements::JointMotion{series.angle + series.amplitude * std::cos(turned),
                                 -rate * series.amplitude * std::sin(turned),
                                 -rate * rate * series.amplitude * std::cos(turned)};
  };
  chain.yaw.prescribed = motion(turbine.yaw_motion);
  chain.teeter.prescribed = motion(turbine.teeter_motion);
  chain.azimuth = turbine.azimuth + turbine.speed * t;
  chain.speed = turbine.speed;
  chain.hub_load.setZero();
  for (std::size_t k = 0; k < turbine.blades.size(); ++k) {
    const model::BladeRoot& root = turbine.roots[k];
    const int first = layout.blade_root(static_cast<int>(k));
    const Vec3<T> force = root.C_Ha.cast<T>() * z.template segment<3>(first);
    const Vec3<T> moment = root.C_Ha.cast<T>() * z.template segment<3>(first + 3);
    const Vec3<T> arm = root.position.cast<T>();
    chain.hub_load.template head<3>() += force;
    chain.hub_load.template tail<3>() += moment + math::cross<T>(arm, force);
  }
  test::HubMotion<T> hub;
  const test::ChainRows<T> rows = test::rigid_chain<T>(turbine.chain, chain, hub);

  Array<T> r = Array<T>::Zero(system.size());
  for (const Place& place : places_of(system))
    add_beam<T>(place, attachment_of<T>(system, place, hub), z, z_dot, r);
  if (turbine.has_tower) r.template segment<6>(layout.tower_tip() + 12) = rows.top;
  const auto put_joint = [&](int first, bool free, const elements::JointRows<T>& own,
                             double angle = 0.0) {
    r(first) = free ? own.kinematic : z(first) - T(angle);
    r(first + 1) = free ? own.balance : own.kinematic;
  };
  put_joint(layout.yaw(), turbine.chain.yaw.free, rows.yaw, chain.yaw.prescribed.angle);
  put_joint(layout.teeter(), turbine.chain.teeter.free, rows.teeter, chain.teeter.prescribed.angle);
  put_joint(layout.shaft_torsion(), turbine.chain.torsion.free, rows.torsion);
  put_joint(layout.generator(), turbine.chain.generator.free, rows.generator);
  for (const int i : layout.padding()) r(i) = z(i);
  return r;
}

/// The program's own equations at a complex state.
Array<Complex> own_residual(const turbine::TurbineSystem& system, double t, const Array<Complex>& z,
                            const Array<Complex>& z_dot) {
  const std::vector<Complex> state(z.data(), z.data() + z.size());
  const std::vector<Complex> rate(z_dot.data(), z_dot.data() + z_dot.size());
  std::vector<Complex> r(state.size());
  system.equations().evaluate<Complex>(t, state, rate, r);
  return Eigen::Map<const Array<Complex>>(r.data(), z.size());
}

/// K and M by the complex step of the sum.
sample::Tangents stepped_tangents(const turbine::TurbineSystem& system, double t,
                                  const sample::RandomState& state) {
  const int n = system.size();
  sample::Tangents result{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
  Array<Complex> z = state.z.cast<Complex>();
  Array<Complex> z_dot = state.z_dot.cast<Complex>();
  for (int j = 0; j < n; ++j) {
    z(j) += Complex(0.0, complex_step);
    result.K.col(j) = summed_residual<Complex>(system, t, z, z_dot).imag() / complex_step;
    z(j) = state.z(j);
    z_dot(j) += Complex(0.0, complex_step);
    result.M.col(j) = summed_residual<Complex>(system, t, z, z_dot).imag() / complex_step;
    z_dot(j) = state.z_dot(j);
  }
  return result;
}

/// Largest difference of two matrices relative to the largest entry of the row in K and M.
double row_error(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected,
                 const Eigen::VectorXd& scale) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < found.rows(); ++i)
    worst = std::max(worst, (found.row(i) - expected.row(i)).cwiseAbs().maxCoeff() / scale(i));
  return worst;
}

/// Without damping in proportion to the mass, which mass_damping_test.cpp sums.
turbine::TurbineSystem build(const sample::Choice& choice) {
  model::TurbineDefinition definition = sample::turbine_definition(choice);
  definition.tower.mass_damping = definition.blades.beam.mass_damping = Vector3::Zero();
  return turbine::TurbineSystem(model::build_turbine(definition), PETSC_COMM_SELF);
}

/// Entry i of P z is sign[i] z[source[i]]; the rows are renamed in the same way.
Eigen::VectorXd renamed(const system::RotorSymmetry& symmetry, const Eigen::VectorXd& z) {
  Eigen::VectorXd result(z.size());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    result(i) = symmetry.sign[at] * z(symmetry.source[at]);
  }
  return result;
}

/// Largest entry of r(t, P z, P z_dot) - P r(t + T/Q, z, z_dot), relative to that of r, in all rows
/// but `except`.
double symmetry_error(const turbine::TurbineSystem& system, const system::RotorSymmetry& symmetry,
                      int except) {
  const double t = 0.37;
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const sample::RandomState state = sample::random_state(system, seed);
    const Eigen::VectorXd later =
        sample::residual_of(system, t + system.period() / symmetry.sectors, state.z, state.z_dot);
    const Eigen::VectorXd now =
        sample::residual_of(system, t, renamed(symmetry, state.z), renamed(symmetry, state.z_dot));
    Eigen::VectorXd difference = now - renamed(symmetry, later);
    if (except >= 0) difference(except) = 0.0;
    worst = std::max(worst, difference.cwiseAbs().maxCoeff() / now.cwiseAbs().maxCoeff());
  }
  return worst;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(residuals_of_turbines)

BOOST_AUTO_TEST_CASE(residual_is_the_sum_over_points_nodes_and_bodies) {
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice);
    for (unsigned seed = 1; seed <= 2; ++seed) {
      const sample::RandomState state = sample::random_state(system, seed);
      const double t = 0.2 + seed;
      const Eigen::VectorXd found = sample::residual_of(system, t, state.z, state.z_dot);
      const Eigen::VectorXd expected = summed_residual<double>(system, t, state.z, state.z_dot);
      BOOST_TEST((found - expected).cwiseAbs().maxCoeff() <
                 round_off * expected.cwiseAbs().maxCoeff());
    }
  }
}

BOOST_AUTO_TEST_CASE(residual_of_a_complex_state_is_the_sum_too) {
  // Other tests rely on it: they differentiate the equations by a complex step.
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice);
    const sample::RandomState state = sample::random_state(system, 1);
    const sample::RandomState step = sample::random_state(system, 2);
    const Complex along(0.0, complex_step);
    const Array<Complex> z = state.z.cast<Complex>() + along * step.z.cast<Complex>();
    const Array<Complex> z_dot = state.z_dot.cast<Complex>() + along * step.z_dot.cast<Complex>();
    const Array<Complex> found = own_residual(system, 0.6, z, z_dot);
    const Array<Complex> expected = summed_residual<Complex>(system, 0.6, z, z_dot);
    const Eigen::VectorXd slope = expected.imag() / complex_step;
    BOOST_TEST((found.real() - expected.real()).cwiseAbs().maxCoeff() <
               round_off * expected.real().cwiseAbs().maxCoeff());
    BOOST_TEST((found.imag() / complex_step - slope).cwiseAbs().maxCoeff() <
               round_off * slope.cwiseAbs().maxCoeff());
  }
}

BOOST_AUTO_TEST_CASE(a_parked_turbine_has_no_period) {
  model::TurbineDefinition definition = sample::turbine_definition({});
  definition.shaft.speed = 0.0;
  const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
  BOOST_TEST(system.period() == 0.0);
}

BOOST_AUTO_TEST_CASE(a_rotation_beyond_170_degrees_is_refused_wherever_it_is) {
  const turbine::TurbineSystem system = build({});
  const turbine::TurbineLayout& layout = system.layout();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  for (const int first :
       {layout.tower_tip(), layout.tower_point(0), layout.blade_point(1, 1), layout.blade_tip(0)}) {
    Eigen::VectorXd z = zero;
    z(first + 4) = 22.8;
    BOOST_CHECK_NO_THROW(sample::residual_of(system, 0.0, z, zero));
    z(first + 4) = 22.9;
    BOOST_CHECK_THROW(sample::residual_of(system, 0.0, z, zero), DomainError);
    z(first + 4) = std::numeric_limits<double>::quiet_NaN();
    BOOST_CHECK_THROW(sample::residual_of(system, 0.0, z, zero), DomainError);
  }
}

BOOST_AUTO_TEST_CASE(residual_depends_on_time_by_the_azimuth_alone) {
  const turbine::TurbineSystem system = build({});
  const sample::RandomState state = sample::random_state(system, 1);
  const Eigen::VectorXd now = sample::residual_of(system, 0.4, state.z, state.z_dot);
  const Eigen::VectorXd later =
      sample::residual_of(system, 0.4 + system.period(), state.z, state.z_dot);
  const Eigen::VectorXd between =
      sample::residual_of(system, 0.4 + 0.3 * system.period(), state.z, state.z_dot);
  const double scale = now.cwiseAbs().maxCoeff();
  BOOST_TEST(std::abs(system.period() - 2.0 * std::numbers::pi / 3.0) < round_off);
  BOOST_TEST((later - now).cwiseAbs().maxCoeff() < round_off * scale);
  BOOST_TEST((between - now).cwiseAbs().maxCoeff() > 1e-3 * scale);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(tangents_of_turbines)

BOOST_AUTO_TEST_CASE(K_and_M_are_the_complex_step_of_the_whole_turbine) {
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice);
    const sample::RandomState state = sample::random_state(system, 3);
    const sample::Tangents found = sample::tangents_of(system, 0.9, state.z, state.z_dot);
    const sample::Tangents expected = stepped_tangents(system, 0.9, state);
    // A row of z and z_dot: the units of both are of one size here.
    const Eigen::VectorXd scale = expected.K.rowwise().lpNorm<Eigen::Infinity>().cwiseMax(
        expected.M.rowwise().lpNorm<Eigen::Infinity>());
    BOOST_TEST_REQUIRE(scale.minCoeff() > 0.0);
    BOOST_TEST(row_error(found.K, expected.K, scale) < tangent_tolerance);
    BOOST_TEST(row_error(found.M, expected.M, scale) < tangent_tolerance);
  }
}

BOOST_AUTO_TEST_CASE(what_tangents_leave_of_the_residual_is_of_second_order) {
  // Taylor: |r(z + h d) - r - h K d - h M d_dot| = O(h^2), slope 2 over three decades.
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice);
    const sample::RandomState state = sample::random_state(system, 4);
    const sample::RandomState step = sample::random_state(system, 5);
    const sample::Tangents tangents = sample::tangents_of(system, 1.1, state.z, state.z_dot);
    const Eigen::VectorXd r = sample::residual_of(system, 1.1, state.z, state.z_dot);
    const Eigen::VectorXd linear = tangents.K * step.z + tangents.M * step.z_dot;
    const Eigen::VectorXd scale = linear.cwiseAbs().array() + 1.0;
    const auto remainder = [&](double h) {
      const Eigen::VectorXd moved =
          sample::residual_of(system, 1.1, state.z + h * step.z, state.z_dot + h * step.z_dot);
      return (moved - r - h * linear).cwiseQuotient(scale).norm();
    };
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      const double slope = std::log2(remainder(0.1 * h) / remainder(0.05 * h));
      BOOST_TEST(std::abs(slope - 2.0) < 0.02);
    }
  }
}

BOOST_AUTO_TEST_CASE(K_and_M_times_a_direction_are_differences_of_eighth_order) {
  const auto central = [](const auto& f, double h) {
    return Eigen::VectorXd((4.0 / 5.0 * (f(h) - f(-h)) - 1.0 / 5.0 * (f(2.0 * h) - f(-2.0 * h)) +
                            4.0 / 105.0 * (f(3.0 * h) - f(-3.0 * h)) -
                            1.0 / 280.0 * (f(4.0 * h) - f(-4.0 * h))) /
                           h);
  };
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice);
    const sample::RandomState state = sample::random_state(system, 6);
    const sample::Tangents tangents = sample::tangents_of(system, 1.7, state.z, state.z_dot);
    const sample::RandomState step = sample::random_state(system, 7);
    const Eigen::VectorXd by_state = central(
        [&](double h) {
          return sample::residual_of(system, 1.7, state.z + h * step.z, state.z_dot);
        },
        difference_step);
    const Eigen::VectorXd by_rate = central(
        [&](double h) {
          return sample::residual_of(system, 1.7, state.z, state.z_dot + h * step.z_dot);
        },
        difference_step);
    const Eigen::VectorXd K_scale = tangents.K.cwiseAbs() * step.z.cwiseAbs();
    const Eigen::VectorXd M_scale = tangents.M.cwiseAbs() * step.z_dot.cwiseAbs() + K_scale;
    const Eigen::VectorXd K_error = (by_state - tangents.K * step.z).cwiseQuotient(K_scale);
    const Eigen::VectorXd M_error = (by_rate - tangents.M * step.z_dot).cwiseQuotient(M_scale);
    BOOST_TEST(K_error.lpNorm<Eigen::Infinity>() < difference_tolerance);
    BOOST_TEST(M_error.lpNorm<Eigen::Infinity>() < difference_tolerance);
  }
}

BOOST_AUTO_TEST_CASE(the_jacobian_is_K_plus_shift_M_and_forgets_the_state_before) {
  const turbine::TurbineSystem system = build({3, 2, true, true, false, true, false});
  const petsc::Handle<Mat> J = system.make_jacobian();
  const petsc::Handle<Mat> M = system.make_mass();
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const sample::RandomState state = sample::random_state(system, seed);
    const petsc::Handle<Vec> z = sample::to_petsc(system, state.z);
    const petsc::Handle<Vec> z_dot = sample::to_petsc(system, state.z_dot);
    const sample::Tangents expected = sample::tangents_of(system, 0.5, state.z, state.z_dot);
    system.tangents(0.5, z.get(), z_dot.get(), 13.0, J.get(), M.get());
    const Eigen::MatrixXd shifted = expected.K + 13.0 * expected.M;
    BOOST_TEST((sample::to_dense(J.get()) - shifted).cwiseAbs().maxCoeff() <=
               1e-15 * shifted.cwiseAbs().maxCoeff());
    BOOST_TEST((sample::to_dense(M.get()) - expected.M).cwiseAbs().maxCoeff() == 0.0);
    system.tangents(0.5, z.get(), z_dot.get(), 0.0, J.get(), nullptr);
    BOOST_TEST((sample::to_dense(J.get()) - expected.K).cwiseAbs().maxCoeff() == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(new_values_in_a_jacobian_are_seen_by_its_solver) {
  // The values are copied behind PETSc's back: its object state must change, or a factorization of
  // the state before is used again.
  const turbine::TurbineSystem system = build({});
  const petsc::Handle<Mat> J = system.make_jacobian();
  const petsc::Handle<Vec> rhs = sample::to_petsc(system, Eigen::VectorXd::Ones(system.size()));
  const petsc::Handle<Vec> solution = system.make_state();
  petsc::Handle<KSP> solver;
  petsc::check(KSPCreate(PETSC_COMM_SELF, solver.fill()));
  petsc::check(KSPSetType(solver.get(), KSPPREONLY));
  PC preconditioner = nullptr;
  petsc::check(KSPGetPC(solver.get(), &preconditioner));
  petsc::check(PCSetType(preconditioner, PCLU));
  petsc::check(PCFactorSetMatOrderingType(preconditioner, MATORDERINGRCM));
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const sample::RandomState state = sample::random_state(system, seed);
    system.tangents(0.5, sample::to_petsc(system, state.z).get(),
                    sample::to_petsc(system, state.z_dot).get(), 20.0, J.get(), nullptr);
    petsc::check(KSPSetOperators(solver.get(), J.get(), J.get()));
    petsc::check(KSPSolve(solver.get(), rhs.get(), solution.get()));
    const Eigen::VectorXd x = sample::to_dense(solution.get());
    const Eigen::VectorXd left = sample::to_dense(J.get()) * x - Eigen::VectorXd::Ones(x.size());
    // LU without pivoting inside blocks that are well conditioned.
    const double scale = (sample::to_dense(J.get()).cwiseAbs() * x.cwiseAbs()).maxCoeff();
    BOOST_TEST(left.cwiseAbs().maxCoeff() < 1e-10 * scale);
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(rotor_symmetry)

BOOST_AUTO_TEST_CASE(two_teetering_blades_repeat_after_half_a_turn_with_the_teeter_reversed) {
  for (const bool tower : {true, false}) {
    const turbine::TurbineSystem system = build({2, 2, tower, true, true, true, false});
    BOOST_TEST(system.symmetry().sectors == 2);
    BOOST_TEST(symmetry_error(system, system.symmetry(), -1) < round_off);
    system::RotorSymmetry unsigned_symmetry = system.symmetry();
    for (double& sign : unsigned_symmetry.sign) sign = 1.0;
    BOOST_TEST(symmetry_error(system, unsigned_symmetry, -1) > 1e-4);
  }
}

BOOST_AUTO_TEST_CASE(two_blades_on_a_rigid_hub_repeat_after_half_a_turn) {
  const turbine::TurbineSystem system = build({2, 1, true, true, false, true, false});
  BOOST_TEST(system.symmetry().sectors == 2);
  BOOST_TEST(symmetry_error(system, system.symmetry(), -1) < round_off);
}

BOOST_AUTO_TEST_CASE(three_blades_repeat_after_a_third_of_a_turn) {
  const turbine::TurbineSystem system = build({3, 2, true, true, false, true, false});
  const int speed = system.layout().teeter() + 1;
  BOOST_TEST(system.symmetry().sectors == 3);
  // The speed U2 of a locked hinge is one component of the shaft's angular velocity, which has no
  // like in the next sector. Nothing depends on it, so that its row may differ.
  BOOST_TEST(symmetry_error(system, system.symmetry(), speed) < round_off);
  const sample::RandomState state = sample::random_state(system, 1);
  sample::Tangents tangents = sample::tangents_of(system, 0.0, state.z, state.z_dot);
  tangents.K(speed, speed) = 0.0;
  BOOST_TEST(tangents.K.col(speed).isZero(0.0));
  BOOST_TEST(tangents.M.col(speed).isZero(0.0));
  BOOST_TEST(tangents.M.row(speed).isZero(0.0));
  BOOST_TEST(!system.differential()[static_cast<std::size_t>(speed)]);
}

BOOST_AUTO_TEST_CASE(the_other_orientation_of_the_renaming_is_no_symmetry) {
  const turbine::TurbineSystem system = build({3, 2, true, true, false, true, false});
  system::RotorSymmetry backward = system.symmetry();
  for (std::size_t i = 0; i < backward.source.size(); ++i)
    backward.source[static_cast<std::size_t>(system.symmetry().source[i])] =
        static_cast<PetscInt>(i);
  BOOST_TEST(symmetry_error(system, backward, system.layout().teeter() + 1) > 1e-3);
}

BOOST_AUTO_TEST_CASE(renaming_every_sector_once_is_no_renaming) {
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice);
    const sample::RandomState state = sample::random_state(system, 1);
    Eigen::VectorXd z = state.z;
    for (int sector = 0; sector < system.symmetry().sectors; ++sector)
      z = renamed(system.symmetry(), z);
    BOOST_TEST((z - state.z).cwiseAbs().maxCoeff() == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(masses_on_the_hub_keep_the_symmetry_where_they_balance) {
  const auto check = [](int blades, const std::vector<Vector3>& places, bool repeats) {
    model::TurbineDefinition definition =
        sample::turbine_definition({blades, 1, true, true, false, true, false});
    for (const Vector3& place : places)
      definition.hub.point_masses.push_back({0.37, place, Vector3::Zero()});
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    BOOST_TEST((system.symmetry().sectors == blades) == repeats);
    const int speed = system.layout().teeter() + 1;
    if (repeats) BOOST_TEST(symmetry_error(system, system.symmetry(), speed) < round_off);
  };
  const auto ring = [](int count, double downwind) {
    std::vector<Vector3> places;
    for (int k = 0; k < count; ++k) {
      const double angle = 0.3 + 2.0 * std::numbers::pi * k / count;
      places.emplace_back(0.7 * std::sin(angle), downwind, 0.7 * std::cos(angle));
    }
    return places;
  };
  check(2, ring(2, 0.1), true);
  check(3, ring(3, 0.1), true);
  check(3, ring(2, 0.1), false);
  check(2, {Vector3(0.7, 0.1, 0.0), Vector3(-0.7, -0.1, 0.0)}, false);  // h2 no principal axis
  check(2, {Vector3(0.0, 0.1, 0.0)}, true);
  check(2, {Vector3(0.0, 0.1, 1e-6)}, false);

  // Ten digits of a typed figure are enough, six are an unbalance.
  const auto typed = [&](double digit) {
    model::TurbineDefinition definition =
        sample::turbine_definition({3, 1, true, true, false, true, false});
    for (const Vector3& place : ring(3, 0.1))
      definition.hub.point_masses.push_back(
          {0.37, (place.array() / digit).round().matrix() * digit, Vector3::Zero()});
    return turbine::TurbineSystem(model::build_turbine(definition), PETSC_COMM_SELF)
        .symmetry()
        .sectors;
  };
  BOOST_TEST(typed(1e-10) == 3);
  BOOST_TEST(typed(1e-6) == 1);
}

BOOST_AUTO_TEST_CASE(prescribed_angles_keep_the_symmetry_where_they_repeat) {
  model::TurbineDefinition definition = sample::turbine_definition({2, 1, true, true, true});
  definition.nacelle.yaw.kind = definition.hub.teeter.kind = model::JointKind::prescribed;
  const auto check = [&](int sectors) {
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    BOOST_TEST(system.symmetry().sectors == sectors);
    BOOST_TEST(system.symmetry().broken_by.empty() == (sectors == 2));
    const int speed = system.layout().teeter() + 1;
    if (sectors == 2) BOOST_TEST(symmetry_error(system, system.symmetry(), speed) < round_off);
  };
  model::PrescribedMotion& yaw = definition.nacelle.yaw.motion;
  model::PrescribedMotion& teeter = definition.hub.teeter.motion;
  check(2);
  yaw = {0.5, 0.2, 2, 0.0, 0.7};
  teeter = {0.0, 0.1, 3, 0.0, -0.4};
  check(2);
  yaw.per_rev = 1;
  check(1);
  yaw.per_rev = 0;
  yaw.frequency = 6.0;
  check(1);
  yaw = {0.5};
  teeter.per_rev = 2;
  check(1);
  teeter = {0.1};
  check(1);
}

BOOST_AUTO_TEST_CASE(dissimilar_rotors_have_one_sector) {
  const sample::Choice three{3, 1, true, true, false, true, false};
  const auto sectors_of = [](const model::TurbineDefinition& definition) {
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    const int sectors = system.symmetry().sectors;
    const bool one_blade = definition.blades.count == 1;
    BOOST_TEST(system.symmetry().broken_by.empty() == (sectors > 1 || one_blade));
    return sectors;
  };
  model::TurbineDefinition definition = sample::turbine_definition(three);
  BOOST_TEST(sectors_of(definition) == 3);
  definition.blades.each[2].pitch = 0.01;
  BOOST_TEST(sectors_of(definition) == 1);
  definition = sample::turbine_definition(three);
  definition.blades.each[3].mass_factor = 1.01;
  BOOST_TEST(sectors_of(definition) == 1);
  definition = sample::turbine_definition(three);
  definition.blades.each[1].stiffness_factor = 1.01;
  BOOST_TEST(sectors_of(definition) == 1);
  definition = sample::turbine_definition(three);
  definition.hub.inertia(2) *= 2.0;
  BOOST_TEST(sectors_of(definition) == 1);
  definition = sample::turbine_definition(three);
  definition.hub.point_masses = {{0.5, Vector3(0.0, 0.1, -0.3), Vector3::Zero()}};
  BOOST_TEST(sectors_of(definition) == 1);
  BOOST_TEST(sectors_of(sample::turbine_definition({3, 1, true, true, true, true, false})) == 1);
  BOOST_TEST(sectors_of(sample::turbine_definition({1, 1, true, true, false, true, false})) == 1);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(description)

BOOST_AUTO_TEST_CASE(every_unknown_has_a_name_of_its_own) {
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice);
    BOOST_TEST(system.unknowns().size() == static_cast<std::size_t>(system.size()));
    std::set<std::string> names;
    int padding = 0;
    for (const system::Unknown& unknown : system.unknowns()) {
      BOOST_TEST(!unknown.name().empty());
      names.insert(unknown.name());
      if (unknown.name() == "padding") ++padding;
    }
    const int repeated = std::max(0, padding - 1);
    BOOST_TEST(static_cast<int>(names.size()) + repeated == system.size());
    BOOST_TEST(padding == static_cast<int>(system.layout().padding().size()));
  }
}

BOOST_AUTO_TEST_CASE(names_units_and_roles_belong_together) {
  const turbine::TurbineSystem system = build({});
  const turbine::TurbineLayout& layout = system.layout();
  const auto is = [&system](int i, const std::string& name, const std::string& unit,
                            system::UnknownRole role) {
    const system::Unknown& unknown = system.unknowns()[static_cast<std::size_t>(i)];
    BOOST_TEST(unknown.name() == name);
    BOOST_TEST(unknown.unit == unit);
    BOOST_TEST((unknown.role == role), name);
  };
  using system::UnknownRole;
  is(layout.blade_point(1, 0) + 2, "blade 2 point 1 u3", "m", UnknownRole::position);
  is(layout.blade_point(0, 1) + 4, "blade 1 point 2 theta2", "rad", UnknownRole::position);
  is(layout.tower_point(3) + 6, "tower point 4 V1", "m/s", UnknownRole::velocity);
  is(layout.tower_tip() + 11, "tower top Omega3", "rad/s", UnknownRole::velocity);
  is(layout.blade_tip(1) + 14, "blade 2 tip F3", "N", UnknownRole::internal);
  is(layout.blade_root(0) + 3, "blade 1 root M1", "N m", UnknownRole::internal);
  is(layout.tower_root(), "tower root F1", "N", UnknownRole::internal);
  is(layout.yaw(), "yaw angle", "rad", UnknownRole::position);
  is(layout.teeter() + 1, "teeter speed", "rad/s", UnknownRole::velocity);
}

BOOST_AUTO_TEST_CASE(row_roles_are_what_the_rows_say) {
  // Constraints have no rates; kinematic rows have a velocity with the coefficient of one.
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice);
    const sample::RandomState state = sample::random_state(system, 2);
    const sample::Tangents tangents = sample::tangents_of(system, 0.2, state.z, state.z_dot);
    BOOST_TEST(system.rows().size() == static_cast<std::size_t>(system.size()));
    for (int i = 0; i < system.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      bool has_velocity = false;
      bool has_force = false;
      for (int j = 0; j < system.size(); ++j) {
        if (tangents.K(i, j) == 0.0) continue;
        const system::UnknownRole role = system.unknowns()[static_cast<std::size_t>(j)].role;
        if (role == system::UnknownRole::velocity) has_velocity = true;
        if (role == system::UnknownRole::internal) has_force = true;
      }
      const std::string name = system.unknowns()[at].name();
      switch (system.rows()[at]) {
        case system::RowRole::constraint:
          BOOST_TEST(tangents.M.row(i).isZero(0.0), name);
          BOOST_TEST(!has_velocity, name);
          break;
        case system::RowRole::kinematic:
          BOOST_TEST(has_velocity, name);
          BOOST_TEST(!has_force, name);
          break;
        case system::RowRole::balance:
          // Between a generator and a shaft that twists there is the shaft's spring alone.
          BOOST_TEST((has_force || name == "generator speed"), name);
          break;
        case system::RowRole::evolution:
        case system::RowRole::definition:
          BOOST_ERROR(name + ": a turbine has none of these");
          break;
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(differential_unknowns_are_those_whose_rates_appear) {
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system = build(choice);
    const turbine::TurbineLayout& layout = system.layout();
    const model::Turbine& turbine = system.turbine();
    std::set<int> expected;
    const auto add = [&expected](int first, int count) {
      for (int i = 0; i < count; ++i) expected.insert(first + i);
    };
    for (const Place& place : places_of(system)) {
      for (std::size_t p = 0; p < place.points.size(); ++p) {
        add(place.points[p], 12);
        for (int i = 0; i < 6; ++i)
          if (place.beam->points[p].damping(i) > 0.0) add(place.points[p] + 12 + i, 1);
      }
      add(place.tip, 6);
      // Velocities of an end carry inertia where there is a mass; Omega where it has inertia.
      const Matrix6& mass = place.beam->tip_mass;
      if (place.blade >= 0 && mass(0, 0) > 0.0) add(place.tip + 6, mass(3, 3) > 0.0 ? 6 : 3);
      for (const int first : place.masses) add(first, 12);
    }
    if (turbine.has_tower) {
      add(layout.tower_tip() + 6, 3);
      add(layout.tower_tip() + 10, 2);
      // U5 moves nothing that U1 does not move where the nacelle is free to yaw.
      if (!turbine.chain.yaw.free || turbine.tower.tip_mass(3, 3) > 0.0)
        add(layout.tower_tip() + 9, 1);
    }
    if (turbine.chain.yaw.free) add(layout.yaw(), 2);
    if (turbine.chain.teeter.free) add(layout.teeter(), 2);
    if (turbine.chain.torsion.free) add(layout.shaft_torsion(), 2);
    if (turbine.chain.generator.free) add(layout.generator(), 2);
    for (int i = 0; i < system.size(); ++i)
      BOOST_TEST(system.differential()[static_cast<std::size_t>(i)] == (expected.count(i) == 1),
                 system.unknowns()[static_cast<std::size_t>(i)].name());
  }
}

BOOST_AUTO_TEST_CASE(degrees_of_freedom_count_elastic_strains_and_free_joints) {
  // The paper's model: flap, lead-lag and torsion at s (M + 2 N) points, yaw and teeter.
  sample::Choice choice{2, 2, true, true, true, false, true};
  model::TurbineDefinition definition = sample::turbine_definition(choice);
  definition.tower.order = 2;
  definition.tower.elements = 4;
  definition.blades.beam.elements = 3;
  BOOST_TEST(model::build_turbine(definition).degrees_of_freedom == 2 * (3 * 4 + 6 * 3) + 2);
  choice.rigid_shear = false;
  choice.yaw = false;
  choice.tower = false;
  BOOST_TEST(model::build_turbine(sample::turbine_definition(choice)).degrees_of_freedom ==
             2 * 2 * 2 * 6 + 1);
}

BOOST_AUTO_TEST_CASE(kinetic_energy_of_a_beam_is_that_of_its_groups) {
  for (const sample::Choice& choice : sample::choices()) {
    const model::TurbineDefinition definition = sample::turbine_definition(choice);
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    const sample::RandomState state = sample::random_state(system, 1);
    std::vector<double> by_blade(static_cast<std::size_t>(choice.blades), 0.0);
    for (const system::EnergyGroup& group : system.energy_groups()) {
      if (group.owner.instance == 0 || group.kind != system::EnergyGroup::Kind::kinetic) continue;
      const std::size_t n = group.unknowns.size();
      BOOST_TEST_REQUIRE(group.weight.size() == n * n);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          by_blade[static_cast<std::size_t>(group.owner.instance) - 1] +=
              0.5 * group.weight[i * n + j] * state.z(group.unknowns[i]) *
              state.z(group.unknowns[j]);
    }
    for (const sample::Piece& piece : sample::bodies_at(definition, system, 0.0, state.z).pieces)
      if (piece.blade >= 0) by_blade[static_cast<std::size_t>(piece.blade)] -= piece.kinetic;
    for (const double left : by_blade) BOOST_TEST(std::abs(left) < 1e3 * round_off);
  }
}

BOOST_AUTO_TEST_CASE(only_joints_that_nothing_restores_are_neutral) {
  model::TurbineDefinition definition = sample::turbine_definition({});
  const auto unconstrained_of = [&definition]() {
    const turbine::TurbineSystem system(model::build_turbine(definition), PETSC_COMM_SELF);
    std::vector<std::string> names;
    for (const system::UnconstrainedCoordinate& unconstrained :
         system.unconstrained_coordinates()) {
      names.push_back(unconstrained.name);
      BOOST_TEST(system.unknowns()[static_cast<std::size_t>(unconstrained.unknown)].name() ==
                 unconstrained.name + " angle");
      BOOST_TEST(
          (system.rows()[static_cast<std::size_t>(unconstrained.row)] == system::RowRole::balance));
    }
    return names;
  };
  BOOST_TEST(unconstrained_of().empty());
  definition.nacelle.yaw.stiffness = 0.0;
  definition.hub.teeter.stiffness = 0.0;
  BOOST_TEST((unconstrained_of() == std::vector<std::string>{"yaw"}));
  definition.shaft.speed = 0.0;
  BOOST_TEST((unconstrained_of() == std::vector<std::string>{"yaw", "teeter"}));
  definition.nacelle.yaw.kind = model::JointKind::locked;
  definition.hub.teeter.kind = model::JointKind::locked;
  BOOST_TEST(unconstrained_of().empty());
}

BOOST_AUTO_TEST_SUITE_END()
